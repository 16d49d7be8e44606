//! Nodes in space that enter a body and leave it again within one step (`../passed.rs`).

use super::crossing::crossing;
use super::node_to_patch::{NodeToPatch, Tools};
use super::paths::Around;
use crate::kinematics::passed::{Boxes, Paths};
use crate::kinematics::way::Met;
use crate::kinematics::{Kinematics, Passed, SpaceHit};

impl NodeToPatch {
    /// The node that was deepest beyond its limit within a step, if any; `bounce`: allowed depth,
    /// relative to the length of a facet, of a node that leaves where it entered.
    pub(super) fn deepest(&self, tools: &mut Tools, ends: [&[f64]; 2], bounce: f64) -> Option<Passed> {
        let Tools { paths, apart, recent, swept, .. } = tools;
        recent.forget();
        // Within one piece, a path may begin and end on either side of its own boundary.
        let folds = self.folds.as_ref();
        let is_itself = folds.is_some_and(|(folds, _)| !folds.has_pieces());
        if is_itself || !self.primary.is_whole() || apart.holds(0.0, ends) {
            return None;
        }
        let among = Paths {
            boundary: &self.primary,
            nodes: self.secondary(),
            allowed: &|place| self.slack(place).max(0.0),
            enters: &|node, facet| !self.excludes(node, facet),
            bounds: &|node, facet| folds.is_none_or(|(folds, _)| folds.is_of_another_piece(node, facet)),
            bounce,
        };
        let motion = among.motion(ends)?;
        paths.update(&self.primary, &self.hull, Around { margin: 0.0, distance: 0.0 }, ends);
        among.deepest(
            motion,
            ends,
            Boxes { tree: paths.tree(), drift: paths.drift(), of_node: &|node| paths.path(node, ends) },
            |facet, ends, until, node| {
                let SpaceHit { theta, xi } = crossing(swept, self.primary.patch(facet), ends, until, node)?;
                Some(Met { theta, facet, xi })
            },
        )
    }
}
