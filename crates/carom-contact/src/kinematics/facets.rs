//! What the boundaries of bodies in the plane and in space have in common.

use carom_algebra::Vector;
use carom_solid::{Bounds, FacetShape, Hull, Tree};

/// Distance up to which a facet is near another one, over its size.
const NEAR: f64 = 0.25;

/// A point relative to a boundary.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Depth {
    /// Distance to the boundary, positive outside.
    pub distance: f64,
    /// Nearest facet, and its point.
    pub facet: usize,
    /// ξ of that point, one coordinate in the plane.
    pub xi: [f64; 2],
}

/// Facets of one shape; positions `y` are flat over all nodes, `D` components each.
pub(crate) trait Facets<const D: usize> {
    /// Shape of every facet.
    fn shape(&self) -> FacetShape;

    /// Nodes of all facets, those of the side and then those of the rest of the boundary, facet by
    /// facet.
    fn nodes(&self) -> &[usize];

    /// Facets whose positions tell, with those of a facet itself, where a point near that lies.
    fn beside(&self, facet: usize) -> impl Iterator<Item = usize>;

    /// Distance between a facet, with its edges and corners, and a point.
    fn distance(&self, facet: usize, point: Vector<D>, y: &[f64]) -> f64;

    /// Where a point lies whose nearest facet is known.
    fn depth(&self, facet: usize, point: Vector<D>, y: &[f64]) -> Depth;

    /// Outward unit normal of a facet at ξ, padded with zeros to space.
    fn normal(&self, facet: usize, xi: [f64; 2], y: &[f64]) -> Vector<3>;

    /// Nodes of a facet.
    fn nodes_of(&self, facet: usize) -> &[usize] {
        let n = self.shape().nodes();
        &self.nodes()[facet * n..(facet + 1) * n]
    }

    /// Number of facets with those of the rest of the boundary.
    fn all(&self) -> usize {
        self.nodes().len() / self.shape().nodes()
    }

    /// Distance between the first corners of a facet.
    fn length(&self, facet: usize, y: &[f64]) -> f64 {
        let (nodes, y) = (self.nodes_of(facet), y.as_chunks::<D>().0);
        (Vector(y[nodes[1]]) - Vector(y[nodes[0]])).norm()
    }

    /// Box around a facet.
    fn bounds(&self, hull: &Hull, facet: usize, y: &[f64]) -> Bounds {
        let (nodes, y) = (self.nodes_of(facet), y.as_chunks::<D>().0);
        hull.bounds(|a| &y[nodes[a]])
    }

    /// The facets without a node of this one whose boxes meet another box.
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
            let around = NEAR * bounds.size();
            if self.apart_from(a, &bounds.grown(around), tree).next().is_some() {
                return 0.0;
            }
            least = least.min(around);
        }
        // Either box grows.
        least / (2.0 * hull.weight())
    }
}
