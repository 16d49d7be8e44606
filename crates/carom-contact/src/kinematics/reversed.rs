//! Secondary nodes against the primary side, and nodes of the primary side against the secondary
//! one, in one set of constraints:
//!
//! ```text
//! secondary nodes, corners of the primary    g ≥ 0
//! other nodes of the primary                 g ≥ −d,   d a fiftieth of a secondary facet
//! ```
//!
//! In space the points between the nodes of sharp edges, on either side, are held like those other
//! nodes (`space/edge_points.rs`).
//!
//! No secondary node enters the primary, and no corner of the primary cuts into an edge of the
//! secondary between two of its nodes. The other nodes follow the secondary side's edges to within
//! d: with d = 0 the sides would be constrained twice, and meshes that do not match would lock.
//!
//! In contact of a side with itself, each of two places that meet is secondary and primary. The one
//! that comes later along the boundary is the secondary (`folds.rs`): all nodes are in either
//! direction, in the first with the facets before them, in the second with those after them. The
//! nodes of a zone of contact are then secondary on one of its flanks and follow on the other one,
//! as between two bodies. Constraining both flanks would lock them; neither, or the mean of both
//! gaps, would let nodes through. Either choice of the flank gives the same answer where nodes
//! meet nodes.
//!
//! The nodes of the primary follow those of the secondary side. Where a corner meets a secondary
//! node and a facet at the corner is parallel to the secondary one, either row would prevent
//! penetration, and both would be nearly dependent: the corner is then left to the node. It is not
//! left to one in a concave corner, whose row may be that with another facet.

use carom_algebra::Vector;

use super::facets::{Facets, OnFacet};
use super::space::cross;
use crate::constants::{KINK, PARALLEL};

/// Nodes of a side with the depth that each may have without contact.
#[derive(Clone, Debug, PartialEq)]
pub struct NodesWithDepth {
    /// Global numbers of the nodes.
    pub nodes: Vec<usize>,
    /// Allowed depth ≥ 0 of each node.
    pub depths: Vec<f64>,
}

impl NodesWithDepth {
    /// Nodes that may have no depth.
    pub fn all_held(nodes: Vec<usize>) -> Self {
        Self { depths: vec![0.0; nodes.len()], nodes }
    }

    /// The nodes that may have no depth.
    #[must_use]
    pub fn without_depth(self) -> Self {
        let all = self.nodes.into_iter().zip(self.depths);
        let (nodes, depths) = all.filter(|(_, depth)| *depth == 0.0).unzip();
        Self { nodes, depths }
    }

    /// Raises smaller depths to this one.
    #[must_use]
    pub fn with_at_least(mut self, least: f64) -> Self {
        self.depths.iter_mut().for_each(|depth| *depth = depth.max(least));
        self
    }
}

/// A pair of a node of the primary side with a facet of the secondary one.
#[derive(Clone, Copy)]
pub(super) struct Faced {
    /// Index of the node among those of its direction of contact.
    pub place: usize,
    pub node: usize,
    pub at: OnFacet<[f64; 2]>,
}

/// The corners of a primary side.
#[derive(Debug, Default)]
pub(super) struct Corners {
    /// Facets of the primary side at each of its corners, with the coordinates of the corner on
    /// them; none at its other nodes.
    facets: Vec<Vec<OnFacet<[f64; 2]>>>,
    /// Distance along the surface between a corner and a node of the other side, relative to the
    /// facet of the corner, below which the pair of the node prevents penetration instead of that
    /// of the corner: just where the node begins to face the side. Where all nodes of both sides
    /// meet, the row of a corner depends on those of the nodes around it to second order in this
    /// distance.
    near: f64,
}

impl Corners {
    /// Corners are the nodes of the side that may have no depth.
    pub(super) fn new<const D: usize>(
        side: &impl Facets<D>,
        nodes: &[usize],
        allowed: impl Fn(usize) -> f64,
        near: f64,
    ) -> Self {
        let of_corner = |(place, &node): (usize, &usize)| match allowed(place) {
            0.0 => side.facets_at(node),
            _ => Vec::new(),
        };
        Self { facets: nodes.iter().enumerate().map(of_corner).collect(), near }
    }

    /// Whether a corner of the primary meets a node of the secondary facet that it faces and has a
    /// facet parallel to that one, so that the node alone prevents penetration.
    pub(super) fn is_left_to_node<const D: usize, F: Facets<D>>(
        &self,
        corner: Faced,
        [primary, secondary]: [&F; 2],
        y: &[f64],
    ) -> bool {
        let normal = secondary.normal(corner.at.facet, corner.at.xi, y);
        let faced = secondary.nodes_of(corner.at.facet);
        self.facets[corner.place].iter().any(|&OnFacet { facet, xi }| {
            let own = primary.normal(facet, xi, y);
            let near = self.near * primary.length(facet, y);
            // Without regard to their depth, which may be large before convergence.
            let meets = |other: usize| cross(offset::<D>(other, corner.node, y), normal).norm() < near;
            own.dot(&normal) < -PARALLEL.cosine
                && faced.iter().any(|&other| meets(other) && !is_in_notch(secondary, other, normal, y))
        })
    }
}

/// Whether a node lies in a concave corner of its side: another facet there rises in front of the
/// one with this normal.
fn is_in_notch<const D: usize>(side: &impl Facets<D>, node: usize, normal: Vector<3>, y: &[f64]) -> bool {
    side.facets_at(node).iter().any(|&OnFacet { facet, .. }| {
        let height = |&other: &usize| offset::<D>(node, other, y).dot(&normal);
        let highest = side.nodes_of(facet).iter().map(height).fold(0.0, f64::max);
        highest > KINK.sine * side.length(facet, y)
    })
}

/// Vector from one node to another, padded with zeros to space.
fn offset<const D: usize>(from: usize, to: usize, y: &[f64]) -> Vector<3> {
    Vector(std::array::from_fn(|i| if i < D { y[D * to + i] - y[D * from + i] } else { 0.0 }))
}
