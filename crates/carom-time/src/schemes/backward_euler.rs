//! Backward Euler: M a_{s+1} + f_{s+1} = 0 with
//!
//! ```text
//! v_{s+1} = d / Δt,   a_{s+1} = (v_{s+1} − v_s) / Δt,   d = y_{s+1} − y_s
//! ```
//!
//! Order 1, ρ∞ = 0 (any text on ordinary differential equations; Hairer, Wanner, Solving ODEs II,
//! §IV.3).
use crate::kind::{Build, KindInfo, Member};
use crate::stage::{Kernel, Memory, Stage};

pub(super) const KIND: KindInfo = KindInfo {
    name: "backward-euler",
    summary: "All forces at the end of the step; first order, ρ∞ = 0.",
    reference: "Hairer, Wanner 1996",
    sets: &[&[]],
    // Free fall exceeds the exact one by g Δt²/2 per step.
    members: &[Member::new(&[], 1, 0.0).falling(|n| 0.5 * n)],
    build: Build::Stages(|_| Ok(Box::new(BackwardEuler))),
};

/// The backward Euler rule.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct BackwardEuler;

impl Kernel for BackwardEuler {
    fn stages(&self) -> usize {
        1
    }

    fn has_predictor(&self) -> bool {
        true
    }

    fn stage_into(&self, _k: usize, dt: f64, memory: &Memory, stage: &mut Stage) {
        let (_, v, _) = memory.states[0];
        stage.at_the_end(1.0, [0.0, 0.0, 1.0]);
        stage.velocity.slope = 1.0 / dt;
        stage.velocity.at_start.clear();
        stage.velocity.at_start.resize(v.len(), 0.0);
        stage.acceleration.slope = 1.0 / (dt * dt);
        stage.acceleration.at_start.clear();
        stage.acceleration.at_start.extend(v.iter().map(|v| -v / dt));
    }
}
