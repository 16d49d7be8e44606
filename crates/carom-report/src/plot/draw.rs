//! Drawing of a plot: the panes with their axes and curves, and labels or a legend.

use std::fmt::Write as _;

use super::direct::End;
use super::frame::Frame;
use super::layout::{LEFT, Layout, RIGHT, TICK};
use super::scale::Scale;
use super::{Band, Curve, Pane, Plot, curve, direct, legend};
use crate::again::{again, once};
use crate::chart::{opened, turned, write_text};
use crate::figure::NARROW;
use crate::labels::unit_of;
use crate::{text, trace};

const WIDTH: f64 = 720.0;
/// Width of bold letters relative to others.
const BOLD: f64 = 1.12;

/// The scales of a pane.
struct Scales {
    x: Scale,
    y: Scale,
}

/// Where a pane is drawn: name, place, and for one of the narrow picture its place in the broad
/// one.
struct Place {
    id: String,
    frame: Frame,
    broad: Option<Frame>,
}

impl Place {
    /// Adds lines within the frame, which the narrow picture shows again.
    fn shared(&self, out: &mut String, part: &str, lines: impl FnOnce(&mut String)) {
        let _ = writeln!(out, "<g clip-path=\"url(#{})\">", self.id);
        let name = format!("{}-{part}", self.id.trim_end_matches(SMALL));
        if let Some(broad) = &self.broad {
            again(out, &name, broad.rectangle(), self.frame.rectangle());
        } else {
            let mut content = String::new();
            lines(&mut content);
            once(out, &name, "chart", &content);
        }
        out.push_str("</g>\n");
    }
}

/// The end of names in the narrow picture.
const SMALL: &str = "-narrow";

impl Plot {
    /// The broad picture.
    pub(crate) fn svg(&self) -> String {
        self.drawn(&Layout::new(self, WIDTH, self.direct), None)
    }

    /// The picture for a narrow window, on a page with the other one; its legend is below.
    pub(crate) fn narrow(&self) -> String {
        let broad = Layout::new(self, WIDTH, self.direct);
        self.drawn(&Layout::new(self, NARROW, false), Some(&broad))
    }

    fn drawn(&self, layout: &Layout, broad: Option<&Layout>) -> String {
        let mut out = opened("chart", &self.name, layout.width, layout.height());
        let mut axis = None;
        let end = if broad.is_some() { SMALL } else { "" };
        for (i, pane) in self.panes.iter().enumerate() {
            let frame = layout.frame(i);
            let count = frame.wide / if self.log[0] { 58.0 } else { 64.0 };
            let scales = Scales {
                x: Scale::new(self.x_range(pane), count.max(2.0), !self.log[0], self.log[0]),
                y: self.y_scale(pane, frame.high),
            };
            let name = self.name.replace(|c: char| !c.is_alphanumeric(), "-");
            let place =
                Place { id: format!("{name}-{i}{end}"), frame, broad: broad.map(|broad| broad.frame(i)) };
            self.pane(&mut out, i, &place, &scales, layout);
            axis = Some(scales.x.axis);
        }
        let (words, unit) = unit_of(&self.x_label);
        let label = axis.map_or_else(|| self.x_label.clone(), |axis| axis.label(words, unit));
        write_text(&mut out, layout.middle(), layout.end + 6.0, "text-anchor=\"middle\"", &label);
        let legend = (&layout.entries[..], &layout.lines[..], self.direct);
        legend::draw(&mut out, legend, (LEFT, layout.end + 24.0), layout.width);
        out.push_str("</svg>\n");
        out
    }

