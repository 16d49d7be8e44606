//! The midpoint rule with a discrete gradient for the internal forces (Simo and Tarnow 1992,
//! Gonzalez 2000):
//!
//! ```text
//! M (v_{s+1} − v_s)/Δt + f(y_s, y_{s+1}) = f_ext,      y_{s+1} − y_s = Δt (v_s + v_{s+1})/2,      f·(y_{s+1} − y_s) = U_{s+1} − U_s
//! ```
//!
//! Energy, linear and angular momentum of free motion are conserved exactly for any hyperelastic
//! law and rotation. Order 2, ρ∞ = 1. The carried acceleration is the mean of the step, (v_{s+1} −
//! v_s)/Δt. The direction of a contact force is up to its law.
use crate::kind::{Build, KindInfo, Member};
use crate::stage::{Internal, Kernel, Memory, Stage};

pub(super) const KIND: KindInfo = KindInfo {
    name: "energy-momentum",
    summary: "Midpoint rule with a discrete gradient; conserves energy and momenta.",
    reference: "Simo, Tarnow 1992; Gonzalez 2000",
    sets: &[&[]],
    members: &[Member::new(&[], 2, 1.0)],
    build: Build::Stages(|_| Ok(Box::new(EnergyMomentum))),
};

/// The energy–momentum method.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct EnergyMomentum;

impl Kernel for EnergyMomentum {
    fn stages(&self) -> usize {
        1
    }

    fn has_predictor(&self) -> bool {
        true
    }

    fn notes(&self) -> &'static [&'static str] {
        &[
            "in free motion energy, momentum and angular momentum are conserved exactly, also with nonlinear forces",
            "in contact momentum and angular momentum are conserved exactly, except with law = \"predictor\"",
            "energy is conserved exactly in contact with enforcement = \"penalty\", and with multipliers as long as no contact begins or ends",
        ]
    }

    fn stage_into(&self, _k: usize, dt: f64, memory: &Memory, stage: &mut Stage) {
        let (_, v, _) = memory.states[0];
        stage.at_the_end(1.0, [0.0, 0.0, 1.0]);
        (stage.average, stage.internal) = (0.5, Internal::DiscreteGradient);
        stage.velocity.slope = 2.0 / dt;
        stage.velocity.at_start.clear();
        stage.velocity.at_start.extend(v.iter().map(|v| -v));
        stage.acceleration.slope = 2.0 / (dt * dt);
        stage.acceleration.at_start.clear();
        stage.acceleration.at_start.extend(v.iter().map(|v| -2.0 * v / dt));
    }
}
