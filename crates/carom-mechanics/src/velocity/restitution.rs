//! Restitution of the conserving constraint: velocity updates that return energy, after T. A.
//! Laursen and G. R. Love (2002). Contact owes e² of the energy D that it has taken,
//!
//! ```text
//! owed = Σ e² D − Σ returned,      D = −Δ contact_work of a step, and what its projection takes
//! v⁺ = v + w,   M w + Gᵀp = 0,   G w = f s,      ½ a f² + b f = owed,   a = −s·p/f,   b = −p/f·G v
//! ```
//!
//! and returns it where pairs close or open. s are their approach speeds, after the projection,
//! with which b = 0, or their separation speeds; zero for pairs that remain closed. Owed energy
//! makes nodes separate faster. Energy that contact has created, owed < 0, makes them separate
//! slower, at most until b + a f = 0; the rest is carried. Gradients are those at y_{n+1}, so
//! momentum and angular momentum do not change. With friction, M w + Gᵀp + Hᵀq = 0 with Coulomb's
//! law for the impulse (`cone.rs`): what it takes is not owed. Which nodes stick depends on f,
//! which is iterated.

use carom_algebra::sums::max_abs;
use carom_contact::{Along, FrictionState, Pair, Row, Tangential, inner};

use crate::contact::independent::independent_rows;
use crate::contact::loose::AT_REST;
use crate::ledger::book_kinetic;
use crate::linear::system::System;
use crate::model::Model;
use crate::rejected::Rejected;
use crate::state::State;
use crate::velocity::active_rows::{measure, pressing};
use crate::velocity::cone::{Closed, Right, Works};

/// Solutions for the factor of speeds with friction, and its change that is round-off.
const ROUNDS: usize = 50;
const ROUND_OFF: f64 = 1e-12;

/// The step at whose end a state is projected.
pub(crate) struct Impact<'a> {
    /// Its size.
    pub dt: f64,
    /// The state at its start.
    pub start: &'a State,
    /// The gaps at its start of pairs that closed in it: (contact, pair), gap.
    pub closed: Vec<((usize, usize), f64)>,
    /// Whether accelerations and contact forces are means over the step.
    pub means: bool,
}

impl Impact<'_> {
    /// Returns energy to projected velocities of closed pairs.
    pub(crate) fn restitute(
        &self,
        model: &Model,
        state: &mut State,
        closed: &Closed,
        system: &mut System,
    ) -> Result<Works, Rejected> {
        let places = closed.places.iter().zip(closed.normals.rows.iter());
        let speeds: Vec<f64> = places.map(|(place, row)| self.approach(*place, row)).collect();
        settle(model, state, closed, &speeds, system)
    }

    /// Approach speed of a pair: at the step's start, or the mean over the step if that is larger,
    /// for a pair that was accelerated towards the contact.
    fn approach(&self, place: (usize, usize), row: Row) -> f64 {
        let gap = self.closed.iter().find(|(closed, _)| *closed == place);
        gap.map_or(0.0, |(_, gap)| (-row.along(&self.start.v)).max(gap / self.dt).max(0.0))
    }
}

/// Adds e² of the energy that contact took to what it owes.
pub(crate) fn take(model: &Model, state: &mut State, energy: f64) {
    let conserving = model.contacts.iter().filter(|contact| contact.conserves());
    // The same for all contacts that have one.
    let restitution = conserving.map(|contact| contact.restitution).fold(0.0, f64::max);
    state.ledger.owed += restitution * restitution * energy;
}

/// Returns energy where contact ends: `released` are the contacts and indices of secondary nodes of
/// pairs that opened in the step. The jump of kinetic energy is recorded as contact work and
/// returned.
pub(crate) fn separate(
    model: &Model,
    state: &mut State,
    released: &[(usize, usize)],
    system: &mut System,
) -> Result<f64, Rejected> {
    if state.ledger.owed == 0.0 {
        return Ok(0.0);
    }
    let opened = |&(k, node): &(usize, usize)| {
        let opens = |pair: &Pair| pair.node == node && !pair.active;
        let p = state.pairs[k].iter().position(opens)?;
        model.contacts[k].conserves().then_some((k, p))
    };
    let opened: Vec<(usize, usize)> = released.iter().filter_map(opened).collect();
    let gaps = measure(model, state, |k, p, pair| pair.active || opened.contains(&(k, p)))?;
    let mut places: Vec<(usize, usize)> = pressing(state).chain(opened.iter().copied()).collect();
    places.sort_unstable();
    let places = independent_rows(model, places.into_iter(), &gaps);
    let closed = Closed::new(model, state, places, &gaps)?;
    let separation = |(place, row): (&(usize, usize), Row)| {
        if opened.contains(place) { row.along(&state.v).max(0.0) } else { 0.0 }
    };
    let speeds: Vec<f64> = closed.places.iter().zip(closed.normals.rows.iter()).map(separation).collect();
    if speeds.iter().all(|s| *s == 0.0) {
        return Ok(0.0);
    }
    let before = state.ledger.kinetic;
    let works = settle(model, state, &closed, &speeds, system)?;
    book_kinetic(model, state);
    let jump = state.ledger.kinetic - before;
    state.ledger.contact_work += jump - works.friction - works.external;
    state.ledger.friction_work += works.friction;
    state.ledger.external_work += works.external;
    Ok(jump)
}

