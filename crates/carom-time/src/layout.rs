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

/// Spectral radius, damping ratio and period error at several steps per period.
pub(crate) fn accuracy_table(f: &mut Formatter, rows: &[Accuracy]) -> Result {
    writeln!(f, "\n  {:>6}  {:>10}  {:>15}  {:>14}", "T/Δt", "ρ", "damping ratio ξ", "period error %")?;
    rows.iter().try_for_each(|row| {
        let (damping, period) = (cell(row.damping_ratio, 1.0), cell(row.period_error, 100.0));
        writeln!(
            f,
            "  {:>6}  {:>10.6}  {damping:>15}  {period:>14}",
            row.steps_per_period, row.spectral_radius
        )
    })
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
