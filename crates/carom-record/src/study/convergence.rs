//! The uncertainty of a value under refinement, from runs whose steps and cells shrink together.
//!
//! ```text
//! two runs      U = 3 |f₁ − f₂| / (r − 1)
//! three runs    p from (f₃ − f₂)/(f₂ − f₁) = r₂₁ᵖ (r₃₂ᵖ − 1)/(r₂₁ᵖ − 1),  δ = |f₁ − f₂| / (r₂₁ᵖ − 1),  Δ = largest difference
//!   0 < p ≤ 2.05       U = min(1.25 δ, 3 Δ) with p = min(p, 2/3)
//!   p > 2.05           U = 1.25 max(δ with p = 2/3, Δ)
//!   f₁ = f₂            U = 1.25 Δ, the limit of p → ∞
//!   not monotone       U = 3 Δ
//! ```
//!
//! f₁ belongs to the finest run, r are the ratios of successive sizes. These are the grid
//! convergence index of P. J. Roache with its safety factors 1.25 and 3, and the treatment of
//! irregular convergence after L. Eça and M. Hoekstra: nothing is extrapolated with an order that
//! was not observed. Three runs do not show whether an order is steady, so that none above 2/3 is
//! used: an impact sends out a jump of the stress, which a method of order q carries as a front of
//! the width h^(q/(q + 1)) (G. W. Hedstrom, Math. Comp. 29, 1975), 2/3 for q = 2. Impulse, rebound
//! and the end of contact follow from the arrival of that front.

use crate::Reason;
use crate::order::{SAFE, from_differences};

/// Observed order and uncertainty.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Converged {
    /// Half-width of the interval around the value of the finest run that should contain the limit
    /// in 95 of 100 cases.
    pub uncertainty: f64,
    /// Observed order, where the values converge monotonically.
    pub order: Option<f64>,
}

/// Order with which a method of second order carries a jump.
const OF_A_JUMP: f64 = 2.0 / 3.0;
/// Largest order of a method of second order; beyond it, convergence is not regular.
const REGULAR: f64 = 2.05;
/// Safety factor without an observed order.
const UNSAFE: f64 = 3.0;
/// Share of the differences below which the last one is round-off.
const SETTLED: f64 = 1e-9;

/// Uncertainty and order from the distances between the values at successive sizes.
///
/// # Errors
/// There is a single run.
pub(super) fn converged_by(
    sizes: &[f64],
    distances: impl DoubleEndedIterator<Item = f64>,
) -> Result<Converged, Reason> {
    // Values whose differences are these distances.
    let mut values = vec![0.0];
    for distance in distances.rev() {
        values.push(values[values.len() - 1] + distance);
    }
    values.reverse();
    converged(sizes, &values)
}

/// Uncertainty and order from the values at decreasing sizes.
///
/// # Errors
/// There is a single run.
pub fn converged(sizes: &[f64], values: &[f64]) -> Result<Converged, Reason> {
    let ([.., h2, h1], [.., f2, f1]) = (sizes, values) else {
        return Err("a single run gives no error estimate".into());
    };
    let r21 = h2 / h1;
    if r21 <= 1.0 {
        return Err("step and mesh of its levels are not both refined".into());
    }
    let of_two = || Converged { uncertainty: UNSAFE * (f1 - f2).abs() / (r21 - 1.0), order: None };
    let ([.., h3, _, _], [.., f3, _, _]) = (sizes, values) else { return Ok(of_two()) };
    // A third run that is no coarser than the second says nothing of the order.
    if h3 <= h2 {
        return Ok(of_two());
    }
    let range = [(f1 - f2).abs(), (f2 - f3).abs(), (f1 - f3).abs()].into_iter().fold(0.0, f64::max);
    if range == 0.0 {
        return Ok(Converged { uncertainty: 0.0, order: None });
    }
    // What no longer changes converges faster than any order that is believed.
    if (f1 - f2).abs() <= SETTLED * range {
        return Ok(Converged { uncertainty: SAFE * range, order: None });
    }
    let order = from_differences([*h3, *h2, *h1], [f3 - f2, f2 - f1]).ok().filter(|p| *p > 0.0);
    let error = |p: f64| (f1 - f2).abs() / (r21.powf(p) - 1.0);
    let uncertainty = match order {
        Some(p) if p > REGULAR => SAFE * error(OF_A_JUMP).max(range),
        Some(p) => (SAFE * error(p.min(OF_A_JUMP))).min(UNSAFE * range),
        None => UNSAFE * range,
    };
    Ok(Converged { uncertainty, order })
}
