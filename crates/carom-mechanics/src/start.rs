//! The state before the first step, in the reference configuration or at the end of another run:
//!
//! ```text
//! M a₀ + Gᵀλ₀ = f_ext − f_int,   λ₀ ≤ 0,  g̈₀ ≥ 0,  λ₀ g̈₀ = 0,   g̈₀ = G a₀ + v₀·∇²g·v₀   at t = 0
//! ```
//!
//! Contacts active at the end of the other run remain active, but do not pull (`persistency.rs`),
//! and stick or slip as in its last step: velocities at the end of a step ring from node to node.
//! In the reference configuration there are none (λ₀ = 0). A moving support has its own v₀, a₀ and
//! must start at the position of its body. Schemes whose contact forces are impulses carry the
//! acceleration of all other forces, M a₀ = f_ext − f_int. Without inertia v₀ and a₀ are zero, and
//! the first load step finds the equilibrium.

use std::sync::Arc;

use std::collections::BTreeMap;

use carom_contact::{FrictionState, Pair, Point, Rows};
use carom_solid::Configuration;

use crate::contact::constraints::Constraints;
use crate::ledger::{book_contact_forces, book_kinetic};
use crate::linear::system::System;
use crate::model::{LoadsAt, Model};
use crate::rejected::Rejected;
use crate::state::{Carried, State};
use crate::velocity::active_rows::measure_all;
use crate::velocity::persistency::{self, contact_forces_into};

/// The start of a run, if not the initial positions.
#[derive(Clone, Debug, PartialEq)]
pub struct InitialState {
    /// Positions.
    pub y: Vec<f64>,
    /// Velocities.
    pub v: Vec<f64>,
    /// Pairs of each contact.
    pub pairs: Vec<Vec<Pair>>,
    /// Which pairs stuck in the step before, and in which direction others slipped, by contact and
    /// pair; for pairs that are not listed the velocities decide.
    pub slid: BTreeMap<(usize, usize), FrictionState>,
    /// Memory of the materials of all bodies; empty if there is none.
    pub memory: Vec<f64>,
}

/// What accelerates the bodies.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Inertia {
    /// Nothing: they have no inertia.
    None,
    /// All forces.
    Constrained,
    /// All but those of contact, which are impulses.
    Free,
}

/// Tolerance, relative to L, between a moving support and its formula at t = 0.
const NEAR: f64 = 1e-9;

