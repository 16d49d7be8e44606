//! What contact in both directions asks of either of them.

use super::Kinematics;

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

    /// Distance between two nodes.
    fn distance(&self, a: usize, b: usize, y: &[f64]) -> f64;
}
