//! Boundaries of the bodies of a model, in global node numbers.

use carom_contact::{Boundary, ClosedSurface, Depth, Skin, Surface};

use crate::model::{BodyInstance, Model};

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

    /// In the plane, where a boundary may be in contact with itself.
    pub(crate) fn plane(&self) -> Option<&Skin> {
        if let Self::Plane(skin) = self { Some(skin) } else { None }
    }
}

/// Position of a node, with zeros for the directions that a model does not have.
pub(crate) fn position(y: &[f64], dimension: usize, node: usize) -> [f64; 3] {
    std::array::from_fn(|i| if i < dimension { y[dimension * node + i] } else { 0.0 })
}

/// Distance between the first corners of a facet in the reference configuration.
pub(crate) fn length(model: &Model, facet: &[usize]) -> f64 {
    let d = model.dimension;
    let [start, end] = [facet[0], facet[1]].map(|node| &model.reference[d * node..d * node + d]);
    start.iter().zip(end).map(|(a, b)| (b - a) * (b - a)).sum::<f64>().sqrt()
}

pub(crate) fn part_of(model: &Model, node: usize) -> Option<usize> {
    model.parts.iter().position(|part| part.nodes().contains(&node))
}

pub(crate) fn skin_facets(part: &BodyInstance) -> Vec<Vec<usize>> {
    let skin = part.body.mesh().skin().into_iter();
    skin.map(|facet| facet.nodes.iter().map(|node| node + part.first_node).collect()).collect()
}

/// The nodes of a body's boundary, ascending.
pub(crate) fn skin_nodes(part: &BodyInstance) -> Vec<usize> {
    let mut nodes = skin_facets(part).concat();
    nodes.sort_unstable();
    nodes.dedup();
    nodes
}

/// The boundary of a body in the plane or in space.
pub(crate) fn skin(part: &BodyInstance) -> Option<BodySkin> {
    let shape = part.body.mesh().element.facet_shape();
    match shape.dimension() {
        2 => plane_skin(part).map(BodySkin::Plane),
        3 => Some(BodySkin::Space(ClosedSurface::new(Boundary::new(shape, &skin_facets(part), &[], 0)))),
        _ => None,
    }
}

/// The boundary of a body in the plane.
pub(crate) fn plane_skin(part: &BodyInstance) -> Option<Skin> {
    let shape = Some(part.body.mesh().element.facet_shape()).filter(|shape| shape.dimension() == 2)?;
    let facets = skin_facets(part);
    Some(Skin::new(Surface::new(shape, &facets, &vec![1.0; facets.len()])))
}

/// The same for its own nodes too.
pub(crate) fn folding_skin(model: &Model, part: &BodyInstance) -> Option<Skin> {
    Some(plane_skin(part)?.with_pieces(&part.body.mesh().pieces(), part.first_node, &model.reference))
}
