//! Settings of Newton's method.

/// Parameters of the solution of a stage.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// ‖Δy‖∞/L and ‖r‖/Σ‖f‖ at convergence.
    pub tolerance: f64,
    /// Iterations before a step is rejected.
    pub max_iterations: usize,
    /// What solves with it.
    pub linear: Linear,
    /// When the tangent is formed and factored.
    pub tangent: Tangent,
    /// Number of earlier iterations with the same factor used to mix each correction.
    pub mixing: usize,
}

/// What solves with a frozen tangent.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Linear {
    /// Its factor.
    #[default]
    Direct,
    /// Conjugate gradients.
    Iterative,
}

/// When the tangent is formed and factored.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Tangent {
    /// When reusing the last one no longer pays; large factors in single precision.
    Frozen,
    /// The same, every factor in double precision.
    FrozenDouble,
    /// In every iteration.
    Full,
}
