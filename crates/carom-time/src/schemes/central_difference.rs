//! Central differences with a lumped mass; the contact force of a step keeps the positions at its end out of contact (Carpenter, Taylor, Katona 1991):
//!
//! ```text
//! M(y_{n+1} − 2y_n + y_{n−1}) = Δt² (f_n + Gᵀλ_n),   g(y_{n+1}) ≥ 0
//! ```
//!
//! Order 2; on linear motion z² + (Ω² − 2)z + 1 = 0 with Ω = ωΔt: |z| = 1 and sin(arg z/2) = Ω/2 up to Ω = 2.
use crate::kind::{Build, KindInfo, Member};
use crate::nonsmooth::Explicit;

pub(super) const KIND: KindInfo = KindInfo {
    name: "central-difference",
    summary: "Explicit central differences, lumped mass; contact by forward increments.",
    reference: "Carpenter, Taylor, Katona 1991",
    sets: &[&[]],
    members: &[Member::new(&[], 2, f64::INFINITY)],
    build: Build::Explicit(Explicit {
        summary: "explicit, with a lumped mass; the contact force of a step keeps the positions at its end out of contact",
        order: 2,
        restitution: false,
        contact: &[
            "the force at a step's start keeps the positions at its end out (forward increment): no penetration but for hand-overs of facets",
            LUMPED,
        ],
    }),
};

pub(super) const LUMPED: &str =
    "needs mass = \"lumped\" on every body; the stable step is computed, a longer one refused";

/// Largest Ω at which no mode grows.
pub(crate) const STABLE: f64 = 2.0;

/// Modulus and angle of the oscillating pair at Ω.
pub(crate) fn oscillation(omega_dt: f64) -> Option<(f64, f64)> {
    (omega_dt < STABLE).then(|| (1.0, 2.0 * (0.5 * omega_dt).asin()))
}

/// The larger root.
pub(crate) fn spectral_radius(omega_dt: f64) -> f64 {
    let half = (0.5 * omega_dt * omega_dt - 1.0).max(1.0);
    half + (half * half - 1.0).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// z = −(7 + 3√5)/2 at Ω = 3.
    #[test]
    fn modes_grow_beyond_the_stable_step() {
        assert!((spectral_radius(3.0) - 0.5 * (7.0 + 45f64.sqrt())).abs() < 1e-12);
        assert_eq!((spectral_radius(1.9), oscillation(2.1)), (1.0, None));
    }
}
