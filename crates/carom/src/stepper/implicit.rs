//! Every kernel that is a list of implicit stages: guess, solve, account, and where contact begins project.

use carom_contact::{Linearised, Pair};
use carom_time::{Before, Internal, Kernel, Memory, Stage, Weights};

use super::{Accepted, StepReport, Stepper};
use crate::balance::known_into;
use crate::case::{ForceTime, NewtonSpec};
use crate::evaluation::{Trial, add_gradient};
use crate::ledger;
use crate::model::{Model, dot};
use crate::newton::solve_stage;
use crate::persistency::project;
use crate::rejected::Rejected;
use crate::state::{Previous, State};
use crate::touching::GAP_TOLERANCE;
use crate::workspace::Workspace;

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

/// Motion at the end of a stage.
#[derive(Default)]
struct Point {
    y: Vec<f64>,
    v: Vec<f64>,
    a: Vec<f64>,
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
        let previous = state.previous.as_ref().filter(|previous| previous.dt == dt);
        let mut next = state.clone();
        let mut report = StepReport::default();
        let mut finished: Vec<Point> = Vec::new();
        let mut end = 0.0;
        let mut trial =
            Trial { increment: vec![0.0; model.dofs()], y: state.y.clone(), pairs: state.pairs.clone(), strain: 0.0 };
        let shift = self.predictor_shift(model, state, dt, to, work)?;
        work.means.clear(model.dofs());
        for k in 0..self.kernel.stages() {
            self.prepare(k, dt, state, &finished, work);
            if let Some(shift) = &shift {
                let Stage { velocity, acceleration, .. } = &mut work.stage;
                for map in [velocity, acceleration] {
                    map.at_start.iter_mut().zip(shift).for_each(|(at_start, c)| *at_start -= map.slope * c);
                }
            }
            let time = if work.stage.end == 1.0 { to } else { state.time + work.stage.end * dt };
            begin(model, state, time, work)?;
            known_into(model, &work.stage, state, &mut work.forces);
            let before = finished.last().map_or(&state.y, |point| &point.y);
            go_on(&next.v, &next.a, (work.stage.end - end) * dt, &mut trial);
            end = work.stage.end;
            let effort = solve_stage(model, state, &next.kept, before, &self.newton, &mut trial, work)?;
            report.newton += effort.iterations;
            report.events.extend(effort.events);
            next.kept = effort.kept;
            ledger::add_stage(model, state, previous, &trial.pairs, dt, work);
            next.a.clone_from(&work.acceleration);
            work.stage.velocity.value_into(&trial.increment, &mut next.v);
            take_motions(work, &mut next);
            if k + 1 < self.kernel.stages() {
                finished.push(Point { y: trial.y.clone(), v: next.v.clone(), a: next.a.clone() });
            }
        }

        next.time = to;
        next.y.clone_from(&trial.y);
        for (i, massless) in model.massless.iter().enumerate() {
            if *massless && !work.stage.is_static() {
                // Without inertia there is nothing to integrate: the velocity is the mean one, the acceleration zero.
                (next.v[i], next.a[i]) = (trial.increment[i] / dt, 0.0);
            }
        }
        take_motions(work, &mut next);
        next.pairs.clone_from(&trial.pairs);
        next.f_external.clone_from(&work.forces.loads);
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
        if let Some(shift) = &shift {
            // Positions moved by the predictor's contact, against the forces of the step: M (v − v_s)/Δt is their sum.
            let change: Vec<f64> = next.v.iter().zip(&state.v).map(|(v, old)| (v - old) / dt).collect();
            let mut forces = vec![0.0; model.dofs()];
            model.mass.multiply_into(&change, &mut forces);
            next.ledger.contact_work -= dot(shift, &forces);
        }
        if work.stage.internal == Internal::DiscreteGradient {
            // A spring goes on from the gap it has counted.
            for (pairs, gaps) in next.pairs.iter_mut().zip(&work.gaps) {
                pairs.iter_mut().zip(gaps).for_each(|(pair, gap)| pair.start = Some(gap.gap));
            }
        }

        report.activations = difference(model, &next, state);
        report.releases = difference(model, state, &next);
        if !report.activations.is_empty() {
            report.projection = project(model, &mut next, &report.activations, work)?;
        }
        next.previous = (self.kernel.two_step() && report.activations.is_empty()).then(|| Previous {
            dt,
            increment: trial.increment,
            velocity: state.v.clone(),
            means: work.means.clone(),
        });
        Accepted::new(next, report)
    }
}

