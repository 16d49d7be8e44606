//! Nodes that several ties hold. Ties meet at corners: of nodes at one place each is tied to
//! another one, and at most one of them to a point of a facet, so that they move together and no
//! tie says anything twice. Links of nodes at one place are a tree, which is turned where a tie
//! needs it.

use std::collections::BTreeMap;

use carom_mechanics::model::Point;

/// What carries a node, and the tie that says so.
#[derive(Clone, Debug, PartialEq)]
struct Link {
    weights: Vec<(usize, f64)>,
    tie: usize,
    /// Whether the node is on the primary side of the tie.
    turned: bool,
}

/// The links of all ties.
#[derive(Debug, Default)]
pub struct Links(BTreeMap<usize, Link>);

impl Links {
    /// Ties a node of the secondary side of a tie to a point of its primary side. What follows from
    /// earlier ties is left out, and so is a second facet for nodes that one carries.
    pub fn tie(&mut self, tie: usize, node: usize, weights: Vec<(usize, f64)>) {
        let end = self.end(node);
        let other = alone(&weights).map(|carrier| (carrier, self.end(carrier)));
        if other.is_some_and(|(_, other)| other == end) {
            return;
        }
        if !self.0.contains_key(&end) {
            self.turn(node);
            self.0.insert(node, Link { weights, tie, turned: false });
            return;
        }
        if let Some((carrier, _)) = other.filter(|(_, end)| !self.0.contains_key(end)) {
            self.turn(carrier);
            self.0.insert(carrier, Link { weights: vec![(node, 1.0)], tie, turned: true });
        }
    }

    /// The node at the place of a node that no other one there carries.
    pub fn end(&self, node: usize) -> usize {
        let mut end = node;
        while let Some(carrier) = self.0.get(&end).and_then(|link| alone(&link.weights)) {
            end = carrier;
        }
        end
    }

    /// Turns the links from a node to the end of its chain: nothing carries it then.
    fn turn(&mut self, node: usize) {
        let mut from = node;
        let mut before: Option<(usize, Link)> = None;
        while let Some(link) = self.0.remove(&from) {
            let next = alone(&link.weights);
            if let Some((other, link)) = before.take() {
                self.0.insert(from, turned(&link, other));
            }
            before = Some((from, link));
            match next {
                Some(next) => from = next,
                None => return,
            }
        }
        if let Some((other, link)) = before {
            self.0.insert(from, turned(&link, other));
        }
    }

    /// The points.
    pub fn points(&self) -> Vec<Point> {
        self.0.iter().map(|(&node, link)| Point { node, weights: link.weights.clone() }).collect()
    }

    /// The nodes that a tie makes points, of its secondary and of its primary side.
    pub fn tied(&self, tie: usize) -> [Vec<usize>; 2] {
        let own = |turned: bool| {
            let links = self.0.iter().filter(|(_, link)| link.tie == tie && link.turned == turned);
            links.map(|(node, _)| *node).collect()
        };
        [own(false), own(true)]
    }
}

/// The link of a node's carrier back to it.
fn turned(link: &Link, node: usize) -> Link {
    Link { weights: vec![(node, 1.0)], tie: link.tie, turned: !link.turned }
}

/// The node at a point, if it is one.
fn alone(weights: &[(usize, f64)]) -> Option<usize> {
    match weights {
        [(carrier, _)] => Some(*carrier),
        _ => None,
    }
}
