//! The energy ledger of a step. Its works are found in `works.rs`, from the means over the step
//! that are formed here or from the forces at both ends of the step.

use carom_contact::{Pair, Row, Rows};
use carom_time::Stage;

use crate::contact::friction::secondary_friction;
use crate::friction_state::{each_slip, friction_forces};
use crate::model::Model;
use crate::stage::balance::mean_acceleration;
use crate::stage::equations::Equations;
use crate::stage::evaluation::Evaluation;
use crate::state::{Means, Previous, State};
use crate::works::{Works, work_ahead};

/// Adds a solved stage to the means over the step (cleared before the first stage). `previous`: the
/// previous step of a two-step scheme; `contact_forces`: those of [`contact_forces`], or projected.
pub(crate) fn add_stage(
    equations: &Equations,
    solved: &Evaluation,
    contact_forces: &[[f64; 3]],
    previous: Option<&Previous>,
    means: &mut Means,
) {
    let Equations { model, state, stage, .. } = equations;
    let [old, start, now] = stage.mean;
    for (k, contact) in model.contacts.iter().enumerate() {
        let (now, start) = if contact.at_the_end { (1.0, 0.0) } else { (now, start) };
        let force = contact_forces[k];
        for i in 0..3 {
            means.contact_forces[k][i] += now * force[i] + start * state.contact_forces[k][i];
        }
    }
    if stage.works_at_both_ends {
        return;
    }
    let before = previous.map(|previous| (old, &previous.means));
    let contact =
        Shares { now: now / stage.weights.contact, start, massless: stage.weights.external.recip() };
    contact.add(model, stage, &solved.forces.contact, &state.f_contact, &mut means.contact);
    if model.has_friction() {
        means.friction.resize(model.dofs(), 0.0);
        contact.add(model, stage, &solved.forces.friction, &friction_forces(state), &mut means.friction);
    }
    if !model.loads.is_empty() {
        let loads = Shares { now, start, massless: 1.0 };
        loads.add(model, stage, &solved.forces.loads, &state.f_external, &mut means.loads);
    }
    if let Some((old, before)) = before {
        add_previous(model, old, before, means);
    }
    if !equations.motions.is_empty() {
        add_supports(equations, solved, before, means);
    }
}

/// Weights of a force at the stage's end and at the step's start; at massless dofs, which have
/// nothing to average with, of that at the step's end.
struct Shares {
    now: f64,
    start: f64,
    massless: f64,
}

impl Shares {
    fn add(&self, model: &Model, stage: &Stage, now: &[f64], start: &[f64], mean: &mut [f64]) {
        for i in 0..mean.len() {
            if !model.massless[i] {
                mean[i] += self.now * now[i] + self.start * start[i];
            } else if stage.end == 1.0 {
                mean[i] = self.massless * now[i];
            }
        }
    }
}

/// The share of the previous step, in the first stage of a two-step scheme.
fn add_previous(model: &Model, old: f64, before: &Means, means: &mut Means) {
    for i in (0..model.dofs()).filter(|&i| !model.massless[i]) {
        means.contact[i] += old * before.contact[i];
        means.loads[i] += old * before.loads[i];
    }
    for (i, (mean, before)) in means.friction.iter_mut().zip(&before.friction).enumerate() {
        *mean += if model.massless[i] { 0.0 } else { old * before };
    }
    for (mean, before) in means.contact_forces.iter_mut().zip(&before.contact_forces) {
        (0..3).for_each(|i| mean[i] += old * before[i]);
    }
}

