//! Parameters of schemes: the keys of a case file, and those common to several kinds.

use std::ops::Bound::{self, Excluded, Included, Unbounded};

/// A parameter: a finite number.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Parameter {
    /// Key in a case file.
    pub key: &'static str,
    /// Bounds of valid values.
    pub range: (Bound<f64>, Bound<f64>),
    /// Its meaning, a sentence.
    pub meaning: &'static str,
    /// A value, as TOML.
    pub example: &'static str,
}

/// ρ∞, the most common parameter.
pub(crate) const RHO_INF: Parameter = Parameter {
    key: "rho_inf",
    range: (Included(0.0), Included(1.0)),
    meaning: "Spectral radius at infinite frequency: 0 removes the highest frequencies within a few steps, 1 does not damp them.",
    example: "0.8",
};

/// Newmark's β.
pub(crate) const BETA: Parameter = Parameter {
    key: "beta",
    range: (Excluded(0.0), Unbounded),
    meaning: "Newmark's β: weight of the new acceleration in the new position.",
    example: "0.25",
};

/// Newmark's γ.
pub(crate) const GAMMA: Parameter = Parameter {
    key: "gamma",
    range: (Excluded(0.0), Unbounded),
    meaning: "Newmark's γ: weight of the new acceleration in the new velocity.",
    example: "0.5",
};
