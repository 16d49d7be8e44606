//! Persistency: where a gap closes or stick begins, velocities and accelerations are made
//! compatible with the active constraints (g ġ = 0).
//!
//! ```text
//! M Δv + Gᵀp = 0,   G (v + Δv) = 0            then       M a + Gᵀλ = f_ext − f_int,
//!                                                        λ ≤ 0,  g̈ ≥ 0,  λ g̈ = 0,   g̈ = G a + v·∇²g·v
//! ```
//!
//! with all active rows as equalities of the velocities. Projecting v alone would retain the
//! accelerations of the impact and does not remove the oscillations (book, "Contact activation"). A
//! multiplier that would pull is zero, and its gap may open; the others keep g̈ = 0. Massless dofs
//! keep their velocity: they follow the massive side. With friction both systems have its impulses
//! and forces (`cone.rs`). Accelerations and multipliers that are means over a step remain. With a
//! restitution, energy is returned (`restitution.rs`) before the accelerations are solved for.
//! Where stick begins, velocities are those of `stick.rs`.

use std::collections::BTreeMap;

use carom_algebra::sums::max_abs;
use carom_contact::{ActiveSet, Along, Contender, FrictionState, Row, Rows, inner};

use crate::contact::independent::independent_rows;
use crate::friction_state::each_slip;
use crate::ledger::{book_contact_forces, book_kinetic};
use crate::linear::system::System;
use crate::model::Model;
use crate::rejected::Rejected;
use crate::state::State;
use crate::velocity::active_rows::{measure_all, pressing};
use crate::velocity::cone::{Closed, Right, Works};
use crate::velocity::restitution::{Impact, take};
use crate::velocity::stick::{begins_to_stick, stop_slips};

/// Contact and pair.
type Place = (usize, usize);

/// Solves in which pairs that were let go may be held again; after that they are only let go, so
/// that in the end none pulls.
const ROUNDS: usize = 50;
/// Multiplier, as a fraction of the largest force, and acceleration, as a fraction of the largest
/// one, that are round-off.
const ROUND_OFF: f64 = 1e-12;

/// Projects `state`, the end of the step `impact`, if one of the new contacts (contact, node)
/// requires it, or a pair that begins to stick. The jump of kinetic energy is recorded as work and
/// returned.
pub(crate) fn project(
    model: &Model,
    state: &mut State,
    impact: &Impact,
    activations: &[(usize, usize)],
    system: &mut System,
) -> Result<Option<f64>, Rejected> {
    let asks = |place: &Place| asks(model, place);
    let closes = activations.iter().any(asks);
    let stops = pressing(state).any(|place| asks(&place) && begins_to_stick(state, impact.start, place));
    if !closes && !stops {
        return Ok(None);
    }
    let pressed = Pressed::new(model, state, impact.start)?;
    let before = state.ledger.kinetic;
    let of_step = impact.means.then(|| state.pairs.clone());
    let mut works = Works::default();
    if stops {
        works = stop_slips(model, state, &pressed.closed, system)?;
        book_kinetic(model, state);
    }
    if closes {
        works += close_gaps(model, state, &pressed.closed, system)?;
        works += impact.restitute(model, state, &pressed.closed, system)?;
    }
    match of_step {
        Some(pairs) => state.pairs = pairs,
        None => pressed.accelerate(model, state, system)?,
    }
    book_kinetic(model, state);
    let jump = state.ledger.kinetic - before;
    state.ledger.contact_work += jump - works.friction - works.external;
    state.ledger.friction_work += works.friction;
    state.ledger.external_work += works.external;
    Ok(Some(jump))
}

/// Projects `state`, the end of a stage within a step from `start` in which pairs close. Forces and
/// accelerations are in balance. The jump of the velocities is recorded nowhere: they are weights
/// of the next stage, and change neither the momentum of the step nor its energy.
pub(crate) fn project_stage(
    model: &Model,
    state: &mut State,
    start: &State,
    system: &mut System,
) -> Result<(), Rejected> {
    let pressed = Pressed::new(model, state, start)?;
    close_gaps(model, state, &pressed.closed, system)?;
    pressed.accelerate(model, state, system)
}

