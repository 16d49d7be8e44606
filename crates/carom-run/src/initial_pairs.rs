//! Closed pairs at the start of a run, of the contacts at the end of another one.
//!
//! A contact goes on where the other run has one of the same kind on the same sides, whatever its
//! name and wherever its obstacle stands: one that has moved goes on from another place, and of its
//! pairs those are closed that touch. Where the other run pressed by springs and this one does not,
//! or the reverse, or by the other method, or the same bodies on other sides, nodes that touch are
//! found anew: pairs of springs are nearly always dependent as constraints.

use std::collections::{BTreeMap, BTreeSet};

use carom_case::{Case, ContactSpec, PrimarySpec, Problem};
use carom_contact::{FrictionState, Pair, Pairing, Rows};
use carom_mechanics::model::{Contact, Model};
use carom_mechanics::{DeepPlace, State, inside};

use crate::overlap::longest;
use crate::quantity::quantity;

/// Gap of nodes that touch, over L.
const TOUCHES: f64 = 1e-9;
/// Depth, relative to the longest facet, beyond which sides overlap that the other run did not keep
/// apart.
const DEEP: f64 = 1e-3;
/// Depth, relative to the longest facet, that a contact of the same bodies leaves by another method
/// or with its sides exchanged: more than the fiftieth of nodes of the primary.
const LEFT: f64 = 0.03;

/// Pairs of each contact, and which of them stuck or slipped, by contact and pair.
pub(crate) struct Found {
    pub(crate) pairs: Vec<Vec<Pair>>,
    pub(crate) slid: BTreeMap<(usize, usize), FrictionState>,
    /// Depth that the other run may have left in each contact.
    pub(crate) left: Vec<f64>,
}

/// The pairs of a model at positions `y`, from the other run and its last state.
/// `free`: contacts whose obstacle is free and goes on where it was; `depths`: how deep the bodies
/// of each contact of that run are at its end.
pub(crate) fn found<'a>(
    case: &Case,
    model: &Model,
    y: &[f64],
    old: &Case,
    state: &State,
    free: &[usize],
    depths: impl Fn() -> &'a [f64],
) -> Found {
    let mut found = Found { pairs: Vec::new(), slid: BTreeMap::new(), left: Vec::new() };
    let before = counterparts(case, model, y, old, state);
    for (own, (spec, contact)) in case.contacts.iter().zip(&model.contacts).enumerate() {
        let Some(before) = before[own] else {
            let is_met = |k: &usize| have_the_same_bodies(&old.contacts[*k], spec);
            let met: Vec<usize> = (0..old.contacts.len()).filter(is_met).collect();
            let share = if met.is_empty() { DEEP } else { left_by_another(spec) };
            found.left.push(share * longest_facet(model, own, y));
            let pressed = met.iter().any(|k| state.pairs.get(*k).is_some_and(|pairs| is_pressed(pairs)));
            found.pairs.push(if pressed { touching(model, contact, y) } else { Vec::new() });
            continue;
        };
        let pressed = state.pairs.get(before).map_or(&[][..], Vec::as_slice);
        let other = &old.contacts[before];
        let goes_on =
            other.method == spec.method && other.enforcement.is_exact() == spec.enforcement.is_exact();
        let stays = other.primary == spec.primary && other.motion.is_fixed() && spec.motion.is_fixed();
        let is_there = stays || free.contains(&own);
        let length = longest_facet(model, own, y);
        found.left.push(match (is_there, goes_on) {
            (true, true) => f64::INFINITY,
            (true, false) => left_by_another(spec) * length,
            // Where the obstacle stands as that run left it, the bodies are as deep as there.
            (false, true) => {
                let depth = depths().get(before).copied().unwrap_or(0.0);
                f64::max(DEEP * length, (1.0 + DEEP) * depth)
            }
            (false, false) => DEEP * length,
        });
        let pairs = if goes_on && is_there {
            pressed.to_vec()
        } else if goes_on {
            still_closed(model, contact, y, pressed)
        } else if is_pressed(pressed) {
            touching(model, contact, y)
        } else {
            Vec::new()
        };
        if goes_on && other.friction.exists() {
            let rubs = pairs.iter().enumerate().filter(|(_, pair)| pair.active);
            found.slid.extend(rubs.map(|(p, pair)| ((own, p), pair.tangential.friction_state)));
        }
        found.pairs.push(pairs);
    }
    found
}

fn is_pressed(pairs: &[Pair]) -> bool {
    pairs.iter().any(|pair| pair.active)
}

