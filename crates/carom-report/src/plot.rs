//! Plots of a study in panes with a common legend. [`crate::tables`] writes the table beside each.
//!
//! Axes are linear or logarithmic; values that are not positive are omitted on a logarithmic axis.
//! Curves with the same label have the same style in all panes and one entry in the legend.

mod curve;
mod scale;

use std::fmt::Write as _;

use crate::axis::range;
use crate::chart::{in_lines, opened, turned, write_text};
use crate::labels::unit_of;
use crate::{text, trace};
pub(crate) use curve::{APART, COLORS, Curve, Drawn, style};
use scale::Scale;

const LEFT: f64 = 62.0;
const RIGHT: f64 = 16.0;
const TOP: f64 = 34.0;
const BELOW: f64 = 34.0;
/// Least width of a pane with its axis.
const LEAST: f64 = 210.0;
/// Height of a line of the legend, its font size, and the room of an entry beside its label.
const LINE: f64 = 18.0;
const SIZE: f64 = 12.0;
const ENTRY: f64 = 50.0;
/// Font size of ticks.
const TICK: f64 = 11.0;
/// Width of bold letters relative to others.
const BOLD: f64 = 1.12;

/// A grey band behind the curves.
#[derive(Clone, Debug)]
pub(crate) struct Band {
    /// Name in tables.
    pub(crate) name: &'static str,
    pub(crate) x: Vec<f64>,
    pub(crate) low: Vec<f64>,
    pub(crate) high: Vec<f64>,
}

/// A pane: axes and curves.
#[derive(Clone, Debug, Default)]
pub(crate) struct Pane {
    /// Name in tables, where it is not the title; no two panes of a figure have the same.
    pub(crate) name: String,
    pub(crate) title: String,
    pub(crate) y_label: String,
    pub(crate) curves: Vec<Curve>,
    pub(crate) band: Option<Band>,
    /// Vertical lines with labels.
    pub(crate) marks: Vec<(f64, String)>,
    /// A horizontal line with a label.
    pub(crate) floor: Option<(f64, String)>,
    /// Range of the vertical axis, where it is not that of the curves.
    pub(crate) limits: Option<(f64, f64)>,
    /// Range of the horizontal axis, likewise.
    pub(crate) span: Option<(f64, f64)>,
    /// Points of the Pareto front, from left to right.
    pub(crate) front: Vec<(f64, f64)>,
}

/// A figure.
#[derive(Clone, Debug, Default)]
pub(crate) struct Plot {
    pub(crate) name: String,
    pub(crate) caption: String,
    pub(crate) x_label: String,
    pub(crate) log: [bool; 2],
    /// Number of panes side by side.
    pub(crate) across: usize,
    /// Whether all panes share one vertical axis.
    pub(crate) same: bool,
    /// Whether the page folds it away.
    pub(crate) folded: bool,
    pub(crate) panes: Vec<Pane>,
}

impl Pane {
    /// The name of the pane in tables.
    pub(crate) fn name(&self) -> &str {
        if self.name.is_empty() { &self.title } else { &self.name }
    }

    /// The curves that set the axes: those of unsound runs do only where there is no other.
    fn setting_axes(&self) -> impl Iterator<Item = &Curve> {
        let all_apart = self.curves.iter().all(|curve| curve.apart);
        self.curves.iter().filter(move |curve| all_apart || !curve.apart)
    }
}

/// The rectangle of a pane in pixels.
struct Frame {
    left: f64,
    top: f64,
    wide: f64,
    high: f64,
}

impl Frame {
    fn right(&self) -> f64 {
        self.left + self.wide
    }

    fn bottom(&self) -> f64 {
        self.top + self.high
    }

    fn contains(&self, [x, y]: [f64; 2]) -> bool {
        let is_beside = (self.left - 0.5..=self.right() + 0.5).contains(&x);
        is_beside && (self.top - 0.5..=self.bottom() + 0.5).contains(&y)
    }
}

/// A pane in its place, with its scales.
struct Placed<'a> {
    pane: &'a Pane,
    id: String,
    frame: Frame,
    x: Scale,
    y: Scale,
}

impl Placed<'_> {
    fn to(&self, x: f64, y: f64) -> [f64; 2] {
        let Frame { left, top, wide, high } = self.frame;
        [left + wide * self.x.position(x), top + high * (1.0 - self.y.position(y))]
    }
}

