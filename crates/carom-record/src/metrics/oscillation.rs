//! Damping ratio and period of a column that oscillates freely about zero, from the linear
//! recurrence of its rows (Prony 1795).
//!
//! ```text
//! c_{n+1} = 2 Re z c_n − |z|² c_{n−1}         z: the principal eigenvalue of a step; both coefficients by least squares
//! ξ = −ln|z|/arg z,   T = 2π Δt/arg z
//! ```
//!
//! Only the second half of the record is used, where other modes excited at the start have decayed.
//! It must contain a full period, and the residual of the recurrence must be at most a hundredth of
//! the second differences; otherwise the column is not a free oscillation with one frequency.

use std::f64::consts::TAU;

use super::given::Given;

/// Smallest number of rows in the second half.
const LEAST: usize = 8;
/// Largest residual of the recurrence: root mean square, relative to that of the second
/// differences.
const RESIDUAL: f64 = 1e-2;

/// ln|z|, arg z and the step between rows.
fn principal(given: &Given) -> Option<(f64, f64, f64)> {
    let values = given.values()?;
    let half = values.len() / 2;
    let times = given.history.times().get(half..)?;
    let values = values.get(half..)?;
    if values.len() < LEAST {
        return None;
    }
    let step = (times[times.len() - 1] - times[0]) / (times.len() - 1) as f64;
    if times.windows(2).any(|t| (t[1] - t[0] - step).abs() > 1e-6 * step) {
        return None;
    }
    let of = |f: fn(&[f64]) -> f64| values.windows(3).map(f).sum::<f64>();
    let aa = of(|w| w[0] * w[0]);
    let bb = of(|w| w[1] * w[1]);
    let ab = of(|w| w[0] * w[1]);
    let ac = of(|w| w[0] * w[2]);
    let bc = of(|w| w[1] * w[2]);
    let determinant = aa * bb - ab * ab;
    let trace = (aa * bc - ab * ac) / determinant;
    let square = (ab * bc - bb * ac) / determinant;
    let residual = values.windows(3).map(|w| (w[2] - trace * w[1] + square * w[0]).powi(2)).sum::<f64>();
    let curvature = of(|w| (w[2] - 2.0 * w[1] + w[0]).powi(2));
    if !(square > 0.0 && trace * trace < 4.0 * square && residual <= RESIDUAL * RESIDUAL * curvature) {
        return None;
    }
    let angle = (0.5 * trace / square.sqrt()).acos();
    (angle * (values.len() - 1) as f64 >= TAU).then(|| (0.5 * square.ln(), angle, step))
}

/// Damping ratio ξ of a free oscillation; none if the column is not one.
pub fn damping_ratio(given: &Given) -> Option<f64> {
    principal(given).map(|(log, angle, _)| -log / angle)
}

/// Period T of a free oscillation; none if the column is not one.
pub fn period(given: &Given) -> Option<f64> {
    principal(given).map(|(_, angle, step)| TAU * step / angle)
}