/// Whether the velocities of a pair are projected.
pub(crate) fn asks(model: &Model, &(contact, _): &Place) -> bool {
    model.contacts[contact].projects
}

/// Pairs in their order, those that are asked for first: none of these is left out for another one.
fn asking_first(
    places: impl Iterator<Item = Place>,
    asks: impl Fn(&Place) -> bool,
) -> impl Iterator<Item = Place> {
    let (asking, others): (Vec<Place>, Vec<Place>) = places.partition(asks);
    asking.into_iter().chain(others)
}

/// The closed pairs of a state that is projected.
struct Pressed {
    /// Rows of all pairs.
    gaps: Vec<Rows>,
    closed: Closed,
    /// Velocities at the end of a step ring from node to node, its slips do not: a pair goes on as
    /// in the step.
    slid: BTreeMap<Place, FrictionState>,
}

impl Pressed {
    fn new(model: &Model, state: &mut State, start: &State) -> Result<Self, Rejected> {
        let gaps = measure_all(model, state)?;
        let mut places =
            independent_rows(model, asking_first(pressing(state), |place| asks(model, place)), &gaps);
        places.retain(|place| asks(model, place));
        places.sort_unstable();
        let closed = Closed::new(model, state, places, &gaps)?;
        let slid = closed.slid(state, start);
        Ok(Self { gaps, closed, slid })
    }

    /// Accelerations of projected velocities, and the contact forces.
    fn accelerate(&self, model: &Model, state: &mut State, system: &mut System) -> Result<(), Rejected> {
        accelerate(model, state, &self.gaps, |place| asks(model, place), &self.slid, system)?;
        contact_forces_into(model, state, &self.gaps);
        book_contact_forces(model, state);
        Ok(())
    }
}

/// The impact of the nodes on the surface.
fn close_gaps(
    model: &Model,
    state: &mut State,
    closed: &Closed,
    system: &mut System,
) -> Result<Works, Rejected> {
    let closing: Vec<f64> = closed.normals.rows.iter().map(|row| -row.along(&state.v)).collect();
    let slips = closed.slip_rates(&state.v);
    let stopping: Vec<Along> = slips.iter().map(|rate| rate.map(|rate| -rate)).collect();
    let right = Right { forces: &vec![0.0; model.dofs()], gaps: &closing, slips: &stopping };
    let jump = closed.impulse(model, state, &right, system)?;
    closed.strike(model, state, &jump);
    let after = closed.slip_rates(&state.v);
    let mean = |(before, after): (&Along, &Along)| [0, 1].map(|i| 0.5 * (before[i] + after[i]));
    let rates = slips.iter().zip(&after).map(mean);
    let friction = -rates.zip(&jump.tangential).map(|(rate, q)| inner(rate, *q)).sum::<f64>();
    let external = closed.work_of_supports(model, state, &jump);
    take(model, state, state.ledger.kinetic - model.kinetic(&state.v) + friction + external);
    Ok(Works { friction, external })
}

