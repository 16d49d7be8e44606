//! Every kernel that is a list of implicit stages: guess, solve, account, and where contact begins project.

use carom_contact::{Linearised, Pair};
use carom_time::{Kernel, Memory};

use super::{Accepted, StepReport, Stepper};
use crate::balance::known_into;
use crate::case::{ForceTime, NewtonSpec};
use crate::ledger;
use crate::model::Model;
use crate::newton::{Trial, Workspace, add_gradient, solve_stage};
use crate::persistency::project;
use crate::rejected::Rejected;
use crate::state::State;

/// The implicit stepper.
pub struct Implicit {
    kernel: Box<dyn Kernel>,
    newton: NewtonSpec,
}

impl Implicit {
    /// A stepper of a kernel.
    pub fn new(kernel: Box<dyn Kernel>, newton: NewtonSpec) -> Self {
        Self { kernel, newton }
    }
}

impl<const D: usize> Stepper<D> for Implicit {
    fn step(
        &self,
        model: &Model<D>,
        state: &State,
        dt: f64,
        to: f64,
        work: &mut Workspace<D>,
    ) -> Result<Accepted, Rejected> {
        let mut stage = std::mem::take(&mut work.stage);
        let memory = Memory { states: &[(&state.y, &state.v, &state.a)] };
        self.kernel.stage_into(0, dt, &memory, &mut stage);
        work.stage = stage;
        begin(model, state, to, work)?;
        known_into(model, &work.stage, state, &mut work.forces);

        let mut trial = guess(model, state, dt);
        let effort = solve_stage(model, state, &self.newton, &mut trial, work)?;

        let mut next = state.clone();
        next.time = to;
        next.y.clone_from(&trial.y);
        next.a.clone_from(&work.acceleration);
        work.stage.velocity.value_into(&trial.increment, &mut next.v);
        for (i, massless) in model.massless.iter().enumerate() {
            if *massless && !work.stage.is_static() {
                // Without inertia there is nothing to integrate: the velocity is the mean one, the acceleration zero.
                (next.v[i], next.a[i]) = (trial.increment[i] / dt, 0.0);
            }
        }
        for moved in work.motions.iter().filter(|_| !work.stage.is_static()) {
            [next.v[moved.dof], next.a[moved.dof]] = [moved.motion[1], moved.motion[2]];
        }
        next.pairs.clone_from(&trial.pairs);
        next.f_external.clone_from(&work.forces.loads);
        next.kept = effort.kept;
        next.f_internal.clone_from(&work.forces.internal);
        let mut strain = trial.strain;
        if work.stage.average != 0.0 {
            strain = model
                .internal_force(&next.y, &mut next.f_internal)
                .map_err(|(body, inverted)| Rejected::Inverted { body, inverted })?;
            model.loads_into(to, &next.y, &mut work.loads, &mut next.f_external)?;
        }
        averaged_contact_into(model, &next.pairs, &work.gaps, &mut next.f_contact);
        ledger::account(model, state, &mut next, strain, &trial.increment, dt, work);

        let mut report = StepReport { newton: effort.iterations, events: effort.events, ..StepReport::default() };
        report.activations = difference(model, &next, state);
        report.releases = difference(model, state, &next);
        if !report.activations.is_empty() {
            report.projection = project(model, &mut next, &report.activations, work)?;
        }
        Accepted::new(next, report)
    }
}

/// Loads at the time the stage's internal forces are taken at, and the motions of supports at its end.
fn begin<const D: usize>(model: &Model<D>, state: &State, to: f64, work: &mut Workspace<D>) -> Result<(), Rejected> {
    let average = work.stage.average;
    let time = if average == 0.0 { to } else { (1.0 - average) * to + average * state.time };
    if !model.loads.is_empty() {
        model.loads.at(&model.parts, model.dofs(), time, &mut work.loads)?;
        if model.loads.follow() {
            work.system.loads_tangent(model, &work.loads);
        }
    }
    Ok(model.motions.at(to, &mut work.motions)?)
}

/// Positions if the acceleration stayed, multipliers as they were, each pair free to change facets again.
fn guess<const D: usize>(model: &Model<D>, state: &State, dt: f64) -> Trial {
    let dofs = model.dofs();
    let increment: Vec<f64> = (0..dofs).map(|i| dt * (state.v[i] + 0.5 * dt * state.a[i])).collect();
    let y = (0..dofs).map(|i| state.y[i] + increment[i]).collect();
    let mut pairs = state.pairs.clone();
    for pairs in &mut pairs {
        // Open pairs are found afresh, so that they depend on positions alone.
        pairs.retain(|p| p.active);
        for pair in pairs {
            pair.left = None;
        }
    }
    Trial { increment, y, pairs, strain: 0.0 }
}

/// Σ Gᵀλ over the contacts whose force is averaged: what the next step takes its share of.
pub(crate) fn averaged_contact_into<const D: usize>(
    model: &Model<D>,
    pairs: &[Vec<Pair>],
    gaps: &[Vec<Linearised<D>>],
    force: &mut [f64],
) {
    force.fill(0.0);
    for k in (0..pairs.len()).filter(|&k| model.contacts[k].force == ForceTime::AlphaF) {
        for (pair, gap) in pairs[k].iter().zip(&gaps[k]).filter(|(pair, _)| pair.active) {
            add_gradient(gap, pair.lambda, force);
        }
    }
}

/// Secondary nodes active in `a` and not in `b`: (contact, global node).
fn difference<const D: usize>(model: &Model<D>, a: &State, b: &State) -> Vec<(usize, usize)> {
    let mut nodes = Vec::new();
    for (k, contact) in model.contacts.iter().enumerate() {
        let active = |s: &State, node: usize| s.pairs[k].iter().any(|p| p.active && p.node == node);
        for pair in a.pairs[k].iter().filter(|p| p.active) {
            if !active(b, pair.node) {
                nodes.push((k, contact.method.secondary()[pair.node]));
            }
        }
    }
    nodes.dedup();
    nodes
}
