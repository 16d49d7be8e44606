//! Rows of secondary nodes over facets in space, which `../joint.rs` joins at edges and corners:
//! gap, slip and their derivatives (`gap.rs`), at the closest point of a pair's facet.

use super::gap::PatchGap;
use super::node_to_patch::NodeToPatch;
use super::patch::place;
use crate::constants::{AT_JOINT, EXTENDED, PAST_END, WANDER};
use crate::kinematics::Facets;
use crate::kinematics::joint::OnFacets;
use crate::kinematics::tangents::tangents;
use crate::pair::{ContactError, Pair};
use crate::rows::Rows;

impl NodeToPatch {
    /// The closest point of a pair's facet to its node, searched from the last one.
    fn closest(&self, pair: &Pair, y: &[f64]) -> Option<[f64; 2]> {
        let patch = self.primary.patch(pair.facet);
        let from = place(y, self.secondary[pair.node]);
        let start = [pair.xi, pair.eta];
        patch.closest_from(y, from, start, WANDER).or_else(|| patch.closest_point(y, from, EXTENDED))
    }
}

impl OnFacets for NodeToPatch {
    fn dimension(&self) -> usize {
        3
    }

    fn parts<'a>(&'a self, pair: &'a Pair, y: &'a [f64]) -> impl Iterator<Item = Pair> + 'a {
        let from = place(y, self.secondary[pair.node]);
        let at = move |facet: usize, [xi, eta]: [f64; 2]| {
            let part = Pair { facet, xi, eta, joint: None, ..*pair };
            let [xi, eta] = self.closest(&part, y).unwrap_or([xi, eta]);
            Pair { xi, eta, ..part }
        };
        let own = at(pair.facet, [pair.xi, pair.eta]);
        let joined = pair.joint.map_or_else(Vec::new, |joint| self.primary.joined(pair.facet, joint));
        let others = joined.into_iter().filter(|&facet| facet != pair.facet);
        let beside = others.map(move |facet| at(facet, self.primary.patch(facet).nearest(y, from).xi));
        std::iter::once(own).chain(beside)
    }

    fn size(&self, facet: usize, y: &[f64]) -> f64 {
        self.primary.patch(facet).length(y)
    }

    fn past_joint(&self, pair: &Pair, joint: u8, y: &[f64]) -> f64 {
        let point = place(y, self.secondary[pair.node]);
        self.primary.past_joint(pair.facet, joint, point, y) / self.primary.patch(pair.facet).length(y)
    }

    fn past_end(&self, pair: &Pair) -> f64 {
        self.primary.patch(pair.facet).furthest([pair.xi, pair.eta])
    }

    fn joint_of(&self, pair: &Pair, y: &[f64]) -> Option<u8> {
        let patch = self.primary.patch(pair.facet);
        let furthest = patch.furthest([pair.xi, pair.eta]);
        if !self.at_joints.mean || !(-PAST_END..=EXTENDED).contains(&furthest) {
            return None;
        }
        // A node may not meet every facet of a joint of its own side.
        let is_met = |&facet: &usize| self.may_take(self.secondary[pair.node], facet, y);
        // At a sharp edge, a blunt one may end.
        let is_joint = |&joint: &u8| {
            let meets_all =
                || self.folds.is_none() || self.primary.joined(pair.facet, joint).iter().all(is_met);
            self.past_joint(pair, joint, y) <= AT_JOINT && meets_all() && self.is_blunt(pair.facet, joint, y)
        };
        (0..2 * patch.corners() as u8).find(is_joint)
    }

    fn is_blunt(&self, facet: usize, joint: u8, y: &[f64]) -> bool {
        // Around a corner, facets that share no edge may turn by more: only a tip is no joint.
        let joined = self.primary.joined(facet, joint);
        let edges = self.primary.shape().corners();
        let across = |one: usize| (0..edges).filter_map(move |edge| self.primary.across(one, edge));
        let is_smooth = |&one: &usize| {
            let mut beside = across(one).filter(|other| joined.contains(other));
            self.primary.is_of_side(one) && beside.all(|other| self.primary.is_smooth(one, other, y))
        };
        let is_tip = || {
            let corner = self.primary.patch(facet).nodes.get(usize::from(joint)).copied();
            corner.filter(|_| usize::from(joint) < edges).is_some_and(|corner| self.primary.is_tip(corner, y))
        };
        joined.len() > 1 && joined.iter().all(is_smooth) && !is_tip()
    }

    fn nodes_with(&self, pair: &Pair) -> Vec<usize> {
        [&[self.secondary[pair.node]], self.primary.nodes_of(pair.facet)].concat()
    }

    fn measure_one(&self, pair: &mut Pair, y: &[f64], rows: &mut Rows) -> Result<(), ContactError> {
        let node = self.secondary[pair.node];
        let lost = ContactError::Lost { node, facet: pair.facet, xi: pair.xi };
        let xi = self.closest(pair, y).ok_or(lost)?;
        [pair.xi, pair.eta] = xi;
        if !pair.active && (self.faces_nothing(pair.facet, xi, y) || self.ends_at(node, pair.facet, xi, y)) {
            rows.push_open();
            return Ok(());
        }
        let patch = self.primary.patch(pair.facet);
        let gap = PatchGap::new(patch, y, place(y, node), xi);
        ContactError::unless_regular(node, pair, gap.regularity())?;
        let slopes = gap.gradient(patch.nodes.len());
        rows.push_both(gap.distance + self.slack(pair.node) + pair.depth, [&[node], patch.nodes], slopes);
        Ok(())
    }

    fn curvature_of_one(&self, pair: &Pair, y: &[f64], curvature: &mut [f64]) {
        let patch = self.primary.patch(pair.facet);
        let from = place(y, self.secondary[pair.node]);
        PatchGap::new(patch, y, from, [pair.xi, pair.eta]).curvature_into(patch.nodes.len(), curvature);
    }

    fn slip_of_one(&self, pair: &Pair, y: &[f64], rows: &mut Rows) -> Result<(), ContactError> {
        let node = self.secondary[pair.node];
        let patch = self.primary.patch(pair.facet);
        let gap = PatchGap::new(patch, y, place(y, node), [pair.xi, pair.eta]);
        ContactError::unless_regular(node, pair, gap.regularity())?;
        for along in tangents(gap.normal(), pair.tangential.tangents) {
            rows.push_both(0.0, [&[node], patch.nodes], gap.slip(along, patch.nodes.len()));
        }
        Ok(())
    }

    fn slip_derivative_of_one(&self, pair: &Pair, y: &[f64], tangent: usize, matrix: &mut [f64]) {
        let patch = self.primary.patch(pair.facet);
        let from = place(y, self.secondary[pair.node]);
        let gap = PatchGap::new(patch, y, from, [pair.xi, pair.eta]);
        let along = tangents(gap.normal(), pair.tangential.tangents)[tangent];
        let second = patch.shape.second([pair.xi, pair.eta]);
        gap.slip_derivative_into(along, &second, patch.nodes.len(), matrix);
    }
}