/// The state before the first step, with or without inertia.
///
/// # Errors
/// If a cell is inverted, a load or a motion has no value at t = 0, a moving support would jump, or
/// the mass matrix is singular.
pub fn start(
    model: &Model,
    inertia: Inertia,
    before: Option<InitialState>,
    system: &mut System,
) -> Result<State, Rejected> {
    let dofs = model.dofs();
    let has_inertia = inertia != Inertia::None;
    let contacts = model.contacts.len();
    let InitialState { y, v, mut pairs, slid, memory } = before.unwrap_or_else(|| InitialState {
        y: model.initial_position.clone(),
        v: model.initial_velocity.clone(),
        pairs: vec![Vec::new(); contacts],
        slid: BTreeMap::new(),
        memory: Vec::new(),
    });
    for pair in pairs.iter_mut().flatten() {
        pair.rests = pair.active;
        pair.begins = false;
        if inertia != Inertia::Constrained {
            pair.depth = 0.0;
        }
    }
    let mut state = State {
        y,
        v: if has_inertia { v } else { vec![0.0; dofs] },
        a: vec![0.0; dofs],
        f_internal: vec![0.0; dofs],
        f_external: vec![0.0; dofs],
        f_contact: vec![0.0; dofs],
        contact_forces: vec![[0.0; 3]; contacts],
        impulses: vec![[0.0; 3]; contacts],
        pairs,
        materials: model.materials(),
        ..State::default()
    };
    // A body that starts strained, and remembers nothing, has reached its positions at once.
    let mut start = model.materials();
    if memory.len() == model.memory() {
        start.memory = Arc::new(memory);
    }
    let at = Configuration { before: None, y: &state.y, past: start.past(0.0) };
    state.ledger.strain = model
        .internal_force(&at, &mut state.f_internal, &mut state.materials)
        .map_err(|(body, inverted)| Rejected::Inverted { body, inverted })?;
    state.materials.lost.clear();
    model.loads_into(0.0, &state.y, &mut LoadsAt::default(), &mut state.f_external)?;
    let mut motions = Vec::new();
    model.motions.at(0.0, &mut motions)?;
    for moved in &motions {
        let distance = (model.reference[moved.dof] + moved.motion[0] - state.y[moved.dof]).abs();
        if distance > NEAR * model.scale {
            return Err(Rejected::Jump { node: moved.dof / model.dimension, distance });
        }
        if has_inertia {
            [state.v[moved.dof], state.a[moved.dof]] = [moved.motion[1], moved.motion[2]];
        }
    }
    model.points.carry(&mut state.v);
    let gaps = measure_all(model, &mut state)?;
    state.ledger.springs = press(model, &mut state, &gaps);
    state.ledger.stick_springs = model.stick_energy(state.pairs.iter().map(Vec::as_slice));
    state.ledger.springs += state.ledger.stick_springs;
    state.ledger.strain += state.ledger.springs;
    match inertia {
        Inertia::None => {}
        Inertia::Constrained => accelerate(model, &mut state, &gaps, &slid, system)?,
        Inertia::Free => {
            let pairs = std::mem::replace(&mut state.pairs, vec![Vec::new(); contacts]);
            accelerate(model, &mut state, &gaps, &slid, system)?;
            state.pairs = pairs;
        }
    }
    contact_forces_into(model, &mut state, &gaps);
    book_contact_forces(model, &mut state);
    if inertia == Inertia::Free {
        jump(model, &mut state, system)?;
    }
    state.carried = Carried::at_start(&state.contact_forces);
    book_kinetic(model, &mut state);
    state.ledger.potential = model.potential(&state.y);
    state.ledger.begin();
    Ok(state)
}

/// The jumps of velocities, divided by the step, for the contact forces with which a run goes on;
/// none in a model with massless nodes.
fn jump(model: &Model, state: &mut State, system: &mut System) -> Result<(), Rejected> {
    if state.f_contact.iter().all(|force| *force == 0.0) || model.massless.contains(&true) {
        return Ok(());
    }
    let forces: Vec<f64> = state.f_contact.iter().map(|force| -force).collect();
    state.jumps = vec![0.0; model.dofs()];
    system.mass_with(model, &Constraints::none(model.dimension))?;
    Ok(system.solve(model, [&forces, &[]], &mut state.jumps, &mut Vec::new())?)
}

/// Evaluates the forces of penalty springs; returns their energy.
pub fn press(model: &Model, state: &mut State, gaps: &[Rows]) -> f64 {
    let mut energy = 0.0;
    for (k, contact) in
        model.contacts.iter().enumerate().filter(|(_, contact)| !contact.interface.is_constraint())
    {
        for (pair, row) in state.pairs[k].iter_mut().zip(gaps[k].iter()) {
            // The gap stored by an energy-conserving spring is that of the other run.
            pair.start = None;
            let at = Point {
                node: pair.node,
                gap: row.gap,
                start: row.gap,
                lambda: pair.lambda,
                active: pair.active,
                multiplier: 0.0,
                stiffness: contact.spring(pair).unwrap_or(0.0),
            };
            let answer = contact.interface.respond(&at);
            (pair.active, pair.lambda) = (answer.active, answer.lambda);
            energy += answer.energy;
        }
    }
    energy
}

/// Computes accelerations, and multipliers of active constraints.
fn accelerate(
    model: &Model,
    state: &mut State,
    gaps: &[Rows],
    slid: &BTreeMap<(usize, usize), FrictionState>,
    system: &mut System,
) -> Result<(), Rejected> {
    // A spring has the force of its gap. A row without mass does not determine an acceleration: its
    // contact keeps its force.
    let asks = |&(k, p): &(usize, usize)| {
        let has_mass = |n: &usize| !model.massless[n * model.dimension];
        model.contacts[k].interface.is_constraint() && gaps[k].row(p).nodes.iter().any(has_mass)
    };
    persistency::accelerate(model, state, gaps, asks, slid, system)
}
