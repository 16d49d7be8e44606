//! Depths that pairs keep. A node may be inside a body when its pair is found: others held it at
//! other places until then, to within the depths that they allow, or it was left to a sharp edge. A
//! force that pushed it out would work on the way, and create energy. The pair keeps that depth d
//! instead, g + d ≥ 0, less by as much as the node comes out since:
//!
//! ```text
//! d ← max(0, −g)            where the pair begins, or is handed to another facet: at the step's start
//! d ← min(d, max(0, −g))    at the start of every step
//! ```
//!
//! A pair that is handed to a facet over which its node did not lie then goes on with its depth.

use carom_contact::{Pair, Pairing, Rows};

use crate::model::{Contact, Model};
use crate::state::State;

/// Notes how deep pairs that have just been found or handed over began: at the positions `before`,
/// where the step or a stage of it started, if pairs keep depths. Of springs those do whose energy
/// is conserved, and only where they are found: a handed-over one goes on as it is.
pub(crate) fn begin(model: &Model, before: Option<&[f64]>, pairings: &mut [Pairing]) {
    let mut row = Rows::new(model.dimension);
    for (contact, pairing) in model.contacts.iter().zip(pairings) {
        let is_constraint = contact.interface.is_constraint();
        let conserves = contact.interface.direction().accumulates();
        for pair in pairing.pairs.iter_mut().filter(|pair| pair.begins) {
            pair.begins = false;
            if conserves && pair.active {
                continue;
            }
            let keeps = (is_constraint || conserves) && contact.kinematics.keeps_depth(pair);
            let Some(before) = before.filter(|_| keeps) else {
                pair.depth = 0.0;
                continue;
            };
            let mut at = Pair { active: true, depth: 0.0, ..*pair };
            let gap = gap_at(contact, &mut at, before, &mut row);
            if contact.kinematics.is_on_facet(&at) {
                pair.depth = if gap < -model.gap_tolerance { -gap } else { 0.0 };
            }
        }
    }
}

/// The positions at which pairs of a step begin. At the start of a run nothing has held their nodes
/// before: an overlap there is kept, closed or refused as a whole.
pub(crate) fn beginning<'a>(state: &State, before: &'a [f64]) -> Option<&'a [f64]> {
    (state.time > 0.0).then_some(before)
}

/// Reduces the depths that pairs keep where their nodes have come out since.
pub(crate) fn ease(model: &Model, y: &[f64], pairings: &mut [Pairing]) {
    let mut row = Rows::new(model.dimension);
    for (contact, pairing) in model.contacts.iter().zip(pairings) {
        for pair in pairing.pairs.iter_mut().filter(|pair| pair.depth > 0.0) {
            let gap = gap_at(contact, &mut pair.clone(), y, &mut row);
            pair.depth -= gap.clamp(0.0, pair.depth);
        }
    }
}

/// Gap of a pair at positions `y`, updating its contact point; infinite without a unique closest
/// point, for a remote pair. `row` is overwritten.
pub(crate) fn gap_at(contact: &Contact, pair: &mut Pair, y: &[f64], row: &mut Rows) -> f64 {
    row.clear();
    let found = contact.kinematics.measure(pair, y, row);
    found.map_or(f64::INFINITY, |()| row.row(0).gap)
}
