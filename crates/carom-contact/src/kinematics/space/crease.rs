//! Creases of the primary: concave edges, and the points where several of them meet. The nearest
//! point of a node below one is on an edge, and its own facet is not the only one that it enters.

use super::node_to_patch::NodeToPatch;
use super::patch::place;
use crate::constants::{EXTENDED, ROUND_OFF};
use crate::kinematics::{Facets, OnFacet};
use crate::pair::Pair;

impl NodeToPatch {
    /// The facet of which a node below a crease is deepest, of those that face its own facet, if
    /// the nearest point of the primary is on an edge. On the extrapolation of its own facet the
    /// node would sink into the others. A facet across an edge of its own one counts
    /// only if the node's foot is past that edge.
    pub(super) fn in_crease(&self, pair: &Pair, y: &[f64]) -> Option<OnFacet<[f64; 2]>> {
        let own = pair.facet;
        let node = self.secondary[pair.node];
        let patch = self.primary.patch(own);
        let beyond = patch.beyond([pair.xi, pair.eta]);
        let is_past = |facet: usize| {
            let edge = (0..patch.corners()).find(|&edge| self.primary.across(own, edge) == Some(facet));
            edge.is_none_or(|edge| beyond[edge] > ROUND_OFF)
        };
        let from = place(y, node);
        if self.primary.depth(own, from, y).distance >= 0.0 {
            return None;
        }
        let mut least = -ROUND_OFF * self.primary.patch(own).length(y);
        let mut deepest = None;
        let is_met = |&facet: &usize| {
            self.primary.is_of_side(facet) && is_past(facet) && self.may_take(node, facet, y)
        };
        for facet in self.primary.ring(own).iter().copied().filter(is_met) {
            let patch = self.primary.patch(facet);
            let Some(xi) = patch.closest_point(y, from, EXTENDED) else { continue };
            let gap = self.gap(facet, xi, from, y);
            if gap < least && self.rises(own, facet, y) && self.rises(facet, own, y) {
                least = gap;
                deepest = Some(OnFacet { facet, xi });
            }
        }
        deepest
    }

    /// Whether the middle of `facet` lies in front of the facet `behind`.
    fn rises(&self, behind: usize, facet: usize, y: &[f64]) -> bool {
        let base = self.primary.middle(behind, y);
        (self.primary.middle(facet, y).position - base.position).dot(&base.normal) > 0.0
    }
}
