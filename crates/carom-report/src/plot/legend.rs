//! The legend below a plot: one entry for every label, in as many lines as needed.

use std::fmt::Write as _;

use super::curve::{Curve, is_dashed, mark};
use crate::chart::{dots, write_text};
use crate::text;

/// Height of a line.
pub(super) const LINE: f64 = 18.0;

/// Width of an entry.
fn entry(label: &str) -> f64 {
    50.0 + text::width(label) * 12.0
}

/// The entries of every line.
pub(super) fn lines(legend: &[&Curve], width: f64) -> Vec<Vec<usize>> {
    let mut lines: Vec<Vec<usize>> = Vec::new();
    let mut used = f64::INFINITY;
    for (i, Curve { label, .. }) in legend.iter().enumerate() {
        if used + entry(label) > width {
            lines.push(Vec::new());
            used = 0.0;
        }
        used += entry(label);
        if let Some(line) = lines.last_mut() {
            line.push(i);
        }
    }
    lines
}

/// Draws the lines from the place of the first one.
pub(super) fn draw(out: &mut String, legend: &[&Curve], lines: &[Vec<usize>], left: f64, top: f64) {
    for (row, line) in lines.iter().enumerate() {
        let (mut x, y) = (left, top + LINE * row as f64);
        for i in line {
            let Curve { label, marked, points, .. } = legend[*i];
            let (color, dashes, marker) = legend[*i].style();
            let dashes = if is_dashed(legend[*i], false) { dashes } else { "" };
            let long = if *points { 0 } else { 26 };
            let _ = writeln!(
                out,
                "<path d=\"M{x:.1} {y:.1}h{long}\" stroke=\"{color}\" stroke-width=\"1.8\" \
                 stroke-dasharray=\"{dashes}\"/>"
            );
            if *marked {
                mark(out, marker, color, x + 13.0, y);
            }
            if *points && !*marked {
                dots(out, [4.0, 13.0, 22.0].map(|by| (x + by, y)).into_iter(), color);
            }
            write_text(out, x + 32.0, y + 4.0, "font-size=\"12\"", label);
            x += entry(label);
        }
    }
}
