//! TR-BDF2 (Bank and others 1985): the trapezoidal rule to (2 − √2)Δt, then backward
//! differentiation to Δt. It is the composite rule of [`super::bathe`] at ρ∞ = 0.
use super::bathe::Bathe;
use crate::kind::{Build, KindInfo, Member};

pub(super) const KIND: KindInfo = KindInfo {
    name: "tr-bdf2",
    summary: "Trapezoidal rule, then backward differentiation; second order, ρ∞ = 0.",
    reference: "Bank et al. 1985",
    sets: &[&[]],
    members: &[Member::new(&[], 2, 0.0)],
    build: Build::Stages(|_| Ok(Box::new(Bathe::new(0.0)?))),
};
