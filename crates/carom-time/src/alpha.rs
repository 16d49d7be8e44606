//! A step of the α family as one stage with the unknown y_{s+1}: eq. (13), (14) solved for a and v, and the weights of eq. (15).
//!
//! ```text
//! a = (y − p)/(βΔt²),      p = y_s + Δt v_s + (½ − β)Δt² a_s
//! v = v_s + Δt (1 − γ) a_s + γΔt a
//! ```
use crate::scheme::{ForceRule, Scheme};
use crate::stage::{Kernel, Memory, Stage, Weights};

/// One implicit solve per step. The acceleration carried from step to step is the algorithmic one: deriving it anew from the balance costs an order.
impl Kernel for Scheme {
    fn stages(&self) -> usize {
        1
    }

    fn stage_into(&self, _k: usize, dt: f64, memory: &Memory, stage: &mut Stage) {
        let (y, v, a) = memory.states[0];
        let slope = 1.0 / (self.beta * dt * dt);
        stage.end = 1.0;
        stage.acceleration.slope = slope;
        stage.velocity.slope = self.gamma / (self.beta * dt);

        // Every product below is formed once and differences are scaled last: what is lost is the last digit of y, not of y/Δt².
        let of_a = (0.5 - self.beta) * dt * dt;
        let predicted = |i: usize| y[i] + (dt * v[i] + of_a * a[i]);
        stage.acceleration.offset.clear();
        stage.acceleration.offset.extend((0..y.len()).map(|i| -slope * predicted(i)));
        let of_old = dt * (1.0 - self.gamma);
        let of_new = dt * self.gamma;
        stage.velocity.offset.clear();
        let offsets = &stage.acceleration.offset;
        stage.velocity.offset.extend((0..y.len()).map(|i| of_new * offsets[i] + (v[i] + of_old * a[i])));

        let (new, old) = (1.0 - self.alpha_f, self.alpha_f);
        let (mass, old_mass) = (1.0 - self.alpha_m, self.alpha_m);
        // Contact is averaged as forces in both rules: its constraint holds at the step's end.
        (stage.weights, stage.before, stage.average) = match self.forces {
            ForceRule::AverageForces => (
                Weights { mass, internal: new, external: new, contact: new },
                Weights { mass: old_mass, internal: old, external: old, contact: old },
                0.0,
            ),
            ForceRule::AverageState => (
                Weights { mass, internal: 1.0, external: 1.0, contact: new },
                Weights { mass: old_mass, internal: 0.0, external: 0.0, contact: old },
                old,
            ),
        };
    }
}
