//! How time is stepped through: the interval, the scheme, the method that solves a step.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

/// Time interval, step and scheme.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct TimeSpec {
    /// End time.
    pub end: f64,
    /// Time step; the grid is n·step.
    pub step: f64,
    /// Time integrator as given.
    pub scheme: SchemeSpec,
    /// Fraction of the largest energy so far that may be created before the run stops; none:
    /// reported only.
    pub energy_guard: Option<f64>,
}

/// A time integrator by its published name: `{ kind = "chung-hulbert", rho_inf = 0.1 }`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SchemeSpec {
    /// The `kind` key.
    pub kind: String,
    /// Its parameters by key, as given.
    #[serde(flatten)]
    pub parameters: BTreeMap<String, f64>,
    /// `average-forces` or `average-state`.
    pub forces: carom_time::ForceRule,
}

/// Newton's method.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct NewtonSpec {
    /// ‖Δy‖∞/L and ‖r‖/Σ‖f‖ at convergence.
    pub tolerance: f64,
    /// Iterations before a step is rejected.
    pub max_iterations: usize,
    /// Whether factors are kept over iterations and steps.
    #[serde(default)]
    pub tangent: TangentRule,
    /// Earlier iterations with the same factor that each correction is improved by. Runs of
    /// versions without this had none.
    #[serde(default)]
    pub mixing: usize,
}

/// When the tangent is formed and factored.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum TangentRule {
    /// When the kept one no longer pays; large factors in single precision.
    #[default]
    Frozen,
    /// The same, every factor in double precision.
    FrozenDouble,
    /// In every iteration.
    Full,
}
