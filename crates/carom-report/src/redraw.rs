//! Files beside a figure: its data as a table, and a short script that redraws it with matplotlib
//! with the same panes, axes, marks and styles.

use std::fmt::Write as _;

use crate::chart::{Chart, Options, Panel, Series, WIDTH};
use crate::figure::{Figure, NARROW};
use crate::labels::with_unit;
use crate::palette::LINES;
use crate::plot::{APART, Band, Curve, Pane, Plot, style};

/// The script; every `@WORD@` is replaced.
const SCRIPT: &str = r##"#!/usr/bin/env python3
"""Plots @NAME@.csv into @NAME@-redrawn.pdf: python3 @NAME@.py  (needs matplotlib)"""
import csv, pathlib
import matplotlib.pyplot as plt

here = pathlib.Path(__file__).resolve().parent
panes = {}
with open(here / "@NAME@.csv", encoding="utf-8", newline="") as file:
    for row in csv.DictReader(file):
        x, y = panes.setdefault(row["pane"], {}).setdefault(row["curve"], ([], []))
        x.append(float(row["x"])); y.append(float(row["y"]))

colors = @COLORS@
dashes = @DASHES@
styles = @STYLES@
own = @OWN@  # colours of curves with one of their own
apart = @APART@  # grey, without influence on the axes
unlisted = @UNLISTED@  # not in the legend
titles = @TITLES@
y_labels = @Y_LABELS@
bands = @BANDS@
limits, floors, spans, fronts = @LIMITS@, @FLOORS@, @SPANS@, @FRONTS@
marks = @MARKS@
thin = @THIN@  # dashed, above the others
points = @POINTS@  # without lines between them
marked, direct, across = @MARKED@, @DIRECT@, @ACROSS@

