//! Penetration, measured over all nodes of both sides of every contact, and in space over points of
//! their sharp edges, whatever pairs there are: a node that a search has lost is found here. A step
//! in which one is deeper than its contact allows is rejected.
//!
//! A node outside, at a distance d from a body, cannot be inside before the two have moved by d
//! together. Until then it is not measured; no result depends on when it was.

use carom_contact::constants::{DEEP, ROUND_OFF, SHALLOW};
use std::collections::{BTreeMap, BTreeSet, HashMap};

use carom_contact::{InsideItself, Pair, Rows, Side};
use serde::{Deserialize, Serialize};

use crate::check::skins::{BodySkin, folding_skin, kinks, length, part_of, skin};
use crate::check::tips::{Pierced, Tips};
use crate::check::watched::{Way, edge_points, first_of_earlier, has_gaps, lengths, watched};
use crate::model::{BodyInstance, Contact, Model};
use crate::rejected::Rejected;
use crate::state::State;

/// Measures penetration. A cache: its content affects no result.
#[derive(Debug, Default)]
pub struct Penetration {
    skins: Vec<Option<BodySkin>>,
    /// Nodes at the kinks of each body that must not be entered.
    kinks: Vec<Vec<usize>>,
    pub(crate) ways: Vec<Way>,
    tips: Vec<Tips>,
    /// Positions to which the clearances refer.
    y: Vec<f64>,
    /// Bodies whose skins have their positions of this step.
    current: Vec<bool>,
    /// Depths of the active pairs of a contact, lengths of their facets, and whether those are at a
    /// kink, by node.
    paired: Vec<(usize, f64, Entered)>,
    rows: Option<Rows>,
    /// For each contact whose nodes all have gaps, the lengths of their facets by node.
    lengths: Vec<HashMap<usize, f64>>,
}

/// Penetration at a state.
#[derive(Debug, Default)]
pub struct Measured {
    /// Largest depth over all contacts.
    pub depths: Depths,
    /// Doubtful contacts, ascending.
    pub doubtful: Vec<usize>,
    /// The first node found beyond its limit, with contact and body.
    beyond: Option<(usize, usize, Inside)>,
}

impl Measured {
    /// Adds the depth of a node in a facet, or of a facet at a node, of this length.
    fn add(&mut self, k: usize, constrained: bool, depth: f64, length: f64) {
        self.depths.add(depth, constrained);
        if depth > DEEP * length && self.doubtful.last() != Some(&k) {
            self.doubtful.push(k);
        }
    }
}

/// Penetration of the nodes of a way.
#[derive(Debug, Default)]
pub(crate) struct Deepest {
    depths: Depths,
    /// Whether a node is so deep that the contact is doubtful.
    is_doubtful: bool,
    /// The node that is furthest beyond its limit.
    pub beyond: Option<Inside>,
}

/// A facet that a node entered.
#[derive(Clone, Copy, Debug)]
struct Entered {
    length: f64,
    /// Whether it has a node at a kink.
    is_at_kink: bool,
}

/// Largest depths of nodes of the sides of contacts in the other body, ≥ 0.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Depths {
    /// Of all nodes.
    pub all: f64,
    /// Of the nodes that a contact constrains: secondary nodes and corners.
    pub constrained: f64,
}

impl Depths {
    /// The larger ones.
    #[must_use]
    pub fn max(self, other: Self) -> Self {
        Self { all: self.all.max(other.all), constrained: self.constrained.max(other.constrained) }
    }

    fn add(&mut self, depth: f64, constrained: bool) {
        let constrained = if constrained { depth } else { 0.0 };
        *self = self.max(Self { all: depth, constrained });
    }
}

/// What lies inside a body, and is said of the node.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum What {
    Node,
    /// A point of an edge that begins with it.
    Edge,
    /// A convex part of an obstacle, near it.
    Obstacle,
}

impl What {
    /// Words that the node's number follows.
    fn words(self) -> &'static str {
        match self {
            Self::Node => "node",
            Self::Edge => "the sharp edge at node",
            Self::Obstacle => "the rigid obstacle beside node",
        }
    }
}

