//! Boundaries of the bodies of a model, in global node numbers.

use carom_contact::{Skin, Surface};
use carom_solid::FacetShape;

use crate::model::{BodyInstance, Contact, Model};

/// Distance between the ends of a facet in the reference configuration.
pub(crate) fn length(model: &Model, facet: &[usize]) -> f64 {
    let [start, end] = [facet[0], facet[1]].map(|node| &model.reference[2 * node..2 * node + 2]);
    (end[0] - start[0]).hypot(end[1] - start[1])
}

/// The contact of a facet with its own body.
pub(crate) fn itself(model: &Model, facet: &[usize]) -> Option<usize> {
    let contains = |contact: &Contact| contact.facets.iter().any(|(_, all)| all.iter().any(|f| f == facet));
    model.contacts.iter().position(|contact| contact.itself && contains(contact))
}

pub(crate) fn part_of(model: &Model, node: usize) -> Option<usize> {
    model.parts.iter().position(|part| part.nodes().contains(&node))
}

pub(crate) fn skin_facets(part: &BodyInstance) -> Vec<Vec<usize>> {
    let skin = part.body.mesh().skin().into_iter();
    skin.map(|facet| facet.nodes.iter().map(|node| node + part.first_node).collect()).collect()
}

pub(crate) fn skin(model: &Model, part: &BodyInstance) -> Option<Skin> {
    let shape = part.body.mesh().element.facet_shape().filter(|shape| *shape != FacetShape::Point)?;
    let facets = skin_facets(part);
    let skin = Skin::new(Surface::new(shape, &facets, &vec![1.0; facets.len()]));
    Some(skin.with_pieces(&part.body.mesh().pieces(), part.first_node, &model.reference))
}
