//! Who touches whom in an iterate: pairs found and handed over, the active set of each contact, pairs that nothing can hold.

use carom_contact::{ActiveSet, Contender, PairEvent};

use crate::evaluation::{Trial, mass_factor, stiffness_factor};
use crate::model::Model;
use crate::rejected::Rejected;
use crate::rows::independent_rows;
use crate::workspace::Workspace;

/// Penetration, as a fraction of L, that counts as touching.
pub(crate) const GAP_TOLERANCE: f64 = 1e-12;
/// Gap, as a fraction of L, of nodes that touch before the first load step.
const TOUCHING: f64 = 1e-9;

/// Brings the pairs up to date with the trial's positions; whether that asks for another solve.
pub(crate) fn detect<const D: usize>(
    model: &Model<D>,
    before: &[f64],
    trial: &mut Trial,
    found: &mut Vec<(usize, PairEvent)>,
) -> Result<bool, Rejected> {
    let (before, now) = (before.as_chunks::<D>().0, trial.y.as_chunks::<D>().0);
    let mut changed = false;
    for (k, contact) in model.contacts.iter().enumerate() {
        let mut events = Vec::new();
        changed |= contact
            .method
            .detect(before, now, &mut trial.pairs[k], &mut events)
            .map_err(|error| Rejected::Contact { contact: contact.name.clone(), error })?;
        found.extend(events.into_iter().map(|event| (k, event)));
    }
    Ok(changed)
}

/// The same for an evaluated trial: where nothing asks for another solve its pairs stay as they are. Open ones may have come and gone, and the gaps at hand, of
/// which the forces are made, belong to the pairs in their old order.
pub(crate) fn look_again<const D: usize>(
    model: &Model<D>,
    before: &[f64],
    trial: &mut Trial,
    found: &mut Vec<(usize, PairEvent)>,
) -> Result<bool, Rejected> {
    let pairs = trial.pairs.clone();
    let changed = detect(model, before, trial, found)?;
    if !changed {
        trial.pairs = pairs;
    }
    Ok(changed)
}

/// Hands over pairs that slid well past the end of their facet; whether there was one.
pub(crate) fn follow<const D: usize>(model: &Model<D>, trial: &mut Trial, found: &mut Vec<(usize, PairEvent)>) -> bool {
    let mut changed = false;
    for (k, contact) in model.contacts.iter().enumerate() {
        let mut events = Vec::new();
        changed |= contact.method.follow(trial.y.as_chunks::<D>().0, &mut trial.pairs[k], &mut events);
        found.extend(events.into_iter().map(|event| (k, event)));
    }
    changed
}

/// Before the first load step, lets bodies that supports leave free hold on to what they touch. Whether that is anything.
pub(crate) fn touch<const D: usize>(model: &Model<D>, trial: &mut Trial, work: &Workspace<D>) -> bool {
    if model.unheld.is_empty() || trial.pairs.iter().flatten().any(|p| p.active) {
        return false;
    }
    let mut changed = false;
    // A spring holds nothing before it is pressed.
    let constraints = model.contacts.iter().map(|contact| contact.penalty.is_none());
    for ((pairs, gaps), _) in trial.pairs.iter_mut().zip(&work.gaps).zip(constraints).filter(|(_, holds)| *holds) {
        for (pair, _) in pairs.iter_mut().zip(gaps).filter(|(_, gap)| gap.gap <= TOUCHING * model.scale) {
            (pair.active, changed) = (true, true);
        }
    }
    changed
}

/// Lets each contact's active set change; a released pair loses its multiplier.
pub(crate) fn change_sets<const D: usize>(
    model: &Model<D>,
    sets: &mut [ActiveSet],
    trial: &mut Trial,
    work: &Workspace<D>,
    settled: bool,
) -> Result<bool, Rejected> {
    let mut changed = false;
    // A spring presses or does not by its gap alone.
    for (k, set) in sets.iter_mut().enumerate().filter(|(k, _)| model.contacts[*k].penalty.is_none()) {
        let secondary = model.contacts[k].method.secondary();
        let stiffness = stiffness_of_touch(model, work);
        let contenders: Vec<Contender> = trial.pairs[k]
            .iter()
            .zip(&work.gaps[k])
            .map(|(pair, gap)| Contender { active: pair.active, gap: gap.gap, lambda: pair.lambda, stiffness })
            .collect();
        let changes = set.changes(&contenders, settled).map_err(|cycle| Rejected::Cycle {
            contact: model.contacts[k].name.clone(),
            nodes: cycle.pairs.iter().map(|&p| secondary[trial.pairs[k][p].node]).collect(),
        })?;
        for p in changes {
            let pair = &mut trial.pairs[k][p];
            pair.active = !pair.active;
            pair.lambda = 0.0;
            changed = true;
        }
    }
    Ok(changed)
}

/// Mean diagonal of the stage's tangent: makes a gap comparable with a multiplier.
fn stiffness_of_touch<const D: usize>(model: &Model<D>, work: &Workspace<D>) -> f64 {
    let sum: f64 = work.system.diagonal(mass_factor(&work.stage), stiffness_factor(&work.stage)).sum();
    sum / model.free.len().max(1) as f64
}

/// Names an active pair that no row holds: supports leave it no way out.
pub(crate) fn stuck<const D: usize>(model: &Model<D>, trial: &Trial, work: &Workspace<D>) -> Result<(), Rejected> {
    let rows = independent_rows(model, &trial.pairs, work);
    for (k, contact) in model.contacts.iter().enumerate().filter(|(_, contact)| contact.penalty.is_none()) {
        for (p, pair) in trial.pairs[k].iter().enumerate().filter(|(_, pair)| pair.active) {
            let depth = -work.gaps[k][p].gap;
            if !rows.contains(&(k, p)) && depth > GAP_TOLERANCE * model.scale {
                let node = contact.method.secondary()[pair.node];
                return Err(Rejected::Stuck { contact: contact.name.clone(), node, depth });
            }
        }
    }
    Ok(())
}
