//! Persistency: at activation of a contact, velocities and accelerations are made compatible with
//! the active constraints (g ġ = 0).
//!
//! ```text
//! M Δv + Gᵀp = 0,   G (v + Δv) = 0            then       M a + Gᵀλ = f_ext − f_int,   G a = −v·∇²g·v
//! ```
//!
//! with all active rows as equalities. Projecting v alone would retain the accelerations of the
//! impact and does not remove the oscillations (theory.md §5.3). Massless dofs keep their velocity:
//! they follow the massive side. With friction both systems have its impulses and forces
//! (`cone.rs`). With a restitution, energy is returned (`restitution.rs`) before the accelerations
//! are solved for.

use carom_contact::{Along, Row, Rows, inner, length};

use crate::active_rows::{measure_all, pressing};
use crate::cone::{AT_REST, Closed, Right};
use crate::friction_state::each_slip;
use crate::independent::independent_rows;
use crate::ledger::{book_contact_forces, book_kinetic};
use crate::model::Model;
use crate::rejected::Rejected;
use crate::restitution::{Impact, take};
use crate::state::State;
use crate::sums::max_abs;
use crate::system::System;

/// Projects `state`, the end of the step `impact`, if one of the new contacts (contact, node)
/// requires it. The jump of kinetic energy is recorded as contact work and returned.
pub(crate) fn project(
    model: &Model,
    state: &mut State,
    impact: &Impact,
    activations: &[(usize, usize)],
    system: &mut System,
) -> Result<Option<f64>, Rejected> {
    let asks = |k: usize| model.contacts[k].projects;
    if !activations.iter().any(|&(k, _)| asks(k)) {
        return Ok(None);
    }
    let gaps = measure_all(model, state)?;
    let mut places = independent_rows(model, pressing(state), &gaps);
    places.retain(|&(k, _)| asks(k));
    let closed = Closed::new(model, state, places, &gaps)?;
    let rows = &closed.normals;
    let dofs = model.dofs();

    let closing: Vec<f64> = rows.rows.iter().map(|row| -row.along(&state.v)).collect();
    let slips = closed.slip_rates(&state.v);
    let stopping: Vec<Along> = slips.iter().map(|rate| rate.map(|rate| -rate)).collect();
    let right = Right { forces: &vec![0.0; dofs], gaps: &closing, slips: &stopping };
    let slid = closed.directions(state, impact.pairs);
    let jump = closed.impulse(model, state, &right, system)?;
    for i in (0..dofs).filter(|&i| !model.massless[i]) {
        state.v[i] += jump.x[i];
    }
    for (k, impulse) in closed.impulses(&jump) {
        (0..3).for_each(|i| state.impulses[k][i] += impulse[i]);
    }
    let after = closed.slip_rates(&state.v);
    let mean = |(before, after): (&Along, &Along)| [0, 1].map(|i| 0.5 * (before[i] + after[i]));
    let rates = slips.iter().zip(&after).map(mean);
    let mut rubbed = -rates.zip(&jump.tangential).map(|(rate, q)| inner(rate, *q)).sum::<f64>();

    // Velocities at the end of a step ring from node to node, its slips do not: a pair slips on in
    // the direction of its slip, unless the impulse turns it round.
    let still = AT_REST * max_abs(&state.v);
    let goes_on = slips.iter().zip(&after).map(|(a, b)| length(*a) > still && inner(*a, *b) > 0.0);
    let slid: Vec<Option<Along>> = slid.into_iter().zip(goes_on).map(|(d, on)| d.filter(|_| on)).collect();

    let before = state.ledger.kinetic;
    take(model, state, before - model.kinetic(&state.v) + rubbed);
    rubbed += impact.restitute(model, state, &closed, system)?;
    accelerate(model, state, &gaps, &closed, &slid, system)?;

    averaged_contact_into(model, state, &gaps);
    book_contact_forces(model, state);
    book_kinetic(model, state);
    let jump = state.ledger.kinetic - before;
    state.ledger.contact_work += jump - rubbed;
    state.ledger.friction_work += rubbed;
    Ok(Some(jump))
}

