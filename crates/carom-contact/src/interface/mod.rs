//! The response of a contact to its gap: traction, the residual of its condition, and both
//! derivatives. Any interface can be combined with any kinematics.
//!
//! ```text
//! [ K   Gᵀ ] [Δy]   [ −r ]
//! [ G   −C ] [Δλ] = [ −c ]        c = Answer::open, C = Answer::compliance of each active pair
//! ```

mod conserving;
mod penalty;
mod unilateral;

pub use conserving::ConservingPenalty;
pub use penalty::Penalty;
pub use unilateral::Unilateral;

/// Input of an interface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Point {
    /// Index of the secondary node.
    pub node: usize,
    /// Gap at the end of the step; infinite for a remote pair.
    pub gap: f64,
    /// Gap at its start, for an interface that acts [between](Interface::acts_between) the two.
    pub start: f64,
    /// Multiplier and activity in the current iteration.
    pub lambda: f64,
    /// See `lambda`.
    pub active: bool,
}

/// Response of an interface.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Answer {
    /// Whether the pair is active: it is a row of the linear system.
    pub active: bool,
    /// Traction λ ≤ 0 on the gap.
    pub lambda: f64,
    /// Residual of the row: the gap of a constraint; zero if the traction already corresponds to
    /// the gap.
    pub open: f64,
    /// ∂g/∂λ: 0 for a constraint.
    pub compliance: f64,
    /// Stored energy.
    pub energy: f64,
}

/// A contact law with its enforcement.
pub trait Interface: Send + Sync {
    /// Whether its pairs are constraints: an active set decides which of them are active.
    fn is_constraint(&self) -> bool;

    /// Whether the force acts along the gradient at the midpoint of the step, and works from the
    /// gap at its start to that at its end.
    fn acts_between(&self) -> bool {
        false
    }

    /// The response at a point.
    fn respond(&self, at: &Point) -> Answer;

    /// Spring stiffness of a secondary node; none for a constraint.
    fn stiffness(&self, node: usize) -> Option<f64> {
        let _ = node;
        None
    }
}
