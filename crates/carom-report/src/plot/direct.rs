//! Labels to the right of a pane, each with a piece of its line, joined to the end of its curve
//! unless others end there too. The label of an unsound run that stops, or leaves the axes, stands
//! where it does so.
//!
//! The heights of labels are those nearest to the ends of the curves, by the sum of squares, that
//! are at least a line apart: with the k-th line subtracted, an isotonic regression, which the
//! pooling of adjacent violators solves exactly (M. Ayer et al., Ann. Math. Statist. 26, 1955).

use std::fmt::Write as _;

use super::Curve;
use super::curve::arrowhead;
use super::frame::Frame;
use crate::chart::{dots, write_text};
use crate::text;

/// Height of a line, font size, and room for the leader between pane and label.
pub(super) const LINE: f64 = 13.5;
const SIZE: f64 = 11.0;
const LEADER: f64 = 34.0;
/// Where the piece of the line begins and ends in that room.
const SWATCH: (f64, f64) = (12.0, 30.0);
/// Largest width of a label.
const MOST: f64 = 236.0;

/// Heights in the order of the wanted ones, which ascend.
fn spread(wanted: &[f64], line: f64, (top, bottom): (f64, f64)) -> Vec<f64> {
    let mut pools: Vec<(f64, usize)> = Vec::new();
    for (k, y) in wanted.iter().enumerate() {
        pools.push((y - line * k as f64, 1));
        while let [.., (before, m), (last, n)] = pools[..] {
            if before <= last {
                break;
            }
            pools.truncate(pools.len() - 2);
            pools.push(((before * m as f64 + last * n as f64) / (m + n) as f64, m + n));
        }
    }
    let room = (bottom - line * wanted.len().saturating_sub(1) as f64).max(top);
    let levels = pools.into_iter().flat_map(|(level, count)| std::iter::repeat_n(level, count));
    levels.enumerate().map(|(k, level)| level.clamp(top, room) + line * k as f64).collect()
}

/// What is written beside a curve.
pub(super) fn words(curve: &Curve) -> String {
    let most = MOST / SIZE;
    // The caption names the others.
    let others = |rest: &str| rest.ends_with(" other") || rest.ends_with(" others");
    let alone = curve.label.rsplit_once(" and ").filter(|(_, rest)| others(rest)).map(|(name, _)| name);
    let short = alone.filter(|_| text::width(&curve.label) > most);
    let name = text::fitted(short.unwrap_or(&curve.label), most);
    if curve.chosen { format!("▸ {name}") } else { name }
}

/// Room that the labels of some curves need beside a pane.
pub(super) fn room<'a>(curves: impl Iterator<Item = &'a Curve>) -> f64 {
    // Bold letters are wider.
    let size = |curve: &Curve| if curve.chosen { 1.12 * SIZE } else { SIZE };
    let widest = curves.map(|curve| text::width(&words(curve)) * size(curve)).fold(0.0, f64::max);
    if widest > 0.0 { widest + LEADER + 6.0 } else { 0.0 }
}

/// Ends that are closer together than this number of pixels are one point for the eye.
const ONE: f64 = 4.0;
/// A curve that ends further from the right edge ends inside the pane.
const INSIDE: f64 = 24.0;

/// Where a curve is last seen in its pane, in pixels.
#[derive(Clone, Copy)]
pub(super) struct End {
    pub(super) x: f64,
    pub(super) y: f64,
    /// Whether it leaves the axes there.
    pub(super) leaves: bool,
}

