//! The part of a state that belongs to some of the bodies and contacts of a model.

use carom_solid::Configuration;

use crate::ledger::book_kinetic;
use crate::materials::Materials;
use crate::model::Model;
use crate::rejected::Rejected;
use crate::stage::renewal::FrozenTangent;
use crate::start::press;
use crate::state::{Ledger, Previous, State};
use crate::velocity::active_rows::measure_all;

impl State {
    /// The state of a model with fewer bodies and contacts: `dofs` and `contacts` are their numbers
    /// in the larger model. Its ledger starts anew. What remains of active pairs, velocities and
    /// the memory of the scheme is unchanged.
    ///
    /// # Errors
    /// If a cell is inverted.
    pub fn restricted(&self, model: &Model, dofs: &[usize], contacts: &[usize]) -> Result<Self, Rejected> {
        let of = |all: &[f64]| -> Vec<f64> {
            if all.is_empty() { Vec::new() } else { dofs.iter().map(|&dof| all[dof]).collect() }
        };
        let each = |all: &[[f64; 3]]| contacts.iter().map(|&k| all[k]).collect::<Vec<_>>();
        if model.remembers() {
            return Err(Rejected::Remembers);
        }
        let mut state = self.clone();
        for vector in [&mut state.y, &mut state.v, &mut state.a] {
            *vector = of(vector);
        }
        for vector in
            [&mut state.f_internal, &mut state.f_external, &mut state.f_contact, &mut state.f_friction]
        {
            *vector = of(vector);
        }
        state.half_step.velocity = of(&self.half_step.velocity);
        for list in [&mut state.contact_forces, &mut state.impulses, &mut state.carried.forces] {
            *list = each(list);
        }
        state.pairs = contacts.iter().map(|&k| self.pairs[k].clone()).collect();
        if let Some(Previous { increment, velocity, means, .. }) = &mut state.previous {
            for vector in [increment, velocity, &mut means.contact, &mut means.loads] {
                *vector = of(vector);
            }
            for vector in [&mut means.friction, &mut means.supports, &mut means.accelerations] {
                *vector = of(vector);
            }
            means.contact_forces = each(&means.contact_forces);
        }
        state.frozen = FrozenTangent::default();
        state.overlaps.clear();
        let mut internal = vec![0.0; model.dofs()];
        let strain = model
            .internal_force(&Configuration::at(&state.y), &mut internal, &mut Materials::default())
            .map_err(|(body, inverted)| Rejected::Inverted { body, inverted })?;
        let springs = springs(model, &state)?;
        state.ledger = Ledger {
            strain: strain + springs,
            springs,
            potential: model.potential(&state.y),
            ..Ledger::default()
        };
        book_kinetic(model, &mut state);
        state.ledger.begin();
        Ok(state)
    }
}

/// Energy of the springs of a model at a state.
fn springs(model: &Model, state: &State) -> Result<f64, Rejected> {
    // Measuring moves contact points, and pressing forgets gaps.
    let mut at = state.clone();
    let gaps = measure_all(model, &mut at)?;
    Ok(press(model, &mut at, &gaps))
}
