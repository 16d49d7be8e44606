//! Time integration: the interval, the step, the scheme, and Newton's method.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

/// Time interval, step and scheme.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct TimeSpec {
    /// End time.
    pub end: f64,
    /// Time step; the grid is n·step if the phase is 0.
    pub step: f64,
    /// Shift of the grid, as a fraction of a step.
    #[serde(default)]
    pub phase: f64,
    /// Time integrator as given.
    pub scheme: SchemeSpec,
    /// Fraction of the energy scale so far that may be created before the run stops; none: the
    /// energy is recorded only.
    pub energy_guard: Option<f64>,
    /// What takes a grid step at which the run would stop.
    #[serde(default)]
    pub fallback: Fallback,
}

/// What takes a grid step at which the run would stop.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Fallback {
    /// Nothing.
    #[default]
    None,
    /// Backward Euler with contact implicit in velocity.
    Velocity,
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

/// Settings of Newton's method.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct NewtonSpec {
    /// Convergence tolerance on ‖Δy‖∞/L and ‖r‖/Σ‖f‖.
    pub tolerance: f64,
    /// Largest number of iterations before a step is rejected.
    pub max_iterations: usize,
    /// What solves with the tangent.
    #[serde(default)]
    pub linear: LinearRule,
    /// When the tangent is factorised.
    #[serde(default)]
    pub tangent: TangentRule,
    /// Number of earlier corrections with the same factorisation that improve the next one; 0 in
    /// records written before this key existed.
    #[serde(default)]
    pub mixing: usize,
}

/// What solves the linear systems.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum LinearRule {
    /// The faster of the two, by size and dimension.
    #[default]
    Auto,
    /// A factorisation.
    Direct,
    /// Conjugate gradients.
    Iterative,
}

/// When the tangent is assembled and factorised.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum TangentRule {
    /// When reusing the factorisation no longer pays; large factors in single precision.
    #[default]
    Frozen,
    /// The same, with every factor in double precision.
    FrozenDouble,
    /// In every iteration.
    Full,
}
