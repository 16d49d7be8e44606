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
use carom_contact::{Pair, PairEvent};

use super::implicit::difference;
use super::watch::{along, approach, carried, depth, gap_at, gradients_into, look};
use super::{Accepted, StepReport, Stepper};
use crate::evaluation::add_gradient;
use crate::ledger::{book_contact_forces, book_kinetic};
use crate::model::Model;
use crate::rejected::Rejected;
use crate::rows::independent_rows;
use crate::stability::lumped;
use crate::state::State;
use crate::touching::GAP_TOLERANCE;
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
    pub fn new<const D: usize>(model: &Model<D>) -> Self {
        let inverse = |(mass, held): (f64, &bool)| if *held { 0.0 } else { mass.recip() };
        Self { inverse_mass: lumped(model).into_iter().zip(&model.fixed).map(inverse).collect() }
    }
}

impl<const D: usize> Stepper<D> for Explicit {
    fn step(
        &self,
        model: &Model<D>,
        state: &State,
        dt: f64,
        to: f64,
        work: &mut Workspace<D>,
    ) -> Result<Accepted, Rejected> {
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
        model.loads_into(to, &next.y, &mut work.loads, &mut next.f_external)?;
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
            for i in 0..2 {
                next.ledger.impulse[i] += 0.5 * dt * (before[i] + now[i]);
            }
        }
        next.ledger.open += ahead;
        next.ledger.potential = model.potential(&next.y);
        book_kinetic(model, &mut next);

        report.activations = difference(model, &next, state);
        report.releases = difference(model, state, &next);
        // Positions were made admissible when they were looked ahead at; a node handed over since may be behind its new facet by a share of what it slid.
        let bound = depth(model, start) + approach::<D>(&start.ahead.velocity, dt);
        let deepest = depth(model, &next);
        Accepted::within(next, report, deepest, bound)
    }
}

