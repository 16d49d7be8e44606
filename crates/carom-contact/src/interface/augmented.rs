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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rounds_find_the_multiplier_of_a_node_on_a_spring() {
        // A spring of stiffness K presses a node with the force f onto a plane: K g = f − λ with
        // g = 0 has λ = f = −3, whatever r.
        let interface = Augmented::default();
        let stiffness = 7.0;
        let force = -3.0;
        let mut multiplier = 0.0;
        let augmentation = 14.0;
        for round in 0..40 {
            // The root of the row and of the balance.
            let gap: f64 = (force - multiplier) / (stiffness + augmentation);
            let lambda = multiplier + augmentation * gap;
            let at =
                Point { node: 0, gap, start: gap, lambda, active: true, multiplier, stiffness: augmentation };
            let answer = interface.respond(&at);
            assert!(answer.open.abs() < 1e-15 && answer.energy == 0.0, "{round}: {answer:?}");
            assert!((stiffness * gap + lambda - force).abs() < 1e-14);
            multiplier = lambda;
        }
        assert!((multiplier - force).abs() < 1e-12, "{multiplier}");
    }
}