/// Accelerations and multipliers of a state with closed pairs, of those that are asked for; `slid`:
/// which pairs stick, and directions in which pairs slip, of the others those of their slip rates.
///
/// A pair that pulls is let go, with its friction, and one whose gap would close is held again, by
/// the rules for the pairs of a step (`carom-contact/src/active_set.rs`): ties change together.
pub(crate) fn accelerate(
    model: &Model,
    state: &mut State,
    gaps: &[Rows],
    asks: impl Fn(&Place) -> bool,
    slid: &BTreeMap<Place, FrictionState>,
    system: &mut System,
) -> Result<(), Rejected> {
    let pairs: Vec<Place> = pressing(state).filter(&asks).collect();
    let bent = bending(model, state, gaps, &pairs);
    let mut held = vec![true; pairs.len()];
    let mut set = ActiveSet::new(0.0, true);
    for round in 0.. {
        let is_held = |place: &Place| pairs.binary_search(place).is_ok_and(|i| held[i]);
        // Of rows that depend on each other the next one takes over where one is let go.
        let candidates = pressing(state).filter(|place| !asks(place) || is_held(place));
        let mut places = independent_rows(model, asking_first(candidates, &asks), gaps);
        places.retain(&asks);
        places.sort_unstable();
        let closed = Closed::new(model, state, places, gaps)?;
        let of_place = |place: &Place| pairs.binary_search(place).map_or(0.0, |i| bent[i]);
        let bending: Vec<f64> = closed.places.iter().map(of_place).collect();
        let forces = drive(model, state, gaps, &closed);
        let turning = turning(model, state, &closed);
        let right = Right { forces: &forces, gaps: &bending, slips: &turning };
        let known: Vec<Option<FrictionState>> =
            closed.places.iter().map(|place| slid.get(place).copied()).collect();
        let motion = closed.accelerate(model, state, &right, &known, system)?;

        let [force, acceleration] = [&forces, &motion.x].map(|x| ROUND_OFF * max_abs(x));
        let contender = |(i, &(k, p)): (usize, &Place)| {
            let row = closed.places.binary_search(&(k, p));
            let lambda = row.map_or(0.0, |row| motion.normal[row]);
            let apart = gaps[k].row(p).along(&motion.x) - bent[i];
            Contender {
                active: held[i],
                gap: if apart < -acceleration { apart } else { 0.0 },
                lambda: if lambda.abs() > force { lambda } else { 0.0 },
                // Compares a force with an acceleration where one pair changes at a time.
                stiffness: force.max(f64::MIN_POSITIVE) / acceleration.max(f64::MIN_POSITIVE),
            }
        };
        let contenders: Vec<Contender> = pairs.iter().enumerate().map(contender).collect();
        let alike = |i: usize, j: usize| {
            let [one, other] = [pairs[i], pairs[j]].map(|(k, p)| gaps[k].row(p));
            one.alike(&other)
        };
        let pulls = |i: &usize| held[*i] && contenders[*i].lambda > 0.0;
        let changes = if round < ROUNDS { set.changes(&contenders, true, alike).ok() } else { None };
        let changes = changes.unwrap_or_else(|| (0..pairs.len()).filter(pulls).collect());
        if changes.is_empty() {
            for (&(k, p), lambda) in closed.places.iter().zip(&motion.normal) {
                state.pairs[k][p].lambda = *lambda;
            }
            for &i in &model.free {
                // Moving supports keep theirs.
                state.a[i] = if model.massless[i] { 0.0 } else { motion.x[i] };
            }
            model.points.carry(&mut state.a);
            break;
        }
        changes.iter().for_each(|&i| held[i] = !held[i]);
        for &(k, p) in &pairs {
            let pair = &mut state.pairs[k][p];
            (pair.lambda, pair.tangential.traction) = (0.0, [0.0; 2]);
        }
    }
    Ok(())
}

/// Right-hand side of M a + Gᵀλ = f_ext − f_int for these constraints, minus the contributions of
/// the accelerations of moving supports, in `state`, and of the forces of all other active pairs,
/// including springs.
fn drive(model: &Model, state: &State, gaps: &[Rows], closed: &Closed) -> Vec<f64> {
    let dofs = model.dofs();
    let mut carried = vec![0.0; dofs];
    if let Some(moved) = moved(model, state) {
        model.mass.multiply_into(&moved, &mut carried);
    }
    let others = |place: Place| !closed.places.contains(&place);
    for (k, p) in pressing(state).filter(|&place| others(place)) {
        gaps[k].row(p).add_to(state.pairs[k][p].lambda, &mut carried);
    }
    each_slip(model, state, |k, p, traction, row| {
        if others((k, p)) {
            row.add_to(traction, &mut carried);
        }
    });
    let force = |i: usize| model.gravity[i] + state.f_external[i] - state.f_internal[i] - carried[i];
    (0..dofs).map(|i| if model.massless[i] { 0.0 } else { force(i) }).collect()
}

