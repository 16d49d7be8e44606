//! Works of a step, with Δy = y_{s+1} − y_s:
//!
//! ```text
//! of both ends     F̄ = (F_s + F_{s+1})/2                              α family, load steps
//! of means         F̄ = the mean of the velocity update, `Stage::mean`     all others
//! external         Δy·F̄_ext (beyond the potential) + Δy_moved·R̄ + (v_s + v_{s+1})/2·M J
//! contact          Δy·F̄_cont
//! ```
//!
//! The balance of the α family has its forces at 1 − α_f of the step. As a quadrature of ∫F·dy this
//! lags by ½ − α_f steps, an error of first order for as long as a load varies. The mean of both
//! ends is of second order. With it the trapezoidal rule dissipates nothing in linear motion, an
//! obstacle that turns under a body does no work, and works do not depend on the frame.
//!
//! Friction in load steps and that on springs works with its mean in the balance, so that its work
//! is not positive where slip begins or ends.
//!
//! Where a gap closes and velocities are projected, F_{s+1} is an impulse over Δt, which changes
//! v_s into v⁻ before the projection. An impulse works at the mean velocity, whatever the path of
//! the positions ([`Works::beyond_path`]):
//!
//! ```text
//! p = Δt κ (F_{s+1} − F_s)      κ = γ (1 − α_f)/(1 − α_m), the share of F_{s+1} in v⁻     α family
//! p = Δt (F̄ − F_s)                                                                       all others
//! work                          Δy·F_s + p·(v_s + v⁻)/2
//! ```
//!
//! In the trapezoidal and the midpoint rule Δy is Δt (v_s + v⁻)/2, and nothing changes. With
//! another path the time integrator would seem to take a part of the impact, which does not vanish
//! with the step. Supports and obstacles have Δy as their path, but for the impulses of velocities
//! that jump.
//!
//! R̄ is the reaction of prescribed dofs. Of both ends it is M Δv/Δt plus the mean of the other
//! forces: accelerations of the α family are of first order. Of means it is the mean residual of
//! the balance. Where a prescribed velocity jumps, J = v_{s+1} − v_s − Δt ā is its change beyond
//! its mean acceleration, and the impulse M J is one of the supports, too: it works at the mean
//! velocity, which is not that of the path Δy.

use std::collections::BTreeSet;

use carom_algebra::sums::dot;
use carom_contact::{Row, Rows};
use carom_time::Stage;

use crate::friction_state::{each_slip, friction_forces};
use crate::stage::equations::Equations;
use crate::stage::evaluation::Evaluation;
use crate::state::{Ledger, Means, State};

/// Works of the forces of a step.
#[derive(Default)]
pub(crate) struct Works {
    /// Work of loads beyond their potential, and of moving supports.
    pub external: f64,
    /// Δy·F̄ of the contact forces as the balance has them.
    pub contact: f64,
    /// The part of friction in it.
    pub friction: f64,
}

impl Works {
    /// With the mean of both ends; `next` has its forces, and velocities before a projection.
    pub(crate) fn at_both_ends(equations: &Equations, last: &Evaluation, next: &State, dt: f64) -> Self {
        let Equations { model, state, stage, .. } = equations;
        let increment = &last.at.increment;
        let mut friction = 0.0;
        let mut contact = at_both_ends(increment, &state.f_contact, &next.f_contact);
        if model.has_friction() {
            let between = at_both_ends(increment, &friction_forces(state), &next.f_friction);
            friction = if friction_is_constraint(equations) {
                between + 0.5 * dot(increment, &turned_friction(last, next))
            } else {
                work_of_friction(equations, last)
            };
            contact += friction - between;
        }
        let mut external = at_both_ends(increment, &state.f_external, &next.f_external);
        if !equations.motions.is_empty() {
            let mut reaction = vec![0.0; model.dofs()];
            if !stage.is_static() {
                let change: Vec<f64> = next.v.iter().zip(&state.v).map(|(v, old)| (v - old) / dt).collect();
                model.mass.multiply_into(&change, &mut reaction);
            }
            let turned = turned_friction(last, next);
            for (i, force) in reaction.iter_mut().enumerate() {
                let internal = state.f_internal[i] + next.f_internal[i];
                let contact = state.f_contact[i] + next.f_contact[i] + turned.get(i).copied().unwrap_or(0.0);
                let loads = state.f_external[i] + next.f_external[i];
                *force += 0.5 * (internal + contact - loads) - model.gravity[i];
            }
            model.points.gather(&mut reaction);
            external += model.motions.dofs().map(|i| increment[i] * reaction[i]).sum::<f64>();
            if !stage.is_static() {
                external += work_of_jumps(equations, next, increment, dt);
            }
        }
        Self { external, contact, friction }
    }

