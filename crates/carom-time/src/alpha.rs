//! A step of the α family as one stage with the unknown d = y_{s+1} − y_s: eq. (13), (14) solved
//! for a and v, and the weights of eq. (15).
//!
//! ```text
//! a = [d − Δt v_s − (½ − β)Δt² a_s] / (βΔt²)
//! v = v_s + Δt [(1 − γ) a_s + γ a]
//! ```
use crate::scheme::{ForceRule, Scheme};
use crate::stage::{Internal, Kernel, Memory, Stage, Weights};

/// One implicit solve per step. The algorithmic acceleration is carried from step to step:
/// recomputing it from the balance costs an order.
impl Kernel for Scheme {
    fn stages(&self) -> usize {
        1
    }

    fn has_predictor(&self) -> bool {
        true
    }

    fn carried(&self) -> f64 {
        1.0 - self.gamma - self.alpha_m
    }

    fn stage_into(&self, _k: usize, dt: f64, memory: &Memory, stage: &mut Stage) {
        let (_, v, a) = memory.states[0];
        stage.end = 1.0;
        stage.acceleration.slope = 1.0 / (self.beta * dt * dt);
        stage.velocity.slope = self.gamma / (self.beta * dt);

        let (a_of_v, a_of_a) = (-1.0 / (self.beta * dt), 1.0 - 0.5 / self.beta);
        let (v_of_v, v_of_a) = (1.0 - self.gamma / self.beta, dt * (1.0 - 0.5 * self.gamma / self.beta));
        let combined = |of_v: f64, of_a: f64| v.iter().zip(a).map(move |(v, a)| of_v * v + of_a * a);
        stage.acceleration.at_start.clear();
        stage.acceleration.at_start.extend(combined(a_of_v, a_of_a));
        stage.velocity.at_start.clear();
        stage.velocity.at_start.extend(combined(v_of_v, v_of_a));

        let (mass, old_mass) = (1.0 - self.alpha_m, self.alpha_m);
        let (new, old) = (1.0 - self.alpha_f, self.alpha_f);
        // Contact forces are averaged under both rules: the constraint holds at the step's end.
        stage.mean = [0.0, old, new];
        stage.works_at_both_ends = true;
        stage.internal = Internal::Gradient;
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
