//! Paoli and Schatzman 2002: central differences whose contact force prevents penetration at a mean
//! of positions,
//!
//! ```text
//! M(y_{n+1} − 2y_n + y_{n−1}) = Δt² (f_n + Gᵀλ_n),   g((y_{n+1} + e y_{n−1})/(1 + e)) ≥ 0
//! ```
//!
//! Order 2 and stable up to Ω = 2 between impacts, as [`super::central_difference`], to which it
//! reduces for e = 0.
use super::central_difference::LUMPED;
use crate::explicit::Explicit;
use crate::kind::{Build, KindInfo, Member};

pub(super) const KIND: KindInfo = KindInfo {
    name: "paoli-schatzman",
    summary: "Explicit, lumped mass; contact with the restitution of [[contact]].",
    reference: "Paoli, Schatzman 2002",
    sets: &[&[]],
    members: &[Member::new(&[], 2, f64::INFINITY)],
    build: Build::Explicit(Explicit {
        summary: "explicit, with a lumped mass; what contact keeps out is (y_{n+1} + e y_{n−1})/(1 + e), e the contact's restitution",
        order: 2,
        restitution: true,
        contact: &[
            "restitution e of the contact, 0: the same as central-difference; positions penetrate by Δt·speed where e > 0",
            "with e = 1 and finite elements energy alternates from step to step during contact and high modes are excited",
            LUMPED,
        ],
    }),
};
