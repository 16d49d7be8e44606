//! Bodies of the plane whose boundary has no order: where two parts of it meet in a single node,
//! the facets around the node do not say which of them follows which, so contact cannot follow it.

use std::collections::{BTreeSet, HashSet};

use carom_case::Problem;
use carom_mechanics::model::{BodyInstance, Contact};

use super::side::coordinates;

/// A problem for each body in contact with other bodies or with itself at a node of whose boundary
/// more than one facet begins.
pub(super) fn branching(parts: &[BodyInstance], contacts: &[Contact]) -> Vec<Problem> {
    // Against a rigid obstacle only the nodes are needed.
    let between_sides = contacts.iter().filter(|contact| contact.facets.len() == 2 || contact.itself);
    let touched: BTreeSet<usize> =
        between_sides.flat_map(|contact| &contact.surface).map(|node| owner(parts, *node)).collect();
    touched.into_iter().filter_map(|part| meets_itself(part, &parts[part])).collect()
}

fn owner(parts: &[BodyInstance], node: usize) -> usize {
    parts.partition_point(|part| part.nodes().end <= node)
}

fn meets_itself(k: usize, part: &BodyInstance) -> Option<Problem> {
    let mesh = part.body.mesh();
    if mesh.dimension() != 2 {
        return None;
    }
    let mut starts = HashSet::new();
    let node = part.skin().iter().map(|facet| facet.nodes[0]).find(|node| !starts.insert(*node))?;
    let place = coordinates(&mesh.nodes.flat()[2 * node..2 * node + 2]);
    Some(Problem::new(
        format!("body[{k}].mesh"),
        format!("the boundary of body \"{}\" meets itself in the single node at {place}", part.name),
        "contact follows the boundary of a body from facet to facet; here two facets leave one node",
        "give each of the two parts a node of its own there, or let cells join them along an edge",
    ))
}
