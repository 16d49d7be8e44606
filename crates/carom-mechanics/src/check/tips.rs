//! How deep the round parts of rigid obstacles lie in bodies: the nodes of a body can pass a
//! circle, a sphere or a corner on both sides of it.
//!
//! A centre at a distance d from the boundary of a body, negative inside, with the radius r lies r
//! − d deep. Nothing is measured before the two can have met. Where the contact holds the parts
//! (`tip_to_facet.rs` of `carom-contact`), the depth counts as penetration if the part is in
//! contact or deeper than nodes alone permit: where they lie on a wide circle, the chords between
//! them are inside.

use std::sync::Arc;

use crate::check::skins::{BodySkin, length, part_of, skin_nodes};
use crate::check::watched::has_gaps;
use crate::model::Model;

/// Allowed depth, over the length of a facet, of parts that the contact does not hold: chords of
/// facets that lie on a circle are inside it.
const SHARE: f64 = 0.25;

/// A round part of the obstacle of a contact.
#[derive(Debug)]
pub(crate) struct Tip {
    pub contact: usize,
    /// Its number among those of the obstacle.
    number: usize,
    /// The body that must not meet it, and the nodes of its boundary.
    pub part: usize,
    boundary: Arc<[usize]>,
    at: [f64; 3],
    clearance: f64,
    near: Option<usize>,
}

/// A round part in a body.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Pierced {
    /// A node of the nearest facet.
    pub node: usize,
    /// Index of the part among the secondary nodes of its contact.
    pub place: usize,
    pub depth: f64,
    /// Depth up to which it does not count; infinite if the contact does not hold it.
    pub counts: f64,
    pub limit: f64,
}

impl Tip {
    /// All of a model.
    pub(crate) fn all(model: &Model) -> Vec<Self> {
        let mut all = Vec::new();
        let contacts = model.contacts.iter().enumerate();
        for (contact, of) in contacts.filter(|(_, of)| model.dimension > 1 && has_gaps(model, of)) {
            let first = of.facets.first().and_then(|(_, facets)| facets.first()?.first());
            let Some(part) = first.and_then(|node| part_of(model, *node)) else { continue };
            let tips = of.kinematics.tips(&model.initial_position);
            let boundary: Arc<[usize]> = skin_nodes(&model.parts[part]).into();
            all.extend(tips.into_iter().enumerate().map(|(number, tip)| Self {
                contact,
                number,
                part,
                boundary: boundary.clone(),
                at: tip.center,
                clearance: 0.0,
                near: None,
            }));
        }
        all
    }

    /// Subtracts the motion of the body from the clearance; `moved`: the square of that of a node.
    pub(crate) fn approach(&mut self, moved: impl Fn(usize) -> f64, amplification: f64) {
        if self.clearance > 0.0 {
            let most = self.boundary.iter().map(|&node| moved(node)).fold(0.0, f64::max);
            self.clearance -= amplification * most.sqrt();
        }
    }

    /// Its depth, if it may have met the body.
    pub(crate) fn pierced(
        &mut self,
        model: &Model,
        skin: &mut BodySkin,
        is_current: &mut bool,
        y: &[f64],
    ) -> Option<Pierced> {
        let contact = &model.contacts[self.contact];
        let tip = *contact.kinematics.tips(y).get(self.number)?;
        let carom_contact::Tip { center: at, radius, .. } = tip;
        let square: f64 = (0..3).map(|i| (at[i] - self.at[i]).powi(2)).sum();
        (self.clearance, self.at) = (self.clearance - square.sqrt(), at);
        if self.clearance > 0.0 {
            return None;
        }
        if !std::mem::replace(is_current, true) {
            skin.update(y);
        }
        let found = skin.depth(at, self.near, y)?;
        (self.clearance, self.near) = (found.distance - radius, Some(found.facet));
        let nodes = 0..contact.kinematics.secondary().len();
        let kept = nodes.map(|node| contact.kinematics.kept(node)).fold(0.0, f64::max);
        let facet = skin.facet_nodes(found.facet);
        let depth = radius - found.distance - kept;
        let place = contact.kinematics.nodes() + self.number;
        let is_held = place < contact.kinematics.secondary().len();
        let length = length(model, facet);
        let counts = if is_held { tip.permitted(length) } else { f64::INFINITY };
        let limit = SHARE.max(contact.depths.others) * length;
        Some(Pierced { node: facet[0], place, depth, counts, limit })
    }
}
