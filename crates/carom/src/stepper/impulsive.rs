//! Schemes whose contact is an impulse (Moreau and Jean's θ-method, the nonsmooth generalised α): Newton on d with the complementarity of impulses and
//! velocities inside.
//!
//! ```text
//! w.mass M a(d) + w.internal f_int − w.external f_ext + known − s GᵀP = 0            s, c: carom_time::ImpulseShares
//! 0 ≤ G v_{n+1} + e G v_n ⊥ P ≥ 0,   v_{n+1} = v(d) + c M⁻¹GᵀP
//! ```
//!
//! G and the gaps that decide who takes part are those at the predicted positions. In each iteration, with K the tangent of the balance at P = 0,
//!
//! ```text
//! d := d − K⁻¹r₀ + s K⁻¹GᵀP,    G v_{n+1} = b + D P,    D = v' s G K⁻¹Gᵀ + c G M⁻¹Gᵀ
//! ```
//!
//! so that P solves a small complementarity problem, exactly, and Newton's method converges as without contact. D is symmetric and positive definite.
//! Velocities are held, not positions: a node penetrates by up to Δt times its speed when it arrives, and that is recorded as it is.

use carom_algebra::complementarity;
use carom_contact::{Linearised, PairEvent};
use carom_time::{Impulse, ImpulseShares, Memory};

use super::implicit::{begin, difference};
use super::watch::{along, approach, carried, depth, gradients_into, look};
use super::{Accepted, StepReport, Stepper};
use crate::balance::{known_into, residual_into};
use crate::case::NewtonSpec;
use crate::evaluation::{Trial, add_gradient, follower_factor, mass_factor, round_off, stiffness_factor};
use crate::ledger::{book_kinetic, open_work, work_of_loads};
use crate::model::Model;
use crate::newton::{NEARLY_THERE, max_abs};
use crate::rejected::Rejected;
use crate::rows::independent_rows;
use crate::state::State;
use crate::workspace::{Workspace, timed};

/// A predicted gap above minus this fraction of L is open: at a tie round-off must not decide.
const TIE: f64 = 1e-10;
/// Halvings of a Newton step that inverts a cell.
const HALVINGS: usize = 8;

/// The stepper of impulses.
pub struct Impulsive {
    scheme: Box<dyn Impulse>,
    newton: NewtonSpec,
}

/// The contacts that take part in a step, and their impulses.
struct Rows<const D: usize> {
    /// Contact and pair.
    places: Vec<(usize, usize)>,
    /// Gradients at the predicted positions.
    gaps: Vec<Linearised<D>>,
    /// e of each.
    restitution: Vec<f64>,
    /// G v_n.
    before: Vec<f64>,
    /// P ≥ 0.
    impulses: Vec<f64>,
    /// M⁻¹Gᵀ, where the scheme needs it.
    released: Vec<Vec<f64>>,
}

impl Impulsive {
    /// A stepper of a scheme.
    pub fn new(scheme: Box<dyn Impulse>, newton: NewtonSpec) -> Self {
        Self { scheme, newton }
    }
}

