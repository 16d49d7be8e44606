//! Contact status of an iterate: search and hand-over of pairs, active sets, and constraints that
//! cannot be satisfied.

use carom_contact::constants::ROUND_OFF;
use std::collections::BTreeSet;

use carom_contact::{
    ActiveSet, Along, Contender, FrictionPair, FrictionState, Pair, PairEvent, Pairing, Row, StickSlip,
    inner, length,
};

use crate::contact::augmented;
use crate::contact::constraints::{Constraints, follows};
use crate::contact::depths::{begin, beginning, ease};
use crate::contact::prevented_slips::PreventedSlips;
use crate::contact::rounds::Rounds;
use crate::linear::system::System;
use crate::model::{Contact, Model};
use crate::rejected::Rejected;
use crate::stage::equations::Equations;
use crate::stage::evaluation::{Evaluation, Iterate};
use crate::timings::timed;
use crate::workspace::Workspace;

/// Traction over the cone that stands for a slip that a support enforces.
const BEYOND: f64 = 2.0;

/// Correction, relative to L, below which facets are handed over before convergence.
const CLOSE: f64 = 1e-5;
/// Correction, over the depth that a node may have without contact, below which it may come into
/// contact before convergence.
const KNOWN: f64 = 0.01;
/// Number of early facet updates in a solve, before corrections are that small.
const FACET_UPDATES: u32 = 12;

/// Events of pairs, with the index of their contact.
pub(crate) type Events = Vec<(usize, PairEvent)>;

/// Prepares the pairs for a step from positions `y`.
pub(crate) fn start_step(model: &Model, y: &[f64], pairings: &mut [Pairing]) {
    for (contact, pairing) in model.contacts.iter().zip(&mut *pairings) {
        pairing.pairs.iter_mut().for_each(|pair| {
            contact.kinematics.start_step(pair, y);
            contact.renew_spring(pair);
        });
    }
    ease(model, y, pairings);
}

/// Updates the pairs for motion from `before` to `now`; returns whether that requires another
/// solve.
pub(crate) fn search(
    model: &Model,
    before: &[f64],
    now: &[f64],
    pairings: &mut [Pairing],
    found: &mut Events,
) -> bool {
    each(model, pairings, found, |contact, pairing, events| {
        contact.kinematics.search(before, now, pairing, events)
    })
}

/// Collects the events of a change of all pairs; returns whether one requires another solve.
fn each(
    model: &Model,
    pairings: &mut [Pairing],
    found: &mut Events,
    mut change: impl FnMut(&Contact, &mut Pairing, &mut Vec<PairEvent>) -> bool,
) -> bool {
    let mut changed = false;
    let mut events = Vec::new();
    for (k, (contact, pairing)) in model.contacts.iter().zip(pairings).enumerate() {
        changed |= change(contact, pairing, &mut events);
        found.extend(events.drain(..).map(|event| (k, event)));
    }
    changed
}

/// Contact changes during the solve of a stage.
pub(crate) struct ContactUpdate<'a> {
    equations: &'a Equations<'a>,
    /// Positions at the end of the previous stage, for trajectories.
    before: &'a [f64],
    sets: Vec<ActiveSet>,
    /// Stick and slip of each contact; of no use without friction.
    holds: Vec<StickSlip>,
    /// Remaining early facet updates.
    facet_updates: u32,
    rounds: Rounds,
    /// The smallest relative singular value of the interface so far, with the sign of its
    /// determinant.
    pub(crate) regularity: f64,
    /// Events so far.
    pub(crate) events: Events,
}

