//! What contact in both directions asks of either of them.

use super::Kinematics;
use super::node_to_facet::NodeToFacet;

/// Secondary nodes against the facets of a primary side, one of the two directions.
pub trait OneWay: Kinematics {
    /// Facets of the primary side of which a node is a corner, with its ξ there.
    fn facets_at(&self, node: usize) -> Vec<(usize, [f64; 2])>;

    /// Global numbers of the nodes of a primary facet.
    fn nodes_of(&self, facet: usize) -> &[usize];

    /// Outward unit normal of a primary facet at ξ, padded with zeros to space.
    fn normal(&self, facet: usize, xi: [f64; 2], y: &[f64]) -> [f64; 3];

    /// Distance between the first corners of a primary facet.
    fn length(&self, facet: usize, y: &[f64]) -> f64;

    /// Whether the closest point of a node on a primary facet lies within it.
    fn is_over(&self, facet: usize, node: usize, y: &[f64]) -> bool;

    /// Distance between two nodes across a `normal`: before convergence they may lie deep.
    fn distance(&self, a: usize, b: usize, normal: [f64; 3], y: &[f64]) -> f64;
}

impl OneWay for NodeToFacet {
    fn facets_at(&self, node: usize) -> Vec<(usize, [f64; 2])> {
        let end = |facet: usize| {
            let nodes = self.primary.facet(facet).nodes;
            let xi = if nodes[0] == node { Some(-1.0) } else { (nodes[1] == node).then_some(1.0) };
            xi.map(|xi| (facet, [xi, 0.0]))
        };
        (0..self.primary.facets()).filter_map(end).collect()
    }

    fn nodes_of(&self, facet: usize) -> &[usize] {
        self.primary.facet(facet).nodes
    }

    fn normal(&self, facet: usize, xi: [f64; 2], y: &[f64]) -> [f64; 3] {
        let [x, y] = self.primary.facet(facet).at(self.places(y), xi[0]).normal.0;
        [x, y, 0.0]
    }

    fn length(&self, facet: usize, y: &[f64]) -> f64 {
        self.primary.length(facet, self.places(y))
    }

    fn is_over(&self, facet: usize, node: usize, y: &[f64]) -> bool {
        let y = self.places(y);
        self.primary.facet(facet).closest_point(y, y.at(node), 1.0).is_some()
    }

    fn distance(&self, a: usize, b: usize, normal: [f64; 3], y: &[f64]) -> f64 {
        let y = self.places(y);
        let apart = y.at(a) - y.at(b);
        (apart[0] * normal[1] - apart[1] * normal[0]).abs()
    }
}
