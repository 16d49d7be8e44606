//! Who touches whom in an iterate: pairs found and handed over, the active set of each contact,
//! pairs that nothing can hold.

use carom_contact::{ActiveSet, Contender, Pair, PairEvent, Pairing, Row};

use crate::constraints::Constraints;
use crate::equations::{Equations, Evaluation, Iterate};
use crate::model::{Contact, Model};
use crate::rejected::Rejected;
use crate::system::System;
use crate::timings::timed;
use crate::workspace::Workspace;

/// Penetration, as a fraction of L, that counts as touching.
pub(crate) const GAP_TOLERANCE: f64 = 1e-12;
/// Gap, as a fraction of L, of nodes that touch before the first load step.
const TOUCHING: f64 = 1e-9;

/// Below this correction, relative to L, facets are handed over before the iteration has converged.
const CLOSE: f64 = 1e-5;
/// How often in a solve pairs are handed over as they slide, before corrections are as small as
/// that.
const FOLLOWS: u32 = 12;

/// Events of pairs, with the place of their contact.
pub(crate) type Events = Vec<(usize, PairEvent)>;

/// Brings the pairs up to date with motion from `before` to `now`; whether that asks for another
/// solve.
pub(crate) fn search(
    model: &Model,
    before: &[f64],
    now: &[f64],
    pairings: &mut [Pairing],
    found: &mut Events,
) -> bool {
    let (mut changed, mut events) = (false, Vec::new());
    for (k, (contact, pairing)) in model.contacts.iter().zip(pairings).enumerate() {
        changed |= contact.kinematics.search(before, now, pairing, &mut events);
        found.extend(events.drain(..).map(|event| (k, event)));
    }
    changed
}

/// Before the first load step, lets bodies that supports leave free hold on to what they touch.
/// Whether that is anything.
pub(crate) fn hold_on(model: &Model, evaluation: &mut Evaluation) -> bool {
    if model.unconstrained.is_empty() || evaluation.pressing().next().is_some() {
        return false;
    }
    let mut changed = false;
    // A spring holds nothing before it is pressed.
    let constraints =
        model.contacts.iter().enumerate().filter(|(_, contact)| contact.interface.is_constraint());
    for (k, _) in constraints {
        for (pair, row) in evaluation.at.pairings[k].pairs.iter_mut().zip(evaluation.rows[k].iter()) {
            if row.gap <= TOUCHING * model.scale {
                (pair.active, changed) = (true, true);
            }
        }
    }
    changed
}

/// How the contacts of a stage change while it is solved.
pub(crate) struct ContactUpdate {
    sets: Vec<ActiveSet>,
    /// Times that pairs may still be handed over early.
    follows: u32,
}

impl ContactUpdate {
    /// At the beginning of a stage.
    pub(crate) fn new(model: &Model) -> Self {
        let set = |contact: &Contact| ActiveSet::new(GAP_TOLERANCE * model.scale, contact.within);
        Self { sets: model.contacts.iter().map(set).collect(), follows: FOLLOWS }
    }

    /// Forgets the visited sets: the pairs themselves have changed.
    pub(crate) fn restart(&mut self) {
        self.sets.iter_mut().for_each(ActiveSet::restart);
    }

    /// Brings active sets and pairs up to date with an iterate; whether one changed. `settled`: all
    /// that is left is this question; `step`: the last correction.
    ///
    /// # Errors
    /// A set keeps returning to one visited before.
    #[allow(clippy::too_many_arguments)]
    pub(crate) fn update(
        &mut self,
        equations: &Equations,
        before: &[f64],
        now: &mut Evaluation,
        events: &mut Events,
        settled: bool,
        step: f64,
        work: &mut Workspace,
    ) -> Result<bool, Rejected> {
        let model = equations.model;
        let mut changed = self.change_sets(equations, now, &work.system, settled)?;
        let mut handed_over = false;
        if !settled && self.follows > 0 && update_facets(model, now, events) {
            self.follows -= 1;
            handed_over = true;
        }
        changed |= handed_over;
        // Where a node will slide to is known long before the last digits are.
        let nearly = step <= CLOSE * model.scale;
        if !changed && (settled || nearly) {
            handed_over = timed(&mut work.timings.contact, || search_again(model, before, now, events));
            changed = handed_over;
        }
        if handed_over {
            self.restart();
        }
        Ok(changed)
    }

