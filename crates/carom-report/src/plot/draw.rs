//! Drawing of a plot: the panes with their axes and curves, and labels or a legend.

use std::fmt::Write as _;

use super::direct::End;
use super::frame::Frame;
use super::scale::Scale;
use super::{Band, Curve, Pane, Plot, curve, direct, legend};
use crate::chart::{open_chart, write_text};
use crate::labels::unit_of;
use crate::{text, trace};

const WIDTH: f64 = 720.0;
const LEFT: f64 = 62.0;
const RIGHT: f64 = 12.0;
/// Width of bold letters relative to others.
const BOLD: f64 = 1.12;
/// Font size of ticks.
const TICK: f64 = 11.0;
const TOP: f64 = 30.0;
const BELOW: f64 = 34.0;

/// The scales of a pane.
struct Scales {
    x: Scale,
    y: Scale,
}

impl Plot {
    /// The figure.
    pub(crate) fn svg(&self) -> String {
        let columns = self.across.max(1);
        let across = columns as f64;
        let labels = if self.direct { direct::room(self.legend().into_iter()) } else { 0.0 };
        let cell = WIDTH / across;
        let y_of = |pane: &Pane, high: f64| {
            Scale::new(self.y_range(pane), (high / 40.0).max(2.0), false, self.log[1])
        };
        let most = self.panes.iter().map(|pane| pane.curves.len()).max().unwrap_or(0);
        let high = match (columns, self.panes.len()) {
            (3.., _) => 150.0,
            (2, _) => 230.0,
            (_, 2..) => 190.0,
            _ => 320.0_f64,
        };
        let high = if self.direct { high.max(direct::LINE * most as f64 + 6.0) } else { high };
        let y_scales: Vec<Scale> = self.panes.iter().map(|pane| y_of(pane, high)).collect();
        let ticks = y_scales.iter().flat_map(|scale| &scale.axis.ticks);
        let widest = ticks.map(|(_, label)| text::width(label) * TICK).fold(0.0, f64::max);
        let left = LEFT.max(widest + 32.0);
        // A title of an axis keeps away from the pane to its left.
        let titled = self.panes.iter().enumerate().any(|(i, p)| i % columns > 0 && !p.y_label.is_empty());
        let right = if titled { 3.0 * RIGHT } else { RIGHT };
        let wide = cell - left - right.max(labels);
        let rows = self.panes.len().div_ceil(columns);
        let entries = if self.direct { Vec::new() } else { self.legend() };
        let lines = legend::lines(&entries, WIDTH - LEFT);
        let height = rows as f64 * (TOP + high + BELOW) + 22.0 + legend::LINE * lines.len() as f64 + 6.0;
        let mut out = open_chart(&self.name, WIDTH, height);
        let mut axis = None;
        for ((i, pane), y) in self.panes.iter().enumerate().zip(y_scales) {
            let frame = Frame {
                left: (i % columns) as f64 * cell + left,
                top: (i / columns) as f64 * (TOP + high + BELOW) + TOP,
                wide,
                high,
                beside: widest + 19.0,
            };
            let count = if self.log[0] { wide / 58.0 } else { wide / 64.0 };
            let scales =
                Scales { x: Scale::new(self.x_range(pane), count.max(2.0), !self.log[0], self.log[0]), y };
            let id = format!("{}-{i}", self.name.replace(|c: char| !c.is_alphanumeric(), "-"));
            self.pane(&mut out, pane, &frame, &scales, &id);
            axis = Some(scales.x.axis);
        }
        let end = rows as f64 * (TOP + high + BELOW);
        let (words, unit) = unit_of(&self.x_label);
        let label = axis.map_or_else(|| self.x_label.clone(), |axis| axis.label(words, unit));
        let middle = if columns > 1 { 0.5 * WIDTH } else { left + 0.5 * wide };
        write_text(&mut out, middle, end + 6.0, "text-anchor=\"middle\"", &label);
        legend::draw(&mut out, &entries, &lines, LEFT, end + 24.0);
        out.push_str("</svg>\n");
        out
    }

