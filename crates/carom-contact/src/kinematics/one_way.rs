//! Interface of one of the two directions of contact between two deformable sides.

use carom_algebra::Vector;

use super::Kinematics;
use super::facets::OnFacet;
use super::facing::PAST_SIDE;
use super::node_to_facet::NodeToFacet;

/// Secondary nodes against the facets of a primary side, as one of the two directions of contact.
pub trait OneWay: Kinematics {
    /// Distance along the surface between a corner and a node of the other side, relative to the
    /// facet of the corner, below which the pair of the node prevents penetration instead of that
    /// of the corner: just where the node begins to face the side. Where all nodes of both sides
    /// meet, the row of a corner depends on those of the nodes around it to second order in this
    /// distance.
    const NEAR_END: f64;

    /// Facets of the primary side of which a node is a corner, with the coordinates of the corner
    /// on them.
    fn facets_at(&self, node: usize) -> Vec<OnFacet<[f64; 2]>>;

    /// Global numbers of the nodes of a primary facet.
    fn nodes_of(&self, facet: usize) -> &[usize];

    /// Outward unit normal of a primary facet at ξ, padded with zeros to space.
    fn normal(&self, facet: usize, xi: [f64; 2], y: &[f64]) -> [f64; 3];

    /// Length of a primary facet: the distance between its first two corners.
    fn length(&self, facet: usize, y: &[f64]) -> f64;

    /// Vector from one node to another, padded with zeros to space.
    fn offset(&self, from: usize, to: usize, y: &[f64]) -> Vector<3>;
}

impl OneWay for NodeToFacet {
    const NEAR_END: f64 = 0.5 * PAST_SIDE;

    fn facets_at(&self, node: usize) -> Vec<OnFacet<[f64; 2]>> {
        let end = |facet: usize| {
            let nodes = self.primary.facet(facet).nodes;
            let xi = if nodes[0] == node { Some(-1.0) } else { (nodes[1] == node).then_some(1.0) };
            xi.map(|xi| OnFacet { facet, xi: [xi, 0.0] })
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

    fn offset(&self, from: usize, to: usize, y: &[f64]) -> Vector<3> {
        let y = self.places(y);
        let [x, y] = (y.at(to) - y.at(from)).0;
        Vector([x, y, 0.0])
    }
}
