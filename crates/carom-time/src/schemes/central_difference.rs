//! Central differences with a lumped mass; the contact force of a step prevents penetration at its
//! end (Carpenter, Taylor, Katona 1991):
//!
//! ```text
//! M(y_{n+1} − 2y_n + y_{n−1}) = Δt² (f_n + Gᵀλ_n),   g(y_{n+1}) ≥ 0
//! ```
//!
//! Order 2 and stable up to Ω = ωΔt = 2.
use crate::explicit::Explicit;
use crate::kind::{Build, KindInfo, Member};

pub(super) const KIND: KindInfo = KindInfo {
    name: "central-difference",
    summary: "Explicit central differences, lumped mass; contact by forward increments.",
    reference: "Carpenter, Taylor, Katona 1991",
    sets: &[&[]],
    members: &[Member::new(&[], 2, f64::INFINITY)],
    build: Build::Explicit(Explicit {
        summary: "explicit, with a lumped mass; the contact force at the start of a step prevents penetration at its end",
        order: 2,
        restitution: false,
        contact: &[
            "the force at the start of a step prevents penetration at its end (forward increment), except in a step in which a node moves to another facet",
            LUMPED,
        ],
    }),
};

pub(super) const LUMPED: &str =
    "requires mass = \"lumped\" on every body; the stable step is computed, and a longer one is rejected";
