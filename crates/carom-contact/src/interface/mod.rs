//! What a contact answers to its gap: traction, what is left of its condition, and both
//! derivatives. Any interface goes with any kinematics.
//!
//! ```text
//! [ K   Gᵀ ] [Δy]   [ −r ]
//! [ G   −C ] [Δλ] = [ −c ]        c = Answer::open, C = Answer::compliance of each pressing pair
//! ```

mod conserving;
mod penalty;
mod unilateral;

pub use conserving::ConservingPenalty;
pub use penalty::Penalty;
pub use unilateral::Unilateral;

/// What an interface is asked about.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Point {
    /// Place of the secondary node.
    pub node: usize,
    /// Gap at the end of the step; infinite where the pair is far away.
    pub gap: f64,
    /// Gap at its start, where the interface acts [between](Interface::acts_between) the two.
    pub start: f64,
    /// Multiplier and whether it presses, as the iteration has them.
    pub lambda: f64,
    /// See `lambda`.
    pub active: bool,
}

/// What it answers.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Answer {
    /// Whether the pair presses: it is a row of the linear system.
    pub active: bool,
    /// Traction λ ≤ 0 on the gap.
    pub lambda: f64,
    /// What the row has yet to close: the gap of a constraint; nothing where the traction is that
    /// of the gap already.
    pub open: f64,
    /// ∂g/∂λ: 0 of a constraint.
    pub compliance: f64,
    /// Energy stored.
    pub energy: f64,
}

/// A law of contact with the way it is enforced.
pub trait Interface: Send + Sync {
    /// Whether its pairs are constraints: an active set decides which of them press.
    fn is_constraint(&self) -> bool;

    /// Whether the force acts along the gradient in the middle of the step, and works from the gap
    /// at its start to that at its end.
    fn acts_between(&self) -> bool {
        false
    }

    /// The answer at a point.
    fn respond(&self, at: &Point) -> Answer;

    /// Stiffness of a secondary node's own spring; none of a constraint.
    fn stiffness(&self, node: usize) -> Option<f64> {
        let _ = node;
        None
    }
}