/// Forces and accelerations of moving supports.
fn add_supports(
    equations: &Equations,
    solved: &Evaluation,
    before: Option<(f64, &Means)>,
    means: &mut Means,
) {
    let Equations { model, state, stage, .. } = equations;
    let [_, start, now] = stage.mean;
    // Residual at the step's start.
    let mut residual = vec![0.0; if start == 0.0 { 0 } else { model.dofs() }];
    if start != 0.0 {
        balance_into(model, state, &state.a, &mut residual);
    }
    for moved in &equations.motions {
        let i = moved.dof;
        if model.massless[i] {
            means.supports[i] = solved.residual[i] / stage.weights.external;
            continue;
        }
        means.supports[i] +=
            now * solved.residual[i] + residual.get(i).map_or(0.0, |residual| start * residual);
        means.accelerations[i] += if stage.average == 0.0 {
            now * moved.motion[2] + start * state.a[i]
        } else {
            mean_acceleration(stage, moved.motion[2], state.a[i])
        };
        if let Some((old, before)) = before {
            means.supports[i] += old * before.supports[i];
            means.accelerations[i] += old * before.accelerations[i];
        }
    }
}

/// Records a step in `next`, before any projection: `last` is its last stage, `strain` the bodies'
/// energy at its end.
pub(crate) fn account(
    equations: &Equations,
    last: &Evaluation,
    next: &mut State,
    strain: f64,
    dt: f64,
    means: &Means,
) {
    let Equations { model, state, stage, .. } = equations;
    let increment = &last.at.increment;
    let works = if stage.works_at_both_ends {
        Works::at_both_ends(equations, last, next, dt)
    } else {
        Works::of_means(equations, next, increment, dt, means)
    };
    works.book(&mut next.ledger);
    if model.has_friction() {
        let stored = last.stick_springs - next.ledger.stick_springs;
        next.ledger.contact_work -= stored;
        next.ledger.friction_work += stored;
        next.ledger.stick_springs = last.stick_springs;
    }
    // Spring energy is not lost: it is part of the strain energy.
    next.ledger.contact_work += last.springs - next.ledger.springs;
    next.ledger.springs = last.springs;
    if stage.works_at_both_ends && !stage.is_static() {
        let [mut averaged, at_end] = changes_of_reactions(model, state, next, increment);
        averaged += change_of_loads(state, next, increment);
        let changes = [averaged, at_end];
        next.ledger.unbooked += work_ahead(stage, dt, changes, &mut next.ledger.relaxing);
    }
    book_contact_forces(model, next);
    for (impulse, mean) in next.impulses.iter_mut().zip(&means.contact_forces) {
        (0..3).for_each(|i| impulse[i] += dt * mean[i]);
    }
    book_materials(next);
    next.ledger.strain = strain + last.springs;
    next.ledger.potential = model.potential(&next.y);
    book_kinetic(model, next);
}

/// Overwrites `residual` with the balance of a state whose accelerations are `a`: the reactions of
/// supports, with those of the points that their nodes carry.
pub(crate) fn balance_into(model: &Model, state: &State, a: &[f64], residual: &mut [f64]) {
    model.mass.multiply_into(a, residual);
    for (i, force) in residual.iter_mut().enumerate() {
        *force += state.f_internal[i] + state.f_contact[i] - model.gravity[i] - state.f_external[i];
    }
    model.points.gather(residual);
}

/// Δy·ΔR of moving supports, of the forces that the balance averages and of those that act at its
/// end: as [`change_of_loads`]. The inertia of their own motion is known: its work is the change of
/// their kinetic energy.
pub(crate) fn changes_of_reactions(
    model: &Model,
    state: &State,
    next: &State,
    increment: &[f64],
) -> [f64; 2] {
    if model.motions.is_empty() {
        return [0.0; 2];
    }
    let reactions = |state: &State| {
        let mut a = state.a.clone();
        model.motions.dofs().for_each(|i| a[i] = 0.0);
        model.points.carry(&mut a);
        let mut forces = vec![0.0; model.dofs()];
        balance_into(model, state, &a, &mut forces);
        forces
    };
    let before = reactions(state);
    let now = reactions(next);
    let all: f64 = model.motions.dofs().map(|i| increment[i] * (now[i] - before[i])).sum();
    let mut change = next.f_at_end.clone();
    change.resize(model.dofs(), 0.0);
    change.iter_mut().zip(&state.f_at_end).for_each(|(change, before)| *change -= before);
    model.points.gather(&mut change);
    let at_end: f64 = model.motions.dofs().map(|i| increment[i] * change[i]).sum();
    [all - at_end, at_end]
}

