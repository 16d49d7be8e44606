//! Comparison of a column with that of a reference. The reference is interpolated linearly between
//! its rows; only rows within its span are used.
//!
//! ```text
//! deviation          √( mean (c_i − r(t_i))² ) / range of r
//! phase shift        the τ that minimises Σ (c_i − r(t_i − τ))², by the Gauss–Newton method; positive: late
//! ```

use super::samples::{at, extreme};

/// Root mean square deviation, divided by the range of the reference.
pub fn deviation(times: &[f64], values: &[f64], reference: (&[f64], &[f64])) -> Option<f64> {
    let range = extreme(reference.1, f64::gt)?.1 - extreme(reference.1, f64::lt)?.1;
    let squares = times
        .iter()
        .zip(values)
        .filter_map(|(&t, c)| at(reference.0, reference.1, t).map(|r| (c - r).powi(2)));
    let (sum, rows) = squares.fold((0.0, 0_u32), |(sum, n), x| (sum + x, n + 1));
    let value = (sum / f64::from(rows)).sqrt() / range;
    value.is_finite().then_some(value)
}

/// Delay of a column; none if the iteration does not converge, or leaves a quarter of the span.
pub fn phase_shift(times: &[f64], values: &[f64], reference: (&[f64], &[f64])) -> Option<f64> {
    let span = times.last()? - times.first()?;
    let width = 1e-3 * span;
    let mut shift = 0.0;
    for _ in 0..50 {
        let mut along = 0.0;
        let mut steep = 0.0;
        for (t, c) in times.iter().zip(values) {
            let r = |t: f64| at(reference.0, reference.1, t);
            let Some(((before, here), after)) =
                r(t - shift - width).zip(r(t - shift)).zip(r(t - shift + width))
            else {
                continue;
            };
            let slope = (after - before) / (2.0 * width);
            along += (c - here) * slope;
            steep += slope * slope;
        }
        let change = -along / steep;
        shift += change;
        if !shift.is_finite() || shift.abs() > 0.25 * span {
            return None;
        }
        if change.abs() <= 1e-9 * span {
            return Some(shift);
        }
    }
    None
}