impl Explicit {
    /// Makes `state` look ahead by a step of this size, from its positions and velocities alone.
    fn begin<const D: usize>(
        &self,
        model: &Model<D>,
        state: &mut State,
        dt: f64,
        work: &mut Workspace<D>,
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
            for i in 0..2 {
                state.ledger.impulse[i] += 0.5 * dt * force[i];
            }
        }
        Ok(())
    }

    /// From y_n and f_int,n in `state` and v_{n−½}: contact forces, a_n, v_n and v_{n+½}.
    fn look_ahead<const D: usize>(
        &self,
        model: &Model<D>,
        state: &mut State,
        before: &[f64],
        dt: f64,
        work: &mut Workspace<D>,
        report: &mut StepReport,
    ) -> Result<(), Rejected> {
        for i in 0..state.a.len() {
            state.a[i] = self.inverse_mass[i] * (model.gravity[i] + state.f_external[i] - state.f_internal[i]);
        }
        let mut ahead = std::mem::take(&mut state.ahead.velocity);
        let mut clock = 0.0;
        state.pairs = timed(&mut clock, || {
            self.contact(model, state, before, dt, &mut ahead, work, &mut report.events, &mut report.newton)
        })?;
        work.timings.contact += clock;

        state.f_contact.fill(0.0);
        for (pairs, gaps) in state.pairs.iter().zip(&work.gaps) {
            for (pair, gap) in pairs.iter().zip(gaps).filter(|(pair, _)| pair.active) {
                add_gradient(gap, pair.lambda, &mut state.f_contact);
            }
        }
        for i in 0..state.a.len() {
            state.a[i] -= self.inverse_mass[i] * state.f_contact[i];
            state.v[i] = before[i] + 0.5 * dt * state.a[i];
        }
        book_contact_forces(model, state);
        (state.ahead.velocity, state.ahead.dt) = (ahead, dt);
        Ok(())
    }

    /// Pairs with the forces that make y_n + Δt v_{n+½} admissible, and that velocity. `work.gaps` holds their gradients at y_n.
    #[allow(clippy::too_many_arguments)]
    fn contact<const D: usize>(
        &self,
        model: &Model<D>,
        state: &State,
        before: &[f64],
        dt: f64,
        ahead: &mut Vec<f64>,
        work: &mut Workspace<D>,
        events: &mut Vec<(usize, PairEvent)>,
        rounds: &mut u32,
    ) -> Result<Vec<Vec<Pair>>, Rejected> {
        let tolerance = GAP_TOLERANCE * model.scale;
        let free: Vec<f64> = before.iter().zip(&state.a).map(|(v, a)| v + dt * a).collect();
        let mut pairs = carried(model, state);
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
            let changed = look(model, &state.y, &at, &mut pairs, events)?;
            gradients_into(model, &state.y, &mut pairs, &mut work.gaps)?;
            // Gaps where the law looks, in the place of those at y_n; a pair that is wrong joins the working set and stays.
            let mut worst = 0.0_f64;
            for (k, contact) in model.contacts.iter().enumerate() {
                place(contact.restitution, &mut at, ahead);
                for (pair, gap) in pairs[k].iter_mut().zip(&mut work.gaps[k]) {
                    gap.gap = if gap.gap.is_finite() { gap_at(contact, pair, &at) } else { gap.gap };
                    let wrong = if pair.lambda < 0.0 { gap.gap.abs() } else { -gap.gap };
                    worst = worst.max(wrong);
                    pair.active |= wrong > tolerance;
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
            *rounds += 1;
            let rows = independent_rows(model, &pairs, work);
            let (matrix, right) = self.problem(model, &pairs, &rows, dt, work);
            complementarity(&matrix, &right, &mut impulses)?;
            pairs.iter_mut().flatten().for_each(|pair| pair.lambda = 0.0);
            at.fill(0.0);
            for (&(k, p), force) in rows.iter().zip(&impulses) {
                pairs[k][p].lambda = -force;
                add_gradient(&work.gaps[k][p], *force, &mut at);
            }
            for i in 0..free.len() {
                ahead[i] = free[i] + dt * self.inverse_mass[i] * at[i];
            }
        }
        for pair in pairs.iter_mut().flatten() {
            pair.active = pair.lambda < 0.0;
        }
        // The contact point of the record is that of the force: at y_n.
        for (contact, pairs) in model.contacts.iter().zip(&mut pairs) {
            pairs.iter_mut().filter(|p| p.active).for_each(|pair| _ = gap_at(contact, pair, &state.y));
        }
        Ok(pairs)
    }

    /// G M⁻¹Gᵀ over the rows, and what it has to make of the linearised gaps: (1 + e) g/Δt² − G M⁻¹Gᵀ P.
    fn problem<const D: usize>(
        &self,
        model: &Model<D>,
        pairs: &[Vec<Pair>],
        rows: &[(usize, usize)],
        dt: f64,
        work: &Workspace<D>,
    ) -> (Vec<f64>, Vec<f64>) {
        let count = rows.len();
        let mut matrix = vec![0.0; count * count];
        let mut column = vec![0.0; self.inverse_mass.len()];
        for (j, &(k, p)) in rows.iter().enumerate() {
            let gap = &work.gaps[k][p];
            column.fill(0.0);
            add_gradient(gap, 1.0, &mut column);
            for (x, m) in column.iter_mut().zip(&self.inverse_mass) {
                *x *= m;
            }
            for (i, &(l, q)) in rows.iter().enumerate() {
                matrix[i * count + j] = along(&work.gaps[l][q], &column);
            }
        }
        let right = rows.iter().enumerate().map(|(i, &(k, p))| {
            let done: f64 =
                rows.iter().enumerate().map(|(j, &(l, q))| -matrix[i * count + j] * pairs[l][q].lambda).sum();
            (1.0 + model.contacts[k].restitution) * work.gaps[k][p].gap / (dt * dt) - done
        });
        let right = right.collect();
        (matrix, right)
    }
}
