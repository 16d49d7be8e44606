//! The response of a contact to its gap: traction, the residual of its condition, and both
//! derivatives. Any interface can be combined with any kinematics.
//!
//! ```text
//! [ K   Gᵀ ] [Δy]   [ −r ]
//! [ G   −C ] [Δλ] = [ −c ]        c = Answer::open, C = Answer::compliance or Answer::yields of each active pair
//! ```

mod augmented;
mod conserving_penalty;
mod conserving_unilateral;
mod penalty;
mod unilateral;

pub use augmented::Augmented;
pub use conserving_penalty::ConservingPenalty;
pub use conserving_unilateral::ConservingUnilateral;
pub use penalty::Penalty;
pub use unilateral::Unilateral;

/// Input of an interface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Point {
    /// Index of the secondary node.
    pub node: usize,
    /// Gap at the end of the step; infinite for a remote pair.
    pub gap: f64,
    /// Gap at its start, for an interface whose force depends on the [path](Direction).
    pub start: f64,
    /// Multiplier and activity in the current iteration.
    pub lambda: f64,
    /// See `lambda`.
    pub active: bool,
    /// λ̂ and r of an augmented Lagrangian.
    pub multiplier: f64,
    /// See `multiplier`.
    pub stiffness: f64,
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
    /// ∂g/∂λ of a spring, whose traction follows from its gap, so that its row is eliminated; 0 for
    /// a constraint.
    pub compliance: f64,
    /// ∂g/∂λ of a row that remains, with λ as an unknown.
    pub yields: f64,
    /// Stored energy.
    pub energy: f64,
}

/// Direction of the contact force over a step.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Direction {
    /// ∇g at the end of the step.
    #[default]
    End,
    /// ∇g at the midpoint; the gap is accumulated along it, g₁ = g₀ + ∇g·Δy.
    Midpoint,
    /// The [discrete gradient](crate::DiscreteGradient) of the gap over the step.
    DiscreteGradient,
}

impl Direction {
    /// Whether gaps are accumulated over steps, along the midpoint of each: the force is a quotient
    /// of differences, which is not linear in the gap.
    pub fn accumulates(self) -> bool {
        self == Self::Midpoint
    }
}

/// A contact law with its enforcement.
pub trait Interface: Send + Sync {
    /// Whether its pairs are constraints: an active set decides which of them are active.
    fn is_constraint(&self) -> bool {
        true
    }

    /// Direction of its force.
    fn direction(&self) -> Direction {
        Direction::End
    }

    /// The response at a point.
    fn respond(&self, at: &Point) -> Answer;

    /// Spring stiffness of a secondary node; none for a constraint.
    fn stiffness(&self, _node: usize) -> Option<f64> {
        None
    }
}
