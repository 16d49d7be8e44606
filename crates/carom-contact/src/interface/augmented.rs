//! Frictionless constraint by an augmented Lagrangian (P. Alart, A. Curnier, Comput. Methods Appl.
//! Mech. Engrg. 92 (1991) 353–375; J. C. Simo, T. A. Laursen, Comput. Struct. 42 (1992) 97–116): a
//! spring of stiffness r on top of a multiplier λ̂ that is kept while Newton's method converges,
//! and then replaced by λ, until the gaps of all closed pairs are small.
//!
//! ```text
//! λ = λ̂ + r g ≤ 0,  g ≥ 0 where open          λ̂ ← λ          row: g − (λ − λ̂)/r = 0
//! ```
//!
//! λ is an unknown, so that the same active set decides as with multipliers, and the rows may
//! depend on each other, because C = 1/r > 0. At the end g = 0, and no energy is stored.

use super::{Answer, Direction, Interface, Point};

/// Unilateral contact by an augmented Lagrangian, whose multipliers are found in rounds.
#[derive(Clone, Copy, Debug, Default)]
pub struct Augmented {
    direction: Direction,
}

impl Augmented {
    /// Augmented Lagrangian with a contact force in the given direction.
    pub fn along(direction: Direction) -> Self {
        Self { direction }
    }
}

impl Interface for Augmented {
    fn direction(&self) -> Direction {
        self.direction
    }

    fn respond(&self, at: &Point) -> Answer {
        if !at.active {
            return Answer::default();
        }
        let yields = at.stiffness.recip();
        let open = at.gap - (at.lambda - at.multiplier) * yields;
        Answer { active: true, lambda: at.lambda, open, yields, ..Answer::default() }
    }
}