impl<const D: usize> Stepper<D> for Impulsive {
    fn step(
        &self,
        model: &Model<D>,
        state: &State,
        dt: f64,
        to: f64,
        work: &mut Workspace<D>,
    ) -> Result<Accepted, Rejected> {
        let mut stage = std::mem::take(&mut work.stage);
        let memory = Memory { states: &[(&state.y, &state.v, &state.a)], before: None };
        self.scheme.stage_into(0, dt, &memory, &mut stage);
        let shares = self.scheme.shares(dt);
        work.stage = stage;
        begin(model, state, to, work)?;
        known_into(model, &work.stage, state, &mut work.forces);

        let mut report = StepReport::default();
        let mut trial = Trial { y: state.y.clone(), pairs: carried(model, state), ..Trial::default() };
        trial.increment = (0..state.v.len()).map(|i| dt * (state.v[i] + 0.5 * dt * state.a[i])).collect();
        let by_solving = self.scheme.predicts_by_solving();
        let mut rows = Rows::none();
        if by_solving {
            report.newton += self.solve(model, state, shares, &mut trial, &mut rows, work)?;
        } else {
            trial.y.iter_mut().zip(&state.v).for_each(|(y, v)| *y += 0.5 * dt * v);
        }
        let mut clock = 0.0;
        rows = timed(&mut clock, || Rows::closed(model, state, shares, &mut trial, &mut report.events, work))?;
        work.timings.contact += clock;
        if !(by_solving && rows.places.is_empty()) {
            report.newton += self.solve(model, state, shares, &mut trial, &mut rows, work)?;
        }

        let mut next = state.clone();
        next.time = to;
        next.y.clone_from(&trial.y);
        work.stage.velocity.value_into(&trial.increment, &mut next.v);
        work.stage.acceleration.value_into(&trial.increment, &mut next.a);
        rows.release(&mut next.v, shares.velocity);
        rows.release(&mut next.a, -shares.acceleration);
        next.f_internal.clone_from(&work.forces.internal);
        next.f_external.clone_from(&work.forces.loads);
        next.ledger.external_work += work_of_loads(model, state, &trial.increment, work);
        next.ledger.strain = trial.strain;
        if work.stage.average != 0.0 {
            next.ledger.strain = model
                .internal_force(&next.y, &mut next.f_internal)
                .map_err(|(body, inverted)| Rejected::Inverted { body, inverted })?;
            model.loads_into(to, &next.y, &mut work.loads, &mut next.f_external)?;
        }
        next.ledger.open += open_work(state, &next, &trial.increment);
        rows.book(dt, &mut trial, &mut next);
        next.pairs = trial.pairs;
        // Nodes that came in later in the step than was looked at are watched from now on.
        gradients_into(model, &next.y, &mut next.pairs, &mut work.gaps)?;
        look(model, &state.y, &next.y, &mut next.pairs, &mut report.events)?;
        next.pairs.iter_mut().flatten().for_each(|pair| pair.active = pair.lambda < 0.0);
        next.ledger.potential = model.potential(&next.y);
        book_kinetic(model, &mut next);

        report.activations = difference(model, &next, state);
        report.releases = difference(model, state, &next);
        let tie = 2.0 * TIE * model.scale;
        let bound = depth(model, state) + approach::<D>(&state.v, dt).max(approach::<D>(&next.v, dt)) + tie;
        let deepest = depth(model, &next);
        Accepted::within(next, report, deepest, bound)
    }
}

