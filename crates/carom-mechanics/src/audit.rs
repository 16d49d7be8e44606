//! An independent check of contact, without tree, pairs, certificate and nearest facet: every node
//! of either side is compared with every chord of the other body's outline.
//!
//! ```text
//! inside    the outline turns around the node by 2π, not by 0
//! depth     the smallest distance to a chord
//! passed    inside at an instant of the straight path of the step, and at neither end of it
//! ```
//!
//! It must find nothing that the measured penetration does not have, and no passage deeper than
//! twice what the contact allows. It costs nodes × chords × instants in every step. What it does
//! not judge is listed by [`unaudited`].

use std::f64::consts::PI;

use carom_solid::Bounds;

use crate::model::{BodyInstance, Model};
use crate::penetration::Depths;
use crate::skins::{length, part_of, skin_facets};

/// Chords of a curved facet.
const CHORDS: usize = 16;
/// Instants of a step's path between its ends.
const INSTANTS: usize = 32;
/// Depth over the length of a facet that chords may feign, and within which the two methods agree.
const SAME: f64 = 5e-3;
/// Depth over the length of a facet that a path through a body may have.
const PASSED: f64 = 0.01;

/// What the audit found.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum Doubt {
    /// A node lies deeper than what was measured.
    #[error("node {node} lies {depth:.3e} deep in body \"{body}\", while {measured:.3e} was measured")]
    Deeper {
        /// Global number.
        node: usize,
        /// The body.
        body: String,
        /// Its depth by the audit.
        depth: f64,
        /// The largest depth that was measured.
        measured: f64,
    },
    /// A node has passed through a body within a step.
    #[error("node {node} passed through body \"{body}\" within a step, {depth:.3e} deep")]
    Passed {
        /// Global number.
        node: usize,
        /// The body.
        body: String,
        /// Its largest depth on the way.
        depth: f64,
    },
}

/// Checks a step from positions `before` to `now` in the plane, whose penetration was `measured`.
///
/// # Errors
/// The first node that contradicts it.
pub fn audit(model: &Model, before: &[f64], now: &[f64], measured: Depths) -> Result<(), Doubt> {
    for contact in model.contacts.iter().filter(|contact| !contact.itself && model.dimension == 2) {
        let (Some(primary), [(_, one), (_, other)]) = (contact.primary_part, &contact.facets[..]) else {
            continue;
        };
        let Some(secondary) = one.first().and_then(|facet| part_of(model, facet[0])) else { continue };
        let kept = |node: usize| {
            let place = contact.kinematics.secondary().iter().position(|&n| n == node);
            place.map_or(0.0, |place| contact.kinematics.kept(place))
        };
        let allowed = |node: usize| {
            let places = contact.kinematics.secondary().iter().enumerate().filter(|(_, n)| **n == node);
            places.map(|(place, _)| contact.kinematics.allowed(place)).fold(0.0, f64::max)
        };
        for (facets, body) in [(one, primary), (other, secondary)] {
            let part = &model.parts[body];
            let path: Vec<Vec<[f64; 2]>> = (0..=INSTANTS)
                .map(|k| outline(part, &between(before, now, k as f64 / INSTANTS as f64)))
                .collect();
            let place = |k: usize, node: usize| {
                let t = k as f64 / INSTANTS as f64;
                [0, 1].map(|i| before[2 * node + i] + t * (now[2 * node + i] - before[2 * node + i]))
            };
            let all = path.iter().flatten().fold(Bounds::EMPTY, |mut bounds, point| {
                bounds.add(point);
                bounds
            });
            let size = facets.iter().map(|facet| length(model, facet)).fold(f64::INFINITY, f64::min);
            let size = skin_facets(part).iter().map(|facet| length(model, facet)).fold(size, f64::min);
            let longest = skin_facets(part).iter().map(|facet| length(model, facet)).fold(0.0, f64::max);
            let mut nodes = facets.concat();
            nodes.sort_unstable();
            nodes.dedup();
            let near = |node: usize| {
                let mut bounds = Bounds::of(&place(0, node));
                bounds.add(&place(INSTANTS, node));
                bounds.meets(&all)
            };
            for node in nodes.into_iter().filter(|&node| near(node) && kept(node) == 0.0) {
                let name = || part.name.clone();
                let depth_at = |k: usize| depth(place(k, node), &path[k]);
                let depth = depth_at(INSTANTS);
                if depth > measured.all + SAME * size {
                    return Err(Doubt::Deeper { node, body: name(), depth, measured: measured.all });
                }
                if depth == 0.0 && depth_at(0) == 0.0 {
                    let depth = (1..INSTANTS).map(depth_at).fold(0.0, f64::max);
                    // A path is measured at a few instants: its largest depth may be missed by a
                    // part.
                    let limit = allowed(node) + contact.depths[0].max(PASSED) * longest;
                    if depth > 2.0 * limit + SAME * longest {
                        return Err(Doubt::Passed { node, body: name(), depth });
                    }
                }
            }
        }
    }
    Ok(())
}