impl<'a> ContactUpdate<'a> {
    /// The initial state for a stage.
    pub(crate) fn new(equations: &'a Equations<'a>, before: &'a [f64]) -> Self {
        let model = equations.model;
        let set = |contact: &Contact| ActiveSet::new(model.gap_tolerance, contact.within);
        let friction_state = |contact: &Contact| StickSlip::new(model.gap_tolerance, contact.within);
        Self {
            equations,
            before,
            sets: model.contacts.iter().map(set).collect(),
            holds: model.contacts.iter().map(friction_state).collect(),
            facet_updates: FACET_UPDATES,
            rounds: Rounds::new(),
            regularity: f64::INFINITY,
            events: Events::new(),
        }
    }

    /// Prepares the multipliers of a guess.
    pub(crate) fn start(&self, guess: &mut Iterate) {
        augmented::start(self.equations.model, guess);
    }

    /// Before the first load step, activates initial contacts if supports leave rigid motions free.
    /// Returns whether there are any.
    pub(crate) fn activate_initial(&self, now: &mut Evaluation) -> bool {
        let Equations { model, stage, .. } = self.equations;
        // A spring that is compressed by round-off does not press.
        let presses = |(k, p): (usize, usize)| {
            model.contacts[k].interface.is_constraint() || now.rows[k].row(p).gap < -ROUND_OFF * model.scale
        };
        if !stage.is_static() || model.unconstrained.is_empty() || now.pressing().any(presses) {
            return false;
        }
        let mut changed = false;
        for (k, contact) in model.contacts.iter().enumerate() {
            for (pair, row) in now.at.pairings[k].pairs.iter_mut().zip(now.rows[k].iter()) {
                if contact.kinematics.nearest(pair, row.gap, &now.y) <= ROUND_OFF * model.scale {
                    (pair.active, changed) = (true, true);
                }
            }
        }
        changed
    }

    /// Reports an active constraint without a row: others prevent it from being satisfied. A field
    /// of pressure presses for those beside it.
    pub(crate) fn check_satisfiable(&self, now: &Evaluation) -> Result<(), Rejected> {
        let model = self.equations.model;
        let rows = Constraints::of(self.equations, now);
        let gaps: BTreeSet<_> =
            rows.list.iter().filter(|row| row.slip.is_none()).map(|row| row.place).collect();
        let is_held = |place: &(usize, usize)| gaps.contains(place) || rows.covered.contains(place);
        for (k, p) in now.pressing().filter(|place| !is_held(place)) {
            let contact = &model.contacts[k];
            let depth = -now.rows[k].row(p).gap;
            let is_deep = depth > model.gap_tolerance && !follows(self.equations, now, (k, p));
            if contact.interface.is_constraint() && is_deep {
                let node = contact.node(&now.at.pairings[k].pairs[p]);
                return Err(Rejected::Overconstrained { contact: contact.name.clone(), node, depth });
            }
        }
        Ok(())
    }

    /// Begins another round from a converged iterate, if augmented Lagrangians need one; returns
    /// whether they do.
    ///
    /// # Errors
    /// If there were too many.
    pub(crate) fn next_round(&mut self, now: &mut Evaluation) -> Result<bool, Rejected> {
        let next = self.rounds.next(self.equations, now)?;
        if next {
            self.restart();
        }
        Ok(next)
    }

    /// Clears the visited sets: the pairs themselves have changed.
    pub(crate) fn restart(&mut self) {
        self.sets.iter_mut().for_each(ActiveSet::restart);
        self.holds.iter_mut().for_each(StickSlip::restart);
    }

    /// Finds the pairs of an iterate at positions `now`; returns whether that requires another
    /// solve.
    pub(crate) fn search(&mut self, now: &[f64], pairings: &mut [Pairing]) -> bool {
        let changed = search(self.equations.model, self.before, now, pairings, &mut self.events);
        self.begin(pairings);
        changed
    }

    /// Notes the depths at which pairs begin. Load steps create no energy, and keep none.
    fn begin(&self, pairings: &mut [Pairing]) {
        let Equations { model, state, stage, .. } = self.equations;
        let before = beginning(state, self.before).filter(|_| !stage.is_static());
        begin(model, before, pairings);
    }

