//! Settings of Newton's method.

/// How a stage is solved.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// ‖Δy‖∞/L and ‖r‖/Σ‖f‖ at convergence.
    pub tolerance: f64,
    /// Iterations before a step is rejected.
    pub max_iterations: usize,
    /// When the tangent is formed and factored.
    pub tangent: Tangent,
    /// Earlier iterations with the same factor that each correction is improved by.
    pub mixing: usize,
}

/// When the tangent is formed and factored.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Tangent {
    /// When the kept one no longer pays; large factors in single precision.
    Frozen,
    /// The same, every factor in double precision.
    FrozenDouble,
    /// In every iteration.
    Full,
}
