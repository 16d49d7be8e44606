//! Equilibrium without inertia, f_int + f_cont − f_ext = 0 at the end of every step: t is the load
//! parameter.

use crate::kind::{Build, KindInfo};
use crate::stage::{Kernel, Memory, Stage};

/// Its name in a case file.
pub const STATIC: &str = "static";

pub(super) const KIND: KindInfo = KindInfo {
    name: STATIC,
    summary: "Static equilibrium at every step, without inertia; t is the load parameter.",
    reference: "",
    sets: &[&[]],
    // Nothing is integrated, so there is nothing to claim.
    members: &[],
    build: Build::Stages(|_| Ok(Box::new(Static))),
};

/// Load steps: a kernel without inertia. Velocities and accelerations are zero.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Static;

impl Kernel for Static {
    fn stages(&self) -> usize {
        1
    }

    fn is_static(&self) -> bool {
        true
    }

    fn stage_into(&self, _k: usize, _dt: f64, memory: &Memory, stage: &mut Stage) {
        let dofs = memory.states[0].0.len();
        stage.at_the_end(1.0, [0.0, 0.0, 1.0]);
        stage.weights.mass = 0.0;
        stage.works_at_both_ends = true;
        for map in [&mut stage.velocity, &mut stage.acceleration] {
            map.slope = 0.0;
            map.at_start.clear();
            map.at_start.resize(dofs, 0.0);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_end_of_a_load_step_is_an_equilibrium_at_rest() {
        let memory = Memory { states: &[(&[1.0, 2.0], &[3.0, 4.0], &[5.0, 6.0])], before: None };
        let mut stage = Stage::default();
        Static.stage_into(0, 0.1, &memory, &mut stage);
        let mut v = [9.0; 2];
        stage.velocity.value_into(&[1.0, 1.0], &mut v);
        assert_eq!((v, stage.before, stage.is_static()), ([0.0; 2], crate::Weights::default(), true));
    }
}
