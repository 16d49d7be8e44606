//! A side in the plane against itself, in the two directions of `reversed.rs`: all nodes as those
//! of the later place, with the facets that come before them, and as those of the earlier one, with
//! the facets that come after them (`folds.rs`).

use std::sync::Arc;

use super::Combined;
use super::folds::{Folds, Side};
use super::joint::AtJoints;
use super::node_to_facet::{Detection, NodeToFacet};
use super::reversed::NodesWithDepth;
use super::surface::Surface;
use crate::constants::ROUND_OFF;

impl NodeToFacet {
    /// A side against itself: its nodes in the role of the later place, and in that of the earlier
    /// one, where their depth is zero at corners; `piece`: the connected piece of its body to
    /// which each node belongs, from `first_node` on; `reference`: the reference positions, flat
    /// over all nodes; `at_joints`: the pairs of nodes over joints.
    pub fn of_itself(
        side: &Surface,
        [later, earlier]: [NodesWithDepth; 2],
        piece: &[usize],
        first_node: usize,
        reference: &[f64],
        at_joints: AtJoints,
    ) -> Combined {
        let folds = Arc::new(Folds::new(side, piece, first_node, reference));
        let of = |nodes: NodesWithDepth, which: Side| {
            let against = Self::new(nodes.nodes, side.clone(), Detection::ClosestPoint);
            let against = against.with_allowed(nodes.depths).with_joints(at_joints);
            against.of_body(side.clone()).folding(folds.clone(), which)
        };
        Combined::both(of(later, Side::Later), of(earlier, Side::Earlier).reversed())
    }

    /// Contact of nodes of the primary side with that side itself.
    fn folding(mut self, folds: Arc<Folds>, side: Side) -> Self {
        self.folds = Some((folds, side));
        self
    }

    /// Whether a node must not form a pair with a facet: one that contains the node, or one that
    /// the other direction of contact compares it with.
    pub(super) fn excludes(&self, node: usize, facet: usize) -> bool {
        self.folds.as_ref().is_some_and(|(folds, side)| !folds.admits(*side, node, facet))
    }

    /// Whether ξ lies past an end of a facet at which a facet follows that the node must not form a
    /// pair with.
    pub(super) fn ends_at(&self, node: usize, facet: usize, xi: f64) -> bool {
        let next = || self.primary.neighbour(facet, xi > 0.0);
        self.folds.is_some()
            && xi.abs() > 1.0 + ROUND_OFF
            && next().is_some_and(|next| self.excludes(node, next))
    }
}
