//! Places of contacts that lie inside the other side, as at the start of a run: nodes, edges, parts
//! of rigid obstacles between nodes, and sides on average where a pressure field holds them.

use crate::check::penetration::{Penetration, below_obstacle};
use crate::check::tips::Pierced;
use crate::check::watched::{has_gaps, keeps};
use crate::model::{Contact, Model};

/// A place of a contact inside the other side's body or the obstacle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DeepPlace {
    /// Index of the contact.
    pub contact: usize,
    /// Global number of the node, or of one where the side lies inside on average.
    pub node: usize,
    /// Depth beyond that which the contact keeps.
    pub depth: f64,
    /// Whether the depth is a mean over the part of the side for which a coefficient of the contact
    /// pressure stands.
    pub is_mean: bool,
}

impl DeepPlace {
    fn at(contact: usize, node: usize, depth: f64) -> Self {
        Self { contact, node, depth, is_mean: false }
    }
}

impl Penetration {
    /// As the function [`inside`], for positions that follow each other. What is measured so is not
    /// for `Penetration::check`.
    pub fn inside(&mut self, model: &Model, y: &[f64], limit: f64) -> Vec<DeepPlace> {
        self.begin(model, y);
        for way in &mut self.ways {
            // Where nodes keep depths, points between those of an edge deviate by as much as facets
            // do from what they stand for: they are judged as in every step.
            let keeps = way.contact.is_some_and(|contact| keeps(&model.contacts[contact]));
            let exact = way.nodes.iter_mut().filter(|watched| !keeps || watched.between.is_empty());
            exact.for_each(|watched| watched.share = 0.0);
        }
        let mut found: Vec<DeepPlace> = Vec::new();
        for k in 0..self.ways.len() {
            let deepest = self.deepest(model, k, None);
            let of_contact = deepest.beyond.zip(self.ways[k].contact);
            found.extend(
                of_contact.map(|(inside, contact)| DeepPlace::at(contact, inside.node, inside.depth)),
            );
        }
        // Chords of facets lie in what their nodes touch.
        let is_too_deep =
            |p: &Pierced| p.depth > if p.is_held { p.limit.min(p.counts + limit) } else { p.limit };
        let pierced = self.pierced(model, y).into_iter().filter(|(.., p)| is_too_deep(p));
        found
            .extend(pierced.map(|(contact, _, pierced)| DeepPlace::at(contact, pierced.node, pierced.depth)));
        for (k, contact) in model.contacts.iter().enumerate().filter(|(_, contact)| has_gaps(model, contact))
        {
            let secondary =
                contact.kinematics.secondary().iter().enumerate().take(contact.kinematics.nodes());
            let depth = |(place, &node)| {
                let distance = contact.kinematics.signed_distance(place, y);
                DeepPlace::at(k, node, -distance.unwrap_or(0.0))
            };
            found.extend(secondary.map(depth));
            found.extend(below_obstacle(contact, y).map(|(node, depth)| DeepPlace::at(k, node, depth)));
        }
        for (k, contact) in model.contacts.iter().enumerate() {
            let of_contact = found.iter().filter(|place| place.contact == k);
            let deepest = of_contact.map(|place| place.depth).fold(0.0, f64::max);
            // A side of which a node is as deep is described by the node.
            let deeper = of_field(contact, y).filter(|(_, depth)| *depth > deepest + limit);
            found.extend(
                deeper.map(|(node, depth)| DeepPlace { is_mean: true, ..DeepPlace::at(k, node, depth) }),
            );
        }
        found.retain(|place| place.depth > limit);
        found.sort_by(|a, b| a.contact.cmp(&b.contact).then(b.depth.total_cmp(&a.depth)));
        found.dedup_by_key(|place| place.contact);
        found
    }
}

/// The deepest place of each contact of which a place lies deeper than `limit` at positions `y`.
pub fn inside(model: &Model, y: &[f64], limit: f64) -> Vec<DeepPlace> {
    Penetration::of_contacts(model).inside(model, y, limit)
}

/// The depths of a side that is held on average, where each coefficient of its pressure acts, with
/// a node there.
fn of_field<'a>(contact: &'a Contact, y: &'a [f64]) -> impl Iterator<Item = (usize, f64)> + 'a {
    let places = contact.kinematics.secondary().iter().enumerate();
    let field = places.take_while(|(place, _)| contact.kinematics.is_of_field(*place));
    field.map(|(place, &node)| (node, -contact.kinematics.signed_distance(place, y).unwrap_or(0.0)))
}