impl Plot {
    fn shown<'a>(&self, values: impl Iterator<Item = &'a f64>, axis: usize) -> (f64, f64) {
        let log = self.log[axis];
        range(values.filter(|x| !log || **x > 0.0))
    }

    /// Panes share the horizontal axis, except those with a span of their own.
    fn x_range(&self, pane: &Pane) -> (f64, f64) {
        let all = self.panes.iter().filter(|pane| pane.span.is_none()).flat_map(Pane::setting_axes);
        pane.span.unwrap_or_else(|| self.shown(all.flat_map(|curve| &curve.x), 0))
    }

    fn y_range(&self, pane: &Pane) -> (f64, f64) {
        let of = |pane: &Pane| {
            let (from, to) = pane.span.unwrap_or((f64::NEG_INFINITY, f64::INFINITY));
            let points = pane.setting_axes().flat_map(|curve| curve.x.iter().zip(&curve.y));
            let values = points.filter(|(x, _)| (from..=to).contains(*x)).map(|(_, y)| y);
            let floor = pane.floor.iter().map(|(level, _)| level);
            pane.limits.unwrap_or_else(|| self.shown(values.chain(floor), 1))
        };
        if !self.same {
            return of(pane);
        }
        // Panes with unsound runs alone do not set the common axis, unless there are no others.
        let sets = |pane: &&Pane| pane.curves.iter().any(|curve| !curve.apart);
        let any = self.panes.iter().any(|pane| sets(&pane));
        let ranges = self.panes.iter().filter(|pane| !any || sets(pane)).map(of);
        ranges.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), (c, d)| (a.min(c), b.max(d)))
    }

    /// A curve of each distinct label.
    fn legend(&self) -> Vec<&Curve> {
        let mut found: Vec<&Curve> = Vec::new();
        for curve in self.panes.iter().flat_map(|pane| &pane.curves) {
            let is_known = found.iter().any(|known| known.label == curve.label);
            if !is_known && !curve.unlisted && !curve.label.is_empty() {
                found.push(curve);
            }
        }
        found
    }

    /// The picture of a width.
    pub(crate) fn drawn(&self, width: f64) -> String {
        let columns = self.across.max(1).min((width / LEAST) as usize).max(1);
        let high = match (self.across, self.panes.len()) {
            (3.., _) => 150.0,
            (2, _) => 230.0,
            (_, 2..) => 190.0,
            _ => 300.0,
        };
        let y_scale =
            |pane: &Pane| Scale::new(self.y_range(pane), (high / 40.0_f64).max(2.0), false, self.log[1]);
        let ticks = self.panes.iter().flat_map(|pane| y_scale(pane).axis.ticks);
        let widest = ticks.map(|(_, label)| text::width(&label) * TICK).fold(0.0, f64::max);
        let left = LEFT.max(widest + 34.0);
        let cell = width / columns as f64;
        let wide = cell - left - RIGHT;
        let count = (wide / if self.log[0] { 58.0 } else { 64.0 }).max(2.0);
        let end = self.panes.len().div_ceil(columns) as f64 * (TOP + high + BELOW);
        let entries = self.legend();
        let sizes = entries.iter().map(|curve| ENTRY + text::width(&curve.label) * SIZE);
        let lines = in_lines(sizes.enumerate(), width - LEFT);
        let height = end + 28.0 + LINE * lines.len() as f64;
        let mut out = opened("chart", &self.name, width, height);
        let name = self.name.replace(|c: char| !c.is_alphanumeric(), "-");
        let mut axis = None;
        for (i, pane) in self.panes.iter().enumerate() {
            let frame = Frame {
                left: (i % columns) as f64 * cell + left,
                top: (i / columns) as f64 * (TOP + high + BELOW) + TOP,
                wide,
                high,
            };
            let x = Scale::new(self.x_range(pane), count, !self.log[0], self.log[0]);
            let id = format!("{name}-{i}-{width}");
            let placed = Placed { pane, id, frame, x, y: y_scale(pane) };
            let is_first = !self.same || i % columns == 0;
            placed.draw(&mut out, if is_first { &pane.y_label } else { "" }, widest + 20.0);
            axis = Some(placed.x.axis);
        }
        let (words, unit) = unit_of(&self.x_label);
        let label = axis.map_or_else(|| self.x_label.clone(), |axis| axis.label(words, unit));
        let middle = if columns > 1 { 0.5 * width } else { left + 0.5 * wide };
        write_text(&mut out, middle, end + 6.0, "text-anchor=\"middle\"", &label);
        for (row, line) in lines.iter().enumerate() {
            let y = end + 24.0 + LINE * row as f64;
            let mut x = LEFT;
            for i in line {
                entries[*i].entry(&mut out, [x, y]);
                let label = text::fitted(&entries[*i].label, (width - x - 34.0) / SIZE);
                write_text(&mut out, x + 32.0, y + 4.0, &format!("font-size=\"{SIZE}\""), &label);
                x += ENTRY + text::width(&entries[*i].label) * SIZE;
            }
        }
        out.push_str("</svg>\n");
        out
    }
}

