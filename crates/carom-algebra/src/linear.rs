//! What Carom asks of a direct solver for sparse symmetric, possibly indefinite systems.

use crate::Pattern;

/// Signs of the pivots: how many eigenvalues of the factored matrix are positive, negative, zero (Sylvester's law of inertia).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Inertia {
    /// Positive eigenvalues.
    pub positive: usize,
    /// Negative eigenvalues.
    pub negative: usize,
    /// Zero pivots.
    pub zero: usize,
}

/// How well a solve went.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SolveReport {
    /// Steps of iterative refinement taken.
    pub refinements: usize,
    /// ‖b − A x‖∞ / (‖b‖∞ + ‖A‖ ‖x‖∞) of the equilibrated system at the end.
    pub residual: f64,
}

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
    /// The engine ran out of memory or indices.
    #[error("the factorisation of {size} unknowns failed: {reason}")]
    Engine {
        /// Unknowns.
        size: usize,
        /// The engine's own words.
        reason: String,
    },
}

/// A direct solver. Equilibration and iterative refinement live inside.
pub trait LinearSolver: Send {
    /// Orders and analyses a pattern. Unknowns of one group (a node's dofs and its multipliers) stay together in the elimination, in ascending
    /// order: multipliers, numbered last, then follow their node's dofs and no pivot is structurally zero.
    fn analyse(&mut self, pattern: &Pattern, groups: &[usize]) -> Result<(), LinearError>;

    /// Values of the lower triangle in the slots of the pattern last analysed.
    fn values(&mut self) -> &mut [f64];

    /// Factors the current values.
    fn factor(&mut self) -> Result<Inertia, LinearError>;

    /// Solves with the last factorisation.
    fn solve(&mut self, rhs: &[f64], out: &mut [f64]) -> Result<SolveReport, LinearError>;
}
