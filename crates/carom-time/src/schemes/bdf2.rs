//! The backward differentiation formula of order 2, for positions and for velocities:
//!
//! ```text
//! v_{s+1} = (3 y_{s+1} − 4 y_s + y_{s−1}) / (2Δt) = (3 d − d_s) / (2Δt),   d_s = y_s − y_{s−1}
//! a_{s+1} = (3 v_{s+1} − 4 v_s + v_{s−1}) / (2Δt),                         M a_{s+1} + f_{s+1} = 0
//! ```
//!
//! Order 2, ρ∞ = 0 (Gear 1971). Without a previous step of the same size it falls back on backward
//! Euler. Where velocities and accelerations were projected, that step is
//!
//! ```text
//! d_s = Δt v_s − ½ Δt² a_s,   v_{s−1} = v_s − Δt a_s
//! ```
//!
//! since the accelerations after a step of backward Euler have an error of ¾ a, however short it
//! is, and friction follows them. The mean force of a step follows from M (v_{s+1} − v_s) =
//! ⅓ M (v_s − v_{s−1}) + ⅔ Δt M a_{s+1}.

use super::backward_euler::BackwardEuler;
use crate::kind::{Build, KindInfo, Member};
use crate::stage::{Kernel, Memory, Stage};

pub(super) const KIND: KindInfo = KindInfo {
    name: "bdf2",
    summary: "Two-step backward differentiation; second order, ρ∞ = 0.",
    reference: "Gear 1971",
    sets: &[&[]],
    // It starts with a step of backward Euler: ¾ g Δt² in total.
    members: &[Member::new(&[], 2, 0.0).falling(|n| 0.75 * (1.0 - 3f64.powf(-n)))],
    build: Build::Stages(|_| Ok(Box::new(Bdf2))),
};

/// The two-step rule.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Bdf2;

impl Kernel for Bdf2 {
    fn stages(&self) -> usize {
        1
    }

    fn two_step(&self) -> bool {
        true
    }

    fn notes(&self) -> &'static [&'static str] {
        &[
            "two-step method: uses backward Euler at the start, after a bisected step, and where contacts begin without a projection of velocities",
        ]
    }

    fn stage_into(&self, k: usize, dt: f64, memory: &Memory, stage: &mut Stage) {
        let Some(before) = memory.before else { return BackwardEuler.stage_into(k, dt, memory, stage) };
        let (_, v, _) = memory.states[0];
        stage.at_the_end(1.0, [1.0 / 3.0, 0.0, 2.0 / 3.0]);
        stage.velocity.slope = 1.5 / dt;
        stage.velocity.at_start.clear();
        stage.velocity.at_start.extend(before.increment.iter().map(|d| -0.5 * d / dt));
        stage.acceleration.slope = 2.25 / (dt * dt);
        let of_velocity = stage.velocity.at_start.iter().zip(v).zip(before.velocity);
        stage.acceleration.at_start.clear();
        stage
            .acceleration
            .at_start
            .extend(of_velocity.map(|((at_start, v), old)| (1.5 * at_start - 2.0 * v + 0.5 * old) / dt));
    }
}