/// Contact forces of a solved last stage as its balance has them: friction along H(y_½) instead of
/// H(y) between steps, and conserving springs along the discrete gradients of their gaps instead of
/// those at the end. The acceleration of the state contains them, the first stage of a composite
/// rule weighs both, and in load steps they bear the loads: momentum and energy are balanced with
/// the same forces.
pub(crate) fn keep_forces(model: &Model, solved: &Evaluation, state: &mut State) {
    state.f_contact.clone_from(&solved.forces.contact);
    if model.has_friction() {
        state.f_friction.clone_from(&solved.forces.friction);
    }
    state.contact_forces = contact_forces(model, solved);
}

/// Force of an evaluation on the secondary side of each contact.
pub(crate) fn contact_forces(model: &Model, solved: &Evaluation) -> Vec<[f64; 3]> {
    (0..model.contacts.len()).map(|k| force_of(solved, k)).collect()
}

/// Force of an evaluation on the secondary side of a contact.
fn force_of(solved: &Evaluation, contact: usize) -> [f64; 3] {
    let mut force = secondary_force(&solved.at.pairings[contact].pairs, solved.directions(contact).iter());
    let friction = secondary_friction(solved, contact);
    (0..3).for_each(|i| force[i] += friction[i]);
    force
}

/// Force on a secondary side, −Σ λ ∂g/∂y_N over the active pairs.
pub fn secondary_force<'a>(pairs: &[Pair], rows: impl Iterator<Item = Row<'a>>) -> [f64; 3] {
    let mut force = [0.0; 3];
    for (pair, row) in pairs.iter().zip(rows).filter(|(pair, _)| pair.active) {
        let normal = row.normal();
        (0..3).for_each(|i| force[i] -= pair.lambda * normal[i]);
    }
    force
}

/// Δy·ΔF of the loads (`works.rs`).
pub(crate) fn change_of_loads(state: &State, next: &State, increment: &[f64]) -> f64 {
    let forces = state.f_external.iter().zip(&next.f_external);
    increment.iter().zip(forces).map(|(moved, (before, now))| moved * (now - before)).sum()
}

/// Records what the materials dissipate in a step, as known from its forces.
pub(crate) fn book_materials(next: &mut State) {
    let lost = std::mem::take(&mut next.materials.lost);
    for (sum, lost) in next.materials.dissipated.iter_mut().zip(lost) {
        *sum += lost;
        next.ledger.materials += lost;
    }
}

/// Updates the kinetic energy.
pub(crate) fn book_kinetic(model: &Model, state: &mut State) {
    state.ledger.kinetic = model.kinetic(&state.v);
}

/// Updates the force on the secondary side of each contact at the state's positions.
pub(crate) fn book_contact_forces(model: &Model, state: &mut State) {
    let mut rows = Rows::new(model.dimension);
    for (k, contact) in model.contacts.iter().enumerate() {
        let mut force = [0.0; 3];
        for pair in state.pairs[k].iter().filter(|p| p.active) {
            rows.clear();
            if contact.kinematics.measure(&mut pair.clone(), &state.y, &mut rows).is_ok() {
                let of_pair = secondary_force(std::slice::from_ref(pair), rows.iter());
                (0..3).for_each(|i| force[i] += of_pair[i]);
            }
        }
        state.contact_forces[k] = force;
    }
    if model.has_friction() {
        let mut friction = vec![[0.0; 3]; model.contacts.len()];
        each_slip(model, state, |k, _, traction, row| {
            let along = row.normal();
            (0..3).for_each(|i| friction[k][i] -= traction * along[i]);
        });
        for (force, friction) in state.contact_forces.iter_mut().zip(friction) {
            (0..3).for_each(|i| force[i] += friction[i]);
        }
    }
}
