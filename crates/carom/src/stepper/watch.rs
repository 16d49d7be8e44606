//! Pairs of the steppers that treat contact themselves: found along the step, and kept from step to step while they touch or penetrate. Detection takes a node
//! behind a facet at the start of a step for one that came from elsewhere, so a law that lets nodes penetrate must not forget them.

use carom_contact::{Linearised, Pair, PairEvent};

use crate::model::{Contact, Model};
use crate::rejected::Rejected;
use crate::state::State;

/// The pairs a step begins with: those that touched or are behind, released and without multiplier.
pub(super) fn carried<const D: usize>(model: &Model<D>, state: &State) -> Vec<Vec<Pair>> {
    let mut pairs = state.pairs.clone();
    for (contact, pairs) in model.contacts.iter().zip(&mut pairs) {
        pairs.retain_mut(|pair| {
            let kept = pair.active || gap_at(contact, pair, &state.y) < 0.0;
            (pair.active, pair.lambda, pair.left) = (false, 0.0, None);
            kept
        });
    }
    pairs
}

/// Brings the pairs up to date with motion from `before` to `now`; whether that asks for another look.
pub(super) fn look<const D: usize>(
    model: &Model<D>,
    before: &[f64],
    now: &[f64],
    pairs: &mut [Vec<Pair>],
    events: &mut Vec<(usize, PairEvent)>,
) -> Result<bool, Rejected> {
    let (before, now) = (before.as_chunks::<D>().0, now.as_chunks::<D>().0);
    let mut changed = false;
    for (k, contact) in model.contacts.iter().enumerate() {
        let mut found = Vec::new();
        changed |= contact
            .method
            .detect(before, now, &mut pairs[k], &mut found)
            .map_err(|error| Rejected::Contact { contact: contact.name.clone(), error })?;
        events.extend(found.into_iter().map(|event| (k, event)));
    }
    Ok(changed)
}

/// Gap of a pair at positions `y`, its contact point moved there; infinite where there is no unique closest point, which is far away.
pub(super) fn gap_at<const D: usize>(contact: &Contact<D>, pair: &mut Pair, y: &[f64]) -> f64 {
    let mut gap = Linearised::default();
    let found = contact.method.linearise(pair, y.as_chunks::<D>().0, 0.0, &mut gap);
    found.map_or(f64::INFINITY, |()| gap.gap)
}

/// Gaps and gradients of all pairs at `y`, their contact points moved there.
///
/// # Errors
/// An active pair has no unique closest point.
pub(super) fn gradients_into<const D: usize>(
    model: &Model<D>,
    y: &[f64],
    pairs: &mut [Vec<Pair>],
    gaps: &mut [Vec<Linearised<D>>],
) -> Result<(), Rejected> {
    for (k, contact) in model.contacts.iter().enumerate() {
        gaps[k].resize(pairs[k].len(), Linearised::default());
        for (pair, gap) in pairs[k].iter_mut().zip(&mut gaps[k]) {
            match contact.method.linearise(pair, y.as_chunks::<D>().0, 0.0, gap) {
                Ok(()) => {}
                Err(error) if pair.active => {
                    return Err(Rejected::Contact { contact: contact.name.clone(), error });
                }
                Err(_) => gap.gap = f64::INFINITY,
            }
        }
    }
    Ok(())
}

/// Depth of the deepest watched node at a state, ≥ 0.
pub(super) fn depth<const D: usize>(model: &Model<D>, state: &State) -> f64 {
    let pairs = model.contacts.iter().zip(&state.pairs).flat_map(|(c, pairs)| pairs.iter().map(move |p| (c, p)));
    pairs.map(|(contact, pair)| -gap_at(contact, &mut pair.clone(), &state.y)).fold(0.0, f64::max)
}

/// How far a node can come closer to a facet within a step at these velocities.
pub(super) fn approach<const D: usize>(v: &[f64], dt: f64) -> f64 {
    let fastest = v.as_chunks::<D>().0.iter().map(|v| v.iter().map(|v| v * v).sum::<f64>()).fold(0.0, f64::max);
    2.0 * dt * fastest.sqrt()
}

/// ∇g·x.
pub(super) fn along<const D: usize>(gap: &Linearised<D>, x: &[f64]) -> f64 {
    (0..gap.count).map(|p| (0..D).map(|i| gap.gradient[p][i] * x[gap.nodes[p] * D + i]).sum::<f64>()).sum()
}
