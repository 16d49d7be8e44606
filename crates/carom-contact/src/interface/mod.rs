//! The response of a contact to its gap: traction, the residual of its condition, and both
//! derivatives. Any interface can be combined with any kinematics.
//!
//! ```text
//! [ K   Gᵀ ] [Δy]   [ −r ]
//! [ G   −C ] [Δλ] = [ −c ]        c = Answer::open, C = Answer::compliance or Answer::yields of each active pair
//! ```

mod augmented;
#[doc(hidden)]
pub mod conserving_penalty;
mod conserving_unilateral;
mod penalty;
mod unilateral;

pub use augmented::Augmented;
pub use conserving_penalty::ConservingPenalty;
pub use conserving_unilateral::ConservingUnilateral;
pub use penalty::Penalty;
pub use unilateral::Unilateral;

/// State of a pair at which a contact law is evaluated.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Point {
    /// Index of the secondary node.
    pub node: usize,
    /// Gap at the end of the step; infinite for a remote pair.
    pub gap: f64,
    /// Gap at the start of the step, for a law whose force depends on the [path](Direction).
    pub start: f64,
    /// Multiplier of the pair in the current iteration.
    pub lambda: f64,
    /// Whether the pair is active in the current iteration.
    pub active: bool,
    /// Multiplier λ̂ of the last round of an augmented Lagrangian.
    pub multiplier: f64,
    /// Stiffness of the spring of a penalty (force per gap, > 0), or r of an augmented Lagrangian.
    pub stiffness: f64,
}

/// Response of a contact law at a pair.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Answer {
    /// Whether the pair is active, and so has a row in the linear system.
    pub active: bool,
    /// Contact traction λ ≤ 0, the force conjugate to the gap.
    pub lambda: f64,
    /// Residual of the row of the linear system: the gap of a constraint, zero for a spring, whose
    /// traction corresponds to the gap.
    pub open: f64,
    /// Compliance ∂g/∂λ of a spring whose row is eliminated, because the traction follows from the
    /// gap; 0 for a constraint.
    pub compliance: f64,
    /// Compliance ∂g/∂λ of a row that remains in the linear system with λ as an unknown.
    pub yields: f64,
    /// Energy stored in the contact spring.
    pub energy: f64,
}

/// Direction of the contact force over a step.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Direction {
    /// Gradient ∇g of the gap at the end of the step.
    #[default]
    End,
    /// Gradient ∇g at the midpoint of the step; the gap is accumulated along it, g₁ = g₀ + ∇g·Δy.
    Midpoint,
    /// The [discrete gradient](crate::DiscreteGradient) of the gap over the step.
    DiscreteGradient,
}

impl Direction {
    /// Whether the gap is accumulated over steps along the gradient at each midpoint; the force is
    /// then a quotient of differences, not linear in the gap.
    pub fn accumulates(self) -> bool {
        self == Self::Midpoint
    }
}

/// A contact law with its enforcement.
pub trait Interface: Send + Sync {
    /// Whether pairs are constraints, so that an active set decides which of them are active.
    fn is_constraint(&self) -> bool {
        true
    }

    /// Direction of the contact force over a step.
    fn direction(&self) -> Direction {
        Direction::End
    }

    /// The traction, residual and compliance of a pair in a given state.
    fn respond(&self, at: &Point) -> Answer;
}
