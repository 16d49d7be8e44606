//! Pairs of the steppers with their own contact law: found along the step, and kept from step to
//! step while in contact or penetrating. The search ignores a node behind a facet at the start of a
//! step, so pairs of a law that allows penetration must persist.

use carom_contact::{Pair, Pairing, Row, Rows};

use crate::check::watched::has_gaps;
use crate::contact::depths::gap_at;
use crate::contact::independent::{DEPENDENT, on_free_dofs};
use crate::model::{Contact, Model};
use crate::rejected::Rejected;
use crate::state::State;

/// The initial pairs of a step: those in contact or penetrating, deactivated and without
/// multiplier; `watch` sets the search margin for others.
pub(super) fn carry_into(
    model: &Model,
    state: &State,
    watch: impl Fn(Vec<Pair>) -> Pairing,
    pairings: &mut Vec<Pairing>,
) {
    let mut row = Rows::new(model.dimension);
    pairings.resize_with(model.contacts.len(), Pairing::default);
    for ((contact, pairs), pairing) in model.contacts.iter().zip(&state.pairs).zip(pairings) {
        pairing.pairs.clone_from(pairs);
        pairing.pairs.retain_mut(|pair| {
            let carried = pair.active || gap_at(contact, pair, &state.y, &mut row) < 0.0;
            (pair.active, pair.lambda, pair.tangential.traction) = (false, 0.0, [0.0; 2]);
            carried
        });
        *pairing = watch(std::mem::take(&mut pairing.pairs));
    }
}

/// Whether a force along a row moves anything: not if supports constrain all its nodes.
pub(super) fn moves(model: &Model, row: Row) -> bool {
    if !model.points.is_empty() {
        return on_free_dofs(model, row).iter().any(|(_, slope)| slope.abs() > DEPENDENT);
    }
    row.entries().any(|(dof, slope)| !model.fixed[dof] && slope.abs() > DEPENDENT)
}

/// The rejection of a gap that supports prevent from opening.
pub(super) fn overconstrained(contact: &Contact, pair: &Pair, gap: f64) -> Rejected {
    let node = contact.node(pair);
    Rejected::Overconstrained { contact: contact.name.clone(), node, depth: -gap }
}

/// Gaps and gradients of all pairs at `y`, updating their contact points.
///
/// # Errors
/// If an active pair has no unique closest point.
pub(super) fn measure_into(
    model: &Model,
    y: &[f64],
    pairings: &mut [Pairing],
    rows: &mut Vec<Rows>,
) -> Result<(), Rejected> {
    rows.resize_with(model.contacts.len(), || Rows::new(model.dimension));
    for ((contact, pairing), rows) in model.contacts.iter().zip(pairings).zip(rows) {
        rows.clear();
        for pair in &mut pairing.pairs {
            match contact.kinematics.measure(pair, y, rows) {
                Ok(()) => {}
                Err(error) if pair.active => {
                    return Err(Rejected::Contact { contact: contact.name.clone(), error });
                }
                Err(_) => rows.push_open(),
            }
        }
    }
    Ok(())
}

/// Contact and pair of all active ones.
pub(super) fn active(pairings: &[Pairing]) -> impl Iterator<Item = (usize, usize)> + '_ {
    let pairs = pairings.iter().enumerate();
    pairs.flat_map(|(k, pairing)| {
        let of_contact = pairing.pairs.iter().enumerate().filter(|(_, pair)| pair.active);
        of_contact.map(move |(p, _)| (k, p))
    })
}

/// Depth of the deepest tracked node behind a rigid primary or a point at a state, ≥ 0. A node
/// handed to another facet may be behind its extension; penetration of facets is measured over
/// whole bodies.
pub(super) fn depth(model: &Model, state: &State) -> f64 {
    let mut row = Rows::new(model.dimension);
    let contacts = model.contacts.iter().zip(&state.pairs).filter(|(contact, _)| has_gaps(model, contact));
    let pairs = contacts.flat_map(|(c, pairs)| pairs.iter().map(move |p| (c, p)));
    pairs.map(|(contact, pair)| -gap_at(contact, &mut pair.clone(), &state.y, &mut row)).fold(0.0, f64::max)
}

/// Bound on the approach of a node to a facet within a step at these velocities.
pub(super) fn approach(model: &Model, v: &[f64], dt: f64) -> f64 {
    let square = |v: &[f64]| v.iter().map(|v| v * v).sum::<f64>();
    2.0 * dt * v.chunks_exact(model.dimension).map(square).fold(0.0, f64::max).sqrt()
}