    fn pane(&self, out: &mut String, pane: &Pane, frame: &Frame, scales: &Scales, id: &str) {
        let Frame { left: x0, top: y0, wide, high, .. } = *frame;
        let to_x = |x: f64| x0 + wide * scales.x.position(x);
        let to_y = |y: f64| y0 + high * (1.0 - scales.y.position(y));
        let _ = writeln!(
            out,
            "<clipPath id=\"{id}\"><rect x=\"{x0:.1}\" y=\"{y0:.1}\" width=\"{wide:.1}\" \
             height=\"{high:.1}\"/></clipPath>"
        );
        if let Some(Band { x, low, high: up, .. }) = &pane.band {
            let shown = self.shown_band(pane);
            let rows: Vec<usize> = (0..x.len()).collect();
            for part in rows.chunk_by(|a, b| shown[*a] == shown[*b]).filter(|part| shown[part[0]]) {
                let upper = part.iter().map(|i| (to_x(x[*i]), to_y(up[*i])));
                let lower = part.iter().map(|i| (to_x(x[*i]), to_y(low[*i])));
                let _ = writeln!(
                    out,
                    "<path clip-path=\"url(#{id})\" d=\"{}\" fill=\"#ececec\" stroke=\"#ececec\" \
                     stroke-width=\"2.5\" stroke-linejoin=\"round\"/>",
                    trace::area(upper, lower)
                );
            }
        }
        self.axes(out, pane, frame, scales);
        if let Some((value, _)) = &pane.floor {
            let y = to_y(*value);
            let _ = writeln!(
                out,
                "<path d=\"M{x0:.1} {y:.1}h{wide:.1}\" stroke=\"#777\" stroke-width=\"0.8\" \
                 stroke-dasharray=\"2 2\"/>"
            );
        }
        marks(out, pane, &to_x, frame);
        if pane.front.len() > 1 {
            let points = pane.front.iter().map(|(x, y)| (to_x(*x), to_y(*y)));
            let _ = writeln!(
                out,
                "<path clip-path=\"url(#{id})\" d=\"{}\" fill=\"none\" stroke=\"#222\" stroke-width=\"5\" \
                 stroke-opacity=\"0.18\" stroke-linejoin=\"round\" stroke-linecap=\"round\"/>",
                trace::path(points)
            );
        }
        let _ = writeln!(
            out,
            "<path d=\"M{x0:.1} {y0:.1}v{high:.1}h{wide:.1}\" fill=\"none\" stroke=\"#222\" \
             stroke-width=\"0.9\"/>"
        );
        // What failed or is of less interest lies behind, points before all.
        let mut order: Vec<&Curve> = pane.curves.iter().collect();
        order.sort_by_key(|curve| (curve.points, curve.over, !curve.apart, !curve.quiet, curve.chosen));
        for curve in &order {
            curve::draw(out, curve, (id, frame), self.direct, &to_x, &to_y);
        }
        if self.direct {
            let shown: Vec<(&Curve, End)> = pane
                .curves
                .iter()
                .filter(|curve| !curve.label.is_empty() && !curve.unlisted)
                .filter_map(|curve| Some((curve, end(curve, frame, &to_x, &to_y)?)))
                .collect();
            let (curves, ends): (Vec<&Curve>, Vec<End>) = shown.into_iter().unzip();
            direct::draw(out, &curves, &ends, frame);
        }
        if let Some((value, word)) = &pane.floor {
            let place = "text-anchor=\"end\" font-size=\"10\" fill=\"#555\" stroke=\"#fff\" stroke-width=\"3\" \
                         paint-order=\"stroke\"";
            write_text(out, x0 + wide - 4.0, to_y(*value) - 4.0, place, word);
        }
    }

    /// Ticks, labels and title of a pane.
    fn axes(&self, out: &mut String, pane: &Pane, frame: &Frame, scales: &Scales) {
        let Frame { left: x0, top: y0, wide, high, beside } = *frame;
        for (value, label) in &scales.y.axis.ticks {
            let y = y0 + high * (1.0 - scales.y.axis.position(*value));
            let _ = writeln!(
                out,
                "<path d=\"M{x0:.1} {y:.1}h{wide:.1}\" stroke=\"#dddddd\" stroke-width=\"0.6\"/>"
            );
            write_text(out, x0 - 6.0, y + 4.0, "text-anchor=\"end\" font-size=\"11\"", label);
        }
        let bottom = frame.bottom();
        for (value, label) in &scales.x.axis.ticks {
            let x = x0 + wide * scales.x.axis.position(*value);
            let _ = writeln!(out, "<path d=\"M{x:.1} {bottom:.1}v4\" stroke=\"#222\" stroke-width=\"0.8\"/>");
            // The label of the last tick may not leave the figure.
            let middle = x.min(WIDTH - 2.0 - 0.5 * TICK * text::width(label));
            write_text(out, middle, bottom + 16.0, "text-anchor=\"middle\" font-size=\"11\"", label);
        }
        let size = if self.across > 2 { 10.5 } else { 12.0 };
        let place = format!("font-size=\"{size}\" font-weight=\"600\"");
        // Above the labels of vertical lines.
        let above = if pane.marks.is_empty() { 9.0 } else { 20.0 };
        let lines = two_lines(&pane.title, (wide + RIGHT) / (BOLD * size));
        for (k, line) in lines.iter().rev().enumerate() {
            write_text(out, x0, y0 - above - 12.0 * k as f64, &place, line);
        }
        if !pane.y_label.is_empty() {
            let (words, unit) = unit_of(&pane.y_label);
            let label = scales.y.axis.label(words, unit);
            // Smaller where it is longer than the pane is high.
            let size = (12.0_f64).min((high + 24.0) / text::width(&label).max(1e-9));
            let place = format!(
                "text-anchor=\"middle\" font-size=\"{size:.1}\" transform=\"translate({:.1} {:.1}) \
                 rotate(-90)\"",
                x0 - beside,
                y0 + 0.5 * high
            );
            write_text(out, 0.0, 0.0, &place, &label);
        }
    }
}

