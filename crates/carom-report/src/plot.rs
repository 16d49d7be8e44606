//! Plots in panels. [`crate::redraw`] writes the table and a script for each of them.
//!
//! Axes are linear or logarithmic; values that are not positive are omitted on a logarithmic axis.
//! Curves with the same label have the same style in all panels and one entry in the common legend.

use std::fmt::Write as _;

use crate::axis::range;
use crate::chart::{open, scaled, write_text};
use crate::labels::with_unit;
use crate::{text, trace};

mod curve;
mod legend;
mod scale;

pub(crate) use curve::{APART, Curve, style};
use scale::Scale;

const WIDTH: f64 = 720.0;
const LEFT: f64 = 62.0;
const RIGHT: f64 = 12.0;

/// One panel: axes and curves.
#[derive(Clone, Debug, Default)]
pub(crate) struct Pane {
    pub(crate) title: String,
    pub(crate) y_label: String,
    pub(crate) curves: Vec<Curve>,
    /// Grey band behind the curves: x, lower and upper edge.
    pub(crate) band: Option<[Vec<f64>; 3]>,
    /// Vertical lines with labels.
    pub(crate) marks: Vec<(f64, String)>,
    /// A horizontal line with a label.
    pub(crate) floor: Option<(f64, String)>,
    /// Range of the vertical axis, where it is not that of the curves.
    pub(crate) limits: Option<(f64, f64)>,
}

/// A figure.
#[derive(Clone, Debug)]
pub(crate) struct Plot {
    pub(crate) name: String,
    pub(crate) caption: String,
    pub(crate) x_label: String,
    pub(crate) log: [bool; 2],
    /// Number of panes side by side.
    pub(crate) across: usize,
    /// Whether all panes share one vertical axis.
    pub(crate) same: bool,
    pub(crate) panes: Vec<Pane>,
}

impl Pane {
    /// The curves that set the axes: those of unsound runs do only where there is no other.
    fn setting_axes(&self) -> impl Iterator<Item = &Curve> {
        let all_apart = self.curves.iter().all(|curve| curve.apart);
        self.curves.iter().filter(move |curve| all_apart || !curve.apart)
    }
}