def style(label):
    if label in apart:
        return {"color": "@APART_COLOR@", "lw": 0.8, "zorder": 1}
    i = styles[label]
    color = own.get(label, colors[i % 8])
    if label in thin:
        return {"color": color, "lw": 0.8, "ls": "--", "zorder": 3}
    if label in points:
        return {"color": color, "marker": "os^Dv"[i % 5], "ms": 4, "ls": "none"}
    if marked:
        return {"color": color, "marker": "os^Dv"[i % 5], "ms": 4}
    return {"color": color, "ls": dashes[(i + i // 8) % 8] if label and not direct else "-"}

rows = -(-len(panes) // across)
size = (7.2, @HIGH@ * rows + 0.5 + 0.1 * len(styles))
figure, axes = plt.subplots(
    rows, across, figsize=size, squeeze=False, sharex=@SHARED@, sharey=@SAME@, layout="constrained"
)
for k, curves in enumerate(panes.values()):
    ax = axes.flat[k]
    if bands[k]:
        low, high = (curves.pop(f"{bands[k]}, {edge}") for edge in ("low", "high"))
        ax.fill_between(low[0], low[1], high[1], color="#cfcfcf")
    for label in sorted(curves, key=lambda label: label in apart):
        if label in apart and not apart.issuperset(curves):
            ax.set(xlim=ax.get_xlim(), ylim=ax.get_ylim())
        ax.plot(*curves[label], label=None if label in unlisted else label, **{"lw": 1.2, **style(label)})
    if fronts[k]:
        ax.plot(*zip(*fronts[k]), color="#222222", alpha=0.18, lw=5, zorder=0)
    for x, word in marks[k]:
        ax.axvline(x, color="#777777", lw=0.7, ls=":")
        ax.annotate(
            word, (x, 0.97), xycoords=("data", "axes fraction"), rotation=90, ha="right", va="top", fontsize=7
        )
    if floors[k]:
        ax.axhline(floors[k][0], color="#777777", lw=0.7, ls=":")
        level, word = floors[k]
        ax.annotate(
            word, (0.98, level), xycoords=("axes fraction", "data"), ha="right", va="bottom", fontsize=7
        )
    ax.set_title(titles[k], fontsize=9 if across < 3 else 7.5)
    ax.set(ylabel=y_labels[k], xscale="@X_SCALE@", yscale="@Y_SCALE@", ylim=limits[k], xlim=spans[k])
for ax in axes.flat[len(panes):]:
    ax.set_visible(False)
for column in axes.T:
    for ax in [ax for ax in column if ax.get_visible()][-1:]:
        ax.set_xlabel(@X_LABEL@)
        ax.tick_params(labelbottom=True)
handles = {l: h for ax in axes.flat for h, l in zip(*ax.get_legend_handles_labels())}
if handles:
    figure.legend(handles.values(), handles.keys(), loc="outside lower center", ncols=2, fontsize=8)
figure.savefig(here / "@NAME@-redrawn.pdf")
"##;

impl Chart<'_> {
    /// The figure of that name, broad and narrow, with its table and script.
    pub(crate) fn figure(&self, name: &str, caption: String, options: &Options) -> Figure {
        let pictures = [WIDTH, NARROW].map(|width| self.draw(&Options { width, ..*options }));
        let plot = of_chart(name, self);
        Figure::new(name, caption, pictures).with(plot.csv(), plot.script())
    }
}

impl Plot {
    /// The figure, broad and narrow, with its table and script.
    pub(crate) fn figure(&self) -> Figure {
        let pictures = [self.svg(), self.narrow()];
        Figure::new(&self.name, &self.caption, pictures).with(self.csv(), self.script())
    }

    /// The table with columns `pane,curve,x,y`; the edges of a band are the curves `NAME, low` and
    /// `NAME, high`.
    pub(crate) fn csv(&self) -> String {
        let mut out = String::from("pane,curve,x,y\n");
        for pane in &self.panes {
            let mut rows = |label: &str, x: &[f64], y: &[f64]| {
                for (x, y) in x.iter().zip(y) {
                    let _ = writeln!(out, "{},{},{x:?},{y:?}", quoted(pane.name()), quoted(label));
                }
            };
            if let Some(Band { name, x, low, high }) = &pane.band {
                rows(&format!("{name}, low"), x, low);
                rows(&format!("{name}, high"), x, high);
            }
            pane.curves.iter().for_each(|c| rows(&c.label, &c.x, &c.y));
        }
        out
    }

    /// The script that plots the table with matplotlib.
    pub(crate) fn script(&self) -> String {
        let list = |of: &dyn Fn(&Pane) -> String| {
            let each: Vec<String> = self.panes.iter().map(of).collect();
            format!("[{}]", each.join(", "))
        };
        let mark = |m: &(f64, String)| format!("({:?}, {})", m.0, string(&plain(&m.1)));
        let curves = || self.panes.iter().flat_map(|p| &p.curves);
        let braced = |mut items: Vec<String>| {
            items.sort_unstable();
            items.dedup();
            format!("{{{}}}", items.join(", "))
        };
        let styles = curves().map(|c| format!("{}: {}", string(&c.label), c.style)).collect();
        let own = curves().filter_map(|c| Some(format!("{}: {}", string(&c.label), string(c.color?))));
        let set = |of: &dyn Fn(&Curve) -> bool| {
            let labels: Vec<String> = curves().filter(|c| of(c)).map(|c| string(&c.label)).collect();
            if labels.is_empty() { "set()".to_owned() } else { braced(labels) }
        };
        let listed: Vec<&str> = curves().filter(|c| !c.unlisted).map(|c| c.label.as_str()).collect();
        let truth = |yes: bool| if yes { "True" } else { "False" }.to_owned();
        let scale = |axis: usize| if self.log[axis] { "log" } else { "linear" }.to_owned();
        let high = ["2.2", "3.0", "1.9"][self.across.clamp(1, 3) - 1];
        let high = if self.panes.len() == 1 { "4.0" } else { high };
        let dashes: Vec<String> = (0..8).map(|i| dashes(style(i).1)).collect();
        [
            ("NAME", self.name.clone()),
            ("COLORS", format!("{:?}", [0, 1, 2, 3, 4, 5, 6, 7].map(|i| style(i).0))),
            ("DASHES", format!("[{}]", dashes.join(", "))),
            ("STYLES", braced(styles)),
            ("OWN", braced(own.collect())),
            ("APART", set(&|c| c.apart)),
            ("APART_COLOR", APART.to_owned()),
            ("UNLISTED", set(&|c| !listed.contains(&c.label.as_str()))),
            ("TITLES", list(&|p| string(&plain(&p.title)))),
            ("Y_LABELS", list(&|p| string(&plain(&p.y_label)))),
            ("BANDS", list(&|p| p.band.as_ref().map_or("None".into(), |band| string(band.name)))),
            ("LIMITS", list(&|p| p.limits.map_or("None".into(), |l| format!("{l:?}")))),
            ("SPANS", list(&|p| p.span.map_or("None".into(), |l| format!("{l:?}")))),
            ("FRONTS", list(&|p| format!("{:?}", p.front))),
            ("SHARED", truth(self.panes.iter().all(|pane| pane.span == self.panes[0].span))),
            ("FLOORS", list(&|p| p.floor.as_ref().map_or("None".into(), mark))),
            ("MARKS", list(&|p| format!("[{}]", p.marks.iter().map(mark).collect::<Vec<_>>().join(", ")))),
            ("MARKED", truth(curves().any(|c| c.marked && !c.points))),
            ("THIN", set(&|c| c.over)),
            ("POINTS", set(&|c| c.points)),
            ("DIRECT", truth(self.direct || curves().any(|c| c.points))),
            ("ACROSS", self.across.max(1).to_string()),
            ("HIGH", high.to_owned()),
            ("SAME", truth(self.same)),
            ("X_SCALE", scale(0)),
            ("Y_SCALE", scale(1)),
            ("X_LABEL", string(&plain(&self.x_label))),
        ]
        .iter()
        .fold(SCRIPT.to_owned(), |script, (word, value)| script.replace(&format!("@{word}@"), value))
    }
}

/// A chart over time as a plot, for its table and script.
fn of_chart(name: &str, chart: &Chart) -> Plot {
    // Tables have names without the signs of subscripts.
    let bare = |label: &str| label.replace("_{", "_").replace('}', "");
    let curve = |(k, series): (usize, &Series)| {
        let known = LINES.iter().position(|color| *color == series.color);
        Curve {
            label: bare(&series.label),
            style: known.unwrap_or(k % LINES.len()),
            color: known.is_none().then_some(series.color),
            x: series.x.to_vec(),
            y: series.y.clone(),
            marked: series.dotted,
            points: series.dotted,
            unlisted: series.unlisted,
            ..Curve::default()
        }
    };
    let pane = |panel: &Panel| Pane {
        name: bare(&panel.label),
        title: panel.label.clone(),
        y_label: with_unit(&panel.label, &panel.unit),
        curves: panel.series.iter().enumerate().map(curve).collect(),
        ..Pane::default()
    };
    Plot {
        name: name.to_owned(),
        x_label: chart.x_label.clone(),
        across: 1,
        direct: true,
        panes: chart.panels.iter().map(pane).collect(),
        ..Plot::default()
    }
}

/// Text as a cell of a table.
pub(crate) fn quoted(text: &str) -> String {
    format!("\"{}\"", text.replace('"', "\"\""))
}

/// Dashes in the notation of matplotlib; `"-"` for none.
fn dashes(svg: &str) -> String {
    if svg.is_empty() { "\"-\"".to_owned() } else { format!("(0, ({}))", svg.replace(' ', ", ")) }
}

/// A script with labels in the places of their words.
pub(crate) fn filled(script: &str, labels: &[(&str, String)]) -> String {
    labels
        .iter()
        .fold(script.to_owned(), |script, (word, label)| script.replace(word, &string(&plain(label))))
}

/// A string of Python: JSON's are.
fn string(text: &str) -> String {
    serde_json::Value::from(text).to_string()
}

/// A label with subscripts and superscripts in the notation of matplotlib.
fn plain(label: &str) -> String {
    let mut out = String::new();
    let mut rest = label;
    while let Some(at) = rest.find(['_', '^']) {
        let (before, after) = rest.split_at(at);
        out.push_str(before);
        if let (true, Some(end)) = (after[1..].starts_with('{'), after.find('}')) {
            let _ = write!(out, "${}{{\\mathrm{{{}}}}}$", &after[..1], &after[2..end]);
            rest = &after[end + 1..];
        } else {
            out.push_str(&after[..1]);
            rest = &after[1..];
        }
    }
    out + rest
}

#[cfg(test)]
mod tests {
    use crate::plot::tests::plot;

    #[test]
    fn the_table_has_all_values() {
        assert_eq!(
            plot().csv(),
            "pane,curve,x,y\n\"one\",\"Hu, \"\"a\"\"\",0.001,0.0\n\"one\",\"Hu, \"\"a\"\"\",0.01,0.0002\n"
        );
    }

    /// The second panel of a chart has no legend, but its curves have names, and their own colours.
    #[test]
    fn curves_of_every_panel_have_names() {
        use crate::chart::{Chart, Options, Panel, Series};
        let series = |unlisted| Series {
            label: "t = 1 s".into(),
            color: "#00224e",
            x: &[0.0, 1.0],
            y: vec![0.0, 1.0],
            dotted: false,
            unlisted,
        };
        let panel = |label: &str, unlisted| Panel {
            label: label.into(),
            unit: String::new(),
            height: 100.0,
            series: vec![series(unlisted)],
        };
        let panels = vec![panel("u_{x}", false), panel("v_{x}", true)];
        let chart = Chart { title: "", x_label: String::new(), shades: Vec::new(), panels };
        let plot = super::of_chart("bodies", &chart);
        assert!(plot.csv().contains("\"v_x\",\"t = 1 s\",1.0,1.0"));
        let script = plot.script();
        assert!(script.contains(r##"own = {"t = 1 s": "#00224e"}"##) && script.contains("unlisted = set()"));
        assert_eq!(chart.draw(&Options::default()).matches("t = 1 s").count(), 1);
    }

    /// Units are any text.
    #[test]
    fn labels_are_strings() {
        let labels = [("@S@", "s (\"\\ kg/m^{2})".to_owned())];
        assert_eq!(super::filled("ylabel=@S@", &labels), r#"ylabel="s (\"\\ kg/m$^{\\mathrm{2}}$)""#);
    }

    #[test]
    fn every_word_of_the_script_is_replaced() {
        let script = plot().script();
        assert!(
            script.contains("time t$_{\\\\mathrm{c}}$ (s)")
                && script.contains(r#"styles = {"Hu, \"a\"": 9}"#),
            "{script}"
        );
        assert!(!script.contains('@'), "{script}");
    }
}
