//! An independent check of contact, without tree, pairs, certificate and nearest facet: every node
//! of either side is compared with every piece of the other body's outline (`outline.rs`).
//!
//! ```text
//! passed    inside at an instant of the straight path of the step, and at neither end of it
//! ```
//!
//! It must find nothing that the measured penetration does not have, and no passage deeper than
//! twice what the contact allows. It costs nodes × pieces × instants in every step. What it does
//! not judge is listed by [`unaudited`].

use carom_solid::Bounds;

use crate::check::outline::Outline;
use crate::check::penetration::Depths;
use crate::check::skins::{length, part_of, position, skin_facets};
use crate::model::Model;

/// Intervals of a step's path, at least and at most.
const INTERVALS: [usize; 2] = [32, 512];
/// Motion in an interval over the length of the shortest facet, up to the most intervals.
const MOTION: f64 = 0.5;
/// Depth over the length of a facet that pieces may feign, and within which the two methods agree.
const SAME: f64 = 5e-3;
/// Depth over the length of a facet that a path through a body may have.
const PASSED: f64 = 0.01;

/// What the audit found.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum AuditFailure {
    /// A node lies deeper than what was measured.
    #[error(
        "node {node} lies {depth:.3e} [length] deep in body \"{body}\", while {measured:.3e} [length] was measured"
    )]
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
    #[error("node {node} passed through body \"{body}\" within a step, {depth:.3e} [length] deep")]
    Passed {
        /// Global number.
        node: usize,
        /// The body.
        body: String,
        /// Its largest depth on the way.
        depth: f64,
    },
}

/// Checks a step from positions `before` to `now`, in the plane or in space, whose penetration was
/// `measured`.
///
/// # Errors
/// The first node that contradicts it.
pub fn audit(model: &Model, before: &[f64], now: &[f64], measured: Depths) -> Result<(), AuditFailure> {
    let d = model.dimension;
    for contact in model.contacts.iter().filter(|contact| !contact.itself && d > 1) {
        let (Some(primary), [(_, one), (_, other)]) = (contact.primary_part, &contact.facets[..]) else {
            continue;
        };
        let Some(secondary) = one.first().and_then(|facet| part_of(model, facet[0])) else { continue };
        // Edges that follow the nodes have the numbers of nodes.
        let places = || contact.kinematics.secondary().iter().enumerate().take(contact.kinematics.nodes());
        let kept = |node: usize| {
            let place = places().find(|(_, n)| **n == node);
            place.map_or(0.0, |(place, _)| contact.kinematics.kept(place))
        };
        let allowed = |node: usize| {
            let of_node = places().filter(|(_, n)| **n == node);
            of_node.map(|(place, _)| contact.kinematics.allowed(place)).fold(0.0, f64::max)
        };
        for (facets, body) in [(one, primary), (other, secondary)] {
            let part = &model.parts[body];
            let outlines = [before, now].map(|y| Outline::new(part, y));
            let all = outlines[0].bounds().union(&outlines[1].bounds());
            let lengths = || skin_facets(part).into_iter().map(|facet| length(model, &facet));
            let size = facets.iter().map(|facet| length(model, facet)).fold(f64::INFINITY, f64::min);
            let size = lengths().fold(size, f64::min);
            let longest = lengths().fold(0.0, f64::max);
            let mut nodes = facets.concat();
            nodes.sort_unstable();
            nodes.dedup();
            let ends = |node: usize| [before, now].map(|y| position(y, d, node));
            let near = |node: usize| ends(node).iter().collect::<Bounds>().meets(&all);
            nodes.retain(|&node| near(node) && kept(node) == 0.0);
            let mut outside = Vec::new();
            for node in nodes {
                let [from, to] = ends(node);
                let depth = outlines[1].depth(to);
                if depth > measured.all + SAME * size {
                    let body = part.name.clone();
                    return Err(AuditFailure::Deeper { node, body, depth, measured: measured.all });
                }
                if depth == 0.0 && outlines[0].depth(from) == 0.0 {
                    outside.push((node, 0.0_f64));
                }
            }
            if outside.is_empty() {
                continue;
            }
            // Relative to one node of the body.
            let first = ends(part.first_node);
            let moved = outside.iter().map(|&(node, _)| {
                let own = ends(node);
                let along = |i: usize| (own[1][i] - own[0][i]) - (first[1][i] - first[0][i]);
                (0..d).map(|i| along(i) * along(i)).sum::<f64>().sqrt()
            });
            let fine = (moved.fold(0.0, f64::max) / (MOTION * size)).ceil() as usize;
            let intervals = fine.clamp(INTERVALS[0], INTERVALS[1]);
            for k in 1..intervals {
                let t = k as f64 / intervals as f64;
                let y = between(before, now, t);
                let outline = Outline::new(part, &y);
                for (node, deepest) in &mut outside {
                    *deepest = deepest.max(outline.depth(position(&y, d, *node)));
                }
            }
            for (node, depth) in outside {
                // A path is measured at a few instants: its largest depth may be missed by a part.
                let limit = allowed(node) + contact.depths.kinks.max(PASSED) * longest;
                if depth > 2.0 * limit + SAME * longest {
                    return Err(AuditFailure::Passed { node, body: part.name.clone(), depth });
                }
            }
        }
    }
    Ok(())
}

/// What [`audit`] does not judge in a model, in words.
pub fn unaudited(model: &Model) -> Vec<String> {
    let mut list = Vec::new();
    if model.dimension < 2 {
        return vec!["any contact, because the model is a line".to_owned()];
    }
    for contact in &model.contacts {
        let name = &contact.name;
        if contact.itself {
            list.push(format!("contact \"{name}\" of a body with itself"));
        } else if contact.primary_part.is_none() || contact.facets.len() < 2 {
            list.push(format!("contact \"{name}\" with a rigid obstacle"));
        } else {
            let nodes = 0..contact.kinematics.nodes();
            let kept = nodes.filter(|&place| contact.kinematics.kept(place) > 0.0).count();
            if kept > 0 {
                list.push(format!("{kept} nodes of contact \"{name}\" that keep an overlap"));
            }
        }
    }
    if model.dimension == 3 {
        list.push("edges between their nodes".to_owned());
    }
    list.push("bodies without a contact between them".to_owned());
    list
}

fn between(before: &[f64], now: &[f64], t: f64) -> Vec<f64> {
    before.iter().zip(now).map(|(a, b)| a + t * (b - a)).collect()
}
