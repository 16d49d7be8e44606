//! A step of eq. (13)–(15) without contact, with Chung and Hulbert's parameters, and a velocity
//! jump w, M w = GᵀP (Chen, Acary, Virlez, Brüls 2013):
//!
//! ```text
//! v_{n+1} += w,   y_{n+1} += Δt w/2
//! ```
//!
//! After elimination of w and a_{n+1}, P remains in the balance and in both maps. Order 2 between
//! impacts, any ρ∞.
use crate::kind::{Build, KindInfo, Member};
use crate::nonsmooth::{Impulse, ImpulseShares};
use crate::parameter::RHO_INF;
use crate::scheme::Scheme;
use crate::stage::{Kernel, Memory, Stage};

pub(super) const KIND: KindInfo = KindInfo {
    name: "nonsmooth-generalized-alpha",
    summary: "Chung–Hulbert between impacts, impulses at impacts.",
    reference: "Chen, Acary, Virlez, Brüls 2013",
    sets: &[&[RHO_INF]],
    members: &[Member::new(&[("rho_inf", 0.1)], 2, 0.1), Member::new(&[("rho_inf", 0.8)], 2, 0.8)],
    build: Build::Impulse(|p| Ok(Box::new(NonsmoothAlpha(Scheme::chung_hulbert(p[0])?)))),
};

/// A member of the α family between impacts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NonsmoothAlpha(pub Scheme);

impl Kernel for NonsmoothAlpha {
    fn stages(&self) -> usize {
        1
    }

    fn stage_into(&self, k: usize, dt: f64, memory: &Memory, stage: &mut Stage) {
        self.0.stage_into(k, dt, memory, stage);
        (stage.weights.contact, stage.before.contact) = (0.0, 0.0);
    }
}

impl Impulse for NonsmoothAlpha {
    fn summary(&self) -> &'static str {
        "Chung and Hulbert's scheme between impacts; impulses with Newton's coefficient of restitution at impacts"
    }

    fn shares(&self, dt: f64) -> ImpulseShares {
        let Scheme { alpha_m, beta, gamma, .. } = self.0;
        // d includes Δt w/2 of the jump: its effect on the maps is subtracted.
        let acceleration = 0.5 / (beta * dt);
        ImpulseShares {
            force: (1.0 - alpha_m) * acceleration,
            velocity: 1.0 - 0.5 * gamma / beta,
            acceleration,
        }
    }

    fn predicts_by_solving(&self) -> bool {
        true
    }

    fn alpha(&self) -> Option<Scheme> {
        Some(self.0)
    }
}