/// Changes velocities by the response of the mass to a factor times `speeds` of closed pairs.
fn settle(
    model: &Model,
    state: &mut State,
    closed: &Closed,
    speeds: &[f64],
    system: &mut System,
) -> Result<Works, Rejected> {
    if state.ledger.owed == 0.0 {
        return Ok(Works::default());
    }
    let forces = vec![0.0; model.dofs()];
    let gaps: Vec<f64> = closed.normals.rows.iter().map(|row| row.along(&state.v)).collect();
    let slips = closed.slip_rates(&state.v);
    // A node that sticks keeps its slip rate, which oscillates from step to step.
    let sticks = |&(k, p): &(usize, usize)| {
        state.pairs[k][p].active && state.pairs[k][p].tangential.friction_state == FrictionState::Stick
    };
    let stop = |(place, rate): (&(usize, usize), &Along)| {
        if sticks(place) { [0.0; 2] } else { rate.map(|rate| -rate) }
    };
    let stopping: Vec<Along> = closed.places.iter().zip(&slips).map(stop).collect();
    // Stick, slip and tractions of the state are not those of these impulses: a pair that has
    // opened slips as it moves, however small they are, and is not stopped by one that pulls.
    let of_state = |&(k, p): &(usize, usize)| state.pairs[k][p].tangential;
    let tangentials: Vec<Tangential> = closed.places.iter().map(of_state).collect();
    let still = AT_REST * max_abs(&state.v);
    let friction_state = |(place, rate): (&(usize, usize), &Along)| {
        if sticks(place) { FrictionState::Stick } else { FrictionState::of(*rate, still) }
    };
    let holds: Vec<FrictionState> = closed.places.iter().zip(&slips).map(friction_state).collect();
    let mut reach = 1.0;
    for _ in 0..ROUNDS {
        let parting: Vec<f64> = speeds.iter().map(|speed| reach * speed).collect();
        let right = Right { forces: &forces, gaps: &parting, slips: &stopping };
        for (&(k, p), friction_state) in closed.places.iter().zip(&holds) {
            state.pairs[k][p].tangential.friction_state = *friction_state;
        }
        let motion = closed.impulse(model, state, &right, system)?;
        for (&(k, p), tangential) in closed.places.iter().zip(&tangentials) {
            state.pairs[k][p].tangential = *tangential;
        }
        let along =
            |rates: &[f64]| -rates.iter().zip(&motion.normal).map(|(s, p)| s * p).sum::<f64>() / reach;
        let size = along(speeds);
        let slope = along(&gaps);
        if size <= 0.0 {
            return Ok(Works::default());
        }
        let factor = root(size, slope, state.ledger.owed);
        if closed.rubs() && factor != 0.0 && (factor - reach).abs() > ROUND_OFF * factor.abs() {
            reach = factor;
            continue;
        }
        let share = factor / reach;
        let rates = closed.slip_rates(&motion.x);
        let works = motion.tangential.iter().zip(slips.iter().zip(&rates));
        let work = |(q, (rate, change)): (&Along, (&Along, &Along))| {
            let rates = [0, 1].map(|i| rate[i] + 0.5 * share * change[i]);
            inner(q.map(|q| share * q), rates)
        };
        let friction = -works.map(work).sum::<f64>();
        let external = share * closed.work_of_supports(model, state, &motion);
        for i in (0..forces.len()).filter(|&i| !model.massless[i]) {
            state.v[i] += share * motion.x[i];
        }
        for (k, impulse) in closed.impulses(&motion) {
            (0..3).for_each(|i| state.impulses[k][i] += share * impulse[i]);
        }
        state.ledger.owed -= factor * (0.5 * size * factor + slope);
        return Ok(Works { friction, external });
    }
    Err(Rejected::NoFrictionBalance)
}

/// f of ½ a f² + b f = owed, a > 0: the larger root, with which nodes separate; the vertex if there
/// is none; 0 if nothing can be taken from nodes that do not separate.
pub fn root(a: f64, b: f64, owed: f64) -> f64 {
    let discriminant = (b * b + 2.0 * a * owed).max(0.0).sqrt();
    match (owed > 0.0, b > 0.0) {
        (true, true) => 2.0 * owed / (b + discriminant),
        (true, false) => (discriminant - b) / a,
        (false, true) => (2.0 * owed / (b + discriminant)).max(-b / a),
        (false, false) => 0.0,
    }
}
