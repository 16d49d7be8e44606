//! Frictionless constraint that conserves: the position constraint g ≥ 0, λ ≤ 0, λ g = 0 at the end
//! of the step, with a force along the [discrete gradient](crate::DiscreteGradient) of the gap.
//!
//! ```text
//! f = λ ∇̄G,   λ ∇̄G·Δy = λ (G_{n+1} − G_n) = −λ G_n
//! ```
//!
//! which is zero while the gap stays closed. In the step in which it closes, −λ G_n ≥ 0 is lost.

use super::{Answer, Direction, Interface, Point, Unilateral};

/// Unilateral contact by Lagrange multipliers that do no work on a closed gap.
#[derive(Clone, Copy, Debug, Default)]
pub struct ConservingUnilateral;

impl Interface for ConservingUnilateral {
    fn direction(&self) -> Direction {
        Direction::DiscreteGradient
    }

    fn respond(&self, at: &Point) -> Answer {
        Unilateral.respond(at)
    }
}
