//! The nodes whose penetration is measured, with the bodies that they must not enter; in space
//! points of sharp edges too, because edges can cross between their nodes.

use carom_contact::constants::BESIDE_KINK;
use std::collections::{BTreeMap, HashMap, HashSet};

use carom_contact::{Boundary, Side};

use crate::check::skins::{kinks, length, part_of, position, skin_facets, skin_nodes};
use crate::model::{Contact, Model};

/// Nodes of a side against a body.
#[derive(Debug)]
pub(crate) struct Way {
    /// The contact; none for bodies without one.
    pub contact: Option<usize>,
    /// The body that must not be entered, and the nodes of its boundary.
    pub body: usize,
    pub boundary: Vec<usize>,
    /// For nodes of the body itself: their side of the places that they may meet.
    pub itself: Option<Side>,
    pub nodes: Vec<Watched>,
    /// The node that was deepest, with which the next search begins.
    pub first: usize,
}

#[derive(Debug)]
pub(crate) struct Watched {
    /// The node; of a point between nodes the first one.
    pub node: usize,
    /// Nodes and weights of a point of an edge; empty for a node.
    pub between: Vec<(usize, f64)>,
    /// Length of its facets in the reference configuration.
    pub length: f64,
    /// Whether the contact constrains it.
    pub constrained: bool,
    /// Allowed depth over the length of a facet.
    pub share: f64,
    /// Depth that its contact keeps, which is not counted.
    pub kept: f64,
    /// Distance up to which its own body is searched.
    pub reach: f64,
    /// Distance that it and the body may still move together before it can be inside.
    pub clearance: f64,
    /// Its nearest facet and ξ, where the next search begins.
    pub near: Option<(usize, [f64; 2])>,
}

impl Way {
    pub(crate) fn new(model: &Model, contact: Option<usize>, body: usize, nodes: Vec<Watched>) -> Self {
        let boundary = skin_nodes(&model.parts[body]);
        Self { contact, body, boundary, itself: None, nodes, first: 0 }
    }

    /// The nodes of a side against the places of their own body that they may meet.
    pub(crate) fn of_itself(model: &Model, contact: usize, side: Side) -> Self {
        let Contact { kinematics, facets, depths, primary_part, .. } = &model.contacts[contact];
        // Edges follow the nodes. Of a pressure field no node is held to more than its bounds.
        let nodes = &kinematics.secondary()[..kinematics.nodes()];
        let half = nodes.len() / 2;
        let is_of_field = kinematics.is_of_field(0);
        let facets = &facets[0].1;
        let earlier: HashMap<usize, usize> = nodes[half..].iter().copied().zip(half..).collect();
        let mut shortest: HashMap<usize, f64> = HashMap::new();
        for facet in facets {
            let length = length(model, facet);
            for &node in facet {
                let shortest = shortest.entry(node).or_insert(length);
                *shortest = shortest.min(length);
            }
        }
        let kinks = primary_part.map_or_else(Vec::new, |part| kinks(model, &model.parts[part]));
        let watched = |(node, longest)| {
            let is_held = || {
                side == Side::Later
                    || earlier.get(&node).is_some_and(|&place| kinematics.allowed(place) == 0.0)
            };
            let constrained = !is_of_field && is_held();
            // Before a node can enter a facet that it does not meet yet, the boundary folds.
            let reach = 0.5 * shortest.get(&node).copied().unwrap_or(f64::INFINITY);
            let is_kink = kinks.binary_search(&node).is_ok();
            Watched { reach, ..Watched::new(node, longest, constrained, depths.of(constrained, is_kink)) }
        };
        let nodes = lengths(model, facets).map(watched).collect();
        Self { itself: Some(side), ..Self::new(model, Some(contact), primary_part.unwrap_or(0), nodes) }
    }
}

impl Watched {
    pub(crate) fn new(node: usize, length: f64, constrained: bool, share: f64) -> Self {
        let between = Vec::new();
        Self { node, between, length, constrained, share, kept: 0.0, reach: 0.0, clearance: 0.0, near: None }
    }

    /// Its position.
    pub(crate) fn point(&self, y: &[f64], dimension: usize) -> [f64; 3] {
        if self.between.is_empty() {
            return position(y, dimension, self.node);
        }
        let mut point = [0.0; 3];
        for &(node, weight) in &self.between {
            let x = position(y, dimension, node);
            (0..3).for_each(|i| point[i] += weight * x[i]);
        }
        point
    }

    /// How far it has moved at most, from the squares of its nodes' motions.
    pub(crate) fn motion(&self, square: impl Fn(usize) -> f64) -> f64 {
        if self.between.is_empty() {
            return square(self.node).sqrt();
        }
        self.between.iter().map(|&(node, weight)| weight.abs() * square(node).sqrt()).sum()
    }

