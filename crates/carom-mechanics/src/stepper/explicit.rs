//! Central differences with a lumped mass, contact by forward increments (Carpenter, Taylor, Katona 1991), and Paoli and Schatzman's law (2002).
//!
//! ```text
//! M (v_{n+½} − v_{n−½}) = Δt (f_n + G_nᵀP_n),   y_{n+1} = y_n + Δt v_{n+½}
//! 0 ≤ P_n ⊥ g(ȳ) ≥ 0,   ȳ = (y_{n+1} + e y_{n−1})/(1 + e),   central-difference: e = 0
//! ```
//!
//! P_n keeps y_{n+1} out, and is the force at t_n: it acts along G_n = ∇g(y_n), as in SHAKE (Ryckaert, Ciccotti, Berendsen 1977), so that force and moment
//! balance at t_n. With g linearised, P solves a small complementarity problem with G M⁻¹Gᵀ; the linearisation is repeated until every gap agrees to 1e-12 L.
//!
//! The state at t_n therefore looks ahead: it holds v_{n+½} and with it P_n, v_n = (v_{n−½} + v_{n+½})/2 = (y_{n+1} − y_{n−1})/2Δt, and a_n, and
//! M a_n + f_int − f_ext − G_nᵀP_n = 0 in every row of the record. Works and the impulse of contact are those of the trapezoidal rule, which is exact for momentum
//! and leaves, with R = M a,
//!
//! ```text
//! Δ dissipation = Δy·½(f_int,n + f_int,n+1) − ΔU − Δt²/8 Δ(a·M a)
//! ```
//!
//! The first step, and one of another size, begins anew: v_{n−½} := v_n − Δt/2 M⁻¹f_n, and a contact force at t_n then acts over a whole step.

use carom_algebra::complementarity;
use carom_contact::{Pairing, Rows};

use super::watch::{active, approach, carried, depth, gap_at, measure_into};
use super::{Accepted, StepReport, Stepper, difference};
use crate::constraints::independent_rows;
use crate::contact_update::{GAP_TOLERANCE, search};
use crate::ledger::{book_contact_forces, book_kinetic};
use crate::model::{LoadsAt, Model};
use crate::rejected::Rejected;
use crate::stability::lumped;
use crate::state::State;
use crate::workspace::{Workspace, timed};

/// Linearisations of the gaps in a step before it is rejected; two to five are usual.
const ROUNDS: u32 = 60;

/// The explicit stepper.
pub struct Explicit {
    /// 1/m per dof; zero where held.
    inverse_mass: Vec<f64>,
}

impl Explicit {
    /// A stepper for a model with lumped masses.
    pub fn new(model: &Model) -> Self {
        let inverse = |(mass, held): (f64, &bool)| if *held { 0.0 } else { mass.recip() };
        Self { inverse_mass: lumped(model).into_iter().zip(&model.fixed).map(inverse).collect() }
    }
}

impl Stepper for Explicit {
    fn step(&self, model: &Model, state: &State, dt: f64, to: f64, work: &mut Workspace) -> Result<Accepted, Rejected> {
        let mut report = StepReport::default();
        let mut begun;
        let start = if state.ahead.dt == dt {
            state
        } else {
            begun = state.clone();
            self.begin(model, &mut begun, dt, work, &mut report)?;
            &begun
        };
        let mut next = start.clone();
        for (y, v) in next.y.iter_mut().zip(&start.ahead.velocity) {
            *y += dt * v;
        }
        next.ledger.strain = timed(&mut work.timings.assembly, || model.internal_force(&next.y, &mut next.f_internal))
            .map_err(|(body, inverted)| Rejected::Inverted { body, inverted })?;
        model.loads_into(to, &next.y, &mut LoadsAt::default(), &mut next.f_external)?;
        next.time = to;
        self.look_ahead(model, &mut next, &start.ahead.velocity, dt, work, &mut report)?;

        // v_n is a mean of half steps: of M v·v/2 a load has made Δt²/8 f·M⁻¹f before its work is booked.
        let mut ahead = 0.0;
        for i in 0..next.y.len() {
            let (before, now) = (start.f_external[i], next.f_external[i]);
            ahead += 0.125 * dt * dt * self.inverse_mass[i] * (now * now - before * before);
            let force = 0.5 * (start.f_contact[i] + next.f_contact[i]);
            next.ledger.contact_work -= dt * start.ahead.velocity[i] * force;
            let load = 0.5 * (start.f_external[i] + next.f_external[i]);
            next.ledger.external_work += dt * start.ahead.velocity[i] * load;
        }
        for (before, now) in start.contact_forces.iter().zip(&next.contact_forces) {
            for i in 0..3 {
                next.ledger.impulse[i] += 0.5 * dt * (before[i] + now[i]);
            }
        }
        next.ledger.open += ahead;
        next.ledger.potential = model.potential(&next.y);
        book_kinetic(model, &mut next);

        report.activations = difference(model, &next, state);
        report.releases = difference(model, state, &next);
        // Positions were made admissible when they were looked ahead at; a node handed over since may be behind its new facet by a share of what it slid.
        let bound = depth(model, start) + approach(model, &start.ahead.velocity, dt);
        let deepest = depth(model, &next);
        Accepted::within(next, report, deepest, bound)
    }
}