    /// Updates active sets and pairs for an iterate; returns whether one changed. `settled`: the
    /// iterate has otherwise converged; `step`: the last correction.
    ///
    /// # Errors
    /// If a set returns to one visited before.
    pub(crate) fn update(
        &mut self,
        now: &mut Evaluation,
        settled: bool,
        step: f64,
        work: &mut Workspace,
    ) -> Result<bool, Rejected> {
        let model = self.equations.model;
        let mut changed = self.change_sets(now, &work.system, settled, step)?;
        changed |= self.change_holds(now, settled)?;
        let mut handed_over = !settled && self.facet_updates > 0 && self.update_facets(now);
        self.facet_updates -= u32::from(handed_over);
        changed |= handed_over;
        // The facet is known long before the position has converged.
        let nearly = step <= CLOSE * model.scale;
        if !changed && (settled || nearly) {
            handed_over = timed(&mut work.timings.contact, || self.search_again(now));
            changed = handed_over;
        }
        if handed_over {
            self.restart();
        }
        Ok(changed)
    }

    /// The search for an evaluated iterate. Unless it requires another solve the pairs are
    /// restored: inactive ones may have changed, while the existing rows, and the forces made of
    /// them, refer to the old order.
    fn search_again(&mut self, now: &mut Evaluation) -> bool {
        let pairings = now.at.pairings.clone();
        let changed = self.search(&now.y, &mut now.at.pairings);
        if !changed {
            now.at.pairings = pairings;
        }
        changed
    }

    /// Hands over pairs that slid well past the end of their facet; returns whether there was one.
    fn update_facets(&mut self, now: &mut Evaluation) -> bool {
        let Evaluation { at, y, .. } = now;
        let changed =
            each(self.equations.model, &mut at.pairings, &mut self.events, |contact, pairing, events| {
                contact.kinematics.update_facets(y, pairing, events)
            });
        self.begin(&mut at.pairings);
        changed
    }

    /// Updates each contact's active set; a released pair loses its multiplier. Returns whether one
    /// changed.
    fn change_sets(
        &mut self,
        evaluation: &mut Evaluation,
        system: &System,
        settled: bool,
        step: f64,
    ) -> Result<bool, Rejected> {
        let equations = self.equations;
        let model = self.equations.model;
        let mut changed = false;
        // The activity of a spring follows from its gap alone.
        let constraints =
            model.contacts.iter().enumerate().filter(|(_, contact)| contact.interface.is_constraint());
        // A sum over all dofs, the same for all contacts.
        let mut mean = None;
        for (k, contact) in constraints {
            if evaluation.at.pairings[k].pairs.is_empty() {
                continue;
            }
            let stiffness = *mean.get_or_insert_with(|| system.mean_stiffness(equations));
            let Iterate { pairings, increment, .. } = &mut evaluation.at;
            let pairs = &mut pairings[k].pairs;
            let contender = |(pair, row): (&Pair, Row)| {
                // Few nodes that may be inside reach their depth: they wait until it is known.
                let allowed = contact.kinematics.allowed(pair.node);
                let waits = !settled && !pair.active && allowed > 0.0 && step > KNOWN * allowed;
                let gap = if waits { f64::INFINITY } else { row.gap };
                Contender { active: pair.active, gap, lambda: pair.lambda, stiffness }
            };
            let contenders: Vec<Contender> =
                pairs.iter().zip(evaluation.rows[k].iter()).map(contender).collect();
            let rows = &evaluation.rows[k];
            let alike = |p: usize, q: usize| rows.row(p).alike(&rows.row(q));
            let changes =
                self.sets[k].changes(&contenders, settled, alike).map_err(|cycle| Rejected::Cycle {
                    contact: contact.name.clone(),
                    nodes: cycle.pairs.iter().map(|&p| contact.node(&pairs[p])).collect(),
                })?;
            for p in changes {
                (pairs[p].active, pairs[p].lambda, changed) = (!pairs[p].active, 0.0, true);
                (pairs[p].multiplier, pairs[p].tangential.before) = (0.0, [0.0; 2]);
                if contact.friction.is_some() {
                    let slip = equations.slip(k, &mut pairs[p], &evaluation.middle, increment);
                    let law = &equations.laws[k][pairs[p].node];
                    pairs[p].tangential.friction_state = FrictionState::under(law, slip, model.gap_tolerance);
                    pairs[p].tangential.traction = [0.0; 2];
                }
            }
        }
        Ok(changed)
    }