/// A node inside a body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Inside {
    pub node: usize,
    pub what: What,
    pub depth: f64,
    pub limit: f64,
}

impl Penetration {
    /// For the contacts of a model.
    pub fn of_contacts(model: &Model) -> Self {
        let mut ways = Vec::new();
        for (k, contact) in model.contacts.iter().enumerate() {
            if contact.itself {
                ways.extend([Side::Later, Side::Earlier].map(|side| Way::of_itself(model, k, side)));
                continue;
            }
            let (Some(primary), [(_, secondary_facets), (_, primary_facets)]) =
                (contact.primary_part, &contact.facets[..])
            else {
                continue;
            };
            if model.dimension < 2 {
                continue;
            }
            let Some(secondary) = secondary_facets.first().and_then(|f| part_of(model, f[0])) else {
                continue;
            };
            for (body, own, facets) in
                [(primary, secondary, secondary_facets), (secondary, primary, primary_facets)]
            {
                let mut nodes = watched(model, contact, facets);
                nodes.append(&mut edge_points(model, contact, own, facets));
                ways.push(Way::new(model, Some(k), body, nodes));
            }
        }
        let of_contact = |contact: &Contact| match &contact.facets[..] {
            [(_, facets), ..] if model.dimension > 1 && has_gaps(model, contact) => {
                lengths(model, facets).collect()
            }
            _ => HashMap::new(),
        };
        let lengths = model.contacts.iter().map(of_contact).collect();
        Self { lengths, ..Self::new(model, ways, Tips::all(model)) }
    }

    pub(crate) fn new(model: &Model, ways: Vec<Way>, tips: Vec<Tips>) -> Self {
        let skin = |body: usize| {
            let part = &model.parts[body];
            let mut of_body = ways.iter().filter(|way| way.body == body).peekable();
            if of_body.peek().is_none() && tips.iter().all(|tips| tips.part != body) {
                return None;
            }
            let folds = of_body.any(|way| way.itself.is_some());
            if folds { folding_skin(model, part) } else { skin(model, part) }
        };
        let skins: Vec<_> = (0..model.parts.len()).map(skin).collect();
        let of_body = |(part, skin): (&BodyInstance, &Option<BodySkin>)| {
            skin.as_ref().map_or_else(Vec::new, |_| kinks(model, part))
        };
        let kinks = model.parts.iter().zip(&skins).map(of_body).collect();
        Self { skins, kinks, ways, tips, ..Self::default() }
    }

    /// Penetration at the state.
    ///
    /// # Errors
    /// A node that is deeper than its contact allows.
    pub fn check(&mut self, model: &Model, state: &State) -> Result<Measured, Rejected> {
        let measured = self.measure(model, state);
        match measured.beyond {
            None => Ok(measured),
            Some((contact, body, inside)) => Err(Rejected::Penetration {
                contact: model.contacts[contact].name.clone(),
                what: inside.what.words(),
                node: inside.node,
                body: model.parts[body].name.clone(),
                depth: inside.depth,
                limit: inside.limit,
            }),
        }
    }

