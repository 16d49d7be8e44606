//! Frictionless constraint, g ≥ 0, λ ≤ 0, λ g = 0, by a Lagrange multiplier: while a pair is in the
//! active set its gap is constrained to zero and λ is an unknown.

use super::{Answer, Interface, Point};

/// Unilateral contact by Lagrange multipliers.
#[derive(Clone, Copy, Debug, Default)]
pub struct Unilateral;

impl Interface for Unilateral {
    fn respond(&self, at: &Point) -> Answer {
        if at.active {
            Answer { active: true, lambda: at.lambda, open: at.gap, ..Answer::default() }
        } else {
            Answer::default()
        }
    }
}
