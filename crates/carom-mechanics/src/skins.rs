//! Boundaries of the bodies of a model, in global node numbers.

use carom_contact::{Skin, Surface};

use crate::model::{BodyInstance, Model};

/// Distance between the ends of a facet in the reference configuration.
pub(crate) fn length(model: &Model, facet: &[usize]) -> f64 {
    let [start, end] = [facet[0], facet[1]].map(|node| &model.reference[2 * node..2 * node + 2]);
    (end[0] - start[0]).hypot(end[1] - start[1])
}

pub(crate) fn part_of(model: &Model, node: usize) -> Option<usize> {
    model.parts.iter().position(|part| part.nodes().contains(&node))
}

pub(crate) fn skin_facets(part: &BodyInstance) -> Vec<Vec<usize>> {
    let skin = part.body.mesh().skin().into_iter();
    skin.map(|facet| facet.nodes.iter().map(|node| node + part.first_node).collect()).collect()
}

/// The boundary of a body in the plane.
pub(crate) fn skin(part: &BodyInstance) -> Option<Skin> {
    let shape = Some(part.body.mesh().element.facet_shape()).filter(|shape| shape.dimension() == 2)?;
    let facets = skin_facets(part);
    Some(Skin::new(Surface::new(shape, &facets, &vec![1.0; facets.len()])))
}

/// The same for its own nodes too.
pub(crate) fn folding_skin(model: &Model, part: &BodyInstance) -> Option<Skin> {
    Some(skin(part)?.with_pieces(&part.body.mesh().pieces(), part.first_node, &model.reference))
}