impl Plot {
    fn shown<'a>(&self, values: impl Iterator<Item = &'a f64>, axis: usize) -> (f64, f64) {
        let log = self.log[axis];
        range(values.filter(|x| !log || **x > 0.0))
    }

    fn x_range(&self) -> (f64, f64) {
        self.shown(self.panes.iter().flat_map(Pane::setting_axes).flat_map(|c| &c.x), 0)
    }

    fn y_range(&self, pane: &Pane) -> (f64, f64) {
        let of = |pane: &Pane| {
            // The middle of the band only: where the reference is most uncertain, its edges would
            // compress the curves.
            let band =
                pane.band.iter().flat_map(|b| b[1].iter().zip(&b[2]).map(|(low, high)| 0.5 * (low + high)));
            let middle: Vec<f64> = band.collect();
            let floor = pane.floor.as_ref().map(|f| f.0);
            pane.limits.unwrap_or_else(|| {
                self.shown(pane.setting_axes().flat_map(|c| &c.y).chain(&middle).chain(&floor), 1)
            })
        };
        if !self.same {
            return of(pane);
        }
        self.panes
            .iter()
            .map(of)
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), (c, d)| (a.min(c), b.max(d)))
    }

    /// A curve of each distinct label.
    pub(crate) fn legend(&self) -> Vec<&Curve> {
        let mut found: Vec<&Curve> = Vec::new();
        for curve in self.panes.iter().flat_map(|p| &p.curves).filter(|c| !c.label.is_empty()) {
            if !found.iter().any(|known| known.label == curve.label) {
                found.push(curve);
            }
        }
        found
    }

    /// The figure.
    pub(crate) fn svg(&self) -> String {
        const TOP: f64 = 30.0;
        const BELOW: f64 = 34.0;
        let across = self.across.max(1) as f64;
        let cell = WIDTH / across;
        let (wide, high) = (
            cell - LEFT - RIGHT,
            if across > 2.0 {
                150.0
            } else if across > 1.0 {
                230.0
            } else if self.panes.len() > 1 {
                190.0
            } else {
                320.0
            },
        );
        let rows = self.panes.len().div_ceil(self.across.max(1));
        let legend = self.legend();
        let lines = legend::lines(&legend, WIDTH - LEFT);
        let height = rows as f64 * (TOP + high + BELOW) + 22.0 + legend::LINE * lines.len() as f64 + 6.0;
        let mut out = open(&self.name, WIDTH, height);
        let x_axis = Scale::new(self.x_range(), (wide / 58.0).max(2.0), !self.log[0], self.log[0]);
        for (i, pane) in self.panes.iter().enumerate() {
            let (x0, y0) = (
                (i % self.across.max(1)) as f64 * cell + LEFT,
                (i / self.across.max(1)) as f64 * (TOP + high + BELOW) + TOP,
            );
            let y_axis = Scale::new(self.y_range(pane), (high / 40.0).max(2.0), false, self.log[1]);
            let to_x = |x: f64| x0 + wide * x_axis.position(x);
            let to_y = |y: f64| y0 + high * (1.0 - y_axis.position(y));
            let id = format!("{}-{i}", self.name.replace(|c: char| !c.is_alphanumeric(), "-"));
            let _ = writeln!(
                out,
                "<clipPath id=\"{id}\"><rect x=\"{x0:.1}\" y=\"{y0:.1}\" width=\"{wide:.1}\" \
                 height=\"{high:.1}\"/></clipPath>"
            );
            if let Some([x, low, up]) = &pane.band {
                let upper = x.iter().zip(up).map(|(x, y)| (to_x(*x), to_y(*y)));
                let lower = x.iter().zip(low).map(|(x, y)| (to_x(*x), to_y(*y)));
                let _ = writeln!(
                    out,
                    "<path clip-path=\"url(#{id})\" d=\"{}\" fill=\"#cfcfcf\" stroke=\"#cfcfcf\" \
                     stroke-width=\"2.5\" stroke-linejoin=\"round\"/>",
                    trace::area(upper, lower)
                );
            }
            for (value, label) in &y_axis.axis.ticks {
                let y = y0 + high * (1.0 - y_axis.axis.position(*value));
                let _ = writeln!(
                    out,
                    "<path d=\"M{x0:.1} {y:.1}h{wide:.1}\" stroke=\"#dddddd\" stroke-width=\"0.6\"/>"
                );
                write_text(&mut out, x0 - 6.0, y + 4.0, "text-anchor=\"end\" font-size=\"11\"", label);
            }
            let bottom = y0 + high;
            for (value, label) in &x_axis.axis.ticks {
                let x = x0 + wide * x_axis.axis.position(*value);
                let _ =
                    writeln!(out, "<path d=\"M{x:.1} {bottom:.1}v4\" stroke=\"#222\" stroke-width=\"0.8\"/>");
                write_text(&mut out, x, bottom + 16.0, "text-anchor=\"middle\" font-size=\"11\"", label);
            }
            if let Some((value, word)) = &pane.floor {
                let y = to_y(*value);
                let _ = writeln!(
                    out,
                    "<path d=\"M{x0:.1} {y:.1}h{wide:.1}\" stroke=\"#777\" stroke-width=\"0.8\" \
                     stroke-dasharray=\"2 2\"/>"
                );
                let place = "text-anchor=\"end\" font-size=\"10\" fill=\"#555\"";
                write_text(&mut out, x0 + wide - 4.0, y - 4.0, place, word);
            }
            marks(&mut out, pane, &to_x, (y0, bottom), (x0, x0 + wide));
            let _ = writeln!(
                out,
                "<path d=\"M{x0:.1} {y0:.1}v{high:.1}h{wide:.1}\" fill=\"none\" stroke=\"#222\" \
                 stroke-width=\"0.9\"/>"
            );
            // Unsound runs lie behind the others.
            let (behind, front): (Vec<_>, Vec<_>) = pane.curves.iter().partition(|curve| curve.apart);
            for curve in behind.into_iter().chain(front) {
                curve::draw(&mut out, curve, &id, &to_x, &to_y);
            }
            let size = if across > 2.0 { 10.5 } else { 12.0 };
            let place = format!("font-size=\"{size}\" font-weight=\"600\"");
            write_text(&mut out, x0, y0 - 9.0, &place, &fitted(&pane.title, wide + RIGHT, size));
            if !pane.y_label.is_empty() {
                let label = if y_axis.axis.exponent == 0 {
                    pane.y_label.clone()
                } else {
                    let (words, unit) = unit_of(&pane.y_label);
                    with_unit(words, &scaled(unit, y_axis.axis.exponent))
                };
                let place = format!(
                    "text-anchor=\"middle\" font-size=\"12\" transform=\"translate({:.1} {:.1}) \
                     rotate(-90)\"",
                    x0 - LEFT + 13.0,
                    y0 + 0.5 * high
                );
                write_text(&mut out, 0.0, 0.0, &place, &label);
            }
        }
        let end = rows as f64 * (TOP + high + BELOW);
        let exponent = x_axis.axis.exponent;
        let label = if exponent == 0 {
            self.x_label.clone()
        } else {
            format!("{} × 10^{{{exponent}}}", self.x_label)
        };
        write_text(&mut out, 0.5 * WIDTH, end + 6.0, "text-anchor=\"middle\"", &label);
        legend::draw(&mut out, &legend, &lines, LEFT, end + 24.0);
        out.push_str("</svg>\n");
        out
    }
}

