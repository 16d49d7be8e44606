//! Penalty contact with the potential U(g) = k/2 min(g, 0)²: λ = U'(g).

use super::{Answer, Interface, Point};

/// Penalty contact: a spring for each secondary node.
#[derive(Clone, Debug)]
pub struct Penalty {
    stiffness: Vec<f64>,
}

impl Penalty {
    /// Penalty springs with a stiffness (force per gap, > 0) for each secondary node.
    pub fn new(stiffness: Vec<f64>) -> Self {
        Self { stiffness }
    }
}

impl Interface for Penalty {
    fn is_constraint(&self) -> bool {
        false
    }

    fn respond(&self, at: &Point) -> Answer {
        let k = self.stiffness[at.node];
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

    fn stiffness(&self, node: usize) -> Option<f64> {
        Some(self.stiffness[node])
    }
}