impl Placed<'_> {
    fn draw(&self, out: &mut String, y_label: &str, beside: f64) {
        let Self { pane, id, frame, .. } = self;
        let Frame { left, top, wide, high } = *frame;
        let _ = writeln!(
            out,
            "<clipPath id=\"{id}\"><rect x=\"{left:.1}\" y=\"{top:.1}\" width=\"{wide:.1}\" height=\"{high:.1}\"/></clipPath>"
        );
        if let Some(Band { x, low, high, .. }) = &pane.band {
            let edge = |values: &[f64]| x.iter().zip(values).map(|(x, y)| self.to(*x, *y).into()).collect();
            let d = trace::area([edge(high), edge(low)]);
            let _ = writeln!(out, "<path clip-path=\"url(#{id})\" d=\"{d}\" fill=\"#ececec\"/>");
        }
        self.axes(out, y_label, beside);
        if pane.front.len() > 1 {
            let d = trace::path(pane.front.iter().map(|(x, y)| self.to(*x, *y).into()));
            let _ = writeln!(
                out,
                "<path clip-path=\"url(#{id})\" d=\"{d}\" fill=\"none\" stroke=\"#222\" stroke-width=\"5\" \
                 stroke-opacity=\"0.18\" stroke-linejoin=\"round\" stroke-linecap=\"round\"/>"
            );
        }
        // What failed lies behind, what is recommended before the others.
        let mut order: Vec<&Curve> = pane.curves.iter().collect();
        order.sort_by_key(|curve| (!curve.apart, curve.thin, curve.chosen));
        for curve in order {
            let points: Vec<[f64; 2]> = curve.x.iter().zip(&curve.y).map(|(x, y)| self.to(*x, *y)).collect();
            // On a logarithmic axis an interval that contains zero has no lower end.
            let end = |x: f64, y: f64| self.to(x, y.max(f64::MIN_POSITIVE));
            let intervals = curve.x.iter().zip(&curve.intervals);
            curve.bars(out, intervals.map(|(x, [low, high])| [end(*x, *low), end(*x, *high)]), id);
            curve.draw(out, &points, id, &|point| frame.contains(point));
        }
        if let Some((level, word)) = &pane.floor {
            let [_, y] = self.to(0.0, *level);
            dashed(out, &format!("M{left:.1} {y:.1}h{wide:.1}"));
            let place = "text-anchor=\"end\" font-size=\"10\" fill=\"#555\" stroke=\"#fff\" stroke-width=\"3\" \
                         paint-order=\"stroke\"";
            write_text(out, frame.right() - 4.0, y - 4.0, place, word);
        }
    }

    /// Ticks, labels, marks and title.
    fn axes(&self, out: &mut String, y_label: &str, beside: f64) {
        let Self { pane, frame, .. } = self;
        let Frame { left, top, wide, high } = *frame;
        let bottom = frame.bottom();
        for (value, label) in &self.y.axis.ticks {
            let y = top + high * (1.0 - self.y.axis.position(*value));
            let _ = writeln!(
                out,
                "<path d=\"M{left:.1} {y:.1}h{wide:.1}\" stroke=\"#dddddd\" stroke-width=\"0.6\"/>"
            );
            write_text(out, left - 6.0, y + 4.0, "text-anchor=\"end\" font-size=\"11\"", label);
        }
        for (value, label) in &self.x.axis.ticks {
            let x = left + wide * self.x.axis.position(*value);
            let _ = writeln!(out, "<path d=\"M{x:.1} {bottom:.1}v4\" stroke=\"#222\" stroke-width=\"0.8\"/>");
            // The label of the last tick may not leave the pane's cell.
            let middle = x.min(frame.right() + RIGHT - 2.0 - 0.5 * TICK * text::width(label));
            write_text(out, middle, bottom + 16.0, "text-anchor=\"middle\" font-size=\"11\"", label);
        }
        let _ = writeln!(
            out,
            "<path d=\"M{left:.1} {top:.1}v{high:.1}h{wide:.1}\" fill=\"none\" stroke=\"#222\" stroke-width=\"0.9\"/>"
        );
        self.marks(out);
        let room = wide + RIGHT;
        let lines = |size: f64| text::broken(&pane.title, room / (BOLD * size));
        let size = [12.0, 10.5].into_iter().find(|size| lines(*size).len() <= 1).unwrap_or(9.5);
        // Above the labels of vertical lines.
        let above = if pane.marks.is_empty() { 8.0 } else { 20.0 };
        let lines = lines(size);
        let first = lines.first().cloned().unwrap_or_default();
        let rest = lines.get(1..).unwrap_or_default();
        let last = text::fitted(&rest.join(" "), room / (BOLD * size));
        for (k, line) in [last, first].iter().filter(|line| !line.is_empty()).enumerate() {
            let place = format!("font-size=\"{size}\" font-weight=\"600\"");
            write_text(out, left, top - above - 12.0 * k as f64, &place, line);
        }
        if !y_label.is_empty() {
            let (words, unit) = unit_of(y_label);
            let label = self.y.axis.label(words, unit);
            // Smaller where it is longer than the pane is high.
            let size = SIZE.min((high + 24.0) / text::width(&label).max(1e-9));
            let x = format!("{:.1}", left - beside);
            turned(out, (x, top + 0.5 * high), &format!(" font-size=\"{size:.1}\""), &label);
        }
    }

    /// Vertical lines with their labels above the pane.
    fn marks(&self, out: &mut String) {
        let Frame { left, top, .. } = self.frame;
        let place = |(x, word): &(f64, String)| (self.to(*x, 0.0)[0], word.clone());
        let mut marks: Vec<(f64, String)> = self.pane.marks.iter().map(place).collect();
        marks.retain(|(x, _)| (left..=self.frame.right()).contains(x));
        marks.sort_by(|a, b| a.0.total_cmp(&b.0));
        for (x, _) in &marks {
            dashed(out, &format!("M{x:.1} {top:.1}V{:.1}", self.frame.bottom()));
        }
        marks.retain(|(_, word)| !word.is_empty());
        let mut last = f64::NEG_INFINITY;
        for (k, (x, word)) in marks.iter().enumerate() {
            let is_near_next = marks.get(k + 1).is_some_and(|next| next.0 - x < 44.0);
            let anchor = match (x - last < 44.0, is_near_next) {
                (true, _) => "start",
                (false, true) => "end",
                (false, false) => "middle",
            };
            let style = format!("font-size=\"10\" fill=\"#555\" text-anchor=\"{anchor}\"");
            write_text(out, *x, top - 5.0, &style, word);
            last = *x;
        }
    }
}

