//! Bodies of the plane whose boundary has no order: where two parts of it meet in a single node,
//! the facets around the node do not say which of them follows which, so contact cannot follow it.

use std::collections::HashSet;

use carom_case::Problem;
use carom_mechanics::model::BodyInstance;

use super::side::{Side, coordinates};

/// A node of the boundary of a side's body at which more than one facet begins.
pub(super) fn branching(side: &Side, parts: &[BodyInstance], path: String) -> Option<Problem> {
    let part = &parts[side.part];
    let mesh = part.body.mesh();
    if mesh.dimension() != 2 {
        return None;
    }
    let mut starts = HashSet::new();
    let node = mesh.skin().into_iter().map(|facet| facet.nodes[0]).find(|node| !starts.insert(*node))?;
    let place = coordinates(&mesh.nodes.flat()[2 * node..2 * node + 2]);
    Some(Problem::new(
        path,
        format!("the boundary of body \"{}\" meets itself in the single node at {place}", part.name),
        "contact follows the boundary of a body from facet to facet; here two facets leave one node",
        "give each of the two parts a node of its own there, or let cells join them along an edge",
    ))
}