    /// With means over the step.
    pub(crate) fn of_means(
        equations: &Equations,
        next: &State,
        increment: &[f64],
        dt: f64,
        means: &Means,
    ) -> Self {
        let model = equations.model;
        let friction = if model.has_friction() { dot(increment, &means.friction) } else { 0.0 };
        let mut external = if model.loads.is_empty() { 0.0 } else { dot(increment, &means.loads) };
        if !equations.motions.is_empty() {
            let mut jump = vec![0.0; increment.len()];
            for i in model.motions.dofs() {
                jump[i] = next.v[i] - equations.state.v[i] - dt * means.accelerations[i];
            }
            model.points.carry(&mut jump);
            let mut impulse = vec![0.0; increment.len()];
            model.mass.multiply_into(&jump, &mut impulse);
            external += dot(increment, &means.supports) + dot(&mean_velocity(equations, next), &impulse);
        }
        Self { external, contact: dot(increment, &means.contact), friction }
    }

    /// Correction of the works of a step in which gaps of the contacts `closing` close: their
    /// impulses times the mean velocity, less their work along the path Δy that is already booked.
    /// `next` has velocities before the projection. Other contacts have none: what closes elsewhere
    /// does not change their work. The α family counts impulses pair by pair; other schemes know
    /// the mean forces on the nodes. The work of supports and obstacles is booked with the
    /// projection (`carried.rs`).
    pub(crate) fn beyond_path(
        equations: &Equations,
        last: &Evaluation,
        next: &State,
        dt: f64,
        (means, closing): (&Means, &BTreeSet<usize>),
    ) -> Self {
        let Equations { model, state, stage, .. } = equations;
        let mut closing = closing.clone();
        closing.retain(|&k| model.contacts[k].projects);
        if closing.is_empty() {
            return Self::default();
        }
        let increment = &last.at.increment;
        let mut path = increment.clone();
        // Supports and obstacles have their own motion, and massless dofs no impulse.
        for i in model.free.iter().copied().filter(|&i| !model.massless[i]) {
            path[i] = 0.5 * dt * (state.v[i] + next.v[i]);
        }
        model.points.carry(&mut path);
        if stage.works_at_both_ends {
            return Self::beyond_path_of_pairs(equations, last, &path, dt, &closing);
        }
        let at = |forces: &[f64], i: usize| forces.get(i).copied().unwrap_or(0.0);
        let mut works = Self::default();
        let nodes: BTreeSet<usize> =
            closing.iter().flat_map(|&k| &model.contacts[k].surface).copied().collect();
        let d = model.dimension;
        for i in nodes.into_iter().flat_map(|node| node * d..(node + 1) * d) {
            let beyond = path[i] - increment[i];
            works.contact += beyond * (means.contact[i] - state.f_contact[i]);
            works.friction += beyond * (at(&means.friction, i) - at(&state.f_friction, i));
        }
        works
    }

    /// [`Works::beyond_path`] of the α family, pair by pair.
    fn beyond_path_of_pairs(
        equations: &Equations,
        last: &Evaluation,
        path: &[f64],
        dt: f64,
        closing: &BTreeSet<usize>,
    ) -> Self {
        let Equations { model, state, stage, .. } = equations;
        let increment = &last.at.increment;
        let is_constraint = friction_is_constraint(equations);
        // The share of a force in the velocities, and that with which it is booked along the path.
        let beyond = |k: usize, row: Row, is_friction: bool| {
            let weight = if model.contacts[k].at_the_end { 1.0 } else { stage.weights.contact };
            let share = gamma(stage, dt) * weight / stage.weights.mass;
            let booked = if is_friction && !is_constraint { weight } else { 0.5 };
            share * row.along(path) - booked * row.along(increment)
        };
        let mut normal = 0.0;
        let mut friction = 0.0;
        let mut rows = Rows::new(model.dimension);
        for (k, contact) in closing.iter().map(|&k| (k, &model.contacts[k])) {
            for (p, pair) in last.at.pairings[k].pairs.iter().enumerate().filter(|(_, pair)| pair.active) {
                normal += pair.lambda * beyond(k, last.rows[k].row(p), false);
                if contact.friction.is_some() {
                    for (row, traction) in last.slip_rows((k, p)).zip(pair.tangential.traction) {
                        friction += traction * beyond(k, row, true);
                    }
                }
            }
            for pair in state.pairs[k].iter().filter(|pair| pair.active) {
                rows.clear();
                if contact.kinematics.measure(&mut pair.clone(), &state.y, &mut rows).is_ok() {
                    normal -= pair.lambda * beyond(k, rows.row(0), false);
                }
            }
        }
        each_slip(model, state, |k, _, traction, row| {
            if closing.contains(&k) {
                friction -= traction * beyond(k, row, true);
            }
        });
        Self { external: 0.0, contact: normal + friction, friction }
    }

    /// Books the works of friction apart from those of contact.
    pub(crate) fn book(&self, ledger: &mut Ledger) {
        ledger.external_work += self.external;
        ledger.contact_work += self.friction - self.contact;
        ledger.friction_work -= self.friction;
    }
}

/// Friction at the end of a step along H(y_½), as the balance has it, less that along H(y_{s+1}),
/// which is that of the next step; empty without friction.
fn turned_friction(last: &Evaluation, next: &State) -> Vec<f64> {
    let mut turned: Vec<f64> = next.f_friction.iter().map(|force| -force).collect();
    let pairings = last.at.pairings.iter().enumerate();
    for (k, pairing) in pairings.filter(|(k, _)| !last.slips[*k].is_empty()) {
        for (p, pair) in pairing.pairs.iter().enumerate().filter(|(_, pair)| pair.active) {
            let along = last.slip_rows((k, p)).zip(pair.tangential.traction);
            along.for_each(|(row, traction)| row.add_to(traction, &mut turned));
        }
    }
    turned
}

