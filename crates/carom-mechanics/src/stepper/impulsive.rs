//! Schemes whose contact is an impulse (Moreau and Jean's θ-method, the nonsmooth generalised α):
//! Newton on d with the complementarity of impulses and velocities inside.
//!
//! ```text
//! w.mass M a(d) + w.internal f_int − w.external f_ext + known − s GᵀP = 0            s, c: carom_time::ImpulseShares
//! 0 ≤ G v_{n+1} + e G v_n ⊥ P ≥ 0,   v_{n+1} = v(d) + c M⁻¹GᵀP
//! ```
//!
//! G and the gaps that select the contacts are those at the predicted positions. In each iteration,
//! with K the tangent of the balance at P = 0,
//!
//! ```text
//! d := d − K⁻¹r₀ + s K⁻¹GᵀP,    G v_{n+1} = b + D P,    D = v' s G K⁻¹Gᵀ + c G M⁻¹Gᵀ
//! ```
//!
//! so that P solves a small complementarity problem (`impulses.rs`), exactly, and Newton's method
//! converges as without contact. K and K⁻¹Gᵀ are kept while corrections shrink well. Velocities are
//! constrained, not positions: an arriving node penetrates by up to Δt times its speed, which is
//! recorded as it is.

use carom_algebra::sums::{dot, max_abs};
use carom_contact::{Pairing, Rows, Tangential};
use carom_time::{Impulse, ImpulseShares, Memory, Stage};

use super::finish::Finish;
use super::impulses::{Impulses, TIE};
use super::meetings::Path;
use super::watch::{approach, carry_into, depth, measure_into};
use super::{Accepted, StepReport, Stepper};
use crate::check::skins::length;
use crate::check::watched::has_gaps;
use crate::contact::constraints::Constraints;
use crate::contact::depths::gap_at;
use crate::contact::update::search;
use crate::ledger::{book_kinetic, book_materials, change_of_loads};
use crate::model::{LoadsAt, Model};
use crate::rejected::Rejected;
use crate::settings::{Settings, Tangent};
use crate::stage::balance::residual_into;
use crate::stage::equations::Equations;
use crate::stage::evaluation::{Evaluation, Iterate};
use crate::state::State;
use crate::timings::timed;
use crate::trace::Iteration;
use crate::works::{Works, at_both_ends, work_ahead};
use crate::workspace::Workspace;
use carom_solid::Configuration;

/// Share of the allowed depth by which a node may sink in a step.
const SINKS: f64 = 0.1;
/// Ratio of two corrections above which the next one has a tangent of its own: K⁻¹Gᵀ costs as many
/// solves as there are impulses.
const RENEWAL: f64 = 0.1;
/// Bisections of a Newton step that inverts a cell.
const BISECTIONS: usize = 8;

/// The stepper of impulse schemes.
pub struct Impulsive {
    scheme: Box<dyn Impulse>,
    settings: Settings,
}

impl Impulsive {
    /// A stepper for a scheme.
    pub fn new(scheme: Box<dyn Impulse>, settings: Settings) -> Self {
        Self { scheme, settings }
    }
}

impl Stepper for Impulsive {
    fn accelerates_freely(&self) -> bool {
        true
    }

