//! Common interface of the boundaries of bodies in the plane and in space.

use carom_algebra::Vector;
use carom_solid::{Bounds, FacetShape, Hull, Tree, longest_edge, shortest_edge};

use crate::constants::NEAR_FACET;

/// Position of a point relative to the boundary of a body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Depth {
    /// Distance to the boundary, positive outside.
    pub distance: f64,
    /// Facet nearest to the point.
    pub facet: usize,
    /// Coordinates ξ of the nearest point on its facet; in the plane only the first is used.
    pub xi: [f64; 2],
}

/// A point of a facet, given by its coordinates ξ: one number in the plane, two in space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OnFacet<X> {
    /// Number of the facet.
    pub facet: usize,
    /// Coordinates on the facet.
    pub xi: X,
}

/// The facets of a boundary, all of one shape; positions `y` are flat over all nodes, `D`
/// components each.
pub trait Facets<const D: usize> {
    /// Shape of every facet.
    fn shape(&self) -> FacetShape;

    /// Nodes of all facets, facet by facet: the facets of the side, then those of the rest of the
    /// boundary.
    fn nodes(&self) -> &[usize];

    /// Neighbours of a facet whose positions, with its own, decide on which side of the boundary a
    /// nearby point lies.
    fn beside(&self, facet: usize) -> impl Iterator<Item = usize>;

    /// Distance between a facet, with its edges and corners, and a point.
    fn distance(&self, facet: usize, point: Vector<D>, y: &[f64]) -> f64;

    /// Position relative to the boundary of a point whose nearest facet is known.
    fn depth(&self, facet: usize, point: Vector<D>, y: &[f64]) -> Depth;

    /// Outward unit normal of a facet at ξ, padded with zeros to space.
    fn normal(&self, facet: usize, xi: [f64; 2], y: &[f64]) -> Vector<3>;

    /// The facets of the side on whose ends or edges a node lies, with its coordinates on them.
    fn facets_at(&self, node: usize) -> Vec<OnFacet<[f64; 2]>>;

    /// Whether a facet lies in a plane of symmetry, where the mirror image continues the body.
    fn is_mirror(&self, facet: usize) -> bool;

    /// Nodes of a facet.
    fn nodes_of(&self, facet: usize) -> &[usize] {
        let n = self.shape().nodes();
        &self.nodes()[facet * n..(facet + 1) * n]
    }

    /// Number of all facets: those of the side and those of the rest of the boundary.
    fn all(&self) -> usize {
        self.nodes().len() / self.shape().nodes()
    }

    /// Length of a facet: that of its longest edge.
    fn length(&self, facet: usize, y: &[f64]) -> f64 {
        longest_edge(self.nodes_of(facet), y, D)
    }

    /// Length of the shortest edge of a facet, to which permitted depths are relative.
    fn shortest_edge(&self, facet: usize, y: &[f64]) -> f64 {
        shortest_edge(self.nodes_of(facet), y, D)
    }

    /// Bounding box of a facet.
    fn bounds(&self, hull: &Hull, facet: usize, y: &[f64]) -> Bounds {
        let nodes = self.nodes_of(facet);
        let y = y.as_chunks::<D>().0;
        hull.bounds(|a| &y[nodes[a]])
    }

    /// Facets that have no node in common with a facet and whose bounding boxes meet another box.
    fn apart_from(&self, facet: usize, bounds: &Bounds, tree: &Tree) -> impl Iterator<Item = usize> {
        let nodes = self.nodes_of(facet);
        let joined = |b: usize| self.nodes_of(b).iter().any(|node| nodes.contains(node));
        tree.meeting(bounds).filter(move |&b| !joined(b))
    }

    /// How far a coordinate of a node may change, apart from a motion of all nodes together, before
    /// two facets without a common node can cross; 0 where two are near at the positions of the
    /// tree of their boxes.
    fn clearance(&self, hull: &Hull, tree: &Tree, y: &[f64]) -> f64 {
        let mut least = f64::INFINITY;
        for a in 0..self.all() {
            let bounds = self.bounds(hull, a, y);
            let around = NEAR_FACET * bounds.size();
            if self.apart_from(a, &bounds.grown(around), tree).next().is_some() {
                return 0.0;
            }
            least = least.min(around);
        }
        // Either box grows.
        least / (2.0 * hull.weight())
    }
}