/// For each contact that of the other run which goes on in it: of those that are alike one of the
/// same name, else that of which most pairs touch. None goes on twice.
fn counterparts(case: &Case, model: &Model, y: &[f64], old: &Case, state: &State) -> Vec<Option<usize>> {
    let mut found = vec![None; case.contacts.len()];
    let alike = |own: usize, found: &[Option<usize>]| -> Vec<usize> {
        let is_alike = |k: &usize| is_alike(&old.contacts[*k], &case.contacts[own]);
        (0..old.contacts.len()).filter(|k| !found.contains(&Some(*k))).filter(is_alike).collect()
    };
    for own in 0..found.len() {
        let name = &case.contacts[own].name;
        found[own] = alike(own, &found).into_iter().find(|k| old.contacts[*k].name == *name);
    }
    for own in 0..found.len() {
        let touch = |k: &usize| {
            let pairs = state.pairs.get(*k).map_or(&[][..], Vec::as_slice);
            let pairs = still_closed(model, &model.contacts[own], y, pairs);
            pairs.iter().filter(|pair| pair.active).count()
        };
        if found[own].is_none() {
            found[own] = alike(own, &found).into_iter().rev().max_by_key(touch);
        }
    }
    found
}

/// Whether contacts are on the same sides, or on the same side and an obstacle of the same kind.
fn is_alike(old: &ContactSpec, new: &ContactSpec) -> bool {
    let primary = match (&old.primary, &new.primary) {
        (PrimarySpec::Plane { .. }, PrimarySpec::Plane { .. }) => true,
        (PrimarySpec::Circle { inside, .. }, PrimarySpec::Circle { inside: other, .. })
        | (PrimarySpec::Cylinder { inside, .. }, PrimarySpec::Cylinder { inside: other, .. }) => {
            inside == other
        }
        (PrimarySpec::Polyline { points, .. }, PrimarySpec::Polyline { points: others, .. }) => {
            points.len() == others.len()
        }
        (PrimarySpec::Surface(old), PrimarySpec::Surface(new)) => {
            [old.triangles, old.rim, old.inner] == [new.triangles, new.rim, new.inner]
        }
        (old, new) => old == new,
    };
    primary && old.secondary == new.secondary
}

/// The pairs, of which those are open that do not touch any more. The gap of a spring says itself
/// whether it presses.
fn still_closed(model: &Model, contact: &Contact, y: &[f64], pairs: &[Pair]) -> Vec<Pair> {
    let mut rows = Rows::new(model.dimension);
    let mut pairs = pairs.to_vec();
    for pair in pairs.iter_mut().filter(|pair| pair.active && contact.interface.is_constraint()) {
        rows.clear();
        let is_measured = contact.kinematics.measure(&mut pair.clone(), y, &mut rows).is_ok();
        if !(is_measured && rows.row(0).gap.abs() <= TOUCHES * model.scale) {
            *pair = Pair { eta: pair.eta, joint: pair.joint, ..Pair::open(pair.node, pair.facet, pair.xi) };
        }
    }
    pairs
}

/// The pairs of nodes that touch.
fn touching(model: &Model, contact: &Contact, y: &[f64]) -> Vec<Pair> {
    let mut rows = Rows::new(model.dimension);
    let mut pairing = Pairing::default();
    contact.kinematics.search(y, y, &mut pairing, &mut Vec::new());
    for pair in &mut pairing.pairs {
        rows.clear();
        let is_measured = contact.kinematics.measure(pair, y, &mut rows).is_ok();
        pair.active = is_measured && rows.row(0).gap <= TOUCHES * model.scale;
    }
    pairing.pairs
}

/// Depth, relative to the longest facet, that a contact of another kind between the same bodies may
/// have left. Springs press at any depth.
fn left_by_another(spec: &ContactSpec) -> f64 {
    if spec.enforcement.is_exact() { LEFT } else { f64::INFINITY }
}

/// Whether two contacts are between the same bodies, whichever is secondary.
fn have_the_same_bodies(one: &ContactSpec, other: &ContactSpec) -> bool {
    let bodies = |contact: &ContactSpec| contact.bodies().map(str::to_owned).collect::<BTreeSet<_>>();
    one.primary.side().is_some() == other.primary.side().is_some() && bodies(one) == bodies(other)
}

/// Length of the longest facet of a contact.
fn longest_facet(model: &Model, contact: usize, y: &[f64]) -> f64 {
    if model.dimension == 1 {
        return model.scale;
    }
    let of_sides = model.contacts[contact].facets.iter();
    of_sides.map(|(_, facets)| longest(facets, y, model.dimension)).fold(0.0, f64::max)
}

/// The problem of a contact whose bodies overlap by more than the other run may have `left`: it did
/// not have the contact, or had it by springs, or its obstacle stands elsewhere now.
pub(crate) fn overlap(case: &Case, model: &Model, y: &[f64], left: &[f64]) -> Option<Problem> {
    let is_deeper = |place: &DeepPlace| place.depth > left[place.contact];
    let found = inside(model, y, 0.0).into_iter().find(is_deeper)?;
    let DeepPlace { contact, node, depth, .. } = found;
    let spec = &case.contacts[contact];
    Some(Problem::new(
        format!("contact[{}]", spec.entry),
        format!(
            "the bodies of contact \"{}\" overlap at the start by {}",
            spec.name,
            quantity(depth, &case.units.length)
        ),
        format!(
            "the run of `initial.from` left node {node} inside, or the obstacle was not there; closing the overlap within one step would drive them apart"
        ),
        "give that run this contact with the same `method` and `enforcement`, or place the obstacle where the bodies touch it",
    ))
}
