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
    summary: "Explicit, lumped mass; contact with the coefficient of restitution of [[contact]].",
    reference: "Paoli, Schatzman 2002",
    sets: &[&[]],
    members: &[Member::new(&[], 2, f64::INFINITY)],
    build: Build::Explicit(Explicit {
        summary: "explicit, with a lumped mass; contact constrains the position (y_{n+1} + e y_{n−1})/(1 + e), where e is the restitution of the contact",
        order: 2,
        restitution: true,
        contact: &[
            "with e = 0 the scheme is identical to central-difference; with e > 0 a penetration of up to Δt·speed remains",
            "with e = 1 on a mesh, the energy alternates from step to step during contact, and high modes are excited",
            LUMPED,
        ],
    }),
};