    /// Allowed depth in a facet of this length: a node that the contact law keeps outside is judged
    /// by the facet that it enters alone.
    ///
    /// A depth that is kept is that of nodes over a facet or its extension past a joint, not of the
    /// points between them nor from the joint.
    pub(crate) fn limit(&self, entered: f64) -> f64 {
        let length = if self.constrained { entered } else { self.length.max(entered) };
        self.share * length + BESIDE_KINK * self.kept.abs()
    }
}

/// The nodes of a side's facets, with the depths that its contact allows.
pub(crate) fn watched(model: &Model, contact: &Contact, facets: &[Vec<usize>]) -> Vec<Watched> {
    let nodes = contact.kinematics.secondary().iter().enumerate().take(contact.kinematics.nodes());
    let strict = nodes.filter(|(k, _)| contact.kinematics.allowed(*k) == 0.0).map(|(_, &node)| node);
    let strict: HashSet<usize> = strict.collect();
    let kept = kept_depths(contact);
    let part = facets.first().and_then(|facet| part_of(model, facet[0]));
    let kinks = part.map_or_else(Vec::new, |part| kinks(model, &model.parts[part]));
    let watched = |(node, length)| {
        let constrained = strict.contains(&node);
        let kept = kept.get(&node).copied().unwrap_or(0.0);
        let share = contact.depths.of(constrained, kinks.binary_search(&node).is_ok());
        Watched { kept, ..Watched::new(node, length, constrained, share) }
    };
    lengths(model, facets).map(watched).collect()
}

/// The depth that a contact keeps at each of its nodes.
pub(crate) fn kept_depths(contact: &Contact) -> HashMap<usize, f64> {
    contact.kinematics.kept_at_nodes().into_iter().collect()
}

/// Whether a node of a contact keeps a depth.
pub(crate) fn keeps(contact: &Contact) -> bool {
    contact.kinematics.kept_at_nodes().iter().any(|(_, depth)| *depth != 0.0)
}

/// Index of the first secondary node in the role of the earlier place, in contact of a side with
/// itself: behind the coefficients of a pressure field, if there is one, and the later nodes.
pub(crate) fn first_of_earlier(contact: &Contact) -> usize {
    let kinematics = &contact.kinematics;
    let all = kinematics.secondary().len();
    let field = (0..all).take_while(|&place| kinematics.is_of_field(place)).count();
    if field == 0 { kinematics.nodes() / 2 } else { field + (all - field) / 2 }
}

/// Whether every node of a contact has a gap: its primary is rigid, or a point.
pub(crate) fn has_gaps(model: &Model, contact: &Contact) -> bool {
    !contact.itself && contact.facets.len() < 2 || model.dimension == 1
}

/// Points of the sharp edges of a side in space, of the body `part`. Contacts hold edges against
/// edges, not these points.
pub(crate) fn edge_points(
    model: &Model,
    contact: &Contact,
    part: usize,
    facets: &[Vec<usize>],
) -> Vec<Watched> {
    let shape = model.parts[part].body.mesh().element.facet_shape();
    if shape.dimension() != 3 {
        return Vec::new();
    }
    let side: HashSet<&Vec<usize>> = facets.iter().collect();
    let mut rest = skin_facets(&model.parts[part]);
    rest.retain(|facet| !side.contains(facet));
    let longest: HashMap<usize, f64> = lengths(model, facets).collect();
    let kept = kept_depths(contact);
    let points = Boundary::new(shape, facets, &rest, 0).points_of_sharp_edges(&model.reference);
    let watched = |between: Vec<(usize, f64)>| {
        let largest = |of: &HashMap<usize, f64>| {
            between.iter().filter_map(|(node, _)| of.get(node)).fold(0.0, |most: f64, x| most.max(*x))
        };
        let length = largest(&longest);
        let kept = largest(&kept);
        let node = between[0].0;
        Watched { between, kept, ..Watched::new(node, length, false, contact.depths.others) }
    };
    points.into_iter().map(watched).collect()
}

/// The nodes of facets, ascending, each with the longest of its facets in the reference
/// configuration.
pub(crate) fn lengths(model: &Model, facets: &[Vec<usize>]) -> impl Iterator<Item = (usize, f64)> {
    let mut nodes = BTreeMap::new();
    for facet in facets {
        let length = length(model, facet);
        for &node in facet {
            let longest: &mut f64 = nodes.entry(node).or_default();
            *longest = longest.max(length);
        }
    }
    nodes.into_iter()
}