impl Explicit {
    /// Makes `state` look ahead by a step of this size, from its positions and velocities alone.
    fn begin(
        &self,
        model: &Model,
        state: &mut State,
        dt: f64,
        work: &mut Workspace,
        report: &mut StepReport,
    ) -> Result<(), Rejected> {
        let free = |i: usize| self.inverse_mass[i] * (model.gravity[i] + state.f_external[i] - state.f_internal[i]);
        let before: Vec<f64> = (0..state.v.len()).map(|i| state.v[i] - 0.5 * dt * free(i)).collect();
        let (velocity, kinetic) = (state.v.clone(), state.ledger.kinetic);
        self.look_ahead(model, state, &before, dt, work, report)?;
        if state.pairs.iter().flatten().all(|p| !p.active) {
            // Without contact v_n is what it was, to the last bit.
            state.v = velocity;
        }
        // Half of the contact force's step lies before t_n: a jump there.
        book_kinetic(model, state);
        report.projection = state.ledger.kinetic - kinetic;
        state.ledger.contact_work += report.projection;
        for force in &state.contact_forces {
            for i in 0..3 {
                state.ledger.impulse[i] += 0.5 * dt * force[i];
            }
        }
        Ok(())
    }

    /// From y_n and f_int,n in `state` and v_{n−½}: contact forces, a_n, v_n and v_{n+½}.
    fn look_ahead(
        &self,
        model: &Model,
        state: &mut State,
        before: &[f64],
        dt: f64,
        work: &mut Workspace,
        report: &mut StepReport,
    ) -> Result<(), Rejected> {
        for i in 0..state.a.len() {
            state.a[i] = self.inverse_mass[i] * (model.gravity[i] + state.f_external[i] - state.f_internal[i]);
        }
        let mut ahead = std::mem::take(&mut state.ahead.velocity);
        let mut clock = 0.0;
        let (pairings, rows) = timed(&mut clock, || self.contact(model, state, before, dt, &mut ahead, report))?;
        work.timings.contact += clock;

        state.take_pairs(&pairings);
        state.f_contact.fill(0.0);
        for (k, p) in active(&pairings) {
            rows[k].row(p).add_to(pairings[k].pairs[p].lambda, &mut state.f_contact);
        }
        for i in 0..state.a.len() {
            state.a[i] -= self.inverse_mass[i] * state.f_contact[i];
            state.v[i] = before[i] + 0.5 * dt * state.a[i];
        }
        book_contact_forces(model, state);
        (state.ahead.velocity, state.ahead.dt) = (ahead, dt);
        Ok(())
    }