/// A title in at most two lines of a width; a second one that is too long is shortened.
fn two_lines(title: &str, most: f64) -> Vec<String> {
    let lines = text::broken(title, most);
    match &lines[..] {
        [first, rest @ ..] if rest.len() > 1 => vec![first.clone(), text::fitted(&rest.join(" "), most)],
        _ => lines.iter().map(|line| text::fitted(line, most)).collect(),
    }
}

/// Where a curve is last seen in its pane; at the edge if it never is.
fn end(curve: &Curve, frame: &Frame, to_x: &dyn Fn(f64) -> f64, to_y: &dyn Fn(f64) -> f64) -> Option<End> {
    let points = curve.x.iter().zip(&curve.y).map(|(x, y)| (to_x(*x), to_y(*y)));
    let mut points = points.filter(|p| p.0.is_finite() && p.1.is_finite()).collect::<Vec<_>>();
    let (top, bottom) = (frame.top, frame.bottom());
    if curve.marked {
        let last = *points.last()?;
        let (x, y) = frame.beyond(last).map_or(last, |(edge, _)| edge);
        return Some(End { x, y, leaves: false });
    }
    points.retain(|p| p.0 >= frame.left - 0.5 && p.0 <= frame.right() + 0.5);
    let last = *points.last()?;
    let seen = points.iter().rposition(|p| p.1 >= top - 0.5 && p.1 <= bottom + 0.5);
    let Some(seen) = seen else { return Some(End { x: last.0, y: last.1.clamp(top, bottom), leaves: true }) };
    let (x, y) = points[seen];
    let Some(next) = points.get(seen + 1) else {
        return Some(End { x, y: y.clamp(top, bottom), leaves: false });
    };
    // Where the line to the next point crosses the edge.
    let edge = if next.1 < top { top } else { bottom };
    let share = ((edge - y) / (next.1 - y)).clamp(0.0, 1.0);
    Some(End { x: x + share * (next.0 - x), y: edge, leaves: true })
}

/// Vertical lines with their labels above the pane, where they cover nothing.
fn marks(out: &mut String, pane: &Pane, to_x: &dyn Fn(f64) -> f64, frame: &Frame) {
    let (top, bottom) = (frame.top, frame.bottom());
    let mut marks: Vec<(f64, &str)> = pane.marks.iter().map(|(x, word)| (to_x(*x), word.as_str())).collect();
    marks.retain(|(x, _)| (frame.left..=frame.right()).contains(x));
    marks.sort_by(|a, b| a.0.total_cmp(&b.0));
    for (x, word) in &marks {
        // The line of a label is longer.
        let from = if word.is_empty() { top } else { top - 4.0 };
        let _ = writeln!(
            out,
            "<path d=\"M{x:.1} {from:.1}V{bottom:.1}\" stroke=\"#777\" stroke-width=\"0.8\" \
             stroke-dasharray=\"2 2\"/>"
        );
    }
    marks.retain(|(_, word)| !word.is_empty());
    for (k, (x, word)) in marks.iter().enumerate() {
        let near = |other: Option<&(f64, &str)>| other.is_some_and(|other| (other.0 - x).abs() < 44.0);
        let (anchor, by) = match (near(k.checked_sub(1).map(|before| &marks[before])), near(marks.get(k + 1)))
        {
            (true, _) => ("start", -4.0),
            (false, true) => ("end", 4.0),
            (false, false) => ("middle", 0.0),
        };
        let place = format!("font-size=\"10\" fill=\"#555\" text-anchor=\"{anchor}\"");
        write_text(out, x + by, top - 7.0, &place, word);
    }
}
