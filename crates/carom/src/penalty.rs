//! Contact by springs of the potential U(g) = k/2 min(g, 0)².
//!
//! At a stage's end λ = U'(g). Between two times, for the energy-momentum scheme, the discrete gradient of U along a gap that is itself carried
//! (F. Armero, E. Petőcz, Comput. Methods Appl. Mech. Engrg. 158 (1998) 269–300):
//!
//! ```text
//! g₁ = g₀ + ∇g(y_m)·Δy,   λ = (U(g₁) − U(g₀)) / (g₁ − g₀)   (U'(g₀) where they are equal),   f = λ ∇g(y_m),   y_m = (y₀ + y₁)/2
//! ```
//!
//! so that f·Δy = U(g₁) − U(g₀) exactly, and force and moment balance at y_m as those of any Σ λ ∇g do. Where g is linear in y, g₁ is the gap; else it
//! departs from it by terms of third order in Δy, and begins anew with each contact.

use carom_contact::{ContactError, ContactMethod, Linearised, Pair};

/// Positions a spring is evaluated between; `middle` for the discrete gradient only.
pub(crate) struct Configuration<'a> {
    pub start: &'a [f64],
    pub middle: Option<&'a Vec<f64>>,
    pub end: &'a [f64],
    pub moved: &'a [f64],
}

/// A spring's ∂λ/∂g₁ and energy U(g₁).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Spring {
    pub stiffness: f64,
    pub energy: f64,
}

/// Linearises a pair as a spring of stiffness `k`: sets its multiplier and whether it presses, and fills `gap` with g₁, ∇g and the second derivative the
/// force really has.
pub(crate) fn spring<const D: usize>(
    method: &dyn ContactMethod<D>,
    k: f64,
    pair: &mut Pair,
    at: &Configuration,
    gap: &mut Linearised<D>,
) -> Result<Spring, ContactError> {
    let nodes = |y| <[f64]>::as_chunks::<D>(y).0;
    let was_active = pair.active;
    let linearised = |pair: &mut Pair, y, gap: &mut Linearised<D>| match method.linearise(pair, nodes(y), 1.0, gap) {
        Ok(()) => Ok(true),
        Err(error) if was_active => Err(error),
        // An open pair whose closest point is not unique is far away.
        Err(_) => Ok(false),
    };
    let (lambda, stiffness, share, found) = match at.middle {
        None => {
            let found = linearised(pair, at.end, gap)?;
            let (lambda, stiffness) = if gap.gap < 0.0 { (k * gap.gap, k) } else { (0.0, 0.0) };
            (lambda, stiffness, 1.0, found)
        }
        Some(middle) => {
            let mut found = true;
            if pair.start.is_none() {
                found = linearised(&mut pair.clone(), at.start, gap)?;
                pair.start = found.then_some(gap.gap);
            }
            found &= linearised(pair, middle, gap)?;
            let moved: f64 = (0..gap.count)
                .map(|p| (0..D).map(|i| gap.gradient[p][i] * at.moved[gap.nodes[p] * D + i]).sum::<f64>())
                .sum();
            let start = pair.start.unwrap_or(f64::INFINITY);
            gap.gap = start + moved;
            let (lambda, stiffness) = discrete_gradient(k, start, moved);
            (lambda, stiffness, 0.5, found)
        }
    };
    if !found {
        (pair.active, pair.lambda, gap.gap) = (false, 0.0, f64::INFINITY);
        return Ok(Spring::default());
    }
    (pair.active, pair.lambda) = (stiffness > 0.0, lambda);
    for row in &mut gap.hessian[..gap.count] {
        for block in &mut row[..gap.count] {
            *block = *block * (share * lambda);
        }
    }
    Ok(Spring { stiffness, energy: 0.5 * k * gap.gap.min(0.0).powi(2) })
}

/// λ = ΔU/Δg of U = k/2 min(g, 0)² from `start` over `moved`, and ∂λ/∂g₁.
fn discrete_gradient(k: f64, start: f64, moved: f64) -> (f64, f64) {
    let end = start + moved;
    match (start < 0.0, end < 0.0) {
        (true, true) => (k * (start + 0.5 * moved), 0.5 * k),
        (true, false) => (-0.5 * k * start * start / moved, 0.5 * k * (start / moved).powi(2)),
        (false, true) => (0.5 * k * end * end / moved, k * end / moved * (1.0 - 0.5 * end / moved)),
        (false, false) => (0.0, 0.0),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn work_is_the_change_of_energy_and_the_stiffness_a_difference() {
        let energy = |g: f64| 0.5 * 7.0 * g.min(0.0).powi(2);
        for start in [-0.3, -0.01, 0.0, 0.2] {
            for end in [-0.4, -0.05, 0.1] {
                let (lambda, stiffness) = discrete_gradient(7.0, start, end - start);
                assert!((lambda * (end - start) - (energy(end) - energy(start))).abs() < 1e-15);
                let h = 1e-6;
                let difference = (discrete_gradient(7.0, start, end + h - start).0
                    - discrete_gradient(7.0, start, end - h - start).0)
                    / (2.0 * h);
                assert!((difference - stiffness).abs() < 1e-7, "{start} {end}: {difference} {stiffness}");
                assert!(lambda <= 0.0 && stiffness >= 0.0);
            }
        }
        assert_eq!(discrete_gradient(7.0, -0.1, 0.0).0, 7.0 * -0.1);
    }
}