impl Impulsive {
    /// Newton's method on `trial.increment` and the impulses of `rows`; its iterations.
    fn solve<const D: usize>(
        &self,
        model: &Model<D>,
        state: &State,
        shares: ImpulseShares,
        trial: &mut Trial,
        rows: &mut Rows<D>,
        work: &mut Workspace<D>,
    ) -> Result<u32, Rejected> {
        let dofs = model.dofs();
        let mut residual = vec![0.0; dofs];
        let mut correction = vec![0.0; dofs];
        let mut columns = vec![vec![0.0; dofs]; rows.places.len()];
        let (mut saved, mut impulses) = (Vec::new(), rows.impulses.clone());
        let (mut iterations, mut step, mut has_tangent) = (0, f64::INFINITY, true);
        let mut forces = evaluate(model, state, shares, trial, rows, &mut residual, work, true)?;
        loop {
            let size = model.free.iter().map(|&i| residual[i] * residual[i]).sum::<f64>().sqrt();
            if step <= self.newton.tolerance * model.scale
                && size <= self.newton.tolerance * forces + round_off(model, work)
            {
                return Ok(iterations);
            }
            if iterations as usize >= self.newton.max_iterations {
                let (step, residual) = (step / model.scale, size / forces.max(f64::MIN_POSITIVE));
                return Err(Rejected::NoConvergence { iterations, step, residual });
            }
            if !has_tangent {
                evaluate(model, state, shares, trial, rows, &mut residual, work, true)?;
            }
            let stage = &work.stage;
            let (mass, stiffness, follower) = (mass_factor(stage), stiffness_factor(stage), follower_factor(stage));
            timed(&mut work.timings.factor, || work.system.factor(model, mass, stiffness, follower, &[]))?;
            // −r₀: the residual without the impulses, which were in work.forces.contact.
            for (r, contact) in residual.iter_mut().zip(&work.forces.contact) {
                *r = contact - *r;
            }
            let mut clock = 0.0;
            timed(&mut clock, || -> Result<(), Rejected> {
                let none = &mut Vec::new();
                work.system.solve(model, &residual, &[], &mut correction, none)?;
                for (gap, column) in rows.gaps.iter().zip(&mut columns) {
                    residual.fill(0.0);
                    add_gradient(gap, 1.0, &mut residual);
                    work.system.solve(model, &residual, &[], column, none)?;
                }
                Ok(())
            })?;
            work.timings.solve += clock;
            impulses_into(shares, trial, rows, &correction, &columns, work, &mut impulses)?;
            for (column, impulse) in columns.iter().zip(&impulses) {
                for (x, c) in correction.iter_mut().zip(column) {
                    *x += shares.force * impulse * c;
                }
            }
            step = max_abs(&correction);
            iterations += 1;
            has_tangent = step > NEARLY_THERE * model.scale;
            saved.clone_from(&trial.increment);
            let old = std::mem::replace(&mut rows.impulses, impulses.clone());
            let mut length = 1.0;
            for halving in 0..=HALVINGS {
                for i in 0..dofs {
                    trial.increment[i] = saved[i] + length * correction[i];
                }
                for (now, (old, new)) in rows.impulses.iter_mut().zip(old.iter().zip(&impulses)) {
                    *now = old + length * (new - old);
                }
                match evaluate(model, state, shares, trial, rows, &mut residual, work, has_tangent) {
                    Ok(measured) => {
                        forces = measured;
                        break;
                    }
                    Err(rejected) if halving == HALVINGS => return Err(rejected),
                    Err(_) => length *= 0.5,
                }
            }
        }
    }
}

/// P of the linearised step: b and D from the answers to −r₀ and to each row.
#[allow(clippy::too_many_arguments)]
fn impulses_into<const D: usize>(
    shares: ImpulseShares,
    trial: &Trial,
    rows: &Rows<D>,
    correction: &[f64],
    columns: &[Vec<f64>],
    work: &Workspace<D>,
    impulses: &mut Vec<f64>,
) -> Result<(), Rejected> {
    let count = rows.places.len();
    let velocity = &work.stage.velocity;
    let end: Vec<f64> = (0..correction.len())
        .map(|i| velocity.slope * (trial.increment[i] + correction[i]) + velocity.at_start[i])
        .collect();
    let mut matrix = vec![0.0; count * count];
    let mut right = vec![0.0; count];
    for (i, gap) in rows.gaps.iter().enumerate() {
        right[i] = along(gap, &end) + rows.restitution[i] * rows.before[i];
        for j in 0..=i {
            let direct = rows.released.get(j).map_or(0.0, |r| shares.velocity * along(gap, r));
            matrix[i * count + j] = velocity.slope * shares.force * along(gap, &columns[j]) + direct;
        }
    }
    Ok(complementarity(&matrix, &right, impulses)?)
}

/// Forces and residual at the trial, and the tangent of the bodies if asked for; the sum of the norms of the forces is returned.
#[allow(clippy::too_many_arguments)]
fn evaluate<const D: usize>(
    model: &Model<D>,
    state: &State,
    shares: ImpulseShares,
    trial: &mut Trial,
    rows: &Rows<D>,
    residual: &mut [f64],
    work: &mut Workspace<D>,
    tangent: bool,
) -> Result<f64, Rejected> {
    let share = 1.0 - work.stage.average;
    for i in 0..trial.y.len() {
        trial.y[i] = state.y[i] + trial.increment[i];
        residual[i] = state.y[i] + share * trial.increment[i];
    }
    let (system, force) = (&mut work.system, &mut work.forces.internal);
    trial.strain = timed(&mut work.timings.assembly, || {
        if tangent {
            system.internal_tangent(model, None, residual, force, None)
        } else {
            model.internal_force(residual, force)
        }
    })
    .map_err(|(body, inverted)| Rejected::Inverted { body, inverted })?;
    if !model.loads.is_empty() {
        model.loads.force_into(&work.loads, residual, &mut work.forces.loads);
    }
    work.stage.acceleration.value_into(&trial.increment, &mut work.acceleration);
    model.mass.multiply_into(&work.acceleration, &mut work.forces.inertia);
    work.forces.contact.fill(0.0);
    for (gap, impulse) in rows.gaps.iter().zip(&rows.impulses) {
        add_gradient(gap, -shares.force * impulse, &mut work.forces.contact);
    }
    Ok(residual_into(model, &work.stage, &work.forces, residual))
}

