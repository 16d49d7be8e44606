//! Creases of the primary: concave edges, and the points where several of them meet. The nearest
//! point of a node below one is on an edge, and its own facet is not the only one that it enters.

use carom_algebra::Vector;

use super::node_to_patch::{NOISE, NodeToPatch, REACH, WANDER};

impl NodeToPatch {
    /// Of a node below a crease, where its nearest point is on an edge: the facet of which it is
    /// deepest, of those that face its own one. On the extrapolation of its own it would sink into
    /// them.
    pub(super) fn in_crease(&self, own: usize, from: Vector<3>, y: &[f64]) -> Option<(usize, [f64; 2])> {
        if self.primary.depth(own, from, y).distance >= 0.0 {
            return None;
        }
        let xi = self.primary.patch(own).closest_point(y, from, WANDER)?;
        let mut least = self.gap(own, xi, from, y) - NOISE * self.primary.patch(own).length(y);
        let mut deepest = None;
        for facet in self.primary.ring(own).into_iter().filter(|&facet| self.primary.is_of_side(facet)) {
            let patch = self.primary.patch(facet);
            let Some(xi) = patch.closest_point(y, from, REACH) else { continue };
            let gap = self.gap(facet, xi, from, y);
            if gap < least && self.rises(own, facet, y) && self.rises(facet, own, y) {
                (least, deepest) = (gap, Some((facet, xi)));
            }
        }
        deepest
    }

    /// Whether the middle of a facet lies in front of another one.
    fn rises(&self, behind: usize, facet: usize, y: &[f64]) -> bool {
        let middle = |facet: usize| {
            let patch = self.primary.patch(facet);
            let at = if patch.corners() == 3 { [1.0 / 3.0; 2] } else { [0.0; 2] };
            patch.at(y, at)
        };
        let base = middle(behind);
        (middle(facet).position - base.position).dot(&base.normal) > 0.0
    }
}
