//! Initial overlap: the depth of every node of a contact in the body of the other side.
//!
//! The depth is that below the side of the contact. Where two strips of the same width overlap, the
//! nodes at their ends lie on the boundary beside the side, and are as deep as their neighbours.

use crate::check::skins::{BodySkin, length, part_of, position, skin};
use crate::check::watched::has_gaps;
use crate::model::Model;
use carom_contact::constants::{FLUSH, ROUND_OFF};

/// Depths at positions `y`, ≥ 0, beyond those that the contacts keep: for each contact one per node
/// of its kinematics.
pub fn depths(model: &Model, y: &[f64]) -> Vec<Vec<f64>> {
    let mut skins: Vec<Option<BodySkin>> = model.parts.iter().map(|_| None).collect();
    let mut all = Vec::new();
    for contact in &model.contacts {
        let first = contact.facets.first().and_then(|(_, facets)| part_of(model, *facets.first()?.first()?));
        let mut depth = |(place, &node): (usize, &usize)| -> f64 {
            let kept = contact.kinematics.kept(place);
            let below = contact.kinematics.signed_distance(place, y).map(|gap| -gap);
            if contact.kinematics.is_of_field(place)
                || has_gaps(model, contact)
                || below.is_some_and(|below| below <= 0.0)
            {
                return below.unwrap_or(0.0).max(0.0);
            }
            let own = part_of(model, node);
            let Some(other) = (if own == first { contact.primary_part } else { first }) else { return 0.0 };
            if skins[other].is_none() {
                skins[other] = skin(model, &model.parts[other]);
                skins[other].iter_mut().for_each(|skin| skin.update(y));
            }
            let at = position(y, model.dimension, node);
            let found = skins[other].as_ref().and_then(|skin| skin.depth(at, None, y));
            let distance = found.map_or(f64::INFINITY, |found| found.distance);
            let beside = found.filter(|_| below.is_some()).zip(skins[other].as_ref());
            let beside = beside.map_or(0.0, |(found, skin)| length(model, skin.facet_nodes(found.facet)));
            // Further behind it lies beside a wall.
            let beside = if below.is_some_and(|below| below <= beside) { beside } else { 0.0 };
            // In front of chords of a convex side, a node may be inside it.
            let is_inside = distance <= ROUND_OFF * model.scale + FLUSH * beside + (-kept).max(0.0);
            // Behind a joint of a hollow side no facet is faced.
            if is_inside { below.unwrap_or(-distance - kept).max(0.0) } else { 0.0 }
        };
        all.push(contact.kinematics.secondary().iter().enumerate().map(&mut depth).collect());
    }
    all
}
