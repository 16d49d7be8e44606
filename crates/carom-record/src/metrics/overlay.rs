//! Measured data beside a column of the history, and how far the column is from them. The column is
//! interpolated linearly between its rows; only measured points within the run are used.
//!
//! ```text
//! overlay_rms        √( mean (c(t_i) − m_i)² )
//! overlay_peak       max |c| / max |m| − 1, both at the measured points
//! overlay_shift      the τ that minimises Σ (c(t_i + τ) − m_i)², by the Gauss–Newton method; positive: c is late
//! ```

use super::compare::phase_shift;
use super::definition::{Definition, OWN, d};
use super::given::Given;
use super::samples::at;
use crate::units::Unit;
use crate::{Overlay, Run};

/// The measured data of a run, from its manifest.
pub fn overlays(run: &Run) -> Vec<Overlay> {
    run.manifest.facts.overlays.clone()
}

/// Metrics of measured data, named `overlay_rms:NAME` and so on.
pub const OVERLAY: [Definition; 3] = [
    d(
        "overlay_rms",
        Unit::Column,
        "√(mean (c(t_i) − m_i)²)",
        OWN,
        "root mean square difference between the column and the measured data",
        rms,
    ),
    d(
        "overlay_peak",
        Unit::None,
        "max |c(t_i)|/max |m_i| − 1",
        OWN,
        "relative error of the largest absolute value of a column at the measured times",
        peak,
    ),
    d(
        "overlay_shift",
        Unit::Time,
        "τ that minimises Σ (c(t_i + τ) − m_i)²",
        OWN,
        "time by which a column is later than the measured data",
        shift,
    ),
];

/// Computed and measured values at the measured times within the run.
fn pairs(given: &Given) -> Option<Vec<(f64, f64)>> {
    let measured = given.measured?;
    let column = given.values()?;
    let computed = |(t, m): (&f64, &f64)| at(given.history.times(), column, *t).map(|c| (c, *m));
    Some(measured.times.iter().zip(&measured.values).filter_map(computed).collect())
}

/// Root of the mean square of the differences.
pub fn rms(given: &Given) -> Option<f64> {
    let pairs = pairs(given)?;
    let sum = pairs.iter().fold(0.0, |sum, (c, m)| sum + (c - m).powi(2));
    Some((sum / pairs.len() as f64).sqrt()).filter(|x| x.is_finite())
}

/// Peak of the column over that of the data, less one.
pub fn peak(given: &Given) -> Option<f64> {
    let pairs = pairs(given)?;
    let computed = pairs.iter().fold(0.0, |most: f64, (c, _)| most.max(c.abs()));
    let measured = pairs.iter().fold(0.0, |most: f64, (_, m)| most.max(m.abs()));
    (measured > 0.0).then(|| computed / measured - 1.0)
}

/// Delay of the column behind the data.
pub fn shift(given: &Given) -> Option<f64> {
    let measured = given.measured?;
    let column = (given.history.times(), given.values()?);
    phase_shift(&measured.times, &measured.values, column).map(|late| -late)
}
