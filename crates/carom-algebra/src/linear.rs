//! Why a linear system could not be solved.

/// Why a linear system could not be solved.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum LinearError {
    /// A pivot vanished or is not finite.
    #[error("the matrix of {size} unknowns is singular: pivot {pivot} is {value:e}")]
    Singular {
        /// Number of unknowns.
        size: usize,
        /// Place of the pivot in the elimination order.
        pivot: usize,
        /// Value of the pivot.
        value: f64,
    },
    /// The solution is not finite or its residual stays large.
    #[error("the solution of {size} unknowns is not usable: relative residual {residual:e}")]
    Inaccurate {
        /// Number of unknowns.
        size: usize,
        /// Relative residual after refinement.
        residual: f64,
    },
    /// No states of open, stick and slip agree with each other.
    #[error(
        "no states of stick and slip agree with each other: {forces} forces, {sweeps} sweeps; use a smaller step or a smaller mu, for a large one there may be none"
    )]
    NoStates {
        /// Number of forces, normal and tangential.
        forces: usize,
        /// Number of sweeps over the forces.
        sweeps: usize,
    },
    /// Conjugate gradients do not converge.
    #[error(
        "conjugate gradients do not converge: {iterations} iterations reduced the residual of {size} unknowns to {reduction:.1e}; use a smaller step, or solve directly"
    )]
    Stalled {
        /// Number of unknowns.
        size: usize,
        /// Number of iterations.
        iterations: usize,
        /// Residual relative to that before the first iteration.
        reduction: f64,
    },
    /// There is not enough memory for the factorisation.
    #[error("there is not enough memory to factorise a matrix of {size} unknowns")]
    Memory {
        /// Number of unknowns.
        size: usize,
    },
    /// The factorisation ran out of indices, or did not terminate.
    #[error("the factorisation of {size} unknowns failed: {reason}")]
    Engine {
        /// Number of unknowns.
        size: usize,
        /// Message of the factorisation library.
        reason: String,
    },
}
