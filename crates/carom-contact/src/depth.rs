//! Where a point lies relative to the boundary of a body, seen from the facet nearest to it.
//!
//! In the plane (for space see `kinematics/space/boundary.rs`): inside a facet the sign of the
//! distance is that of the normal; at a joint the point is outside if the joint is convex, inside
//! if it is concave.

use carom_algebra::Vector;
use carom_solid::FacetShape;

use crate::constants::ON_FACET;
use crate::kinematics::mirror::Continuation;
use crate::kinematics::{Depth, Facets, OnFacet, Surface};
use crate::places::Places;

/// The point of a facet in the plane that is nearest to a given point.
#[derive(Clone, Copy)]
pub(crate) struct NearestOnFacet {
    pub(crate) xi: f64,
    pub(crate) distance: f64,
}

impl Surface {
    /// The point of a facet, with its ends, that is nearest to a given point.
    pub(crate) fn nearest(&self, facet: usize, point: Vector<2>, y: Places) -> NearestOnFacet {
        let side = self.facet(facet);
        let at = |xi: f64| NearestOnFacet { xi, distance: (point - side.at(y, xi).position).norm() };
        let ends = [-1.0, 1.0].map(at);
        let inner = side.closest_point(y, point, 1.0).map(at);
        let first = if ends[1].distance < ends[0].distance { ends[1] } else { ends[0] };
        inner.filter(|inner| inner.distance < first.distance).unwrap_or(first)
    }

    fn is_outside(&self, facet: usize, xi: f64, point: Vector<2>, y: Places) -> bool {
        let at = self.facet(facet).at(y, xi);
        (point - at.position).dot(&at.normal) >= 0.0
    }

    /// Whether a point is outside a body where the nearest point is a joint of two facets: in front
    /// of either facet at a convex joint, in front of both at a concave one, which is nearest to a
    /// remote point by round-off only.
    fn is_outside_joint(&self, facet: usize, xi: f64, point: Vector<2>, y: Places) -> bool {
        let Some(neighbour) = self.neighbour(facet, xi > 0.0) else {
            return self.is_outside(facet, xi, point, y);
        };
        if self.is_mirror(neighbour) {
            // The mirror image continues the facet, but what lies past the plane of symmetry is no
            // part of this half.
            let end = self.facet(facet).at(y, xi).position;
            let past = (point - end).dot(&self.facet(neighbour).at(y, 0.0).normal);
            let is_past = past > ON_FACET * self.length(facet, y);
            return is_past || self.is_outside(facet, xi, point, y);
        }
        let [first, second] = if xi > 0.0 { [facet, neighbour] } else { [neighbour, facet] };
        let sine = self.kink(first, second, y).sine;
        let [before, after] = [(first, 1.0), (second, -1.0)].map(|(f, xi)| self.is_outside(f, xi, point, y));
        if sine > 0.0 { before || after } else { before && after }
    }
}

impl Facets<2> for Surface {
    fn shape(&self) -> FacetShape {
        self.shape
    }

    fn nodes(&self) -> &[usize] {
        &self.nodes
    }

    fn beside(&self, facet: usize) -> impl Iterator<Item = usize> {
        [false, true].into_iter().filter_map(move |forward| self.neighbour(facet, forward))
    }

    fn facets_at(&self, node: usize) -> Vec<OnFacet<[f64; 2]>> {
        let end = |facet: usize| {
            let nodes = self.facet(facet).nodes;
            let xi = if nodes[0] == node { Some(-1.0) } else { (nodes[1] == node).then_some(1.0) };
            xi.map(|xi| OnFacet { facet, xi: [xi, 0.0] })
        };
        (0..self.facets()).filter_map(end).collect()
    }

    fn is_mirror(&self, facet: usize) -> bool {
        self.continuation(facet) == Continuation::Mirror
    }

    fn distance(&self, facet: usize, point: Vector<2>, y: &[f64]) -> f64 {
        self.nearest(facet, point, Places::new(y, 2)).distance
    }

    fn depth(&self, facet: usize, point: Vector<2>, y: &[f64]) -> Depth {
        let y = Places::new(y, 2);
        let NearestOnFacet { xi, distance } = self.nearest(facet, point, y);
        let joint = xi.abs() >= 1.0;
        let outside =
            if joint { Self::is_outside_joint } else { Self::is_outside }(self, facet, xi, point, y);
        let distance = if outside { distance } else { -distance };
        Depth { distance, facet, xi: [xi, 0.0] }
    }

    fn normal(&self, facet: usize, xi: [f64; 2], y: &[f64]) -> Vector<3> {
        let [x, y] = self.facet(facet).at(Places::new(y, self.shape.dimension()), xi[0]).normal.0;
        Vector([x, y, 0.0])
    }
}
