//! The θ-method with impulses (Moreau 1999, Jean 1999):
//!
//! ```text
//! M(v_{n+1} − v_n) = Δt f(y_n + θd) + GᵀP,   d = Δt(θ v_{n+1} + (1 − θ) v_n)
//! ```
//!
//! Order 2 for θ = ½, 1 above; ρ∞ = (1 − θ)/θ; on linear motion z = (1 + i(1 − θ)Ω)/(1 − iθΩ).
use std::ops::Bound::Included;

use crate::error::SchemeError;
use crate::kind::{Build, KindInfo, Member};
use crate::nonsmooth::{Impulse, ImpulseShares};
use crate::parameter::Parameter;
use crate::stage::{Kernel, Memory, Stage};

pub(super) const KIND: KindInfo = KindInfo {
    name: "moreau-jean",
    summary: "The θ-method with impulses: contact constrains velocities.",
    reference: "Moreau 1999; Jean 1999",
    sets: &[&[Parameter {
        key: "theta",
        range: (Included(0.5), Included(1.0)),
        meaning: "Weight of the new velocity and force: ½ gives second order, 1 the strongest damping.",
        example: "0.5",
    }]],
    // Free fall exceeds the exact one by (θ − ½) g Δt² per step.
    members: &[
        Member::new(&[("theta", 0.5)], 2, 1.0),
        Member::new(&[("theta", 0.625)], 1, 0.6).falling(|n| 0.125 * n).hidden(),
        Member::new(&[("theta", 1.0)], 1, 0.0).falling(|n| 0.5 * n),
    ],
    build: Build::Impulse(|p| Ok(Box::new(MoreauJean::new(p[0])?))),
};

/// The θ-method for a given θ.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MoreauJean {
    /// Weight of the new velocity and force.
    pub theta: f64,
}

impl MoreauJean {
    /// From θ, in [½, 1].
    ///
    /// # Errors
    /// For other values.
    pub fn new(theta: f64) -> Result<Self, SchemeError> {
        if (0.5..=1.0).contains(&theta) {
            return Ok(Self { theta });
        }
        let hint = "below ½ every mode grows; ½ gives second order, 1 the strongest damping".to_owned();
        Err(SchemeError::OutOfRange { key: "theta", value: theta, range: "[0.5, 1]", hint })
    }
}

impl Kernel for MoreauJean {
    fn stages(&self) -> usize {
        1
    }

    fn stage_into(&self, _k: usize, dt: f64, memory: &Memory, stage: &mut Stage) {
        let (_, v, _) = memory.states[0];
        let new = 1.0 / (self.theta * dt);
        stage.at_the_end(1.0, [0.0, 0.0, 1.0]);
        (stage.weights.contact, stage.average) = (0.0, 1.0 - self.theta);
        (stage.velocity.slope, stage.acceleration.slope) = (new, new / dt);
        stage.velocity.at_start.clear();
        stage.velocity.at_start.extend(v.iter().map(|v| (1.0 - 1.0 / self.theta) * v));
        stage.acceleration.at_start.clear();
        stage.acceleration.at_start.extend(v.iter().map(|v| -new * v));
    }
}

impl Impulse for MoreauJean {
    fn summary(&self) -> &'static str {
        "the θ-method with impulses: contact constrains velocities, with Newton's coefficient of restitution"
    }

    fn shares(&self, dt: f64) -> ImpulseShares {
        ImpulseShares { force: 1.0 / dt, ..ImpulseShares::default() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A free mass stopped by P: d = Δt(v + θ P/m), by d = Δt(θ v_{n+1} + (1 − θ) v_n) and v_{n+1}
    /// = v_n + P/m.
    #[test]
    fn a_jump_moves_the_position_by_its_share() {
        let (dt, mass, v, p) = (0.1, 2.0, -3.0, 6.0);
        for theta in [0.5, 0.6, 1.0] {
            let (scheme, mut stage) = (MoreauJean { theta }, Stage::default());
            scheme.stage_into(0, dt, &Memory { states: &[(&[0.0], &[v], &[0.0])], before: None }, &mut stage);
            let a = &stage.acceleration;
            let d = (scheme.shares(dt).force * p / mass - a.at_start[0]) / a.slope;
            assert!((d - dt * (v + theta * p / mass)).abs() < 1e-14, "θ = {theta}: {d}");
        }
    }
}
