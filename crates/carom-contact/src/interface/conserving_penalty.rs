//! Energy-conserving springs: the discrete gradient of U(g) = k/2 min(g, 0)² along a gap that is
//! itself updated from step to step (F. Armero, E. Petőcz, Comput. Methods Appl. Mech. Engrg. 158
//! (1998) 269–300).
//!
//! ```text
//! g₁ = g₀ + ∇g(y_m)·Δy,   λ = (U(g₁) − U(g₀)) / (g₁ − g₀)   (U'(g₀) where they are equal),   f = λ ∇g(y_m),   y_m = (y₀ + y₁)/2
//! ```
//!
//! so that f·Δy = U(g₁) − U(g₀) exactly, and force and moment balance at y_m as for any Σ λ ∇g. If
//! g is linear in y, g₁ is the gap. Otherwise it deviates by terms of third order in Δy, and is
//! reset at each new contact.

use super::{Answer, Direction, Interface, Point};

/// Energy-conserving penalty contact: springs with the stiffness of the [`Point`].
#[derive(Clone, Copy, Debug)]
pub struct ConservingPenalty;

impl Interface for ConservingPenalty {
    fn is_constraint(&self) -> bool {
        false
    }

    fn direction(&self) -> Direction {
        Direction::Midpoint
    }

    fn respond(&self, at: &Point) -> Answer {
        if !(at.gap.is_finite() && at.start.is_finite()) {
            return Answer::default();
        }
        let k = at.stiffness;
        let (lambda, slope) = discrete_gradient(k, at.start, at.gap - at.start);
        let energy = 0.5 * k * at.gap.min(0.0).powi(2);
        if slope > 0.0 {
            Answer { active: true, lambda, compliance: slope.recip(), energy, ..Answer::default() }
        } else {
            Answer { energy, ..Answer::default() }
        }
    }
}

/// Discrete gradient λ = ΔU/Δg of the potential U = k/2 min(g, 0)² between the gaps `start` and
/// `start + moved`, and its derivative by the gap at the end.
pub fn discrete_gradient(k: f64, start: f64, moved: f64) -> (f64, f64) {
    let end = start + moved;
    match (start < 0.0, end < 0.0) {
        (true, true) => (k * (start + 0.5 * moved), 0.5 * k),
        (true, false) => (-0.5 * k * start * start / moved, 0.5 * k * (start / moved).powi(2)),
        (false, true) => (0.5 * k * end * end / moved, k * end / moved * (1.0 - 0.5 * end / moved)),
        (false, false) => (0.0, 0.0),
    }
}