    fn step(
        &self,
        model: &Model,
        state: &State,
        dt: f64,
        to: f64,
        work: &mut Workspace,
    ) -> Result<Accepted, Rejected> {
        let mut stage = Stage::default();
        let memory = Memory { states: &[(&state.y, &state.v, &state.a)], before: None };
        self.scheme.stage_into(0, dt, &memory, &mut stage);
        let shares = self.scheme.shares(dt);
        let equations = Equations::new(model, state, stage, to)?;

        let mut report = StepReport::default();
        let mut pairings = Vec::new();
        carry_into(model, state, Pairing::new, &mut pairings);
        let mut increment: Vec<f64> =
            (0..state.v.len()).map(|i| dt * (state.v[i] + 0.5 * dt * state.a[i])).collect();
        let mut impulses = Impulses::none(model.dimension);
        let mut solved = None;
        let predicted: Vec<f64> = if self.scheme.predicts_by_solving() {
            let free = solve(
                &self.settings,
                &equations,
                shares,
                increment.clone(),
                &mut impulses,
                &mut report.newton,
                work,
            )?;
            increment.clone_from(&free.at.increment);
            let predicted = free.y.clone();
            solved = Some(free);
            predicted
        } else {
            state.y.iter().zip(&state.v).map(|(y, v)| y + 0.5 * dt * v).collect()
        };
        let mut clock = 0.0;
        timed(&mut clock, || {
            if search(model, &state.y, &predicted, &mut pairings, &mut report.events) {
                // A node that has just met a facet may have passed it.
                measure_into(model, &predicted, &mut pairings, &mut Vec::new())?;
                search(model, &state.y, &predicted, &mut pairings, &mut report.events);
            }
            impulses = Impulses::closed(model, (state, dt), shares, &predicted, &mut pairings, work)?;
            Ok::<(), Rejected>(())
        })?;
        work.timings.contact += clock;
        let solved = match solved {
            Some(free) if impulses.rows.is_empty() => free,
            _ => {
                solve(&self.settings, &equations, shares, increment, &mut impulses, &mut report.newton, work)?
            }
        };

        let mut next = work.copy(state);
        next.time = to;
        next.y.clone_from(&solved.y);
        equations.stage.velocity.value_into(&solved.at.increment, &mut next.v);
        equations.stage.acceleration.value_into(&solved.at.increment, &mut next.a);
        impulses.release(&mut next.v, shares.velocity);
        impulses.release(&mut next.a, -shares.acceleration);
        next.jumps.clear();
        if shares.acceleration != 0.0 {
            next.jumps.resize(next.a.len(), 0.0);
            impulses.release(&mut next.jumps, 1.0 / dt);
        }
        // Impulses take the place of contact forces: those of a start from another run are over.
        next.f_contact.fill(0.0);
        next.f_friction.fill(0.0);
        next.f_internal.clone_from(&solved.forces.internal);
        next.f_external.clone_from(&solved.forces.loads);
        let loads = next.f_external.clone();
        next.ledger.strain = solved.strain;
        next.materials.accept(&solved.materials);
        if equations.stage.average != 0.0 {
            let past = state.materials.past(dt);
            let reached = Configuration { before: None, y: &next.y, past };
            next.ledger.strain = model
                .internal_force(&reached, &mut next.f_internal, &mut next.materials)
                .map_err(|(body, inverted)| Rejected::Inverted { body, inverted })?;
            model.loads_into(to, &next.y, &mut LoadsAt::default(), &mut next.f_external)?;
        }
        book_materials(&mut next);
        let increment = &solved.at.increment;
        if equations.stage.works_at_both_ends {
            next.ledger.external_work += at_both_ends(increment, &state.f_external, &next.f_external);
            let changes = [change_of_loads(state, &next, increment), 0.0];
            let relaxing = &mut next.ledger.relaxing;
            next.ledger.unbooked += work_ahead(&equations.stage, dt, changes, relaxing);
        } else {
            next.ledger.external_work += dot(increment, &loads);
        }
        impulses.record(dt, &mut next, &mut pairings);
        let node = |(k, p): (usize, usize)| (k, model.contacts[k].node(&pairings[k].pairs[p]));
        let dependent = impulses.with_arbitrary_friction(model).into_iter().map(node).collect();
        report.dependent.extend(work.tell(dependent));
        // Nodes that arrived later in the step than the prediction are tracked from now on.
        measure_into(model, &next.y, &mut pairings, &mut Vec::new())?;
        search(model, &state.y, &next.y, &mut pairings, &mut report.events);
        next.take_pairs(&pairings);
        for pair in next.pairs.iter_mut().flatten() {
            pair.active = pair.lambda < 0.0;
            if !pair.active {
                pair.tangential = Tangential::default();
            }
        }
        next.ledger.potential = model.potential(&next.y);
        book_kinetic(model, &mut next);
        work.spare.put(solved);

        sinks_slowly(model, state, &next)?;
        let tie = 2.0 * TIE * model.scale;
        let fastest = approach(model, &state.v, dt).max(approach(model, &next.v, dt));
        let leaves = Some(depth(model, state) + fastest + tie);
        let paths = vec![Path { start: [&state.y, &state.v, &state.a], from: state.time, to }];
        Finish {
            model,
            start: state,
            dt,
            carried: 0.0,
            leads: [0.0; 2],
            means: false,
            impulses: Works::default(),
            paths,
            previous: None,
            leaves,
        }
        .accept(next, report, work)
    }
}

