//! Penalty contact with the potential U(g) = k/2 min(g, 0)²: λ = U'(g).

use super::{Answer, Interface, Point};

/// Penalty contact: springs with the stiffness of the [`Point`].
#[derive(Clone, Copy, Debug)]
pub struct Penalty;

impl Interface for Penalty {
    fn is_constraint(&self) -> bool {
        false
    }

    fn respond(&self, at: &Point) -> Answer {
        let k = at.stiffness;
        if at.gap >= 0.0 {
            return Answer::default();
        }
        Answer {
            active: true,
            lambda: k * at.gap,
            compliance: k.recip(),
            energy: 0.5 * k * at.gap * at.gap,
            ..Answer::default()
        }
    }
}