    /// Lets each contact's active set change; a released pair loses its multiplier. Whether one
    /// did.
    fn change_sets(
        &mut self,
        equations: &Equations,
        evaluation: &mut Evaluation,
        system: &System,
        settled: bool,
    ) -> Result<bool, Rejected> {
        let (model, mut changed) = (equations.model, false);
        // A spring presses or does not by its gap alone.
        let constraints =
            model.contacts.iter().enumerate().filter(|(_, contact)| contact.interface.is_constraint());
        for (k, contact) in constraints {
            let stiffness = system.mean_stiffness(equations);
            let pairs = &mut evaluation.at.pairings[k].pairs;
            let contender = |(pair, row): (&Pair, Row)| Contender {
                active: pair.active,
                gap: row.gap,
                lambda: pair.lambda,
                stiffness,
            };
            let contenders: Vec<Contender> =
                pairs.iter().zip(evaluation.rows[k].iter()).map(contender).collect();
            let changes = self.sets[k].changes(&contenders, settled).map_err(|cycle| Rejected::Cycle {
                contact: contact.name.clone(),
                nodes: cycle.pairs.iter().map(|&p| contact.kinematics.secondary()[pairs[p].node]).collect(),
            })?;
            for p in changes {
                (pairs[p].active, pairs[p].lambda, changed) = (!pairs[p].active, 0.0, true);
            }
        }
        Ok(changed)
    }
}

/// The same for an evaluated iterate: where nothing asks for another solve its pairs stay as they
/// are. Open ones may have come and gone, and the rows at hand, of which the forces are made,
/// belong to the pairs in their old order.
fn search_again(model: &Model, before: &[f64], evaluation: &mut Evaluation, found: &mut Events) -> bool {
    let pairings = evaluation.at.pairings.clone();
    let changed = search(model, before, &evaluation.y, &mut evaluation.at.pairings, found);
    if !changed {
        evaluation.at.pairings = pairings;
    }
    changed
}

/// Hands over pairs that slid well past the end of their facet; whether there was one.
fn update_facets(model: &Model, evaluation: &mut Evaluation, found: &mut Events) -> bool {
    let (mut changed, mut events) = (false, Vec::new());
    for (k, (contact, pairing)) in model.contacts.iter().zip(&mut evaluation.at.pairings).enumerate() {
        changed |= contact.kinematics.update_facets(&evaluation.y, pairing, &mut events);
        found.extend(events.drain(..).map(|event| (k, event)));
    }
    changed
}

/// Names a pressing constraint that no row holds: supports leave it no way out.
pub(crate) fn check_stuck(equations: &Equations, evaluation: &Evaluation) -> Result<(), Rejected> {
    let model = equations.model;
    let rows = Constraints::of(equations, evaluation).places;
    for (k, p) in evaluation.pressing().filter(|place| !rows.contains(place)) {
        let (contact, depth) = (&model.contacts[k], -evaluation.rows[k].row(p).gap);
        if contact.interface.is_constraint() && depth > GAP_TOLERANCE * model.scale {
            let node = contact.kinematics.secondary()[evaluation.at.pairings[k].pairs[p].node];
            return Err(Rejected::Stuck { contact: contact.name.clone(), node, depth });
        }
    }
    Ok(())
}

impl Iterate {
    /// The guess of a stage from where the iterate is: positions if the acceleration stayed for
    /// `dt`, multipliers as they are, each pair free to change facets again. Open pairs are found
    /// afresh, so that they depend on positions alone.
    pub(crate) fn predict(&mut self, v: &[f64], a: &[f64], dt: f64) {
        for (increment, (v, a)) in self.increment.iter_mut().zip(v.iter().zip(a)) {
            *increment += dt * (v + 0.5 * dt * a);
        }
        self.pairings.iter_mut().for_each(Pairing::restart);
    }
}
