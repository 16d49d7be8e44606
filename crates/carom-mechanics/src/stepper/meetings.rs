//! When nodes met the other side within a step: the first crossing of their paths, as far as they
//! would move without contact. Detection finds it along straight paths, in the plane with a
//! certificate (`carom_contact`, `swept`); the contact law acts from the end of the step on.

use crate::model::Model;
use crate::state::State;

/// A part of a step: positions, velocities and accelerations at its start, and its ends in time.
pub(super) struct Path<'a> {
    pub start: [&'a [f64]; 3],
    pub from: f64,
    pub to: f64,
}

/// The time at which each of these nodes, (contact, global node), with closed pairs in `now` first
/// met the other side; none if detection does not know it.
pub(super) fn meetings(
    model: &Model,
    now: &State,
    nodes: &[(usize, usize)],
    paths: &[Path],
) -> Vec<Option<f64>> {
    let mut found = vec![None; nodes.len()];
    if nodes.is_empty() {
        return found;
    }
    for path in paths {
        let [y, v, a] = path.start;
        let dt = path.to - path.from;
        let free: Vec<f64> =
            y.iter().zip(v.iter().zip(a)).map(|(y, (v, a))| y + dt * (v + 0.5 * dt * a)).collect();
        for (k, contact) in model.contacts.iter().enumerate() {
            let secondary = contact.kinematics.secondary();
            let place = |node: usize| {
                let mut closed = now.pairs[k].iter().filter(|pair| pair.active);
                closed.find(|pair| secondary[pair.node] == node).map(|pair| pair.node)
            };
            let (asked, places): (Vec<usize>, Vec<usize>) = (0..nodes.len())
                .filter(|&n| nodes[n].0 == k && found[n].is_none())
                .filter_map(|n| Some((n, place(nodes[n].1)?)))
                .unzip();
            if places.is_empty() {
                continue;
            }
            for (n, theta) in asked.into_iter().zip(contact.kinematics.met(&places, y, &free)) {
                found[n] = theta.map(|theta| path.from + theta * dt);
            }
        }
    }
    found
}
