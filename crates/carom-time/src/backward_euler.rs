//! Backward Euler: M a_{s+1} + f_{s+1} = 0 with
//!
//! ```text
//! v_{s+1} = d / Δt,   a_{s+1} = (v_{s+1} − v_s) / Δt,   d = y_{s+1} − y_s
//! ```
//!
//! Order 1, ρ∞ = 0 (any text on ordinary differential equations; Hairer, Wanner, Solving ODEs II, §IV.3).
use crate::stage::{Kernel, Memory, Stage, Weights};

/// The backward Euler rule.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct BackwardEuler;

/// All forces at the end of the stage.
pub(crate) const AT_THE_END: Weights = Weights { mass: 1.0, internal: 1.0, external: 1.0, contact: 1.0 };

impl Kernel for BackwardEuler {
    fn stages(&self) -> usize {
        1
    }

    fn has_predictor(&self) -> bool {
        true
    }

    fn stage_into(&self, _k: usize, dt: f64, memory: &Memory, stage: &mut Stage) {
        let (_, v, _) = memory.states[0];
        at_the_end(stage, 1.0, [0.0, 0.0, 1.0]);
        stage.velocity.slope = 1.0 / dt;
        stage.velocity.at_start.clear();
        stage.velocity.at_start.resize(v.len(), 0.0);
        stage.acceleration.slope = 1.0 / (dt * dt);
        stage.acceleration.at_start.clear();
        stage.acceleration.at_start.extend(v.iter().map(|v| -v / dt));
    }
}

/// Everything but the maps of a stage whose balance holds at its end.
pub(crate) fn at_the_end(stage: &mut Stage, end: f64, mean: [f64; 3]) {
    stage.end = end;
    stage.mean = mean;
    (stage.weights, stage.before, stage.average) = (AT_THE_END, Weights::default(), 0.0);
    stage.internal = crate::stage::Internal::Gradient;
}