/// Draws the labels, those outside the pane only if they are `beside` it; `ends` are where the
/// curves end in the pane.
pub(super) fn draw(out: &mut String, curves: &[&Curve], ends: &[End], frame: &Frame, beside: bool) {
    let right = frame.right();
    let inside = |k: &usize| ends[*k].x < right - INSIDE;
    // All unsound runs are grey, so that no legend can tell them apart where they have no markers.
    let within = |k: &usize| match curves[*k].marked {
        marked if beside => !marked && inside(k),
        marked => !marked || ends[*k].leaves,
    };
    let (stopped, mut order): (Vec<usize>, Vec<usize>) =
        (0..curves.len()).partition(|k| curves[*k].apart && within(k));
    stops(out, &stopped.iter().map(|k| (curves[*k], ends[*k])).collect::<Vec<_>>(), frame);
    order.retain(|_| beside);
    order.sort_by(|a, b| ends[*a].y.total_cmp(&ends[*b].y));
    let wanted: Vec<f64> = order.iter().map(|k| ends[*k].y).collect();
    let heights = spread(&wanted, LINE, (frame.top + 4.0, frame.bottom() - 2.0));
    let alone = |k: usize| {
        let near =
            |other: &&usize| **other != k && !inside(other) && (ends[**other].y - ends[k].y).abs() < ONE;
        // Markers identify the others.
        (curves[k].apart || !inside(&k) && !curves[k].marked) && !order.iter().any(|other| near(&other))
    };
    for (&k, y) in order.iter().zip(heights) {
        let (curve, End { x, y: from, .. }) = (curves[k], ends[k]);
        let (color, dashes, marker) = curve.style();
        let (first, last) = (right + SWATCH.0, right + SWATCH.1);
        if alone(k) {
            let _ = writeln!(
                out,
                "<path d=\"M{x:.1} {from:.1}L{right:.1} {from:.1}L{first:.1} {y:.1}\" fill=\"none\" \
                 stroke=\"{color}\" stroke-width=\"0.7\" stroke-opacity=\"0.5\"/>"
            );
        }
        if curve.points && !curve.marked {
            dots(out, [4.0, 14.0].map(|by| (first + by, y)).into_iter(), color);
        } else {
            let dashes = if super::curve::is_dashed(curve, true) { dashes } else { "" };
            let width = if curve.apart || curve.quiet { 1.0 } else { 2.0 };
            let _ = writeln!(
                out,
                "<path d=\"M{first:.1} {y:.1}H{last:.1}\" stroke=\"{color}\" stroke-width=\"{width}\" \
                 stroke-dasharray=\"{dashes}\"/>"
            );
        }
        if curve.marked {
            super::curve::mark(out, marker, color, 0.5 * (first + last), y);
        }
        let weight = if curve.chosen { " font-weight=\"700\"" } else { "" };
        let place = format!("font-size=\"{SIZE}\"{weight}");
        write_text(out, right + LEADER, y + 3.8, &place, &words(curve));
    }
}

/// The labels of some curves inside the pane, with a cross where one stops, or an arrowhead where
/// it leaves the axes.
fn stops(out: &mut String, stopped: &[(&Curve, End)], frame: &Frame) {
    let mut taken: Vec<(f64, f64, f64)> = Vec::new();
    for (curve, End { x, y, leaves }) in stopped {
        let color = curve.style().0;
        if curve.marked || !leaves && *x >= frame.right() - INSIDE {
            // It has its marker, or goes on to the end.
        } else if *leaves {
            let up = y - frame.top < frame.bottom() - y;
            arrowhead(out, color, (*x, *y), (0.0, if up { -1.0 } else { 1.0 }));
        } else {
            let _ = writeln!(
                out,
                "<path d=\"M{:.1} {:.1}l6 6m0 -6l-6 6\" stroke=\"{color}\" stroke-width=\"1.6\"/>",
                x - 3.0,
                y - 3.0
            );
        }
        let wide = text::width(&words(curve)) * SIZE;
        let left = if x + 6.0 + wide < frame.right() { x + 6.0 } else { (x - 6.0 - wide).max(frame.left) };
        // The nearest line, below or above, that no other label has.
        let (low, high) = (frame.top + SIZE, frame.bottom() - 3.0);
        let free = |line: &f64| {
            let covers =
                |(a, b, at): &(f64, f64, f64)| (at - line).abs() < LINE && left < *b && *a < left + wide;
            (low..=high).contains(line) && !taken.iter().any(covers)
        };
        let first = (y - 5.0).clamp(low, high.max(low));
        let lines = (0..40).flat_map(|k| [1.0, -1.0].map(|sign| first + sign * LINE * f64::from(k)));
        let line = lines.into_iter().find(free).unwrap_or(first);
        taken.push((left, left + wide, line));
        let place = format!(
            "font-size=\"{SIZE}\" fill=\"#555\" stroke=\"#fff\" stroke-width=\"3\" paint-order=\"stroke\""
        );
        write_text(out, left, line, &place, &words(curve));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The number of others goes first, so that the value of a parameter is not cut.
    #[test]
    fn a_long_label_loses_its_others_first() {
        let label = |name: &str| Curve { label: format!("{name} and 1 other"), ..Curve::default() };
        let long = "Chung–Hulbert, ρ∞ = 0.6, with smoothing";
        assert_eq!((words(&label("Hu")).as_str(), words(&label(long)).as_str()), ("Hu and 1 other", long));
    }

    /// By hand: 0, 1, 2 in lines of 10 are −10, 0, 10 about their mean 1, so −9, 1, 11; a label far
    /// away stays.
    #[test]
    fn labels_are_spread_about_their_ends() {
        assert_eq!(spread(&[0.0, 1.0, 2.0, 90.0], 10.0, (-100.0, 200.0)), [-9.0, 1.0, 11.0, 90.0]);
        assert_eq!(spread(&[5.0, 5.0], 10.0, (5.0, 200.0)), [5.0, 15.0]);
        assert_eq!(spread(&[99.0, 100.0], 10.0, (0.0, 100.0)), [90.0, 100.0]);
        assert!(spread(&[], 10.0, (0.0, 1.0)).is_empty());
    }
}
