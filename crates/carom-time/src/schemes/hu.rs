//! Hu 1997: γ = 3/2, β = 1 without averages: ρ∞ = 0, first order, strongly dissipative. The damped
//! Newmark rule at ρ∞ = 0.
use crate::kind::{Build, KindInfo, Member};
use crate::scheme::{ForceRule, Scheme};

pub(super) const KIND: KindInfo = KindInfo {
    name: "hu",
    summary: "Hu: β = 1, γ = 3/2, first order.",
    reference: "Hu 1997",
    sets: &[&[]],
    members: &[Member::new(&[], 1, 0.0)],
    build: Build::Alpha(|_, _| Ok(Scheme::hu())),
};

impl Scheme {
    /// Hu 1997: γ = 3/2, β = 1.
    pub const fn hu() -> Self {
        Self { alpha_m: 0.0, alpha_f: 0.0, beta: 1.0, gamma: 1.5, forces: ForceRule::AverageForces }
    }
}
