//! Warning about bodies that touch along whole facets at the start, without contact or tie: every
//! body has nodes of its own, so that nodes at one place are not connected.

use std::collections::{BTreeMap, HashMap};

use carom_case::Case;
use carom_mechanics::model::{BodyInstance, Model};

use super::found::Found;

/// Distance, relative to L, within which two nodes are at one place.
const NEAR: f64 = 1e-9;

pub(super) fn unconnected_bodies(case: &Case, model: &Model) -> Vec<Found> {
    // The other run has moved its bodies.
    if case.initial.is_some() {
        return Vec::new();
    }
    let contacts = case.contacts.iter().map(|contact| contact.bodies().collect::<Vec<_>>());
    let ties = case.ties.iter().map(|tie| tie.bodies().to_vec());
    let connected: Vec<Vec<&str>> = contacts.chain(ties).collect();
    let in_contact = |a: &BodyInstance, b: &BodyInstance| {
        let has = |bodies: &[&str], part: &BodyInstance| bodies.contains(&part.name.as_str());
        connected.iter().any(|bodies| has(bodies, a) && has(bodies, b))
    };
    let bodies: Vec<&BodyInstance> = model.parts.iter().filter(|part| !part.is_rigid()).collect();
    if bodies.len() < 2 {
        return Vec::new();
    }
    let places = Places::new(model, &bodies);
    let mut found = Vec::new();
    for (k, a) in bodies.iter().enumerate() {
        // Facets by the later body that has all of their nodes.
        let mut common: BTreeMap<usize, Vec<Vec<f64>>> = BTreeMap::new();
        for facet in a.skin() {
            let nodes: Vec<usize> = facet.nodes.iter().map(|node| node + a.first_node).collect();
            let mut others = places.of_other_bodies(nodes[0], k);
            others.retain(|other| nodes.iter().all(|&n| places.of_other_bodies(n, k).contains(other)));
            for other in others {
                common
                    .entry(other)
                    .or_default()
                    .push(model.initial_position[nodes[0] * model.dimension..][..model.dimension].to_vec());
            }
        }
        for (other, facets) in common {
            let b = bodies[other];
            if in_contact(a, b) {
                continue;
            }
            let facet = ["point", "edge", "face"][model.dimension.clamp(1, 3) - 1];
            let several =
                if facets.len() == 1 { format!("a {facet}") } else { format!("{} {facet}s", facets.len()) };
            found.push(Found::at(
                format!("bodies \"{}\" and \"{}\"", a.name, b.name),
                format!(
                    "they have {several} in common at the start, the first at {:?}, and neither contact nor tie",
                    facets[0]
                ),
            ));
        }
    }
    found
}

/// Boundary nodes of bodies by their places at the start.
struct Places<'a> {
    model: &'a Model,
    cell: f64,
    nodes: HashMap<[i64; 3], Vec<Node>>,
}

#[derive(Clone, Copy)]
struct Node {
    body: usize,
    number: usize,
}

impl<'a> Places<'a> {
    fn new(model: &'a Model, bodies: &[&BodyInstance]) -> Self {
        let mut places = Self { model, cell: 2.0 * NEAR * model.scale, nodes: HashMap::new() };
        for (body, part) in bodies.iter().enumerate() {
            for (number, _) in part.nodes().zip(part.on_boundary()).filter(|(_, on)| *on) {
                places.nodes.entry(places.key(number)).or_default().push(Node { body, number });
            }
        }
        places
    }

    fn at(&self, node: usize) -> &[f64] {
        let d = self.model.dimension;
        &self.model.initial_position[node * d..(node + 1) * d]
    }

    fn key(&self, node: usize) -> [i64; 3] {
        let x = self.at(node);
        std::array::from_fn(|axis| x.get(axis).map_or(0, |x| (x / self.cell).floor() as i64))
    }

    /// The bodies after a node's own one that have a node at its place.
    fn of_other_bodies(&self, node: usize, own: usize) -> Vec<usize> {
        let key = self.key(node);
        let near = |other: &Node| {
            let apart = self.at(node).iter().zip(self.at(other.number)).map(|(x, y)| (x - y).abs());
            apart.fold(0.0, f64::max) <= NEAR * self.model.scale
        };
        let around = (0..27_i64).map(|i| [i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1]);
        let cells = around.filter_map(|by| self.nodes.get(&std::array::from_fn(|axis| key[axis] + by[axis])));
        let mut bodies: Vec<usize> =
            cells.flatten().filter(|other| other.body > own && near(other)).map(|other| other.body).collect();
        bodies.sort_unstable();
        bodies.dedup();
        bodies
    }
}
