//! The α family as data: what a step of eq. (15) needs, and the published ways to choose it.
//!
//! ```text
//! (1 − α_m) M a_{s+1} + α_m M a_s + (1 − α_f) f_{s+1} + α_f f_s = 0                              (15)
//! y_{s+1} = y_s + Δt v_s + Δt² [(½ − β) a_s + β a_{s+1}]                                         (13)
//! v_{s+1} = v_s + Δt [(1 − γ) a_s + γ a_{s+1}]                                                   (14)
//! ```
//!
//! Index s + 1 − α: an α is the share of the *old* term (Chung and Hulbert 1993). [`crate::explain`] translates.
use serde::{Deserialize, Serialize};

use crate::error::SchemeError;

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

/// Constructors by published name. All average forces; see [`Scheme::with_forces`].
impl Scheme {
    /// Four raw parameters. Refused: what is not finite, β ≤ 0 (no implicit step), α_m = 1 or α_f = 1 (no new inertia or no new force).
    pub fn generalized_alpha(alpha_m: f64, alpha_f: f64, beta: f64, gamma: f64) -> Result<Self, SchemeError> {
        let scheme = Self { alpha_m, alpha_f, beta, gamma, forces: ForceRule::AverageForces };
        scheme.checked()
    }

    /// Newmark 1959. (¼, ½) is the trapezoidal rule.
    ///
    /// ```
    /// let trapezoidal = carom_time::Scheme::newmark(0.25, 0.5)?;
    /// assert_eq!((trapezoidal.alpha_m, trapezoidal.alpha_f), (0.0, 0.0));
    /// assert!(carom_time::Scheme::newmark(0.0, 0.5).is_err());
    /// # Ok::<(), carom_time::SchemeError>(())
    /// ```
    pub fn newmark(beta: f64, gamma: f64) -> Result<Self, SchemeError> {
        Self::generalized_alpha(0.0, 0.0, beta, gamma)
    }

    /// Newmark with damping, order 1: γ = (3 − ρ∞)/(2(1 + ρ∞)), β = (γ + ½)²/4.
    pub fn newmark_damped(rho_inf: f64) -> Result<Self, SchemeError> {
        let r = in_unit_interval(rho_inf)?;
        let gamma = (3.0 - r) / (2.0 * (1.0 + r));
        Self::newmark(0.25 * (gamma + 0.5) * (gamma + 0.5), gamma)
    }

    /// Hu 1997: γ = 3/2, β = 1. The damped Newmark rule at ρ∞ = 0, first order.
    pub const fn hu() -> Self {
        Self { alpha_m: 0.0, alpha_f: 0.0, beta: 1.0, gamma: 1.5, forces: ForceRule::AverageForces }
    }

    /// Hilber, Hughes and Taylor 1977 by α = α_f ≥ 0 (their α is −α_f): γ = ½ + α, β = (1 + α)²/4. Above 1/3 ρ∞ rises again:
    /// used as given, [`Scheme::remarks`] says so.
    ///
    /// ```
    /// let hht = carom_time::Scheme::hht(0.25)?;
    /// assert_eq!((hht.gamma, hht.beta), (0.75, 0.390625));
    /// let refused = carom_time::Scheme::hht(-0.05).unwrap_err().to_string();
    /// assert!(refused.contains("write alpha = 0.05"));
    /// # Ok::<(), carom_time::SchemeError>(())
    /// ```
    pub fn hht(alpha: f64) -> Result<Self, SchemeError> {
        if alpha < 0.0 && alpha.is_finite() {
            let hint = format!(
                "write alpha = {}: here alpha is the share of the old forces, the opposite of the α of the 1977 paper",
                -alpha
            );
            return Err(SchemeError::OutOfRange { key: "alpha", value: alpha, range: "[0, 1)", hint });
        }
        if alpha >= 1.0 {
            let hint = "the usual range is 0 to 1/3".to_owned();
            return Err(SchemeError::OutOfRange { key: "alpha", value: alpha, range: "[0, 1)", hint });
        }
        finite("alpha", alpha)?;
        Self::generalized_alpha(0.0, alpha, 0.25 * (1.0 + alpha) * (1.0 + alpha), 0.5 + alpha)
    }

    /// Wood, Bossak and Zienkiewicz 1980: α_m = (ρ∞ − 1)/(ρ∞ + 1) ≤ 0, γ = ½ − α_m, β = (1 − α_m)²/4.
    pub fn wbz(rho_inf: f64) -> Result<Self, SchemeError> {
        let r = in_unit_interval(rho_inf)?;
        let alpha_m = (r - 1.0) / (r + 1.0);
        Self::generalized_alpha(alpha_m, 0.0, 0.25 * (1.0 - alpha_m) * (1.0 - alpha_m), 0.5 - alpha_m)
    }

    /// Chung and Hulbert 1993, eq. (16), (17): α_m = (2ρ∞ − 1)/(ρ∞ + 1), α_f = ρ∞/(ρ∞ + 1), γ = ½ − α_m + α_f, β = (1 − α_m + α_f)²/4.
    ///
    /// ```
    /// let scheme = carom_time::Scheme::chung_hulbert(0.6)?;
    /// assert!((scheme.alpha_m - 0.125).abs() < 1e-15 && (scheme.beta - 0.390625).abs() < 1e-15);
    /// assert!(carom_time::Scheme::chung_hulbert(1.2).is_err());
    /// # Ok::<(), carom_time::SchemeError>(())
    /// ```
    pub fn chung_hulbert(rho_inf: f64) -> Result<Self, SchemeError> {
        let r = in_unit_interval(rho_inf)?;
        // α_f − α_m = (1 − ρ∞)/(1 + ρ∞), formed without cancellation.
        let (alpha_m, alpha_f, shift) = ((2.0 * r - 1.0) / (r + 1.0), r / (r + 1.0), (1.0 - r) / (1.0 + r));
        Self::generalized_alpha(alpha_m, alpha_f, 0.25 * (1.0 + shift) * (1.0 + shift), 0.5 + shift)
    }

    /// The same scheme with another rule for what α_f averages.
    #[must_use]
    pub const fn with_forces(self, forces: ForceRule) -> Self {
        Self { forces, ..self }
    }

    /// The scheme itself if a step can be taken with it; for one read from a file.
    pub fn checked(self) -> Result<Self, SchemeError> {
        let parameters =
            [("alpha_m", self.alpha_m), ("alpha_f", self.alpha_f), ("beta", self.beta), ("gamma", self.gamma)];
        for (key, value) in parameters {
            finite(key, value)?;
        }
        if self.beta <= 0.0 {
            let hint = "with β = 0 the new position does not depend on the new acceleration: an explicit scheme, which this \
                        implicit family cannot solve for; the trapezoidal rule has beta = 0.25";
            return Err(SchemeError::OutOfRange { key: "beta", value: self.beta, range: "> 0", hint: hint.to_owned() });
        }
        for (key, value, what) in [("alpha_m", self.alpha_m, "inertia"), ("alpha_f", self.alpha_f, "force")] {
            if value == 1.0 {
                let hint =
                    format!("at 1 the balance holds no new {what} term and cannot be solved for the new positions");
                return Err(SchemeError::OutOfRange { key, value, range: "finite, not 1", hint });
            }
        }
        Ok(self)
    }
}

fn finite(key: &'static str, value: f64) -> Result<f64, SchemeError> {
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
        let hint = "ρ∞ = 1 keeps the highest frequencies, ρ∞ = 0 removes them in a step".to_owned();
        Err(SchemeError::OutOfRange { key: "rho_inf", value: rho_inf, range: "[0, 1]", hint })
    }
}
