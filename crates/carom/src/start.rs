//! The state before the first step, in the reference positions or where another run ended:
//!
//! ```text
//! M a₀ + Gᵀλ₀ = f_ext − f_int,   G a₀ = −v₀·∇²g·v₀        at t = 0
//! ```
//!
//! Contacts that were closed at the end of the other run stay closed; in the reference positions none is (λ₀ = 0). A moved support has its own v₀, a₀
//! and must begin where the bodies are. Without inertia v₀ and a₀ are zero, and the first load step finds the equilibrium.

use carom_contact::Linearised;

use crate::initial::Before;
use crate::ledger::{book_contact_forces, book_kinetic};
use crate::model::Model;
use crate::penalty::{self, Configuration};
use crate::persistency::{drive, linearise_all, take_accelerations};
use crate::rejected::Rejected;
use crate::rows::independent_rows;
use crate::state::State;
use crate::stepper::averaged_contact_into;
use crate::system::Row;
use crate::workspace::Workspace;

/// A moved support may be this far, relative to L, from where its formula has it at t = 0.
const NEAR: f64 = 1e-9;

/// The state before the first step, with inertia or without.
///
/// # Errors
/// A cell is inverted, a load or a motion has no value at t = 0, a moved support would jump, or the mass matrix is singular.
pub(crate) fn start<const D: usize>(
    model: &Model<D>,
    inertia: bool,
    before: Option<Before>,
    work: &mut Workspace<D>,
) -> Result<State, Rejected> {
    let dofs = model.dofs();
    let contacts = model.contacts.len();
    let Before { y, v, pairs } = before.unwrap_or_else(|| Before {
        y: model.initial_position.clone(),
        v: model.initial_velocity.clone(),
        pairs: vec![Vec::new(); contacts],
    });
    let mut state = State {
        y,
        v: if inertia { v } else { vec![0.0; dofs] },
        a: vec![0.0; dofs],
        f_internal: vec![0.0; dofs],
        f_external: vec![0.0; dofs],
        f_contact: vec![0.0; dofs],
        contact_forces: vec![[0.0; 2]; contacts],
        pairs,
        ..State::default()
    };
    state.ledger.strain = model
        .internal_force(&state.y, &mut state.f_internal)
        .map_err(|(body, inverted)| Rejected::Inverted { body, inverted })?;
    model.loads_into(0.0, &state.y, &mut work.loads, &mut state.f_external)?;
    model.motions.at(0.0, &mut work.motions)?;
    for moved in &work.motions {
        let distance = (model.reference[moved.dof] + moved.motion[0] - state.y[moved.dof]).abs();
        if distance > NEAR * model.scale {
            return Err(Rejected::Jump { node: moved.dof / D, distance });
        }
        if inertia {
            [state.v[moved.dof], state.a[moved.dof]] = [moved.motion[1], moved.motion[2]];
        }
    }
    linearise_all(model, &mut state, work)?;
    state.ledger.springs = press(model, &mut state, work)?;
    state.ledger.strain += state.ledger.springs;
    if inertia {
        accelerate(model, &mut state, work)?;
    }
    // The second derivatives above are for λ = 1; gaps and gradients do not depend on λ.
    averaged_contact_into(model, &state.pairs, &work.gaps, &mut state.f_contact);
    book_contact_forces(model, &mut state);
    book_kinetic(model, &mut state);
    state.ledger.potential = model.potential(&state.y);
    state.ledger.total_at_start = state.ledger.total();
    Ok(state)
}

/// Springs of penalties take the forces of their gaps; their energy is returned.
fn press<const D: usize>(model: &Model<D>, state: &mut State, work: &mut Workspace<D>) -> Result<f64, Rejected> {
    let mut energy = 0.0;
    for (k, contact) in model.contacts.iter().enumerate() {
        let Some(stiffness) = &contact.penalty else { continue };
        let at = Configuration { start: &state.y, middle: None, end: &state.y, moved: &[] };
        for (pair, gap) in state.pairs[k].iter_mut().zip(&mut work.gaps[k]) {
            // The gap an energy-conserving spring has counted is of the other run.
            pair.start = None;
            energy += penalty::spring(&*contact.method, stiffness[pair.node], pair, &at, gap)
                .map_err(|error| Rejected::Contact { contact: contact.name.clone(), error })?
                .energy;
        }
    }
    Ok(energy)
}

/// Accelerations, and multipliers of what is closed.
fn accelerate<const D: usize>(model: &Model<D>, state: &mut State, work: &mut Workspace<D>) -> Result<(), Rejected> {
    let has_mass = |gap: &Linearised<D>| gap.nodes[..gap.count].iter().any(|n| !model.massless[n * D]);
    let mut places = independent_rows(model, &state.pairs, work);
    // A spring has the force of its gap. A row without mass has no acceleration to ask for: its contact keeps the force it had.
    places.retain(|&(k, p)| model.contacts[k].penalty.is_none() && has_mass(&work.gaps[k][p]));
    let rows: Vec<Row<D>> =
        places.iter().map(|&(k, p)| Row { gap: &work.gaps[k][p], weight: 1.0, compliance: 0.0 }).collect();
    let inertia = work.system.factor_mass(model, &rows)?;
    if inertia.negative > rows.len() {
        return Err(Rejected::NegativeMass { directions: inertia.negative - rows.len() });
    }
    let (forces, bending) = drive(model, state, &work.gaps, &places);
    let (mut solved, mut multipliers) = (vec![0.0; model.dofs()], Vec::new());
    work.system.solve(model, &forces, &bending, &mut solved, &mut multipliers)?;
    take_accelerations(model, state, &solved);
    for (&(k, p), lambda) in places.iter().zip(&multipliers) {
        state.pairs[k][p].lambda = *lambda;
    }
    Ok(())
}