/// Newton's method on the increment and the impulses; adds to `iterations`.
pub(super) fn solve(
    settings: &Settings,
    equations: &Equations,
    shares: ImpulseShares,
    increment: Vec<f64>,
    impulses: &mut Impulses,
    iterations: &mut u32,
    work: &mut Workspace,
) -> Result<Evaluation, Rejected> {
    let model = equations.model;
    let dofs = model.dofs();
    let none = Constraints::none(model.dimension);
    let mut right = vec![0.0; dofs];
    let mut correction = vec![0.0; dofs];
    let mut columns = vec![vec![0.0; dofs]; impulses.rows.len()];
    let mut target = impulses.values.clone();
    let mut step = f64::INFINITY;
    let mut due = true;
    work.trace.start();
    let mut now = evaluate(equations, shares, increment, impulses, work)?;
    for iteration in 0.. {
        let size = now.measure.residual;
        let forces = now.measure.forces;
        let iterate = Iteration {
            number: iteration as u32,
            residual: size / forces.max(f64::MIN_POSITIVE),
            correction: step / model.scale,
            active: impulses.values.iter().filter(|impulse| **impulse > 0.0).count() as u32,
            ..Iteration::default()
        };
        work.trace.push(iterate, &now.y);
        if step <= settings.tolerance * model.scale
            && size <= settings.tolerance * forces + work.system.round_off(equations)
        {
            return Ok(now);
        }
        if iteration >= settings.max_iterations {
            work.trace.blame(&now.residual, &model.free);
            let tolerance = settings.tolerance;
            let allowed = tolerance * forces + work.system.round_off(equations);
            return Err(Rejected::NoConvergence {
                iterations: iteration as u32,
                step: [step / model.scale, tolerance],
                residual: [size, allowed].map(|r| r / forces.max(f64::MIN_POSITIVE)),
                gap: None,
                unbalanced: false,
                changing: false,
            });
        }
        *iterations += 1;
        let Workspace { system, timings, .. } = work;
        let renewed = std::mem::replace(&mut due, settings.tangent == Tangent::Full);
        if renewed {
            let point = equations.point(&now.place, &[]);
            timed(&mut timings.factor, || -> Result<(), Rejected> {
                system.tangent_at(model, &point, true)?;
                Ok(system.preconditioner.prepare(model, &none).map(|_| ())?)
            })?;
        }
        // −r₀: the residual without the impulses.
        for (right, (contact, r)) in right.iter_mut().zip(now.forces.contact.iter().zip(&now.residual)) {
            *right = contact - r;
        }
        timed(&mut timings.solve, || -> Result<(), Rejected> {
            let multipliers = &mut Vec::new();
            system.solve(model, [&right, &[]], &mut correction, multipliers)?;
            if !renewed {
                return Ok(());
            }
            for (row, column) in impulses.rows.rows.iter().zip(&mut columns) {
                right.fill(0.0);
                row.add_to(1.0, &mut right);
                system.solve(model, [&right, &[]], column, multipliers)?;
            }
            Ok(())
        })?;
        impulses.solve(equations, shares, &now, &correction, &columns, &mut target)?;
        for (column, impulse) in columns.iter().zip(&target) {
            for (x, c) in correction.iter_mut().zip(column) {
                *x += shares.force * impulse * c;
            }
        }
        let last = std::mem::replace(&mut step, max_abs(&correction));
        due |= step > RENEWAL * last;
        let old = impulses.values.clone();
        let mut length = 1.0;
        for bisection in 0..=BISECTIONS {
            let moved = now.at.increment.iter().zip(&correction).map(|(d, c)| d + length * c).collect();
            for (value, (old, new)) in impulses.values.iter_mut().zip(old.iter().zip(&target)) {
                *value = old + length * (new - old);
            }
            match evaluate(equations, shares, moved, impulses, work) {
                Ok(next) => {
                    work.spare.put(std::mem::replace(&mut now, next));
                    break;
                }
                Err(rejected) if bisection == BISECTIONS => return Err(rejected),
                Err(_) => {
                    length *= 0.5;
                    work.trace.shorten(length);
                }
            }
        }
    }
    Ok(now)
}

/// The law leaves the penetration of the step in which contact begins, and what facets turn: a step
/// in which a node sinks by too much of the allowed depth is too long.
///
/// # Errors
/// A node in contact sinks by more.
fn sinks_slowly(model: &Model, before: &State, now: &State) -> Result<(), Rejected> {
    let mut row = Rows::new(model.dimension);
    for (k, contact) in model.contacts.iter().enumerate().filter(|(_, contact)| !has_gaps(model, contact)) {
        for pair in now.pairs[k].iter().filter(|pair| pair.active) {
            let [start, end] = [before, now].map(|at| -gap_at(contact, &mut pair.clone(), &at.y, &mut row));
            let depth = end - start.max(0.0);
            let bound = SINKS * contact.depths.kinks * length(model, contact.kinematics.facet_nodes(pair));
            if depth > bound {
                return Err(Rejected::Deep { depth, bound });
            }
        }
    }
    Ok(())
}

/// Forces and residual at an increment, with the impulses as contact forces.
fn evaluate(
    equations: &Equations,
    shares: ImpulseShares,
    increment: Vec<f64>,
    impulses: &Impulses,
    work: &mut Workspace,
) -> Result<Evaluation, Rejected> {
    let model = equations.model;
    let mut now = equations.evaluate(
        Iterate { increment, ..Iterate::default() },
        &mut work.spare,
        &mut work.timings,
    )?;
    for (row, impulse) in impulses.rows.rows.iter().zip(&impulses.values) {
        row.add_to(-shares.force * impulse, &mut now.forces.contact);
    }
    let norms = residual_into(model, &equations.stage, &now.forces, &equations.known, &mut now.residual);
    (now.measure.residual, now.measure.forces) = norms;
    Ok(now)
}
