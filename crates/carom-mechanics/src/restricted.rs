//! The part of a state that belongs to some of the bodies and contacts of a model.

use std::sync::Arc;

use carom_solid::Configuration;

use crate::ledger::book_kinetic;
use crate::model::{Model, past_of};
use crate::rejected::Rejected;
use crate::stage::renewal::FrozenTangent;
use crate::start::press;
use crate::state::{Ledger, OverDofs, State};
use crate::velocity::active_rows::measure_all;

impl State {
    /// The state of a model with fewer bodies and contacts than `whole`: `dofs` and `contacts` are
    /// their numbers in that. Its ledger starts anew. What remains of active pairs, velocities, the
    /// memory of the scheme and that of materials is unchanged.
    ///
    /// # Errors
    /// If a cell is inverted.
    pub fn restricted(
        &self,
        whole: &Model,
        model: &Model,
        dofs: &[usize],
        contacts: &[usize],
    ) -> Result<Self, Rejected> {
        let mut state = self.clone();
        state.materials = model.materials();
        let memory = model.parts.iter().flat_map(|part| {
            let k = whole.parts.iter().position(|other| other.name == part.name).unwrap_or(0);
            past_of(&whole.parts, k, self.materials.past(0.0).memory).memory
        });
        state.materials.memory = Arc::new(memory.copied().collect());
        for OverDofs { values, .. } in
            state.over_dofs().into_iter().filter(|vector| !vector.values.is_empty())
        {
            *values = dofs.iter().map(|&dof| values[dof]).collect();
        }
        for (_, resultants) in state.over_contacts() {
            *resultants = contacts.iter().map(|&k| resultants[k]).collect();
        }
        state.pairs = contacts.iter().map(|&k| self.pairs[k].clone()).collect();
        state.frozen = FrozenTangent::default();
        state.overlaps.clear();
        let mut internal = vec![0.0; model.dofs()];
        let past = state.materials.past(0.0);
        let mut reached = state.materials.clone();
        let strain = model
            .internal_force(&Configuration { before: None, y: &state.y, past }, &mut internal, &mut reached)
            .map_err(|(body, inverted)| Rejected::Inverted { body, inverted })?;
        state.materials.stored = reached.stored;
        state.materials.min_det_f = reached.min_det_f;
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