    fn measure(&mut self, model: &Model, state: &State) -> Measured {
        self.begin(model, &state.y);
        let mut measured = Measured::default();
        for k in 0..self.ways.len() {
            let Deepest { depths, is_doubtful, beyond } = self.deepest(model, k, Some(state));
            measured.depths = measured.depths.max(depths);
            let Some(contact) = self.ways[k].contact else { continue };
            if is_doubtful {
                measured.doubtful.push(contact);
            }
            let of_way = beyond.map(|inside| (contact, self.ways[k].body, inside));
            measured.beyond = measured.beyond.or(of_way);
        }
        for (k, contact) in model.contacts.iter().enumerate().filter(|(_, contact)| contact.itself) {
            if let Some((body, inside, length)) = self.folded(model, contact, &state.y) {
                measured.add(k, false, inside.depth, length);
                let is_beyond = inside.depth > inside.limit;
                measured.beyond = measured.beyond.or(is_beyond.then_some((k, body, inside)));
            }
        }
        for (contact, part, pierced) in self.pierced(model, &state.y) {
            let Pierced { node, place, depth, counts, limit, length, .. } = pierced;
            if depth > counts || state.closed(contact, place).is_some() {
                let length = if counts > 0.0 { f64::INFINITY } else { length };
                measured.add(contact, pierced.is_held && counts == 0.0, depth, length);
            }
            let inside = Inside { node, what: What::Obstacle, depth, limit };
            measured.beyond = measured.beyond.or((depth > limit).then_some((contact, part, inside)));
        }
        for (k, contact) in model.contacts.iter().enumerate().filter(|(_, contact)| has_gaps(model, contact))
        {
            let lengths = &self.lengths[k];
            let length = |node: usize| lengths.get(&node).copied().unwrap_or(f64::INFINITY);
            for (place, &node) in
                contact.kinematics.secondary().iter().enumerate().take(contact.kinematics.nodes())
            {
                let gap = contact.kinematics.signed_distance(place, &state.y);
                measured.add(k, true, -gap.unwrap_or(0.0), length(node));
            }
            below_obstacle(contact, &state.y)
                .for_each(|(node, depth)| measured.add(k, false, depth, length(node)));
        }
        measured.doubtful.sort_unstable();
        measured.doubtful.dedup();
        measured
    }

    /// The deepest node of a body in contact with itself where its boundary crosses itself, pair or
    /// not, with the body and the length of the facet that the node entered.
    fn folded(&mut self, model: &Model, contact: &Contact, y: &[f64]) -> Option<(usize, Inside, f64)> {
        let body = contact.primary_part?;
        let skin = self.skins[body].as_mut()?;
        if !std::mem::replace(&mut self.current[body], true) {
            skin.update(y);
        }
        if !skin.crosses_itself(y, |_, _| false) {
            return None;
        }
        let InsideItself { node, facet, depth } = skin.deepest_in_itself(y)?;
        let length = length(model, skin.facet_nodes(facet));
        // Chords do not tell smaller depths from none.
        (depth > SHALLOW * length).then_some((
            body,
            Inside { node, what: What::Node, depth, limit: contact.depths.others * length },
            length,
        ))
    }

    /// The convex parts of rigid obstacles that may have met a body, with contact and body.
    pub(crate) fn pierced(&mut self, model: &Model, y: &[f64]) -> Vec<(usize, usize, Pierced)> {
        let Self { skins, tips, current, .. } = self;
        let mut found = Vec::new();
        for tips in tips {
            let Some(skin) = skins[tips.part].as_mut() else { continue };
            let pierced = tips.pierced(model, skin, &mut current[tips.part], y).into_iter();
            found.extend(pierced.map(|pierced| (tips.contact, tips.part, pierced)));
        }
        found
    }

    /// Whether convex parts of the obstacle of a contact are measured.
    pub(crate) fn has_tips(&self, contact: usize) -> bool {
        self.tips.iter().any(|tips| tips.contact == contact)
    }

    /// Subtracts the motion since the last call from the clearances.
    pub(crate) fn begin(&mut self, model: &Model, y: &[f64]) {
        if self.y.len() == y.len() {
            let moved = |node: usize| square(&self.y, y, model.dimension, node);
            for way in &mut self.ways {
                if way.nodes.iter().any(|watched| watched.clearance > 0.0) {
                    let nodes = way.boundary.iter().map(|&node| moved(node)).fold(0.0, f64::max).sqrt();
                    let body = nodes * self.skins[way.body].as_ref().map_or(1.0, BodySkin::amplification);
                    for watched in way.nodes.iter_mut().filter(|watched| watched.clearance > 0.0) {
                        watched.clearance -= watched.motion(moved) + body;
                    }
                }
            }
        }
        if self.y.len() == y.len() {
            for tips in &mut self.tips {
                let amplification = self.skins[tips.part].as_ref().map_or(1.0, BodySkin::amplification);
                tips.approach(|node| square(&self.y, y, model.dimension, node), amplification);
            }
        }
        self.y.clear();
        if !self.ways.is_empty() || !self.tips.is_empty() {
            self.y.extend_from_slice(y);
        }
        self.current.clear();
        self.current.resize(model.parts.len(), false);
    }