    /// Updates stick and slip of the closed pairs with friction; returns whether one changed.
    fn change_holds(&mut self, evaluation: &mut Evaluation, settled: bool) -> Result<bool, Rejected> {
        let equations = self.equations;
        let mut changed = false;
        let dragged = if settled { dragged(equations, evaluation) } else { BTreeSet::new() };
        for (k, contact) in equations.model.contacts.iter().enumerate() {
            if contact.friction.is_none() {
                continue;
            }
            let rub = |(p, pair): (usize, &Pair)| {
                // A pair that has just closed has no pressure yet. A pair whose gap others keep
                // closed, as a support or a tie does, has none when Newton's method has converged,
                // and cannot stick. A slip without friction or pressure goes on.
                let presses = pair.lambda != 0.0;
                let sticks = pair.tangential.friction_state == FrictionState::Stick;
                let rubs = if presses {
                    sticks || !equations.laws[k][pair.node].is_none()
                } else {
                    sticks && settled
                };
                let rubs = (pair.active && rubs).then(|| equations.rubs(evaluation, (k, p)))?;
                if dragged.contains(&(k, p)) {
                    let size = length(rubs.slip);
                    return Some(FrictionPair {
                        traction: rubs.slip.map(|s| BEYOND * rubs.cone * s / size),
                        ..rubs
                    });
                }
                Some(rubs)
            };
            let pairs = &evaluation.at.pairings[k].pairs;
            let rubs: Vec<Option<FrictionPair>> = pairs.iter().enumerate().map(rub).collect();
            let pairs = &mut evaluation.at.pairings[k].pairs;
            let changes =
                self.holds[k].changes(&rubs, settled).map_err(|cycle| Rejected::StickSlipCycle {
                    contact: contact.name.clone(),
                    nodes: cycle.pairs.iter().map(|&p| contact.node(&pairs[p])).collect(),
                    regularity: self.regularity,
                })?;
            for change in changes {
                pairs[change.pair].tangential.friction_state = change.friction_state;
                changed = true;
            }
        }
        Ok(changed)
    }
}

/// Sticks whose slip is not a row of the system, because supports determine it, and which it does
/// not keep: supports drag them along the surface.
fn dragged(equations: &Equations, evaluation: &Evaluation) -> BTreeSet<(usize, usize)> {
    let model = equations.model;
    let slides = |&(k, p): &(usize, usize)| {
        let contact = &model.contacts[k];
        let pair = &evaluation.at.pairings[k].pairs[p];
        let sticks = contact.friction.is_some() && pair.tangential.friction_state == FrictionState::Stick;
        let is_held = sticks && contact.augmentation.is_none() && equations.stick_spring(k, pair).is_none();
        is_held && length(evaluation.slip_of((k, p))) > model.gap_tolerance
    };
    let sliding: BTreeSet<_> = evaluation.pressing().filter(slides).collect();
    if sliding.is_empty() {
        return sliding;
    }
    let slips = PreventedSlips::of(equations, evaluation);
    let dropped = slips.dropped(evaluation);
    let along = |&(place, along): &((usize, usize), Along)| {
        sliding.contains(&place) && inner(along, evaluation.slip_of(place)).abs() > model.gap_tolerance
    };
    dropped.iter().filter(|of| along(of)).map(|(place, _)| *place).collect()
}
