//! A boundary in space against itself, in the two directions of `../reversed.rs`: all nodes as
//! those of the later place, with the facets that come before them, and as those of the earlier
//! one, with the facets that come after them. Of two sharp edges the later one is secondary.

use std::collections::BTreeSet;
use std::sync::Arc;

use super::boundary::Boundary;
use super::edge_to_edge::EdgeToEdge;
use super::folds::PatchFolds;
use super::node_to_patch::NodeToPatch;
use super::paths::Paths;
use crate::constants::ROUND_OFF;
use crate::kinematics::{AtJoints, Combined, NodesWithDepth, Side};

impl NodeToPatch {
    /// A side against itself: its nodes in the role of the later place, and those in the role of
    /// the earlier one, whose depth is zero at sharp edges; `piece`: the connected piece of its
    /// body to which each node belongs, from `first_node` on; `reference`: the reference positions,
    /// flat over all nodes; `at_joints`: the pairs of nodes over joints.
    pub fn of_itself(
        side: &Boundary,
        nodes: Vec<usize>,
        earlier: NodesWithDepth,
        piece: &[usize],
        first_node: usize,
        reference: &[f64],
        at_joints: AtJoints,
    ) -> Combined {
        let folds = Arc::new(PatchFolds::new(side, piece, first_node, reference));
        let of = |nodes: Vec<usize>, which: Side| {
            let nodes = NodeToPatch::new(nodes, side.clone()).with_joints(at_joints);
            nodes.of_body(side.clone()).folding(folds.clone(), which)
        };
        let others = [BTreeSet::new(), BTreeSet::new()];
        let edges = EdgeToEdge::new([side.clone(), side.clone()], &others, reference).folding(folds.clone());
        let reverse = of(earlier.nodes, Side::Earlier).with_allowed(earlier.depths).reversed();
        Combined::new(vec![Box::new(of(nodes, Side::Later)), Box::new(reverse), Box::new(edges)])
    }

    /// Whether a node must not form a pair with a facet: one that contains the node, one across its
    /// wall, or one that the other direction of contact compares it with.
    pub(super) fn excludes(&self, node: usize, facet: usize) -> bool {
        self.folds.as_ref().is_some_and(|(folds, side)| !folds.admits(*side, node, facet))
    }

    /// Whether ξ lies past an edge of a facet across which a facet follows that the node must not
    /// form a pair with. Sharp edges have their own tolerance, whatever follows.
    pub(super) fn ends_at(&self, node: usize, facet: usize, xi: [f64; 2], y: &[f64]) -> bool {
        let patch = self.primary.patch(facet);
        self.folds.is_some()
            && (0..patch.corners()).zip(patch.beyond(xi)).any(|(edge, beyond)| {
                let next = || self.primary.across(facet, edge);
                beyond > ROUND_OFF
                    && next().is_some_and(|next| self.excludes(node, next))
                    && !self.primary.is_sharp(facet, edge, y)
            })
    }

    /// Whether a pair of a node may be handed over to a facet at positions `y`.
    pub(super) fn may_take(&self, node: usize, facet: usize, y: &[f64]) -> bool {
        let normal = |facet: usize| self.primary.middle(facet, y).normal;
        self.folds.as_ref().is_none_or(|(folds, side)| folds.met(node, facet, normal) == Some(*side))
            && self.may_press(node, y, |facet| self.primary.middle(facet, y))(facet)
    }

    /// Keeps those of the facets near a node that it may meet at the start of the step, in either
    /// direction of contact: those of the other direction tell where it enters.
    pub(super) fn retain_met(&self, node: usize, paths: &Paths, near: &mut Vec<usize>) {
        if let Some((folds, _)) = &self.folds {
            near.retain(|&facet| folds.met(node, facet, |facet| paths.middle(facet).normal).is_some());
        }
    }

    /// Whether a node may have a pair with a facet near it, at the start of the step.
    pub(super) fn is_met(&self, node: usize, facet: usize, paths: &Paths) -> bool {
        let of_fold = |(folds, side): &(Arc<PatchFolds>, Side)| {
            folds.met(node, facet, |facet| paths.middle(facet).normal) == Some(*side)
        };
        self.primary.is_of_side(facet) && self.folds.as_ref().is_none_or(of_fold)
    }
}
