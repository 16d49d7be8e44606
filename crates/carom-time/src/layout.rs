//! Parts of the text of `carom explain` that are common to all families.

use std::fmt::{Formatter, Result};

use crate::explain::Accuracy;

/// ξ and PE without noise in the last digits.
pub(crate) fn cell(x: Option<f64>, scale: f64) -> String {
    match x.map(|x| x * scale) {
        None => "–".to_owned(),
        Some(x) if x.abs() < 1e-12 => "0".to_owned(),
        Some(x) if x.abs() < 1e-3 => format!("{x:.1e}"),
        Some(x) => format!("{x:.4}"),
    }
}

/// Spectral radius, damping ratio, period error and dispersion at several steps per period.
pub(crate) fn accuracy_table(f: &mut Formatter, rows: &[Accuracy]) -> Result {
    let heads = ["T/Δt", "ρ", "damping ratio ξ", "period error %", "dispersion %"];
    let [steps, radius, damping, period, dispersion] = heads;
    writeln!(f, "\n  {steps:>6}  {radius:>10}  {damping:>15}  {period:>14}  {dispersion:>12}")?;
    rows.iter().try_for_each(|row| {
        let steps = row.steps_per_period;
        let radius = row.spectral_radius;
        let damping = cell(row.damping_ratio, 1.0);
        let period = cell(row.period_error, 100.0);
        let dispersion = cell(row.dispersion, 100.0);
        writeln!(f, "  {steps:>6}  {radius:>10.6}  {damping:>15}  {period:>14}  {dispersion:>12}")
    })?;
    let words = "dispersion: error of the phase velocity of a wave in a bar of linear elements, with as many \
                 elements per wavelength as steps per period; masses are lumped with explicit schemes, and \
                 consistent with others";
    write_wrapped(f, words)
}

/// An indented paragraph of at most 100 columns; continued lines are indented further.
pub(crate) fn write_wrapped(f: &mut Formatter, text: &str) -> Result {
    let mut column = 0;
    for word in text.split(' ') {
        let width = word.chars().count();
        let before = match column {
            0 => "  ",
            _ if column + 1 + width > 100 => "\n    ",
            _ => " ",
        };
        write!(f, "{before}{word}")?;
        column = width + if before.starts_with('\n') { 4 } else { column + before.len() };
    }
    writeln!(f)
}