/// Accelerations and multipliers of a state with these closed pairs; `slid`: directions in which
/// they slip, of the others those of their slip rates.
pub(crate) fn accelerate(
    model: &Model,
    state: &mut State,
    gaps: &[Rows],
    closed: &Closed,
    slid: &[Option<Along>],
    system: &mut System,
) -> Result<(), Rejected> {
    let (forces, bending) = drive(model, state, gaps, closed);
    let turning: Vec<Along> =
        closed.slip_curvatures(model, state).iter().map(|bent| bent.map(|b| -b)).collect();
    let right = Right { forces: &forces, gaps: &bending, slips: &turning };
    let motion = closed.accelerate(model, state, &right, slid, system)?;
    for &i in &model.free {
        // Moving supports keep theirs.
        state.a[i] = if model.massless[i] { 0.0 } else { motion.x[i] };
    }
    for (&(k, p), lambda) in closed.places.iter().zip(&motion.normal) {
        state.pairs[k][p].lambda = *lambda;
    }
    Ok(())
}

/// Right-hand sides of M a + Gᵀλ = f_ext − f_int, G a = −v·∇²g·v for these constraints, minus the
/// contributions of the accelerations of moving supports, in `state`, and of the forces of all
/// other active pairs, including springs.
fn drive(model: &Model, state: &State, gaps: &[Rows], closed: &Closed) -> (Vec<f64>, Vec<f64>) {
    let dofs = model.dofs();
    let (mut moved, mut carried) = (vec![0.0; dofs], vec![0.0; dofs]);
    if !model.motions.is_empty() {
        model.motions.dofs().for_each(|dof| moved[dof] = state.a[dof]);
        model.mass.multiply_into(&moved, &mut carried);
    }
    let others = |place: (usize, usize)| !closed.places.contains(&place);
    for (k, p) in pressing(state).filter(|&place| others(place)) {
        gaps[k].row(p).add_to(state.pairs[k][p].lambda, &mut carried);
    }
    each_slip(model, state, |k, p, traction, row| {
        if others((k, p)) {
            row.add_to(traction, &mut carried);
        }
    });
    let force = |i: usize| model.gravity[i] + state.f_external[i] - state.f_internal[i] - carried[i];
    let forces = (0..dofs).map(|i| if model.massless[i] { 0.0 } else { force(i) }).collect();
    let mut second = Vec::new();
    let bending = |(&(k, p), row): (&(usize, usize), Row)| {
        second.resize(row.gradient.len().pow(2), 0.0);
        model.contacts[k].kinematics.curvature_into(&state.pairs[k][p], &state.y, &mut second);
        -curvature(row, &second, &state.v) - row.along(&moved)
    };
    (forces, closed.places.iter().zip(closed.normals.rows.iter()).map(bending).collect())
}

/// Σ Gᵀλ over the contacts with averaged forces, for the next step.
pub(crate) fn averaged_contact_into(model: &Model, state: &mut State, rows: &[Rows]) {
    let State { f_contact, pairs, .. } = state;
    f_contact.fill(0.0);
    for (k, contact) in model.contacts.iter().enumerate().filter(|(_, contact)| !contact.at_the_end) {
        debug_assert_eq!(rows[k].len(), pairs[k].len(), "rows of contact {}", contact.name);
        for (pair, row) in pairs[k].iter().zip(rows[k].iter()).filter(|(pair, _)| pair.active) {
            row.add_to(pair.lambda, f_contact);
        }
    }
    state.f_friction.clear();
    if model.has_friction() {
        let mut friction = vec![0.0; model.dofs()];
        each_slip(model, state, |k, _, traction, row| {
            if !model.contacts[k].at_the_end {
                row.add_to(traction, &mut friction);
            }
        });
        state.f_contact.iter_mut().zip(&friction).for_each(|(force, part)| *force += part);
        state.f_friction = friction;
    }
}

/// v·∇²g·v of a row, with row-major ∇²g.
fn curvature(row: Row, second: &[f64], v: &[f64]) -> f64 {
    let along: Vec<f64> = row.entries().map(|(dof, _)| v[dof]).collect();
    let rows = second.chunks_exact(along.len());
    along.iter().zip(rows).map(|(v, row)| v * row.iter().zip(&along).map(|(c, w)| c * w).sum::<f64>()).sum()
}
