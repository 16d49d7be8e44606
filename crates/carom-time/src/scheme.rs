//! The α family as data.
use serde::{Deserialize, Serialize};

/// What is averaged over the step with α_f: the forces (eq. 15) or the state they are evaluated at.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum ForceRule {
    /// (1 − α_f) f(y_{s+1}) + α_f f(y_s).
    #[default]
    AverageForces,
    /// f((1 − α_f) y_{s+1} + α_f y_s).
    AverageState,
}

/// One member of the α family, index s + 1 − α (eq. 15). Values are used as given; nothing is clamped.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Scheme {
    /// Share of the old inertia force.
    pub alpha_m: f64,
    /// Share of the old other forces.
    pub alpha_f: f64,
    /// Newmark's β.
    pub beta: f64,
    /// Newmark's γ.
    pub gamma: f64,
    /// What α_f averages.
    pub forces: ForceRule,
}