/// −v·∇²g·v of these pairs, minus the acceleration of the gap by moving supports.
fn bending(model: &Model, state: &State, gaps: &[Rows], pairs: &[Place]) -> Vec<f64> {
    let moved = moved(model, state);
    let mut second = Vec::new();
    let of_pair = |&(k, p): &Place| {
        let row = gaps[k].row(p);
        second.resize(row.gradient.len().pow(2), 0.0);
        model.contacts[k].kinematics.curvature_into(&state.pairs[k][p], &state.y, &mut second);
        -curvature(row, &second, &state.v) - moved.as_ref().map_or(0.0, |moved| row.along(moved))
    };
    pairs.iter().map(of_pair).collect()
}

/// −v·∂H/∂y·v of these pairs, minus the rate at which moving supports change their slip rates.
fn turning(model: &Model, state: &State, closed: &Closed) -> Vec<Along> {
    let mut turning = closed.slip_curvatures(model, state);
    if let Some(moved) = moved(model, state) {
        for (bent, moved) in turning.iter_mut().zip(closed.slip_rates(&moved)) {
            *bent = [bent[0] + moved[0], bent[1] + moved[1]];
        }
    }
    turning.iter().map(|bent| bent.map(|bent| -bent)).collect()
}

/// Accelerations of moving supports and of points by those that carry them, zero elsewhere, if
/// there are any.
fn moved(model: &Model, state: &State) -> Option<Vec<f64>> {
    let mut moved = vec![0.0; model.dofs()];
    model.motions.dofs().for_each(|dof| moved[dof] = state.a[dof]);
    model.points.carry(&mut moved);
    (!model.motions.is_empty()).then_some(moved)
}

/// Σ Gᵀλ over the contacts, for the next step.
pub(crate) fn contact_forces_into(model: &Model, state: &mut State, rows: &[Rows]) {
    let acts_at_end = model.contacts.iter().any(|contact| contact.at_the_end);
    let State { f_contact, f_at_end, pairs, .. } = state;
    f_contact.fill(0.0);
    f_at_end.clear();
    f_at_end.resize(if acts_at_end { f_contact.len() } else { 0 }, 0.0);
    for (k, contact) in model.contacts.iter().enumerate() {
        debug_assert_eq!(rows[k].len(), pairs[k].len(), "rows of contact {}", contact.name);
        for (pair, row) in pairs[k].iter().zip(rows[k].iter()).filter(|(pair, _)| pair.active) {
            row.add_to(pair.lambda, f_contact);
            if contact.at_the_end {
                row.add_to(pair.lambda, f_at_end);
            }
        }
    }
    state.f_friction.clear();
    state.f_friction_at_end.clear();
    if model.has_friction() {
        let mut friction = vec![0.0; model.dofs()];
        let mut at_end = vec![0.0; if acts_at_end { model.dofs() } else { 0 }];
        each_slip(model, state, |k, _, traction, row| {
            row.add_to(traction, &mut friction);
            if model.contacts[k].at_the_end {
                row.add_to(traction, &mut at_end);
            }
        });
        state.f_contact.iter_mut().zip(&friction).for_each(|(force, part)| *force += part);
        state.f_at_end.iter_mut().zip(&at_end).for_each(|(force, part)| *force += part);
        state.f_friction = friction;
        state.f_friction_at_end = at_end;
    }
}

/// v·∇²g·v of a row, with row-major ∇²g.
fn curvature(row: Row, second: &[f64], v: &[f64]) -> f64 {
    let along: Vec<f64> = row.entries().map(|(dof, _)| v[dof]).collect();
    let rows = second.chunks_exact(along.len());
    along.iter().zip(rows).map(|(v, row)| v * row.iter().zip(&along).map(|(c, w)| c * w).sum::<f64>()).sum()
}
