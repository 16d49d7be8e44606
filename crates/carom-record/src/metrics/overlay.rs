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
pub(crate) const OVERLAY: [Definition; 3] = [
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

fn rms(given: &Given) -> Option<f64> {
    let pairs = pairs(given)?;
    let sum = pairs.iter().fold(0.0, |sum, (c, m)| sum + (c - m).powi(2));
    Some((sum / pairs.len() as f64).sqrt()).filter(|x| x.is_finite())
}

fn peak(given: &Given) -> Option<f64> {
    let pairs = pairs(given)?;
    let computed = pairs.iter().fold(0.0, |most: f64, (c, _)| most.max(c.abs()));
    let measured = pairs.iter().fold(0.0, |most: f64, (_, m)| most.max(m.abs()));
    (measured > 0.0).then(|| computed / measured - 1.0)
}

fn shift(given: &Given) -> Option<f64> {
    let measured = given.measured?;
    let column = (given.history.times(), given.values()?);
    phase_shift(&measured.times, &measured.values, column).map(|late| -late)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Column, History};

    fn history(f: impl Fn(f64) -> f64) -> History {
        let column = |name: &str| Column {
            name: name.into(),
            unit: String::new(),
            description: String::new(),
            integer: false,
        };
        let times: Vec<f64> = (0..=1000).map(|i| 0.01 * f64::from(i)).collect();
        let values = times.iter().map(|t| f(*t)).collect();
        History::new(vec![column("time"), column("u")], vec![times, values])
    }

    fn overlay(points: &[(f64, f64)]) -> Overlay {
        let (times, values) = points.iter().copied().unzip();
        Overlay { name: "test".into(), column: "u".into(), times, values, source: None }
    }

    /// By hand: c = 2t at 1, 2, 3 is 2, 4, 6; measured 2, 5, 8 give differences 0, −1, −2, so
    /// √(5/3) and 6/8 − 1. The point at 20 is outside the run.
    #[test]
    fn differences_by_hand() {
        let line = history(|t| 2.0 * t);
        let data = overlay(&[(1.0, 2.0), (2.0, 5.0), (3.0, 8.0), (20.0, 0.0)]);
        assert!((rms(&Given::of(&line).beside(&data)).unwrap() - (5.0_f64 / 3.0).sqrt()).abs() < 1e-12);
        assert!((peak(&Given::of(&line).beside(&data)).unwrap() + 0.25).abs() < 1e-12);
    }

    /// A sine that is 0.3 late.
    #[test]
    fn a_late_column_has_a_positive_shift() {
        let points: Vec<(f64, f64)> = (1..60).map(|i| 0.15 * f64::from(i)).map(|t| (t, t.sin())).collect();
        let late = history(|t| (t - 0.3).sin());
        let data = overlay(&points);
        let found = shift(&Given::of(&late).beside(&data)).unwrap();
        assert!((found - 0.3).abs() < 1e-4, "{found}");
        let other = Overlay { column: "v".into(), ..data.clone() };
        assert_eq!(rms(&Given::of(&late).beside(&other)), None);
    }
}