impl<const D: usize> Rows<D> {
    fn none() -> Self {
        Self {
            places: Vec::new(),
            gaps: Vec::new(),
            restitution: Vec::new(),
            before: Vec::new(),
            impulses: Vec::new(),
            released: Vec::new(),
        }
    }

    /// The pairs whose gap is closed at the predicted positions, `trial.y`.
    fn closed(
        model: &Model<D>,
        state: &State,
        shares: ImpulseShares,
        trial: &mut Trial,
        events: &mut Vec<(usize, PairEvent)>,
        work: &mut Workspace<D>,
    ) -> Result<Self, Rejected> {
        look(model, &state.y, &trial.y, &mut trial.pairs, events)?;
        gradients_into(model, &trial.y, &mut trial.pairs, &mut work.gaps)?;
        for (pairs, gaps) in trial.pairs.iter_mut().zip(&work.gaps) {
            for (pair, gap) in pairs.iter_mut().zip(gaps) {
                pair.active = gap.gap < -TIE * model.scale;
            }
        }
        let places = independent_rows(model, &trial.pairs, work);
        let gaps: Vec<Linearised<D>> = places.iter().map(|&(k, p)| work.gaps[k][p].clone()).collect();
        let mut released = Vec::new();
        if !gaps.is_empty() && (shares.velocity != 0.0 || shares.acceleration != 0.0) {
            work.system.factor_mass(model, &[])?;
            let mut force = vec![0.0; model.dofs()];
            for gap in &gaps {
                force.fill(0.0);
                add_gradient(gap, 1.0, &mut force);
                let mut column = vec![0.0; model.dofs()];
                work.system.solve(model, &force, &[], &mut column, &mut Vec::new())?;
                released.push(column);
            }
        }
        Ok(Self {
            restitution: places.iter().map(|&(k, _)| model.contacts[k].restitution).collect(),
            before: gaps.iter().map(|gap| along(gap, &state.v)).collect(),
            impulses: vec![0.0; places.len()],
            places,
            gaps,
            released,
        })
    }

    /// x += factor M⁻¹GᵀP.
    fn release(&self, x: &mut [f64], factor: f64) {
        for (column, impulse) in self.released.iter().zip(&self.impulses) {
            for (x, c) in x.iter_mut().zip(column) {
                *x += factor * impulse * c;
            }
        }
    }

    /// Impulses into the pairs, as the forces −λ = P/Δt, and into the ledger: work ½(Gv⁻ + Gv⁺)·P.
    fn book(&self, dt: f64, trial: &mut Trial, next: &mut State) {
        trial.pairs.iter_mut().flatten().for_each(|pair| pair.lambda = 0.0);
        next.contact_forces.fill([0.0; 2]);
        for (r, (&(k, p), impulse)) in self.places.iter().zip(&self.impulses).enumerate() {
            trial.pairs[k][p].lambda = -impulse / dt;
            for i in 0..D.min(2) {
                let along_axis = impulse * self.gaps[r].gradient[0][i];
                next.contact_forces[k][i] += along_axis / dt;
                next.ledger.impulse[i] += along_axis;
            }
            next.ledger.contact_work += 0.5 * impulse * (self.before[r] + along(&self.gaps[r], &next.v));
        }
    }
}