    /// Pairs with the forces that make y_n + Δt v_{n+½} admissible, and that velocity, with the rows whose gradients are those at y_n.
    fn contact(
        &self,
        model: &Model,
        state: &State,
        before: &[f64],
        dt: f64,
        ahead: &mut Vec<f64>,
        report: &mut StepReport,
    ) -> Result<(Vec<Pairing>, Vec<Rows>), Rejected> {
        let tolerance = GAP_TOLERANCE * model.scale;
        let free: Vec<f64> = before.iter().zip(&state.a).map(|(v, a)| v + dt * a).collect();
        let mut pairings = carried(model, state);
        let (mut rows, mut row) = (Vec::new(), Rows::new(model.dimension));
        let mut at = vec![0.0; free.len()];
        let mut impulses = Vec::new();
        ahead.clone_from(&free);
        for round in 0..=ROUNDS {
            let place = |e: f64, at: &mut [f64], ahead: &[f64]| {
                for i in 0..at.len() {
                    at[i] = state.y[i] + dt * (ahead[i] - e * before[i]) / (1.0 + e);
                }
            };
            place(0.0, &mut at, ahead);
            let changed = search(model, &state.y, &at, &mut pairings, &mut report.events);
            measure_into(model, &state.y, &mut pairings, &mut rows)?;
            // Gaps where the law looks, in the place of those at y_n; a pair that is wrong joins the working set and stays.
            let mut worst = 0.0_f64;
            for (k, contact) in model.contacts.iter().enumerate() {
                if contact.restitution != 0.0 {
                    place(contact.restitution, &mut at, ahead);
                }
                for (p, pair) in pairings[k].pairs.iter_mut().enumerate() {
                    let gap = rows[k].gap_mut(p);
                    if gap.is_finite() {
                        *gap = gap_at(contact, pair, &at, &mut row);
                    }
                    let wrong = if pair.lambda < 0.0 { gap.abs() } else { -*gap };
                    worst = worst.max(wrong);
                    pair.active |= wrong > tolerance;
                }
                if contact.restitution != 0.0 {
                    place(0.0, &mut at, ahead);
                }
            }
            if worst <= tolerance && !changed {
                break;
            }
            if round == ROUNDS {
                return Err(Rejected::Unsettled { rounds: ROUNDS, gap: worst });
            }
            if worst <= tolerance {
                continue;
            }
            report.newton += 1;
            let places = independent_rows(model, active(&pairings), &rows);
            let (matrix, right) = self.problem(model, &pairings, &rows, &places, dt);
            complementarity(&matrix, &right, &mut impulses)?;
            pairings.iter_mut().flat_map(|pairing| &mut pairing.pairs).for_each(|pair| pair.lambda = 0.0);
            at.fill(0.0);
            for (&(k, p), force) in places.iter().zip(&impulses) {
                pairings[k].pairs[p].lambda = -force;
                rows[k].row(p).add_to(*force, &mut at);
            }
            for i in 0..free.len() {
                ahead[i] = free[i] + dt * self.inverse_mass[i] * at[i];
            }
        }
        for (contact, pairing) in model.contacts.iter().zip(&mut pairings) {
            for pair in &mut pairing.pairs {
                pair.active = pair.lambda < 0.0;
                if pair.active {
                    // The contact point of the record is that of the force: at y_n.
                    gap_at(contact, pair, &state.y, &mut row);
                }
            }
        }
        Ok((pairings, rows))
    }

    /// G M⁻¹Gᵀ over the rows, and what it has to make of the linearised gaps: (1 + e) g/Δt² − G M⁻¹Gᵀ P.
    fn problem(
        &self,
        model: &Model,
        pairings: &[Pairing],
        rows: &[Rows],
        places: &[(usize, usize)],
        dt: f64,
    ) -> (Vec<f64>, Vec<f64>) {
        let count = places.len();
        let mut matrix = vec![0.0; count * count];
        let mut column = vec![0.0; self.inverse_mass.len()];
        for (j, &(k, p)) in places.iter().enumerate() {
            let row = rows[k].row(p);
            for (dof, slope) in row.entries() {
                column[dof] = self.inverse_mass[dof] * slope;
            }
            for (i, &(l, q)) in places.iter().enumerate() {
                matrix[i * count + j] = rows[l].row(q).along(&column);
            }
            row.entries().for_each(|(dof, _)| column[dof] = 0.0);
        }
        let right = places.iter().enumerate().map(|(i, &(k, p))| {
            let force = |&(l, q): &(usize, usize)| pairings[l].pairs[q].lambda;
            let done: f64 = places.iter().enumerate().map(|(j, place)| -matrix[i * count + j] * force(place)).sum();
            (1.0 + model.contacts[k].restitution) * rows[k].row(p).gap / (dt * dt) - done
        });
        let right = right.collect();
        (matrix, right)
    }
}
