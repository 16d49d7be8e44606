//! Boundaries of the bodies of a model, in global node numbers.

use carom_contact::{Boundary, ClosedSurface, Depth, InsideItself, Side, Skin, Surface};
use carom_solid::shortest_edge;

use crate::model::{BodyInstance, Model, bounds};

/// The boundary of a body.
#[derive(Debug)]
pub(crate) enum BodySkin {
    Plane(Skin),
    Space(ClosedSurface),
}

impl BodySkin {
    /// Global numbers of the nodes of a facet.
    pub(crate) fn facet_nodes(&self, facet: usize) -> &[usize] {
        match self {
            Self::Plane(skin) => skin.facet_nodes(facet),
            Self::Space(surface) => surface.facet_nodes(facet),
        }
    }

    /// How much further a point of a facet may move than each of its nodes.
    pub(crate) fn amplification(&self) -> f64 {
        match self {
            Self::Plane(skin) => skin.amplification(),
            Self::Space(surface) => surface.amplification(),
        }
    }

    /// Moves it to positions `y`.
    pub(crate) fn update(&mut self, y: &[f64]) {
        match self {
            Self::Plane(skin) => skin.update(y),
            Self::Space(surface) => surface.update(y),
        }
    }

    /// Where a point lies, searched from a facet near it if one is known.
    pub(crate) fn depth(&self, point: [f64; 3], from: Option<usize>, y: &[f64]) -> Option<Depth> {
        match self {
            Self::Plane(skin) => skin.depth([point[0], point[1]], from, y),
            Self::Space(surface) => surface.depth(point, from, y),
        }
    }

    /// Distance between a point and one of a facet.
    pub(crate) fn distance(&self, facet: usize, xi: [f64; 2], point: [f64; 3], y: &[f64]) -> f64 {
        match self {
            Self::Plane(skin) => skin.distance(facet, xi[0], [point[0], point[1]], y),
            Self::Space(surface) => surface.distance(facet, xi, point, y),
        }
    }

    /// Where a node of the boundary lies relative to those parts of it that it may meet, if one is
    /// nearer than `reach`.
    pub(crate) fn depth_of(&self, node: usize, side: Side, reach: f64, y: &[f64]) -> Option<Depth> {
        match self {
            Self::Plane(skin) => skin.depth_of(node, side, reach, y),
            Self::Space(surface) => surface.depth_of(node, side, reach, y),
        }
    }

    /// Whether two facets that do not meet each other's nodes cross. Pairs that are `known` do not
    /// count.
    pub(crate) fn crosses_itself(&self, y: &[f64], known: impl Fn(usize, usize) -> bool) -> bool {
        match self {
            Self::Plane(skin) => skin.crosses_itself(y, known),
            Self::Space(surface) => surface.crosses_itself(y, known),
        }
    }

    /// How far a coordinate of a node may change before two facets can cross.
    pub(crate) fn clearance_to_itself(&self, y: &[f64]) -> f64 {
        match self {
            Self::Plane(skin) => skin.clearance_to_itself(y),
            Self::Space(surface) => surface.clearance_to_itself(y),
        }
    }

    /// The node that lies deepest inside its own body, if one does.
    pub(crate) fn deepest_in_itself(&self, y: &[f64]) -> Option<InsideItself> {
        match self {
            Self::Plane(skin) => skin.deepest_in_itself(y),
            Self::Space(surface) => surface.deepest_in_itself(y),
        }
    }
}

/// Position of a node, with zeros for the directions that a model does not have.
pub(crate) fn position(y: &[f64], dimension: usize, node: usize) -> [f64; 3] {
    std::array::from_fn(|i| if i < dimension { y[dimension * node + i] } else { 0.0 })
}

/// Length of the shortest edge of a facet in the reference configuration.
pub(crate) fn length(model: &Model, facet: &[usize]) -> f64 {
    shortest_edge(facet, &model.reference, model.dimension)
}

pub(crate) fn part_of(model: &Model, node: usize) -> Option<usize> {
    model.parts.iter().position(|part| part.nodes().contains(&node))
}

pub(crate) fn skin_facets(part: &BodyInstance) -> Vec<Vec<usize>> {
    part.skin().iter().map(|facet| facet.nodes.iter().map(|node| node + part.first_node).collect()).collect()
}

/// The nodes of a body's boundary, ascending.
pub(crate) fn skin_nodes(part: &BodyInstance) -> Vec<usize> {
    let mut nodes = skin_facets(part).concat();
    nodes.sort_unstable();
    nodes.dedup();
    nodes
}

/// The boundary of a body in the plane or in space.
pub(crate) fn skin(model: &Model, part: &BodyInstance) -> Option<BodySkin> {
    match part.body.mesh().element.facet_shape().dimension() {
        2 => plane_surface(model, part).map(|surface| BodySkin::Plane(Skin::new(surface))),
        3 => Some(BodySkin::Space(ClosedSurface::new(surface(model, part)))),
        _ => None,
    }
}

/// The boundary of a body in the plane.
fn plane_surface(model: &Model, part: &BodyInstance) -> Option<Surface> {
    let shape = Some(part.body.mesh().element.facet_shape()).filter(|shape| shape.dimension() == 2)?;
    let facets = skin_facets(part);
    let surface = Surface::new(shape, &facets, &vec![1.0; facets.len()]);
    let is_fixed = |node: usize, axis: usize| model.fixed[2 * node + axis];
    Some(surface.with_mirrors(&model.reference, &bounds(&model.parts, &model.reference), is_fixed))
}

/// The boundary of a body in space.
fn surface(model: &Model, part: &BodyInstance) -> Boundary {
    let shape = part.body.mesh().element.facet_shape();
    let boundary = Boundary::new(shape, &skin_facets(part), &[], 0);
    let is_fixed = |node: usize, axis: usize| model.fixed[3 * node + axis];
    boundary.with_mirrors(&model.reference, &bounds(&model.parts, &model.reference), is_fixed)
}

/// Nodes of a body's boundary at convex kinks of more than 30° in the reference configuration,
/// ascending.
pub(crate) fn kinks(model: &Model, part: &BodyInstance) -> Vec<usize> {
    match part.body.mesh().element.facet_shape().dimension() {
        3 => surface(model, part).nodes_of_sharp_edges(&model.reference),
        _ => plane_surface(model, part).map_or_else(Vec::new, |surface| surface.corners(&model.reference)),
    }
}

/// The same as [`skin`] for its own nodes too.
pub(crate) fn folding_skin(model: &Model, part: &BodyInstance) -> Option<BodySkin> {
    let pieces = part.body.mesh().pieces();
    let first = part.first_node;
    let reference = &model.reference;
    Some(match skin(model, part)? {
        BodySkin::Plane(skin) => BodySkin::Plane(skin.with_pieces(&pieces, first, reference)),
        BodySkin::Space(surface) => BodySkin::Space(surface.with_pieces(&pieces, first, reference)),
    })
}
