//! The α family as data: the parameters of eq. (15). Published choices are in `schemes/`.
//!
//! ```text
//! (1 − α_m) M a_{s+1} + α_m M a_s + (1 − α_f) f_{s+1} + α_f f_s = 0                              (15)
//! y_{s+1} = y_s + Δt v_s + Δt² [(½ − β) a_s + β a_{s+1}]                                         (13)
//! v_{s+1} = v_s + Δt [(1 − γ) a_s + γ a_{s+1}]                                                   (14)
//! ```
//!
//! Index s + 1 − α: an α is the weight of the *old* term (Chung and Hulbert 1993).
//! [`crate::explain`] translates.
use serde::{Deserialize, Serialize};

use crate::error::SchemeError;

/// What α_f averages over the step: the forces (eq. 15) or the state at which they are evaluated.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum ForceRule {
    /// (1 − α_f) f(y_{s+1}) + α_f f(y_s).
    #[default]
    AverageForces,
    /// f((1 − α_f) y_{s+1} + α_f y_s).
    AverageState,
}

/// A member of the α family, index s + 1 − α (eq. 15). Values are used as given, without clamping.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Scheme {
    /// Weight of the old inertia force.
    pub alpha_m: f64,
    /// Weight of the old other forces.
    pub alpha_f: f64,
    /// Newmark's β.
    pub beta: f64,
    /// Newmark's γ.
    pub gamma: f64,
    /// What α_f averages.
    pub forces: ForceRule,
}

/// Constructors by published name are in [`crate::schemes`]; all average forces, see
/// [`Scheme::with_forces`].
impl Scheme {
    /// The same scheme with another rule for what α_f averages.
    #[must_use]
    pub const fn with_forces(self, forces: ForceRule) -> Self {
        Self { forces, ..self }
    }

    /// The scheme itself if a step is possible with it; for schemes read from a file.
    pub fn checked(self) -> Result<Self, SchemeError> {
        let parameters = [
            ("alpha_m", self.alpha_m),
            ("alpha_f", self.alpha_f),
            ("beta", self.beta),
            ("gamma", self.gamma),
        ];
        for (key, value) in parameters {
            finite(key, value)?;
        }
        if self.beta <= 0.0 {
            let hint = "with β = 0 the new position does not depend on the new acceleration: this would be an explicit scheme, and \
                        the family is implicit; the trapezoidal rule has beta = 0.25";
            return Err(SchemeError::OutOfRange {
                key: "beta",
                value: self.beta,
                range: "> 0",
                hint: hint.to_owned(),
            });
        }
        if self.gamma <= 0.0 {
            let hint = "γ is the weight of the new acceleration in the new velocity; below ½ the motion grows, and the trapezoidal rule has gamma = 0.5";
            return Err(SchemeError::OutOfRange {
                key: "gamma",
                value: self.gamma,
                range: "> 0",
                hint: hint.to_owned(),
            });
        }
        for (key, value, what) in [("alpha_m", self.alpha_m, "inertia"), ("alpha_f", self.alpha_f, "force")] {
            if value >= 1.0 {
                let hint = format!(
                    "at 1 the balance equation contains no new {what} term, and above 1 one with the wrong sign"
                );
                return Err(SchemeError::OutOfRange { key, value, range: "< 1", hint });
            }
        }
        Ok(self)
    }
}

pub(crate) fn finite(key: &'static str, value: f64) -> Result<f64, SchemeError> {
    if value.is_finite() {
        Ok(value)
    } else {
        Err(SchemeError::OutOfRange { key, value, range: "finite", hint: "give a number".to_owned() })
    }
}

pub(crate) fn in_unit_interval(rho_inf: f64) -> Result<f64, SchemeError> {
    if (0.0..=1.0).contains(&rho_inf) {
        Ok(rho_inf)
    } else {
        let hint =
            "ρ∞ = 1 preserves the highest frequencies, ρ∞ = 0 removes them within a few steps".to_owned();
        Err(SchemeError::OutOfRange { key: "rho_inf", value: rho_inf, range: "[0, 1]", hint })
    }
}