/// Work of the impulse M J of supports, less what is booked of it along the path of prescribed
/// dofs: J = Δv − Δt (a_s + a_{s+1})/2 is the change of prescribed velocities beyond their
/// acceleration, which the balance averages like forces. Through M it acts on their neighbours,
/// too.
fn work_of_jumps(equations: &Equations, next: &State, increment: &[f64], dt: f64) -> f64 {
    let Equations { model, state, .. } = equations;
    let mut jump = vec![0.0; increment.len()];
    for moved in &equations.motions {
        let i = moved.dof;
        let mean = 0.5 * (state.a[i] + moved.motion[2]);
        jump[i] = next.v[i] - state.v[i] - dt * mean;
    }
    model.points.carry(&mut jump);
    let mut inertia = vec![0.0; increment.len()];
    model.mass.multiply_into(&jump, &mut inertia);
    let all = dot(&mean_velocity(equations, next), &inertia);
    model.points.gather(&mut inertia);
    let booked: f64 = model.motions.dofs().map(|i| increment[i] * inertia[i]).sum();
    all - booked / dt
}

/// (v_s + v_{s+1})/2.
fn mean_velocity(equations: &Equations, next: &State) -> Vec<f64> {
    equations.state.v.iter().zip(&next.v).map(|(before, now)| 0.5 * (before + now)).collect()
}

/// Work Δy·(F_s + F_{s+1})/2.
pub(crate) fn at_both_ends(increment: &[f64], before: &[f64], now: &[f64]) -> f64 {
    let forces = before.iter().zip(now);
    increment.iter().zip(forces).map(|(moved, (before, now))| 0.5 * moved * (before + now)).sum()
}

/// Whether all friction is a constraint of a motion: not in load steps, and not on springs. The
/// work of friction is known for all contacts together.
fn friction_is_constraint(equations: &Equations) -> bool {
    let mut rubs = equations.model.contacts.iter().filter(|contact| contact.friction.is_some());
    !equations.stage.is_static() && rubs.all(|contact| contact.interface.is_constraint())
}

/// Work of friction with its mean in the balance of a step.
fn work_of_friction(equations: &Equations, last: &Evaluation) -> f64 {
    let Equations { model, state, stage, .. } = equations;
    let before = friction_forces(state);
    let mut work = 0.0;
    for (i, moved) in last.at.increment.iter().enumerate() {
        // The balance of massless dofs has no forces of the start.
        let mean = if model.massless[i] && !stage.is_static() {
            last.forces.friction[i] / stage.weights.external
        } else {
            let averaged = before[i] - state.f_friction_at_end.get(i).copied().unwrap_or(0.0);
            last.forces.friction[i] + stage.before.contact * averaged
        };
        work += moved * mean;
    }
    work
}

/// Work that forces which change by ΔF over a step do on the momentum of velocities beyond the mean
/// of both ends: `changes` has Δy·ΔF of those that the balance averages, and of those that act at
/// its end, α_f = 0. The momentum of velocities is p = Σ Δt F̄ − c Δt q (`carried.rs`), so that
///
/// ```text
/// p − Σ Δt (F_s + F_{s+1})/2 = Δt [(½ − α_f − c) F + c x],     x = F − q
/// (1 − α_m) x_{s+1} = (α_f − α_m) ΔF − α_m x_s
/// ```
///
/// The first part vanishes in schemes of second order, the second one where forces are steady.
/// `relaxing`: Δy·x, which becomes that of the step's end.
pub(crate) fn work_ahead(stage: &Stage, dt: f64, changes: [f64; 2], relaxing: &mut f64) -> f64 {
    let gamma = gamma(stage, dt);
    let alpha_m = stage.before.mass;
    let carried = 1.0 - gamma - alpha_m;
    let mut work = 0.0;
    let mut next = -alpha_m * *relaxing;
    let alphas = [stage.before.contact, 0.0];
    for ((change, alpha_f), lead) in changes.into_iter().zip(alphas).zip(leads(stage, dt)) {
        work += lead * change;
        next += (alpha_f - alpha_m) * change;
    }
    next /= stage.weights.mass;
    work += carried * (next - *relaxing);
    *relaxing = next;
    work
}

/// ½ − α_f − c of the forces that the balance averages and of those that act at its end.
pub(crate) fn leads(stage: &Stage, dt: f64) -> [f64; 2] {
    let carried = 1.0 - gamma(stage, dt) - stage.before.mass;
    [0.5 - stage.before.contact - carried, 0.5 - carried]
}

/// γ of Δv = Δt [(1 − γ) a_s + γ a_{s+1}], from the maps of a stage.
fn gamma(stage: &Stage, dt: f64) -> f64 {
    stage.velocity.slope / (stage.acceleration.slope * dt)
}
