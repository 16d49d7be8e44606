//! Why a linear system could not be solved.

/// Why a linear system could not be solved.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum LinearError {
    /// A pivot vanished or is not finite.
    #[error("the matrix of {size} unknowns is singular: pivot {pivot} is {value:e}")]
    Singular {
        /// Unknowns.
        size: usize,
        /// Place of the pivot in the elimination order.
        pivot: usize,
        /// Its value.
        value: f64,
    },
    /// The solution is not finite or its residual stays large.
    #[error("the solution of {size} unknowns is not usable: relative residual {residual:e}")]
    Inaccurate {
        /// Unknowns.
        size: usize,
        /// Residual after refinement.
        residual: f64,
    },
    /// No states of open, stick and slip agree with each other.
    #[error(
        "no states of stick and slip agree with each other: {forces} forces, {sweeps} sweeps; use a smaller step or a smaller mu, for a large one there may be none"
    )]
    NoStates {
        /// Forces, normal and tangential.
        forces: usize,
        /// Sweeps over them.
        sweeps: usize,
    },
    /// Conjugate gradients do not converge.
    #[error(
        "conjugate gradients do not converge: {iterations} iterations reduced the residual of {size} unknowns to {reduction:.1e}; use a smaller step, or solve directly"
    )]
    Stalled {
        /// Unknowns.
        size: usize,
        /// Iterations.
        iterations: usize,
        /// Residual relative to the first.
        reduction: f64,
    },
    /// There is not enough memory for the factorisation.
    #[error("there is not enough memory to factorise a matrix of {size} unknowns")]
    Memory {
        /// Unknowns.
        size: usize,
    },
    /// The engine ran out of indices, or did not end.
    #[error("the factorisation of {size} unknowns failed: {reason}")]
    Engine {
        /// Unknowns.
        size: usize,
        /// The engine's message.
        reason: String,
    },
}
