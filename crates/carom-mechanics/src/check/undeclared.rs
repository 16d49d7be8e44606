//! Contact that nobody has declared: bodies that overlap, or lie in a rigid obstacle, with nodes
//! that no contact between them covers, and bodies that cross themselves. Nothing prevents it, and
//! no force comes of it: it is warned of. So are parts of rigid obstacles that lie between the
//! nodes of a body: wide circles and spheres, and in space also narrow ones and sharp edges.
//!
//! Where a boundary touches itself, its chords cross by round-off. A body crosses itself where the
//! node deepest inside it is as deep as other bodies may not be, at a place that no contact of the
//! body with itself covers.

use carom_contact::constants::SHALLOW;
use std::collections::{BTreeSet, HashMap, HashSet};

use carom_contact::InsideItself;

use crate::check::overlapping::Overlap;
use crate::check::penetration::Penetration;
use crate::check::skins::{BodySkin, length, part_of, skin, skin_facets};
use crate::check::tips::Tips;
use crate::check::valid_cells::Checked;
use crate::check::watched::{Watched, Way, has_gaps, kept_depths, lengths};
use crate::model::{BodyInstance, Contact, Model};

/// Finds it. A cache: its content affects no result.
#[derive(Debug)]
pub struct Undeclared {
    between: Penetration,
    obstacles: Vec<Beside>,
    /// The bodies that may cross themselves, once they have been asked for.
    own: Option<Vec<Own>>,
}

/// Nodes of a body that are not in the side of its contact with a rigid obstacle, and were outside
/// the obstacle at the start: each with the depth that is allowed.
#[derive(Debug)]
struct Beside {
    body: usize,
    contact: usize,
    nodes: Vec<(usize, f64)>,
}

/// A body that may cross itself.
#[derive(Debug)]
struct Own {
    body: usize,
    skin: BodySkin,
    /// The contact of each facet with its own body.
    declared: Vec<Option<usize>>,
    /// The nodes of the side of each contact with its own body.
    sides: Vec<HashSet<usize>>,
    checked: Checked,
}

impl Own {
    /// Whether the node that is deepest inside the body lies where no contact keeps it out.
    fn is_inside(&self, model: &Model, y: &[f64]) -> bool {
        let Some(InsideItself { node, facet, depth }) = self.skin.deepest_in_itself(y) else { return false };
        let facet = self.skin.facet_nodes(facet);
        let covers =
            |side: &HashSet<usize>| side.contains(&node) && facet.iter().any(|other| side.contains(other));
        depth > SHALLOW * length(model, facet) && !self.sides.iter().any(covers)
    }
}

impl Undeclared {
    /// For all bodies in the plane or in space; in space none is asked whether it crosses itself.
    pub fn new(model: &Model) -> Self {
        let mut ways = Vec::new();
        let covered = Covered::all(model);
        let other = Covered::default();
        let is_solid = |part: &BodyInstance| part.body.mesh().element.facet_shape().dimension() > 1;
        let solid = model.parts.iter().enumerate().filter(|(_, part)| is_solid(part));
        for (a, part) in solid.filter(|_| model.parts.len() > 1) {
            let nodes: Vec<(usize, f64)> = lengths(model, &skin_facets(part)).collect();
            for body in (0..model.parts.len()).filter(|&b| b != a) {
                let covered = covered.get(&(a.min(body), a.max(body))).unwrap_or(&other);
                let watched = |&(node, length): &(usize, f64)| {
                    let kept = covered.kept;
                    Watched { kept, ..Watched::new(node, length, false, covered.share) }
                };
                let beside = nodes.iter().filter(|(node, _)| !covered.nodes.contains(node));
                let watched: Vec<Watched> = beside.map(watched).collect();
                if !watched.is_empty() {
                    ways.push(Way::new(model, None, body, watched));
                }
            }
        }
        // Pressures on average lie half above and half below a wide circle.
        let holds_nodes = |tips: &Tips| !model.contacts[tips.contact].kinematics.is_of_field(0);
        let tips = Tips::all(model).into_iter().filter(holds_nodes).collect();
        Self { between: Penetration::new(model, ways, tips), obstacles: beside(model), own: None }
    }

    /// Whether anything is watched that could overlap so.
    pub fn watches(&self, model: &Model, overlap: Overlap) -> bool {
        match overlap {
            Overlap::Bodies(a, b) => self.between.ways.iter().any(|way| {
                let own = way.nodes.first().and_then(|watched| part_of(model, watched.node));
                (own, way.body) == (Some(a), b) || (own, way.body) == (Some(b), a)
            }),
            Overlap::Obstacle { contact, .. } => {
                self.obstacles.iter().any(|beside| beside.contact == contact)
            }
            Overlap::Between { contact, .. } => self.between.has_tips(contact),
            Overlap::Sides { .. } => false,
        }
    }

    /// Everything that overlaps at these positions.
    pub(crate) fn found(&mut self, model: &Model, y: &[f64]) -> Vec<Overlap> {
        let mut found = self.overlapping(model, y);
        found.extend(self.crossing_themselves(model, y));
        found
    }

