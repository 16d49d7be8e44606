//! Chung and Hulbert 1993: inertia and other forces averaged, with the least low-frequency damping
//! for its ρ∞. Order 2:
//!
//! ```text
//! α_m = (2ρ∞ − 1)/(ρ∞ + 1),   α_f = ρ∞/(ρ∞ + 1),                                                 (16)
//! γ = ½ − α_m + α_f,          β = (1 − α_m + α_f)²/4                                             (17)
//! ```
use crate::error::SchemeError;
use crate::kind::{Build, KindInfo, Member};
use crate::parameter::RHO_INF;
use crate::scheme::{Scheme, in_unit_interval};

pub(super) const KIND: KindInfo = KindInfo {
    name: "chung-hulbert",
    summary: "Chung–Hulbert generalised α.",
    reference: "Chung, Hulbert 1993",
    sets: &[&[RHO_INF]],
    members: &[
        Member::new(&[("rho_inf", 0.8)], 2, 0.8),
        Member::new(&[("rho_inf", 0.6)], 2, 0.6),
        Member::new(&[("rho_inf", 0.1)], 2, 0.1),
        Member::new(&[("rho_inf", 0.0)], 2, 0.0),
        Member::new(&[("rho_inf", 1.0)], 2, 1.0).hidden(),
    ],
    build: Build::Alpha(|_, p| Scheme::chung_hulbert(p[0])),
};

impl Scheme {
    /// Chung and Hulbert 1993, eq. (16), (17): α_m = (2ρ∞ − 1)/(ρ∞ + 1), α_f = ρ∞/(ρ∞ + 1), γ = ½ −
    /// α_m + α_f, β = (1 − α_m + α_f)²/4.
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
}
