//! Newmark 1959: eq. (15) with α_m = α_f = 0. Order 2 for γ = ½; damping costs an order:
//!
//! ```text
//! γ = (3 − ρ∞)/(2(1 + ρ∞)),   β = (γ + ½)²/4
//! ```
use crate::error::SchemeError;
use crate::kind::{Build, KindInfo, Member};
use crate::parameter::{BETA, GAMMA, Parameter, RHO_INF};
use crate::scheme::{Scheme, in_unit_interval};

pub(super) const KIND: KindInfo = KindInfo {
    name: "newmark",
    summary: "Newmark's scheme, given by beta and gamma or by rho_inf.",
    reference: "Newmark 1959",
    sets: &[
        &[BETA, GAMMA],
        &[Parameter {
            meaning: "Spectral radius at infinite frequency, instead of beta and gamma.",
            example: "1.0",
            ..RHO_INF
        }],
    ],
    members: &[
        Member::new(&[("beta", 0.25), ("gamma", 0.5)], 2, 1.0),
        Member::new(&[("rho_inf", 0.9)], 1, 0.9),
        Member::new(&[("rho_inf", 0.6)], 1, 0.6),
        Member::new(&[("rho_inf", 0.0)], 1, 0.0).hidden(),
    ],
    build: Build::Alpha(
        |set, p| if set == 0 { Scheme::newmark(p[0], p[1]) } else { Scheme::newmark_damped(p[0]) },
    ),
};

impl Scheme {
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
}
