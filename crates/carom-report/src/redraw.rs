//! Files beside a figure: its data as a table, and a short script that redraws it with matplotlib
//! with the same panes, axes, marks and styles.

use std::fmt::Write as _;

use crate::chart::{Chart, Panel, Series};
use crate::labels::with_unit;
use crate::palette::LINES;
use crate::plot::{APART, Curve, Pane, Plot, style};

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
apart = @APART@  # dashed grey, without influence on the axes
y_labels = @Y_LABELS@
limits, floors, spans, fronts = @LIMITS@, @FLOORS@, @SPANS@, @FRONTS@
marks = @MARKS@
points = @POINTS@  # without lines between them
marked, direct, across = @MARKED@, @DIRECT@, @ACROSS@

def style(label):
    if label in apart:
        return {"color": "@APART_COLOR@", "ls": @APART_DASHES@, "zorder": 1}
    i = styles[label]
    if label in points:
        return {"color": colors[i % 8], "marker": "os^Dv"[i % 5], "ms": 4, "ls": "none"}
    if marked:
        return {"color": colors[i % 8], "marker": "os^Dv"[i % 5], "ms": 4}
    return {"color": colors[i % 8], "ls": dashes[(i + i // 8) % 8] if label and not direct else "-"}

rows = -(-len(panes) // across)
size = (7.2, @HIGH@ * rows + 0.5 + 0.1 * len(styles))
figure, axes = plt.subplots(
    rows, across, figsize=size, squeeze=False, sharex=@SHARED@, sharey=@SAME@, layout="constrained"
)
for k, (title, curves) in enumerate(panes.items()):
    ax = axes.flat[k]
    low, high = curves.pop("reference, low", None), curves.pop("reference, high", None)
    if low:
        ax.fill_between(low[0], low[1], high[1], color="#cfcfcf")
    for label in sorted(curves, key=lambda label: label in apart):
        if label in apart and not apart.issuperset(curves):
            ax.set(xlim=ax.get_xlim(), ylim=ax.get_ylim())
        ax.plot(*curves[label], lw=1.2, label=label, **style(label))
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
    ax.set_title(title, fontsize=9 if across < 3 else 7.5)
    ax.set(ylabel=y_labels[k], xscale="@X_SCALE@", yscale="@Y_SCALE@", ylim=limits[k], xlim=spans[k])
for ax in axes.flat[len(panes):]:
    ax.set_visible(False)
for column in range(across):
    last = [ax for ax in axes[:, column] if ax.get_visible()][-1]
    last.set_xlabel(@X_LABEL@)
    last.tick_params(labelbottom=True)
handles = {l: h for ax in axes.flat for h, l in zip(*ax.get_legend_handles_labels())}
if handles:
    figure.legend(handles.values(), handles.keys(), loc="outside lower center", ncols=2, fontsize=8)
figure.savefig(here / "@NAME@-redrawn.pdf")
"##;

impl Plot {
    /// The table with columns `pane,curve,x,y`; the edges of a band are the curves `reference, low`
    /// and `reference, high`.
    pub(crate) fn csv(&self) -> String {
        let mut out = String::from("pane,curve,x,y\n");
        let quoted = |text: &str| format!("\"{}\"", text.replace('"', "\"\""));
        for pane in &self.panes {
            let mut rows = |label: &str, x: &[f64], y: &[f64]| {
                for (x, y) in x.iter().zip(y) {
                    let _ = writeln!(out, "{},{},{x:?},{y:?}", quoted(&pane.title), quoted(label));
                }
            };
            if let Some([x, low, high]) = &pane.band {
                rows("reference, low", x, low);
                rows("reference, high", x, high);
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
        let mark = |m: &(f64, String)| format!("({:?}, {:?})", m.0, plain(&m.1));
        let curves = || self.panes.iter().flat_map(|p| &p.curves);
        let mut styles: Vec<String> = curves().map(|c| format!("{:?}: {}", c.label, c.style)).collect();
        styles.sort_unstable();
        styles.dedup();
        let set = |of: &dyn Fn(&Curve) -> bool| {
            let mut labels: Vec<String> =
                curves().filter(|c| of(c)).map(|c| format!("{:?}", c.label)).collect();
            labels.dedup();
            if labels.is_empty() { "set()".to_owned() } else { format!("{{{}}}", labels.join(", ")) }
        };
        let truth = |yes: bool| if yes { "True" } else { "False" }.to_owned();
        let scale = |axis: usize| if self.log[axis] { "log" } else { "linear" }.to_owned();
        let dashes: Vec<String> = (0..8).map(|i| dashes(style(i).1)).collect();
        [
            ("NAME", self.name.clone()),
            ("COLORS", format!("{:?}", [0, 1, 2, 3, 4, 5, 6, 7].map(|i| style(i).0))),
            ("DASHES", format!("[{}]", dashes.join(", "))),
            ("STYLES", format!("{{{}}}", styles.join(", "))),
            ("APART", set(&|c| c.apart)),
            ("APART_COLOR", APART.0.to_owned()),
            ("APART_DASHES", self::dashes(APART.1)),
            ("Y_LABELS", list(&|p| format!("{:?}", plain(&p.y_label)))),
            ("LIMITS", list(&|p| p.limits.map_or("None".into(), |l| format!("{l:?}")))),
            ("SPANS", list(&|p| p.span.map_or("None".into(), |l| format!("{l:?}")))),
            ("FRONTS", list(&|p| format!("{:?}", p.front))),
            ("SHARED", truth(self.panes.iter().all(|pane| pane.span == self.panes[0].span))),
            ("FLOORS", list(&|p| p.floor.as_ref().map_or("None".into(), mark))),
            ("MARKS", list(&|p| format!("[{}]", p.marks.iter().map(mark).collect::<Vec<_>>().join(", ")))),
            ("MARKED", truth(curves().any(|c| c.marked && !c.points))),
            ("POINTS", set(&|c| c.points)),
            ("DIRECT", truth(self.direct || curves().any(|c| c.points))),
            ("ACROSS", self.across.max(1).to_string()),
            (
                "HIGH",
                if self.panes.len() == 1 {
                    "4.0"
                } else {
                    ["2.2", "3.0", "1.9"][self.across.clamp(1, 3) - 1]
                }
                .to_owned(),
            ),
            ("SAME", truth(self.same)),
            ("X_SCALE", scale(0)),
            ("Y_SCALE", scale(1)),
            ("X_LABEL", format!("{:?}", plain(&self.x_label))),
        ]
        .iter()
        .fold(SCRIPT.to_owned(), |script, (word, value)| script.replace(&format!("@{word}@"), value))
    }
}

/// A chart over time as a plot, for its table and script.
pub(crate) fn of_chart(name: &str, chart: &Chart) -> Plot {
    // Tables have names without the signs of subscripts.
    let bare = |label: &str| label.replace("_{", "_").replace('}', "");
    let curve = |(k, series): (usize, &Series)| Curve {
        label: bare(&series.label),
        style: LINES.iter().position(|color| *color == series.color).unwrap_or(k % LINES.len()),
        x: series.x.to_vec(),
        y: series.y.clone(),
        marked: series.dotted,
        points: series.dotted,
        ..Curve::default()
    };
    let pane = |panel: &Panel| Pane {
        title: bare(&panel.label),
        y_label: with_unit(&panel.label, &panel.unit),
        curves: panel.series.iter().enumerate().map(curve).collect(),
        ..Pane::default()
    };
    Plot {
        name: name.to_owned(),
        caption: String::new(),
        x_label: chart.x_label.clone(),
        log: [false, false],
        across: 1,
        same: false,
        direct: true,
        panes: chart.panels.iter().map(pane).collect(),
    }
}

/// Dashes in the notation of matplotlib; `"-"` for none.
fn dashes(svg: &str) -> String {
    if svg.is_empty() { "\"-\"".to_owned() } else { format!("(0, ({}))", svg.replace(' ', ", ")) }
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