impl Implicit {
    /// The law "predictor" (P. Deuflhard, R. Krause, S. Ertel, Int. J. Numer. Meth. Engng 73 (2008) 1274–1290): in place of y_s + Δt v_s in Newmark's
    /// formula stands the nearest point, in the mass, without penetration,
    ///
    /// ```text
    /// min ½ ‖q − (y_s + Δt v_s)‖²_M   with   g(q) ≥ 0
    /// ```
    ///
    /// and velocities do not see the difference. It is solved as a stage of its own; q − (y_s + Δt v_s) is returned, none where nothing would penetrate.
    fn predictor_shift<const D: usize>(
        &self,
        model: &Model<D>,
        state: &State,
        dt: f64,
        to: f64,
        work: &mut Workspace<D>,
    ) -> Result<Option<Vec<f64>>, Rejected> {
        if !model.contacts.iter().any(|contact| contact.predictor) {
            return Ok(None);
        }
        let mut trial =
            Trial { increment: vec![0.0; model.dofs()], y: state.y.clone(), pairs: state.pairs.clone(), strain: 0.0 };
        go_on(&state.v, &vec![0.0; model.dofs()], dt, &mut trial);
        // A support goes where it is moved to, whatever the contact.
        model.motions.at(to, &mut work.motions)?;
        for moved in &work.motions {
            trial.increment[moved.dof] = model.reference[moved.dof] + moved.motion[0] - state.y[moved.dof];
            trial.y[moved.dof] = state.y[moved.dof] + trial.increment[moved.dof];
        }
        let free = trial.increment.clone();
        trial.pairs.iter_mut().flatten().for_each(|pair| pair.lambda = 0.0);
        if !penetrates(model, &state.y, &mut trial)? {
            return Ok(None);
        }
        let stage = &mut work.stage;
        (stage.end, stage.average, stage.internal) = (1.0, 0.0, Internal::Gradient);
        stage.weights = Weights { mass: 1.0, internal: 0.0, external: 0.0, contact: 1.0 };
        stage.before = Weights::default();
        stage.acceleration.slope = 1.0 / (dt * dt);
        stage.acceleration.at_start.clear();
        stage.acceleration.at_start.extend(free.iter().map(|d| -d / (dt * dt)));
        known_into(model, &work.stage, state, &mut work.forces);
        solve_stage(model, state, &state.kept, &state.y, &self.newton, &mut trial, work)?;
        Ok(Some(trial.increment.iter().zip(&free).map(|(d, free)| d - free).collect()))
    }

    /// Fills `work.stage` with stage `k`.
    fn prepare<const D: usize>(&self, k: usize, dt: f64, state: &State, finished: &[Point], work: &mut Workspace<D>) {
        let mut states: Vec<(&[f64], &[f64], &[f64])> = vec![(&state.y, &state.v, &state.a)];
        states.extend(finished.iter().map(|p| (&p.y[..], &p.v[..], &p.a[..])));
        let previous = state.previous.as_ref().filter(|previous| previous.dt == dt);
        let before = previous.map(|p| Before { increment: &p.increment, velocity: &p.velocity });
        self.kernel.stage_into(k, dt, &Memory { states: &states, before }, &mut work.stage);
    }
}

/// Loads at the time the stage's internal forces are taken at, and the motions of supports at its end.
pub(super) fn begin<const D: usize>(
    model: &Model<D>,
    state: &State,
    to: f64,
    work: &mut Workspace<D>,
) -> Result<(), Rejected> {
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

/// Velocities and accelerations of the supports that move are their own, not the scheme's.
fn take_motions<const D: usize>(work: &Workspace<D>, next: &mut State) {
    for moved in work.motions.iter().filter(|_| !work.stage.is_static()) {
        [next.v[moved.dof], next.a[moved.dof]] = [moved.motion[1], moved.motion[2]];
    }
}

/// The guess of a stage from where the trial is: positions if the acceleration stayed for `dt`, multipliers as they are, each pair free to change
/// facets again.
fn go_on(v: &[f64], a: &[f64], dt: f64, trial: &mut Trial) {
    for i in 0..trial.increment.len() {
        let moved = dt * (v[i] + 0.5 * dt * a[i]);
        trial.increment[i] += moved;
        trial.y[i] += moved;
    }
    for pairs in &mut trial.pairs {
        // Open pairs are found afresh, so that they depend on positions alone.
        pairs.retain(|p| p.active);
        for pair in pairs {
            pair.left = None;
        }
    }
}

/// Whether any pair at the trial's positions penetrates.
fn penetrates<const D: usize>(model: &Model<D>, before: &[f64], trial: &mut Trial) -> Result<bool, Rejected> {
    let (before, now) = (before.as_chunks::<D>().0, trial.y.as_chunks::<D>().0);
    let mut gap = Linearised::default();
    for (contact, pairs) in model.contacts.iter().zip(&mut trial.pairs) {
        contact
            .method
            .detect(before, now, pairs, &mut Vec::new())
            .map_err(|error| Rejected::Contact { contact: contact.name.clone(), error })?;
        for pair in pairs {
            let found = contact.method.linearise(pair, now, 0.0, &mut gap);
            if found.is_ok() && gap.gap < -GAP_TOLERANCE * model.scale {
                return Ok(true);
            }
        }
    }
    Ok(false)
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
pub(crate) fn difference<const D: usize>(model: &Model<D>, a: &State, b: &State) -> Vec<(usize, usize)> {
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