    fn pane(&self, out: &mut String, i: usize, place: &Place, scales: &Scales, layout: &Layout) {
        let (pane, Place { id, frame, .. }) = (&self.panes[i], place);
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
            place.shared(out, "band", |out| {
                for part in rows.chunk_by(|a, b| shown[*a] == shown[*b]).filter(|part| shown[part[0]]) {
                    let edges = [up, low].map(|y| part.iter().map(|i| (to_x(x[*i]), to_y(y[*i]))).collect());
                    let _ = writeln!(
                        out,
                        "<path d=\"{}\" fill=\"#ececec\" stroke=\"#ececec\" stroke-width=\"2.5\" \
                         stroke-linejoin=\"round\"/>",
                        trace::area(edges)
                    );
                }
            });
        }
        self.axes(out, i, frame, scales, layout);
        if let Some((value, _)) = &pane.floor {
            dashed(out, &format!("M{x0:.1} {:.1}h{wide:.1}", to_y(*value)));
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
        let draw = |out: &mut String| {
            for curve in &order {
                curve::draw(out, curve, (id, frame), self.direct, &to_x, &to_y);
            }
        };
        // Markers lie outside the frame, too, and keep their size.
        if order.iter().any(|curve| curve.marked) {
            draw(out);
        } else {
            place.shared(out, "lines", draw);
        }
        if self.direct {
            let shown: Vec<(&Curve, End)> = pane
                .curves
                .iter()
                .filter(|curve| !curve.label.is_empty() && !curve.unlisted)
                .filter_map(|curve| Some((curve, end(curve, frame, &to_x, &to_y)?)))
                .collect();
            let (curves, ends): (Vec<&Curve>, Vec<End>) = shown.into_iter().unzip();
            direct::draw(out, &curves, &ends, frame, place.broad.is_none());
        }
        if let Some((value, word)) = &pane.floor {
            let place = "text-anchor=\"end\" font-size=\"10\" fill=\"#555\" stroke=\"#fff\" stroke-width=\"3\" \
                         paint-order=\"stroke\"";
            write_text(out, x0 + wide - 4.0, to_y(*value) - 4.0, place, word);
        }
    }

    /// Ticks, labels and title of a pane.
    fn axes(&self, out: &mut String, i: usize, frame: &Frame, scales: &Scales, layout: &Layout) {
        let (pane, y_label) = (&self.panes[i], self.y_label(i, layout.columns));
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
            let middle = x.min(layout.width - 2.0 - 0.5 * TICK * text::width(label));
            write_text(out, middle, bottom + 16.0, "text-anchor=\"middle\" font-size=\"11\"", label);
        }
        // Smaller where the title does not fit.
        let fits = |size: &f64| text::broken(&pane.title, (wide + RIGHT) / (BOLD * size)).len() <= 2;
        let size =
            [if self.across > 2 { 10.5 } else { 12.0 }, 10.0, 9.0].into_iter().find(fits).unwrap_or(9.0);
        let place = format!("font-size=\"{size}\" font-weight=\"600\"");
        // Above the labels of vertical lines.
        let above = if pane.marks.is_empty() { 9.0 } else { 20.0 };
        let lines = two_lines(&pane.title, (wide + RIGHT) / (BOLD * size));
        for (k, line) in lines.iter().rev().enumerate() {
            write_text(out, x0, y0 - above - 12.0 * k as f64, &place, line);
        }
        if !y_label.is_empty() {
            let (words, unit) = unit_of(y_label);
            let label = scales.y.axis.label(words, unit);
            // Smaller where it is longer than the pane is high.
            let size = (12.0_f64).min((high + 24.0) / text::width(&label).max(1e-9));
            let left = format!("{:.1}", x0 - beside);
            turned(out, (left, y0 + 0.5 * high), &format!(" font-size=\"{size:.1}\""), &label);
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
        let beyond = frame.beyond(last);
        let (x, y) = beyond.map_or(last, |(edge, _)| edge);
        return Some(End { x, y, leaves: beyond.is_some() });
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

/// A thin dashed line.
fn dashed(out: &mut String, d: &str) {
    let style = "stroke=\"#777\" stroke-width=\"0.8\" stroke-dasharray=\"2 2\"";
    let _ = writeln!(out, "<path d=\"{d}\" {style}/>");
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
        dashed(out, &format!("M{x:.1} {from:.1}V{bottom:.1}"));
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