    /// Depths of the nodes of a way.
    pub(crate) fn deepest(&mut self, model: &Model, way: usize, state: Option<&State>) -> Deepest {
        let Self { skins, kinks, ways, y, current, paired, rows, .. } = self;
        let Way { contact, body, itself, nodes, first, .. } = &mut ways[way];
        let mut found = Deepest::default();
        let Some(skin) = skins[*body].as_mut() else { return found };
        paired.clear();
        let kinks = &kinks[*body];
        let of_facet = |facet: &[usize]| Entered {
            length: length(model, facet),
            is_at_kink: facet.iter().any(|node| kinks.binary_search(node).is_ok()),
        };
        if let (Some(k), Some(state)) = (*contact, state) {
            // An active pair on its facet is no deeper than its gap; its node has no clearance,
            // whatever it faced when it was last measured.
            let rows = rows.get_or_insert_with(|| Rows::new(model.dimension));
            let contact = &model.contacts[k];
            let half = first_of_earlier(contact);
            let of_way = |node: usize| itself.is_none_or(|side| (side == Side::Later) == (node < half));
            for pair in state.pairs[k].iter().filter(|pair| {
                pair.active
                    && pair.node < contact.kinematics.nodes()
                    && contact.kinematics.is_on_facet(pair)
                    && contact.kinematics.allowed(pair.node) == 0.0
                    && of_way(pair.node)
            }) {
                rows.clear();
                // A frozen contact point is not the closest one.
                let mut pair = *pair;
                contact.kinematics.start_step(&mut pair, y);
                if contact.kinematics.measure(&mut pair, y, rows).is_ok() {
                    let node = contact.node(&pair);
                    let facet = contact.kinematics.facet_nodes(&pair);
                    paired.push((node, (pair.depth - rows.row(0).gap).max(0.0), of_facet(facet)));
                }
            }
            // On springs, what presses between nodes is as deep as its row.
            for pair in state.pairs[k].iter().filter(|pair| pair.active && contact.springs.is_some()) {
                rows.clear();
                if contact.kinematics.between_nodes(pair).is_some()
                    && contact.kinematics.measure(&mut pair.clone(), y, rows).is_ok()
                {
                    found.depths.add(pair.depth - rows.row(0).gap, true);
                }
            }
            // A node in a concave corner has two pairs: the deeper one counts.
            paired.sort_unstable_by(|a, b| a.0.cmp(&b.0).then(b.1.total_cmp(&a.1)));
            paired.dedup_by_key(|(node, ..)| *node);
        }
        let start = *first;
        for i in 0..nodes.len() {
            // `start` comes before those that precede it.
            let k = if i == 0 { start } else { i - usize::from(i <= start) };
            let watched = &mut nodes[k];
            let node = watched.node;
            let is_node = watched.between.is_empty();
            let of_node = paired.binary_search_by_key(&node, |(paired, ..)| *paired).ok().filter(|_| is_node);
            if watched.clearance > 0.0 && of_node.is_none() {
                continue;
            }
            let (depth, entered) = if let Some(p) = of_node {
                watched.clearance = 0.0;
                (paired[p].1, paired[p].2)
            } else {
                if !std::mem::replace(&mut current[*body], true) {
                    skin.update(y);
                }
                let entered = |facet: usize| of_facet(skin.facet_nodes(facet));
                if let Some(side) = *itself {
                    let nearest = skin.depth_of(node, side, watched.reach, y);
                    let distance = nearest.map_or(watched.reach, |nearest| nearest.distance);
                    watched.clearance = distance - ROUND_OFF * watched.length;
                    let Some(nearest) = nearest else { continue };
                    (-nearest.distance - watched.kept, entered(nearest.facet))
                } else {
                    // No deeper than any point of the boundary is away: neither the deepest nor too
                    // deep.
                    let known = if watched.constrained { found.depths.constrained } else { found.depths.all };
                    let point = watched.point(y, model.dimension);
                    if let Some((facet, xi)) = watched.near {
                        let bound = skin.distance(facet, xi, point, y);
                        let length = entered(facet).length;
                        let is_deep = contact.is_some() && bound > DEEP * length;
                        if bound <= known && bound <= watched.limit(length) && !is_deep {
                            continue;
                        }
                    }
                    let Some(nearest) = skin.depth(point, watched.near.map(|near| near.0), y) else {
                        continue;
                    };
                    watched.clearance = nearest.distance - ROUND_OFF * watched.length;
                    watched.near = Some((nearest.facet, nearest.xi));
                    (-nearest.distance - watched.kept, entered(nearest.facet))
                }
            };
            if depth > found.depths.all {
                *first = k;
            }
            found.depths.add(depth, watched.constrained);
            found.is_doubtful |= contact.is_some() && depth > DEEP * entered.length;
            let mut limit = watched.limit(entered.length);
            if watched.constrained
                && entered.is_at_kink
                && let Some(k) = *contact
            {
                limit = limit.max(model.contacts[k].depths.kinks * entered.length);
            }
            if depth > limit
                && watched.constrained
                && of_node.is_none()
                && let Some(k) = *contact
                && is_left(&model.contacts[k], node, y)
            {
                limit = limit.max(model.contacts[k].depths.others * watched.length.max(entered.length));
            }
            if depth > limit
                && contact.is_some()
                && let Some(state) = state
            {
                limit += kept(model, state, *body, node);
            }
            if depth > limit && found.beyond.is_none_or(|worst| depth - limit > worst.depth - worst.limit) {
                let what = if is_node { What::Node } else { What::Edge };
                found.beyond = Some(Inside { node, what, depth, limit });
            }
        }
        found
    }
}

