//! The sides named in a case, `body.side`, in the node numbers of the whole model.

use std::collections::HashSet;

use carom_case::Problem;
use carom_mechanics::model::BodyInstance;
use carom_solid::FacetShape;

/// A side in global node numbers.
#[derive(Clone)]
pub(crate) struct Side {
    pub(crate) part: usize,
    pub(crate) nodes: Vec<usize>,
    pub(crate) facets: Vec<Vec<usize>>,
    pub(crate) orientations: Vec<f64>,
    pub(crate) shape: FacetShape,
}

impl Side {
    /// The side without these facets, given by their nodes in ascending order; all of it if nothing
    /// would be left.
    pub(crate) fn without(mut self, closed: &HashSet<Vec<usize>>) -> Self {
        let is_open: Vec<bool> =
            self.facets.iter().map(|facet| !closed.contains(&ascending(facet.clone()))).collect();
        if closed.is_empty() || !is_open.contains(&true) {
            return self;
        }
        let facets = self.facets.into_iter().zip(self.orientations).zip(is_open);
        let open = facets.filter(|(_, is_open)| *is_open).map(|(facet, _)| facet);
        (self.facets, self.orientations) = open.unzip();
        let left: HashSet<usize> = self.facets.iter().flatten().copied().collect();
        self.nodes.retain(|node| left.contains(node));
        self
    }

    /// The other facets of its body's boundary.
    pub(crate) fn rest(&self, parts: &[BodyInstance]) -> Vec<Vec<usize>> {
        if self.shape == FacetShape::Point {
            // A point has no neighbours.
            return Vec::new();
        }
        let own: HashSet<&[usize]> = self.facets.iter().map(Vec::as_slice).collect();
        let part = &parts[self.part];
        let facets =
            part.skin().iter().map(|facet| facet.nodes.iter().map(|n| n + part.first_node).collect());
        facets.filter(|facet: &Vec<usize>| !own.contains(facet.as_slice())).collect()
    }
}

/// The side of a name; a missing one is a problem with the key `path`.
pub(crate) fn side(parts: &[BodyInstance], name: &str, path: &str) -> Result<Side, Problem> {
    let missing =
        |why: String, help: String| Problem::new(path, format!("there is no side \"{name}\""), why, help);
    let bodies = || parts.iter().map(|p| p.name.as_str()).collect::<Vec<_>>().join(", ");
    let (body, side) = name
        .split_once('.')
        .ok_or_else(|| missing("a side is written body.side".into(), format!("bodies: {}", bodies())))?;
    let part = parts
        .iter()
        .position(|p| p.name == body)
        .ok_or_else(|| missing(format!("there is no body \"{body}\""), format!("bodies: {}", bodies())))?;
    let mesh = parts[part].body.mesh();
    let first = parts[part].first_node;
    let (Some(facets), Some(nodes)) = (mesh.sides.get(side), mesh.side_nodes(side)) else {
        let sides = mesh.sides.keys().map(String::as_str).collect::<Vec<_>>().join(", ");
        if sides.is_empty() {
            return Err(missing(
                format!("the mesh of \"{body}\" has no sides"),
                "name a part of its boundary".into(),
            ));
        }
        return Err(missing(format!("the sides of \"{body}\" are: {sides}"), "use one of them".into()));
    };
    Ok(Side {
        part,
        nodes: nodes.iter().map(|n| n + first).collect(),
        facets: facets.iter().map(|f| f.nodes.iter().map(|n| n + first).collect()).collect(),
        orientations: facets.iter().map(|f| mesh.orientation(f)).collect(),
        shape: mesh.element.facet_shape(),
    })
}

/// The nodes of a facet in ascending order, by which it is known whatever lists it.
pub(super) fn ascending(mut nodes: Vec<usize>) -> Vec<usize> {
    nodes.sort_unstable();
    nodes
}

/// The part that a node belongs to.
pub(crate) fn owner(parts: &[BodyInstance], node: usize) -> Option<&BodyInstance> {
    parts.iter().find(|part| part.nodes().contains(&node))
}

/// A position for messages, without the noise of its last digits.
pub(super) fn coordinates(place: &[f64]) -> String {
    let places: Vec<_> = place.iter().map(|x| ((x * 1e9).round() / 1e9 + 0.0).to_string()).collect();
    format!("[{}]", places.join(", "))
}
