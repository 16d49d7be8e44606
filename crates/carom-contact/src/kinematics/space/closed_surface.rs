//! The whole boundary of a body in space: how deep a point lies inside. Independent of pairs, sides
//! and history, so that it can judge them.

use carom_algebra::Vector;
use carom_solid::{Hull, Tree};

use super::boundary::Boundary;
use super::folds::{PatchFolds, update_normals};
use super::patch::Nearest;
use crate::kinematics::{Depth, Facets, amplification};

/// The whole boundary of a body in space: how deep a point lies inside.
#[derive(Debug)]
pub struct ClosedSurface {
    pub(super) boundary: Boundary,
    pub(super) hull: Hull,
    pub(super) tree: Tree,
    /// For nodes of the boundary itself: which facets they may meet, and the normals of the facets.
    pub(super) folds: Option<(PatchFolds, Vec<Vector<3>>)>,
}

impl ClosedSurface {
    /// A closed surface of all facets of the boundary of a body.
    pub fn new(boundary: Boundary) -> Self {
        let hull = Hull::facet(boundary.shape());
        Self { boundary, hull, tree: Tree::default(), folds: None }
    }

    /// Global numbers of the nodes of a facet.
    pub fn facet_nodes(&self, facet: usize) -> &[usize] {
        self.boundary.nodes_of(facet)
    }

    /// Moves the boundary to positions `y`, flat over all nodes.
    pub fn update(&mut self, y: &[f64]) {
        let boundary = &self.boundary;
        let hull = &self.hull;
        self.tree.place(boundary.all(), |facet| boundary.bounds(hull, facet, y));
        if let Some((_, normals)) = &mut self.folds {
            update_normals(&self.boundary, y, normals);
        }
    }

    /// Position relative to the boundary of a point, at the positions of the last update, searched
    /// from a facet near it if one is known; `None` without a boundary.
    pub fn depth(&self, point: [f64; 3], from: Option<usize>, y: &[f64]) -> Option<Depth> {
        let at = Vector(point);
        let mut last = None::<(usize, Nearest)>;
        let (facet, _) = self.tree.nearest(&at.0, from, |facet| {
            if self.boundary.is_mirror(facet) {
                return None;
            }
            let nearest = self.boundary.patch(facet).nearest(y, at);
            if last.is_none_or(|(_, least)| nearest.distance < least.distance) {
                last = Some((facet, nearest));
            }
            Some(nearest.distance)
        })?;
        // Of equally near facets the first one counts, which may not be the one asked first.
        Some(match last.filter(|(asked, _)| *asked == facet) {
            Some((_, nearest)) => self.boundary.depth_from(facet, nearest, at, y),
            None => self.boundary.depth(facet, at, y),
        })
    }

    /// Distance between a point and the boundary at ξ of a facet.
    pub fn distance(&self, facet: usize, xi: [f64; 2], point: [f64; 3], y: &[f64]) -> f64 {
        (Vector(point) - self.boundary.patch(facet).at(y, xi).position).norm()
    }

    /// Largest ratio of the motion of a point of a facet to that of its nodes: the largest Σ |φᵃ|.
    pub fn amplification(&self) -> f64 {
        amplification(self.boundary.shape())
    }
}
