//! The part of a state that belongs to some of the bodies and contacts of a model.

use carom_solid::Configuration;

use crate::ledger::book_kinetic;
use crate::materials::Materials;
use crate::model::Model;
use crate::rejected::Rejected;
use crate::stage::renewal::FrozenTangent;
use crate::start::press;
use crate::state::{Ledger, OverDofs, State};
use crate::velocity::active_rows::measure_all;

impl State {
    /// The state of a model with fewer bodies and contacts: `dofs` and `contacts` are their numbers
    /// in the larger model. Its ledger starts anew. What remains of active pairs, velocities and
    /// the memory of the scheme is unchanged.
    ///
    /// # Errors
    /// If a cell is inverted.
    pub fn restricted(&self, model: &Model, dofs: &[usize], contacts: &[usize]) -> Result<Self, Rejected> {
        if model.remembers() {
            return Err(Rejected::Remembers);
        }
        let mut state = self.clone();
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
