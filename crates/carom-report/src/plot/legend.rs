//! The legend below a plot: one entry for every label, in as many lines as needed.

use std::fmt::Write as _;

use super::curve::{Curve, is_dashed, mark};
use super::direct::words;
use crate::chart::{dots, in_lines, write_text};
use crate::text;

/// Height of a line.
pub(super) const LINE: f64 = 18.0;
const SIZE: f64 = 12.0;
/// Room for the piece of line, and between entries.
const PIECE: f64 = 32.0;
const GAP: f64 = 18.0;

/// What is written of a curve: in place of a label beside it, the same.
fn name(curve: &Curve, direct: bool) -> String {
    if direct { words(curve) } else { curve.label.clone() }
}

/// Width of an entry.
fn entry(curve: &Curve, direct: bool) -> f64 {
    PIECE + GAP + text::width(&name(curve, direct)) * SIZE
}

/// The entries of every line.
pub(super) fn lines(legend: &[&Curve], width: f64, direct: bool) -> Vec<Vec<usize>> {
    in_lines(legend.iter().map(|curve| entry(curve, direct)).enumerate(), width)
}

/// Draws the lines from the place of the first one, in a figure of a width.
pub(super) fn draw(
    out: &mut String,
    (legend, lines, direct): (&[&Curve], &[Vec<usize>], bool),
    (left, top): (f64, f64),
    width: f64,
) {
    for (row, line) in lines.iter().enumerate() {
        let (mut x, y) = (left, top + LINE * row as f64);
        for i in line {
            let curve = legend[*i];
            let (color, dashes, marker) = curve.style();
            let dashes = if is_dashed(curve, direct) { dashes } else { "" };
            let long = if curve.points { 0 } else { 26 };
            let _ = writeln!(
                out,
                "<path d=\"M{x:.1} {y:.1}h{long}\" stroke=\"{color}\" stroke-width=\"1.8\" \
                 stroke-dasharray=\"{dashes}\"/>"
            );
            if curve.marked {
                mark(out, marker, color, x + 13.0, y);
            }
            if curve.points && !curve.marked {
                dots(out, [4.0, 13.0, 22.0].map(|by| (x + by, y)).into_iter(), color);
            }
            let weight = if direct && curve.chosen { " font-weight=\"700\"" } else { "" };
            let label = text::fitted(&name(curve, direct), (width - x - PIECE) / SIZE);
            write_text(out, x + PIECE, y + 4.0, &format!("font-size=\"{SIZE}\"{weight}"), &label);
            x += entry(curve, direct);
        }
    }
}