    /// Pairs of bodies of which one is inside the other, and bodies in obstacles.
    pub fn overlapping(&mut self, model: &Model, y: &[f64]) -> Vec<Overlap> {
        self.between.begin(model, y);
        let mut found = Vec::new();
        for k in 0..self.between.ways.len() {
            if let Some(inside) = self.between.deepest(model, k, None).beyond
                && let Some(part) = part_of(model, inside.node)
            {
                let body = self.between.ways[k].body;
                found.push(Overlap::Bodies(part.min(body), part.max(body)));
            }
        }
        for Beside { body, contact, nodes } in &self.obstacles {
            let kinematics = &model.contacts[*contact].kinematics;
            let is_inside = |&(node, limit): &(usize, f64)| {
                kinematics.distance_to_obstacle(node, y).is_some_and(|gap| gap < -limit)
            };
            if nodes.iter().any(is_inside) {
                found.push(Overlap::Obstacle { body: *body, contact: *contact });
            }
        }
        for (contact, body, pierced) in self.between.pierced(model, y) {
            let is_loose = model.dimension == 3 || pierced.counts > 0.0;
            if is_loose && pierced.depth > SHALLOW * pierced.length {
                found.push(Overlap::Between { body, contact });
            }
        }
        found.sort_unstable();
        found.dedup();
        found
    }

    fn crossing_themselves(&mut self, model: &Model, y: &[f64]) -> Vec<Overlap> {
        let skins = self.own.get_or_insert_with(|| own(model));
        let crosses = |own: &mut Own| {
            let now = model.parts[own.body].of(y);
            if own.checked.holds(now, model.dimension) {
                return None;
            }
            own.skin.update(y);
            let declared = &own.declared;
            let known = |a: usize, b: usize| declared[a].is_some() && declared[a] == declared[b];
            let crosses = own.skin.crosses_itself(y, known);
            own.checked.set(now, if crosses { 0.0 } else { own.skin.clearance_to_itself(y) });
            (crosses && own.is_inside(model, y)).then_some(Overlap::Bodies(own.body, own.body))
        };
        skins.iter_mut().filter_map(crosses).collect()
    }
}

/// Nodes that contacts and ties between two bodies cover, and the depths that they allow.
struct Covered {
    /// Nodes of their sides.
    nodes: HashSet<usize>,
    /// Depth that is allowed to other nodes, over the length of a facet.
    share: f64,
    /// Depth that the contacts keep.
    kept: f64,
}

impl Default for Covered {
    fn default() -> Self {
        Self { nodes: HashSet::new(), share: SHALLOW, kept: 0.0 }
    }
}

impl Covered {
    /// By pairs of bodies that have a contact or a tie, the lower number first.
    fn all(model: &Model) -> HashMap<(usize, usize), Self> {
        let mut all: HashMap<_, Self> = HashMap::new();
        for contact in &model.contacts {
            let (Some(a), Some(b)) = (contact.primary_part, secondary_part(model, contact)) else { continue };
            let covered = all.entry((a.min(b), a.max(b))).or_default();
            covered.nodes.extend(contact.facets.iter().flat_map(|(_, facets)| facets).flatten());
            covered.share = covered.share.max(contact.depths.others);
            covered.kept = kept_depths(contact).into_values().fold(covered.kept, f64::max);
        }
        for tie in &model.ties {
            // Tied sides coincide; where they are curved and their meshes differ, their chords
            // cross.
            let [a, b] = tie.bodies;
            all.entry((a.min(b), a.max(b))).or_default().nodes.extend(&tie.surface);
        }
        all
    }
}

fn secondary_part(model: &Model, contact: &Contact) -> Option<usize> {
    let (_, facets) = contact.facets.first()?;
    part_of(model, *facets.first()?.first()?)
}

/// The nodes beside each contact with a rigid obstacle.
fn beside(model: &Model) -> Vec<Beside> {
    let mut all = Vec::new();
    for (k, contact) in model.contacts.iter().enumerate().filter(|_| model.dimension > 1) {
        let Some(body) = secondary_part(model, contact).filter(|_| has_gaps(model, contact)) else {
            continue;
        };
        let covered: HashSet<usize> = contact.facets[0].1.iter().flatten().copied().collect();
        let kept = kept_depths(contact).into_values().fold(0.0, f64::max);
        let is_beside = |(node, _): &(usize, f64)| {
            let at_start = contact.kinematics.distance_to_obstacle(*node, &model.initial_position);
            !covered.contains(node) && at_start.is_some_and(|gap| gap >= 0.0)
        };
        let facets = skin_facets(&model.parts[body]);
        let nodes = lengths(model, &facets).filter(is_beside);
        let nodes: Vec<_> =
            nodes.map(|(node, length)| (node, contact.depths.others * length + kept)).collect();
        if !nodes.is_empty() {
            all.push(Beside { body, contact: k, nodes });
        }
    }
    all
}

/// The bodies of which not the whole boundary is in one contact with itself.
fn own(model: &Model) -> Vec<Own> {
    let mut contact_of: HashMap<&[usize], usize> = HashMap::new();
    for (k, contact) in model.contacts.iter().enumerate().filter(|(_, contact)| contact.itself) {
        for facet in contact.facets.iter().flat_map(|(_, facets)| facets) {
            contact_of.entry(facet).or_insert(k);
        }
    }
    let skins = model.parts.iter().enumerate().filter(|_| model.dimension == 2);
    let skins = skins.filter_map(|(body, part)| {
        let of = |facet: &Vec<usize>| contact_of.get(facet.as_slice()).copied();
        let declared: Vec<Option<usize>> = skin_facets(part).iter().map(of).collect();
        let in_one = declared.iter().all(|contact| contact.is_some() && *contact == declared[0]);
        if in_one {
            None
        } else {
            let skin = skin(model, part)?;
            let contacts: BTreeSet<usize> = declared.iter().flatten().copied().collect();
            let nodes = |k: usize| model.contacts[k].facets.iter().flat_map(|(_, facets)| facets).flatten();
            let sides = contacts.into_iter().map(|k| nodes(k).copied().collect()).collect();
            Some(Own { body, skin, declared, sides, checked: Checked::default() })
        }
    });
    skins.collect()
}