/// Splits a label into text and the unit in brackets at its end.
fn unit_of(label: &str) -> (&str, &str) {
    label.strip_suffix(')').and_then(|l| l.rsplit_once(" (")).unwrap_or((label, ""))
}

/// A title shortened to a width.
fn fitted(title: &str, width: f64, size: f64) -> String {
    if text::width(title) * size <= width {
        return title.to_owned();
    }
    let mut cut: String = title.to_owned();
    while !cut.is_empty() && text::width(&cut) * size > width - size {
        cut.pop();
    }
    cut.trim_end().to_owned() + "…"
}

fn marks(
    out: &mut String,
    pane: &Pane,
    to_x: &dyn Fn(f64) -> f64,
    (top, bottom): (f64, f64),
    (left, right): (f64, f64),
) {
    for (x, word) in &pane.marks {
        let x = to_x(*x);
        if !(left..=right).contains(&x) {
            continue;
        }
        let _ = writeln!(
            out,
            "<path d=\"M{x:.1} {top:.1}V{bottom:.1}\" stroke=\"#777\" stroke-width=\"0.8\" \
             stroke-dasharray=\"2 2\"/>"
        );
        if !word.is_empty() {
            let place = format!(
                "font-size=\"10\" fill=\"#555\" text-anchor=\"end\" transform=\"translate({:.1} {:.1}) \
                 rotate(-90)\"",
                x - 3.0,
                top + 4.0
            );
            write_text(out, 0.0, 0.0, &place, word);
        }
    }
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;

    pub(crate) fn plot() -> Plot {
        let curve = Curve {
            label: "Hu, \"a\"".into(),
            style: 9,
            x: vec![1e-3, 1e-2],
            y: vec![0.0, 2e-4],
            marked: true,
            apart: false,
        };
        Plot {
            name: "error-cost".into(),
            caption: String::new(),
            x_label: "time t_{c} (s)".into(),
            log: [true, true],
            across: 2,
            same: false,
            panes: vec![Pane {
                title: "one".into(),
                y_label: "E".into(),
                curves: vec![curve],
                ..Pane::default()
            }],
        }
    }

    #[test]
    fn a_logarithmic_axis_omits_values_that_are_not_positive() {
        let svg = plot().svg();
        assert!(!svg.contains("NaN") && !svg.contains("inf"), "{svg}");
        // One marker in the pane, one in the legend.
        assert_eq!(svg.matches("z\" fill=").count(), 2);
    }

    #[test]
    fn forty_styles_differ() {
        assert_eq!((0..40).map(style).collect::<std::collections::HashSet<_>>().len(), 40);
    }

    #[test]
    fn an_unsound_run_is_grey_and_does_not_set_the_axes() {
        let mut plot = plot();
        plot.log = [false, false];
        let curve = |label: &str, apart: bool, high: f64| Curve {
            label: label.into(),
            style: 0,
            x: vec![0.0, 1.0],
            y: vec![0.0, high],
            marked: false,
            apart,
        };
        let with = |plot: &Plot, curves: Vec<Curve>| {
            let panes = vec![Pane { curves, ..plot.panes[0].clone() }];
            Plot { panes, ..plot.clone() }
        };
        let fails = curve("fails", true, 50.0);
        let both = with(&plot, vec![curve("finishes", false, 1.0), fails.clone()]);
        assert_eq!((both.y_range(&both.panes[0]), both.legend().len()), ((0.0, 1.0), 2));
        assert!(both.svg().contains(&format!("stroke=\"{}\"", APART.0)));
        let alone = with(&plot, vec![fails]);
        assert_eq!(alone.y_range(&alone.panes[0]), (0.0, 50.0));
    }
}
