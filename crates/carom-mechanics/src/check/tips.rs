//! How deep the convex parts of rigid obstacles lie in bodies: the nodes of a body can pass a
//! circle, a sphere, a corner or a sharp edge on both sides of it.
//!
//! A centre at a distance d from the boundary of a body, negative inside, with the radius r lies r
//! − d deep. Nothing is measured before the two can have met. The depth counts as penetration if
//! the part is in contact or deeper than nodes alone permit: where they lie on a wide circle, the
//! chords between them are inside. Contacts in the plane hold the parts (`tip_to_facet.rs` of
//! `carom-contact`); in space nothing does, and what is deep is warned of (`undeclared.rs`).

use carom_contact::constants::DEEPEST;
use carom_solid::Bounds;

use crate::check::skins::{BodySkin, length, part_of, position, skin_nodes};
use crate::check::watched::has_gaps;
use crate::model::Model;

/// The convex parts of the obstacle of a contact.
#[derive(Debug)]
pub(crate) struct Tips {
    pub contact: usize,
    /// The body that must not meet them, and the nodes of its boundary.
    pub part: usize,
    boundary: Vec<usize>,
    all: Vec<Tip>,
}

#[derive(Debug)]
struct Tip {
    at: [f64; 3],
    clearance: f64,
    near: Option<usize>,
}

/// A convex part in a body.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Pierced {
    /// A node of the nearest facet.
    pub node: usize,
    /// Index of the part among the secondary nodes of its contact.
    pub place: usize,
    /// Whether the contact holds it.
    pub is_held: bool,
    pub depth: f64,
    /// Depth up to which it does not count.
    pub counts: f64,
    pub limit: f64,
    /// Length of the nearest facet.
    pub length: f64,
}

impl Tips {
    /// All of a model.
    pub(crate) fn all(model: &Model) -> Vec<Self> {
        let mut all = Vec::new();
        let contacts = model.contacts.iter().enumerate();
        for (contact, of) in contacts.filter(|(_, of)| model.dimension > 1 && has_gaps(model, of)) {
            let first = of.facets.first().and_then(|(_, facets)| facets.first()?.first());
            let Some(part) = first.and_then(|node| part_of(model, *node)) else { continue };
            let tips = of.kinematics.tips(&model.initial_position);
            let at_start = |tip: carom_contact::Tip| Tip { at: tip.center, clearance: 0.0, near: None };
            let tips: Vec<Tip> = tips.into_iter().map(at_start).collect();
            if !tips.is_empty() {
                all.push(Self { contact, part, boundary: skin_nodes(&model.parts[part]), all: tips });
            }
        }
        all
    }

    /// Subtracts the motion of the body from the clearances; `moved`: the square of that of a node.
    pub(crate) fn approach(&mut self, moved: impl Fn(usize) -> f64, amplification: f64) {
        if self.all.iter().any(|tip| tip.clearance > 0.0) {
            let most = self.boundary.iter().map(|&node| moved(node)).fold(0.0, f64::max);
            let nearer = amplification * most.sqrt();
            self.all.iter_mut().filter(|tip| tip.clearance > 0.0).for_each(|tip| tip.clearance -= nearer);
        }
    }

    /// The parts of obstacles that may have met the body.
    pub(crate) fn pierced(
        &mut self,
        model: &Model,
        skin: &mut BodySkin,
        is_current: &mut bool,
        y: &[f64],
    ) -> Vec<Pierced> {
        let contact = &model.contacts[self.contact];
        let secondary = contact.kinematics.secondary().len();
        let kept = (0..secondary).map(|node| contact.kinematics.kept(node)).fold(0.0, f64::max);
        // Beyond a plane of symmetry a boundary is continued, but not what is said of its distance.
        let mut extent = Bounds::EMPTY;
        let is_held = secondary > contact.kinematics.nodes();
        let measured = self.boundary.iter().filter(|_| !is_held);
        measured.for_each(|&node| extent.add(&position(y, model.dimension, node)));
        let mut found = Vec::new();
        for (number, (known, tip)) in self.all.iter_mut().zip(contact.kinematics.tips(y)).enumerate() {
            let carom_contact::Tip { center: at, radius, .. } = tip;
            let square: f64 = (0..3).map(|i| (at[i] - known.at[i]).powi(2)).sum();
            known.clearance -= square.sqrt();
            known.at = at;
            let may_be_inside = is_held || extent.grown(radius).contains(&at);
            if known.clearance > 0.0 || !may_be_inside {
                continue;
            }
            if !std::mem::replace(is_current, true) {
                skin.update(y);
            }
            let Some(nearest) = skin.depth(at, known.near, y) else { continue };
            known.clearance = nearest.distance - radius;
            known.near = Some(nearest.facet);
            let facet = skin.facet_nodes(nearest.facet);
            let place = contact.kinematics.nodes() + number;
            let length = length(model, facet);
            let counts = tip.permitted(length);
            let depth = radius - nearest.distance - kept;
            found.push(Pierced {
                node: facet[0],
                place,
                is_held,
                depth,
                counts,
                limit: DEEPEST.max(contact.depths.others) * length,
                length,
            });
        }
        found
    }
}
