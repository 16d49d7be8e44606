//! Rows of secondary nodes over facets in the plane, which `joint.rs` joins at joints: gap, slip
//! and their derivatives (`gap.rs`), at the closest point of a pair's facet or at a frozen one.

use super::facets::Facets;
use super::gap::Gap;
use super::joint::OnFacets;
use super::node_to_facet::{ContactPoint, NodeToFacet};
use crate::constants::{AT_JOINT, REACH_XI, WANDER_XI};
use crate::pair::{ContactError, Pair};
use crate::places::Places;
use crate::rows::Rows;

impl NodeToFacet {
    /// Coordinate ξ of the point of a pair's facet that is closest to its node, searched from the
    /// last one.
    pub(super) fn closest(&self, pair: &Pair, y: Places) -> Option<f64> {
        let facet = self.primary.facet(pair.facet);
        let from = y.at(self.secondary[pair.node]);
        facet.closest_from(y, from, pair.xi, WANDER_XI).or_else(|| facet.closest_point(y, from, REACH_XI))
    }

    /// Gap of a pair at its contact point.
    pub(super) fn gap_of(&self, pair: &Pair, y: Places) -> Gap {
        let facet = self.primary.facet(pair.facet);
        let from = y.at(self.secondary[pair.node]);
        match self.point {
            ContactPoint::Closest => Gap::closest(facet, y, from, pair.xi),
            ContactPoint::Frozen => Gap::fixed(facet, y, from, pair.xi),
        }
    }
}

impl OnFacets for NodeToFacet {
    fn dimension(&self) -> usize {
        self.primary.shape().dimension()
    }

    fn parts<'a>(&'a self, pair: &'a Pair, y: &'a [f64]) -> impl Iterator<Item = Pair> + 'a {
        let y = self.places(y);
        let at = move |facet: usize, xi: f64| {
            let part = Pair { facet, xi, joint: None, ..*pair };
            Pair { xi: self.closest(&part, y).unwrap_or(xi), ..part }
        };
        let own = at(pair.facet, pair.xi);
        let forward = pair.joint == Some(1);
        let next = pair.joint.and_then(|_| self.primary.neighbour_of_side(pair.facet, forward));
        let beside = next.map(|facet| at(facet, if forward { -1.0 } else { 1.0 }));
        std::iter::once(own).chain(beside)
    }

    fn size(&self, facet: usize, y: &[f64]) -> f64 {
        self.primary.length(facet, self.places(y))
    }

    fn past_joint(&self, pair: &Pair, joint: u8, y: &[f64]) -> f64 {
        let y = self.places(y);
        let forward = joint == 1;
        let Some(next) = self.primary.neighbour(pair.facet, forward) else { return f64::INFINITY };
        let [first, second] = if forward { [pair.facet, next] } else { [next, pair.facet] };
        let before = self.primary.facet(first).at(y, 1.0);
        let after = self.primary.facet(second).at(y, -1.0);
        let along = before.tangent * before.measure.recip() + after.tangent * after.measure.recip();
        let past = (y.at(self.secondary[pair.node]) - after.position).dot(&along) / along.norm();
        past.abs() / self.primary.length(pair.facet, y)
    }

    fn past_end(&self, pair: &Pair) -> f64 {
        0.5 * (pair.xi.abs() - 1.0)
    }

    fn joint_of(&self, pair: &Pair, y: &[f64]) -> Option<u8> {
        if !self.at_joints.mean || self.is_frozen() || (pair.xi.abs() - 1.0).abs() > REACH_XI - 1.0 {
            return None;
        }
        let forward = pair.xi > 0.0;
        let joint = u8::from(forward);
        // A node may meet only one facet of a joint of its own side.
        let next = self.primary.neighbour(pair.facet, forward)?;
        if self.excludes(self.secondary[pair.node], next) {
            return None;
        }
        let is_over = self.past_joint(pair, joint, y) <= AT_JOINT;
        (is_over && self.is_blunt(pair.facet, joint, y)).then_some(joint)
    }

    fn is_blunt(&self, facet: usize, joint: u8, y: &[f64]) -> bool {
        let forward = joint == 1;
        self.primary.neighbour_of_side(facet, forward).is_some_and(|next| {
            let [first, second] = if forward { [facet, next] } else { [next, facet] };
            self.primary.is_blunt(first, second, self.places(y))
        })
    }

    fn nodes_with(&self, pair: &Pair) -> Vec<usize> {
        [&[self.secondary[pair.node]], self.primary.facet(pair.facet).nodes].concat()
    }

    fn measure_one(&self, pair: &mut Pair, y: &[f64], rows: &mut Rows) -> Result<(), ContactError> {
        let node = self.secondary[pair.node];
        let y = self.places(y);
        let facet = self.primary.facet(pair.facet);
        if !self.is_frozen() {
            let lost = ContactError::Lost { node, facet: pair.facet, xi: pair.xi };
            pair.xi = self.closest(pair, y).ok_or(lost)?;
            if !pair.active && self.primary.faces_nothing(pair.facet, pair.xi, y) {
                rows.push_open();
                return Ok(());
            }
        }
        let gap = self.gap_of(pair, y);
        ContactError::unless_regular(node, pair, gap.a)?;
        let slopes = gap.gradient(facet.nodes.len());
        rows.push_both(gap.distance + self.slack(pair.node) + pair.depth, [&[node], facet.nodes], slopes);
        Ok(())
    }

    fn curvature_of_one(&self, pair: &Pair, y: &[f64], curvature: &mut [f64]) {
        let facet = self.primary.facet(pair.facet);
        self.gap_of(pair, self.places(y)).curvature_into(
            facet.nodes.len(),
            facet.shape.dimension(),
            curvature,
        );
    }

    fn slip_of_one(&self, pair: &Pair, y: &[f64], rows: &mut Rows) -> Result<(), ContactError> {
        let node = self.secondary[pair.node];
        let facet = self.primary.facet(pair.facet);
        let gap = self.gap_of(pair, self.places(y));
        ContactError::unless_regular(node, pair, gap.a)?;
        rows.push_both(0.0, [&[node], facet.nodes], gap.slip(facet.nodes.len()));
        Ok(())
    }

    fn slip_derivative_of_one(&self, pair: &Pair, y: &[f64], _: usize, matrix: &mut [f64]) {
        let facet = self.primary.facet(pair.facet);
        self.gap_of(pair, self.places(y)).slip_derivative_into(facet.nodes.len(), matrix);
    }
}
