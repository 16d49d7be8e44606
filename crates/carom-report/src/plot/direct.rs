//! Labels to the right of a pane, each joined to the end of its curve. Where curves end in one
//! point or inside the pane, a piece of the line stands before the label instead; the label of a
//! run that stopped stands where it stopped.
//!
//! The heights of labels are those nearest to the ends of the curves, by the sum of squares, that
//! are at least a line apart: with the k-th line subtracted, an isotonic regression, which the
//! pooling of adjacent violators solves exactly (M. Ayer et al., Ann. Math. Statist. 26, 1955).

use std::fmt::Write as _;

use super::Curve;
use super::frame::Frame;
use crate::chart::{dots, write_text};
use crate::text;

/// Height of a line, font size, and room for the leader between pane and label.
pub(super) const LINE: f64 = 13.5;
const SIZE: f64 = 11.0;
const LEADER: f64 = 20.0;
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
fn words(curve: &Curve) -> String {
    let name = text::fitted(&curve.label, MOST / SIZE);
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

/// Draws the labels; `ends` are where the curves end in the pane.
pub(super) fn draw(out: &mut String, curves: &[&Curve], ends: &[(f64, f64)], frame: &Frame) {
    let right = frame.right();
    let inside = |k: &usize| ends[*k].0 < right - INSIDE;
    let (stopped, mut order): (Vec<usize>, Vec<usize>) =
        (0..curves.len()).partition(|k| curves[*k].apart && inside(k));
    stops(out, &stopped.iter().map(|k| (curves[*k], ends[*k])).collect::<Vec<_>>(), frame);
    order.sort_by(|a, b| ends[*a].1.total_cmp(&ends[*b].1));
    let wanted: Vec<f64> = order.iter().map(|k| ends[*k].1).collect();
    let heights = spread(&wanted, LINE, (frame.top + 4.0, frame.bottom() - 2.0));
    let alone = |k: usize| {
        let near =
            |other: &&usize| **other != k && !inside(other) && (ends[**other].1 - ends[k].1).abs() < ONE;
        !inside(&k) && !order.iter().any(|other| near(&other))
    };
    for (&k, y) in order.iter().zip(heights) {
        let (curve, (x, from)) = (curves[k], ends[k]);
        let (color, dashes, marker) = curve.style();
        if alone(k) {
            let _ = writeln!(
                out,
                "<path d=\"M{x:.1} {from:.1}L{right:.1} {from:.1}L{:.1} {y:.1}\" fill=\"none\" \
                 stroke=\"{color}\" stroke-width=\"0.7\" stroke-opacity=\"0.5\"/>",
                right + LEADER - if curve.marked { 10.0 } else { 3.0 }
            );
        } else if curve.points && !curve.marked {
            dots(out, [4.0, 10.0].map(|by| (right + by, y)).into_iter(), color);
        } else {
            let dashes = if super::curve::is_dashed(curve, true) { dashes } else { "" };
            let _ = writeln!(
                out,
                "<path d=\"M{:.1} {y:.1}h{:.1}\" stroke=\"{color}\" stroke-width=\"2\" \
                 stroke-dasharray=\"{dashes}\"/>",
                right + 3.0,
                LEADER - 6.0
            );
        }
        if curve.marked {
            super::curve::mark(out, marker, color, right + LEADER - 9.0, y);
        }
        let weight = if curve.chosen { " font-weight=\"700\"" } else { "" };
        let place = format!("font-size=\"{SIZE}\" fill=\"{}\"{weight}", ink(color));
        write_text(out, right + LEADER, y + 3.8, &place, &words(curve));
    }
}

/// A cross where each of some curves stops inside the pane, with its label.
fn stops(out: &mut String, stopped: &[(&Curve, (f64, f64))], frame: &Frame) {
    let mut taken: Vec<(f64, f64, f64)> = Vec::new();
    for (curve, (x, y)) in stopped {
        let color = curve.style().0;
        let _ = writeln!(
            out,
            "<path d=\"M{:.1} {:.1}l6 6m0 -6l-6 6\" stroke=\"{color}\" stroke-width=\"1.6\"/>",
            x - 3.0,
            y - 3.0
        );
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
            "font-size=\"{SIZE}\" fill=\"{}\" stroke=\"#fff\" stroke-width=\"3\" paint-order=\"stroke\"",
            ink(color)
        );
        write_text(out, left, line, &place, &words(curve));
    }
}

/// The colour of a label: that of its line, darkened where it would be hard to read as text.
fn ink(color: &str) -> &str {
    match color {
        "#cc79a7" => "#9c3f74",
        "#e69f00" => "#8a5f00",
        "#56b4e9" => "#1f6f9f",
        "#009e73" => "#00694f",
        "#d55e00" => "#a84a00",
        "#b0b0b0" | "#9a9a9a" | "#777777" => "#666666",
        color => color,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

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