/// What [`audit`] does not judge in a model, in words.
pub fn unaudited(model: &Model) -> Vec<String> {
    let mut list = Vec::new();
    if model.dimension != 2 {
        return vec!["any contact, because the model is not plane".to_owned()];
    }
    for contact in &model.contacts {
        let name = &contact.name;
        if contact.itself {
            list.push(format!("contact \"{name}\" of a body with itself"));
        } else if contact.primary_part.is_none() || contact.facets.len() < 2 {
            list.push(format!("contact \"{name}\" with a rigid obstacle"));
        } else {
            let nodes = 0..contact.kinematics.secondary().len();
            let kept = nodes.filter(|&place| contact.kinematics.kept(place) > 0.0).count();
            if kept > 0 {
                list.push(format!("{kept} nodes of contact \"{name}\" that keep an overlap"));
            }
        }
    }
    list.push("bodies without a contact between them".to_owned());
    list
}

fn between(before: &[f64], now: &[f64], t: f64) -> Vec<f64> {
    before.iter().zip(now).map(|(a, b)| a + t * (b - a)).collect()
}

/// Chords of a body's outline, start and end of each in turn.
fn outline(part: &BodyInstance, y: &[f64]) -> Vec<[f64; 2]> {
    let mut chords = Vec::new();
    for facet in skin_facets(part) {
        let n = facet.len();
        // Nodes at equal parameters: both ends first.
        let order: Vec<usize> = [0].into_iter().chain(2..n).chain([1]).collect();
        let steps = if n == 2 { 1 } else { CHORDS };
        let place = |s: f64| {
            let mut at = [0.0; 2];
            for (j, &a) in order.iter().enumerate() {
                let others = (0..n).filter(|&i| i != j);
                let weight: f64 =
                    others.map(|i| ((n - 1) as f64 * s - i as f64) / (j as f64 - i as f64)).product();
                at[0] += weight * y[2 * facet[a]];
                at[1] += weight * y[2 * facet[a] + 1];
            }
            at
        };
        for k in 0..steps {
            chords.extend([k, k + 1].map(|k| place(k as f64 / steps as f64)));
        }
    }
    chords
}

/// Depth of a point inside an outline, 0 outside.
fn depth(point: [f64; 2], chords: &[[f64; 2]]) -> f64 {
    let (mut turn, mut nearest) = (0.0, f64::INFINITY);
    for chord in chords.chunks_exact(2) {
        let [a, b] = [chord[0], chord[1]].map(|p| [p[0] - point[0], p[1] - point[1]]);
        turn += (a[0] * b[1] - a[1] * b[0]).atan2(a[0] * b[0] + a[1] * b[1]);
        let along = [b[0] - a[0], b[1] - a[1]];
        let share = -(a[0] * along[0] + a[1] * along[1]) / (along[0] * along[0] + along[1] * along[1]);
        let share = share.clamp(0.0, 1.0);
        nearest = nearest.min((a[0] + share * along[0]).hypot(a[1] + share * along[1]));
    }
    if turn > PI { nearest } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::depth;

    #[test]
    fn a_point_is_inside_a_square_or_not() {
        let corners = [[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0]];
        let chords: Vec<[f64; 2]> = (0..4).flat_map(|k| [corners[k], corners[(k + 1) % 4]]).collect();
        assert!((depth([0.3, 1.0], &chords) - 0.3).abs() < 1e-15);
        assert_eq!(depth([-0.3, 1.0], &chords), 0.0);
        assert_eq!(depth([2.3, 2.4], &chords), 0.0);
    }
}