/// A thin dashed line.
fn dashed(out: &mut String, d: &str) {
    let _ = writeln!(out, "<path d=\"{d}\" stroke=\"#777\" stroke-width=\"0.8\" stroke-dasharray=\"2 2\"/>");
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
            drawn: Drawn::Marked,
            ..Curve::default()
        };
        let pane = Pane { title: "one".into(), y_label: "E".into(), curves: vec![curve], ..Pane::default() };
        let name = "error-cost".into();
        let x_label = "time t_{c} (s)".into();
        Plot { name, x_label, log: [true, true], across: 2, panes: vec![pane], ..Plot::default() }
    }

    #[test]
    fn a_logarithmic_axis_omits_values_that_are_not_positive() {
        let svg = plot().drawn(720.0);
        assert!(!svg.contains("NaN") && !svg.contains("inf"), "{svg}");
        // One marker in the pane, one in the legend.
        assert_eq!(svg.matches("z\" fill=").count(), 2);
    }

    #[test]
    fn the_ring_is_around_one_point() {
        let mut plot = plot();
        plot.log = [false, false];
        let curve = &mut plot.panes[0].curves[0];
        curve.ring = Some(1);
        assert_eq!(plot.drawn(720.0).matches("r=\"8\"").count(), 1);
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
            x: vec![0.0, 1.0],
            y: vec![0.0, high],
            apart,
            ..Curve::default()
        };
        let fails = curve("fails", true, 50.0);
        plot.panes[0].curves = vec![curve("finishes", false, 1.0), fails.clone()];
        assert_eq!((plot.y_range(&plot.panes[0]), plot.legend().len()), ((0.0, 1.0), 2));
        assert!(plot.drawn(720.0).contains(&format!("stroke=\"{APART}\"")));
        plot.panes[0].curves = vec![fails];
        assert_eq!(plot.y_range(&plot.panes[0]), (0.0, 50.0));
    }
}