/// The depths of nodes in a rigid obstacle that only their mean holds, less those that they keep.
pub(crate) fn below_obstacle<'a>(
    contact: &'a Contact,
    y: &'a [f64],
) -> impl Iterator<Item = (usize, f64)> + 'a {
    let kept: BTreeMap<usize, f64> = contact.kinematics.kept_at_nodes().into_iter().collect();
    let of_field = contact.facets.iter().filter(|_| contact.kinematics.is_of_field(0));
    let nodes: BTreeSet<usize> = of_field.flat_map(|(_, facets)| facets.iter().flatten().copied()).collect();
    nodes.into_iter().filter_map(move |node| {
        let distance = contact.kinematics.distance_to_obstacle(node, y)?;
        Some((node, -distance - kept.get(&node).copied().unwrap_or(0.0)))
    })
}

/// Penetration at a state.
pub fn penetration(model: &Model, state: &State) -> Depths {
    Penetration::of_contacts(model).measure(model, state).depths
}

/// Square of the distance between two positions of a node.
fn square(a: &[f64], b: &[f64], dimension: usize, node: usize) -> f64 {
    (dimension * node..dimension * (node + 1)).map(|dof| (a[dof] - b[dof]).powi(2)).sum()
}

/// The depth that the pairs of a node with facets of a body keep, in whichever contact: a corner
/// may belong to two.
fn kept(model: &Model, state: &State, body: usize, node: usize) -> f64 {
    let is_of = |contact: &Contact, pair: &Pair| {
        let entered = contact.kinematics.facet_nodes(pair).first();
        contact.node(pair) == node && entered.and_then(|&node| part_of(model, node)) == Some(body)
    };
    let pairs = model.contacts.iter().zip(&state.pairs);
    let own = pairs.flat_map(|(contact, pairs)| pairs.iter().filter(move |pair| is_of(contact, pair)));
    own.map(|pair| pair.depth).fold(0.0, f64::max)
}

/// Whether a contact leaves a node that it constrains to a sharp edge that the node faces.
fn is_left(contact: &Contact, node: usize, y: &[f64]) -> bool {
    let kinematics = &contact.kinematics;
    let mut places = kinematics.secondary().iter().take(kinematics.nodes()).enumerate();
    places.any(|(place, &other)| other == node && kinematics.is_left(place, y))
}
