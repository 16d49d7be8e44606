//! Wood, Bossak and Zienkiewicz 1980: averaged inertia forces. Order 2, any ρ∞:
//!
//! ```text
//! α_m = (ρ∞ − 1)/(ρ∞ + 1) ≤ 0,   γ = ½ − α_m,   β = (1 − α_m)²/4
//! ```
use crate::error::SchemeError;
use crate::kind::{Build, KindInfo, Member};
use crate::parameter::RHO_INF;
use crate::scheme::{Scheme, in_unit_interval};

pub(super) const KIND: KindInfo = KindInfo {
    name: "wbz",
    summary: "Wood–Bossak–Zienkiewicz.",
    reference: "Wood, Bossak, Zienkiewicz 1980",
    sets: &[&[RHO_INF]],
    members: &[Member::new(&[("rho_inf", 0.6)], 2, 0.6), Member::new(&[("rho_inf", 0.1)], 2, 0.1)],
    build: Build::Alpha(|_, p| Scheme::wbz(p[0])),
};

impl Scheme {
    /// Wood, Bossak and Zienkiewicz 1980: α_m = (ρ∞ − 1)/(ρ∞ + 1) ≤ 0, γ = ½ − α_m, β = (1 −
    /// α_m)²/4.
    pub fn wbz(rho_inf: f64) -> Result<Self, SchemeError> {
        let r = in_unit_interval(rho_inf)?;
        let alpha_m = (r - 1.0) / (r + 1.0);
        Self::generalized_alpha(alpha_m, 0.0, 0.25 * (1.0 - alpha_m) * (1.0 - alpha_m), 0.5 - alpha_m)
    }
}
