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

use crate::order::{SAFE, from_differences};

/// Observed order and uncertainty.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Converged {
    /// Half-width of the interval around the value of the finest run that should contain the limit
    /// in 95 of 100 cases.
    pub(super) uncertainty: f64,
    /// Observed order, where the values converge monotonically.
    pub(super) order: Option<f64>,
}

/// Order with which a method of second order carries a jump.
const OF_A_JUMP: f64 = 2.0 / 3.0;
/// Largest order of a method of second order; beyond it, convergence is not regular.
const REGULAR: f64 = 2.05;
/// Safety factor without an observed order.
const UNSAFE: f64 = 3.0;
/// Share of the differences below which the last one is round-off.
const SETTLED: f64 = 1e-9;

/// Uncertainty and order from the values at decreasing sizes; none for a single run.
pub(super) fn converged(sizes: &[f64], values: &[f64]) -> Option<Converged> {
    let n = values.len().min(sizes.len());
    if n < 2 {
        return None;
    }
    let f1 = values[n - 1];
    let f2 = values[n - 2];
    let r21 = sizes[n - 2] / sizes[n - 1];
    if n == 2 {
        return Some(Converged { uncertainty: UNSAFE * (f1 - f2).abs() / (r21 - 1.0), order: None });
    }
    let f3 = values[n - 3];
    let range = [(f1 - f2).abs(), (f2 - f3).abs(), (f1 - f3).abs()].into_iter().fold(0.0, f64::max);
    if range == 0.0 {
        return Some(Converged { uncertainty: 0.0, order: None });
    }
    // What no longer changes converges faster than any order that is believed.
    if (f1 - f2).abs() <= SETTLED * range {
        return Some(Converged { uncertainty: SAFE * range, order: None });
    }
    let steps = [sizes[n - 3], sizes[n - 2], sizes[n - 1]];
    let order = from_differences(steps, [f3 - f2, f2 - f1]).ok().filter(|p| *p > 0.0);
    let error = |p: f64| (f1 - f2).abs() / (r21.powf(p) - 1.0);
    let uncertainty = match order {
        Some(p) if p > REGULAR => SAFE * error(OF_A_JUMP).max(range),
        Some(p) => (SAFE * error(p.min(OF_A_JUMP))).min(UNSAFE * range),
        None => UNSAFE * range,
    };
    Some(Converged { uncertainty, order })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// f = 1 + h^p at h = 4, 2, 1 and at 3, 2, 1: the order is p; the uncertainty is 1.25 times the
    /// error of the order 2/3.
    #[test]
    fn orders_are_recovered() {
        for sizes in [[4.0, 2.0, 1.0], [3.0, 2.0, 1.0], [2.0, 1.5, 1.0]] {
            for p in [1.0, 1.5, 2.0] {
                let values = sizes.map(|h: f64| 1.0 + 0.01 * h.powf(p));
                let found = converged(&sizes, &values).unwrap();
                assert!((found.order.unwrap() - p).abs() < 1e-6, "{found:?}");
                let of_a_jump = (values[1] - values[2]) / (sizes[1].powf(2.0 / 3.0) - 1.0);
                assert!((found.uncertainty - 1.25 * of_a_jump).abs() < 1e-8, "{found:?}");
            }
        }
    }

    /// By hand: the order 1/2 of 2, √2 and 1 puts the limit 1 below; an order of 3 is not believed,
    /// and values that do not converge have three times their range.
    #[test]
    fn irregular_convergence_is_wider() {
        let h = [4.0, 2.0, 1.0];
        let slow = converged(&h, &h.map(|h: f64| h.sqrt())).unwrap();
        assert!((slow.uncertainty - 1.25).abs() < 1e-9, "{slow:?}");
        let fast = converged(&h, &h.map(|h: f64| h.powi(3) / 64.0)).unwrap();
        assert!((fast.uncertainty - 1.25 * 63.0 / 64.0).abs() < 1e-12, "{fast:?}");
        // Whether the two finest values are equal or almost so makes no difference.
        for last in [1.0, 1.0 + 1e-15, 1.0 - 1e-15, 1.0 - 1e-8] {
            assert!((converged(&h, &[1.2, 1.0, last]).unwrap().uncertainty - 0.25).abs() < 1e-7, "{last}");
        }
        assert_eq!(converged(&h, &[1.4, 1.2, 1.4]).unwrap().order, None);
        assert!((converged(&h, &[1.4, 1.2, 1.4]).unwrap().uncertainty - 0.6).abs() < 1e-12);
        assert!((converged(&[2.0, 1.0], &[1.1, 1.0]).unwrap().uncertainty - 0.3).abs() < 1e-12);
        assert_eq!(converged(&h, &[1.0; 3]).unwrap().uncertainty, 0.0);
        assert!(converged(&[1.0], &[1.0]).is_none());
    }
}
