//! Nodes of a boundary that lie inside their own body: where a fold has passed through itself,
//! places no longer face each other, and no pair says so.
//!
//! The angle under which a node sees the oriented boundary, without the facets that contain it, is
//! that of the body at the node, in (0, 2π), and 2π more where another part of the body covers it.

use std::f64::consts::PI;

use carom_algebra::Vector;

use crate::constants::SHARPEST;
use crate::kinematics::{Facets, Surface};
use crate::places::Places;
use crate::skin::{CHORDS, Skin};

/// A node of a boundary that lies inside its own body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct InsideItself {
    /// Global number of the node.
    pub node: usize,
    /// The nearest facet that does not contain the node; on the flank of a slit, one of the other
    /// flank.
    pub facet: usize,
    /// Distance between the node and the nearest facet.
    pub depth: f64,
}

impl Skin {
    /// The node that lies deepest inside its own body at positions `y`, if one does.
    pub fn deepest_in_itself(&self, y: &[f64]) -> Option<InsideItself> {
        let at = Places::new(y, 2);
        let surface = self.surface();
        let mut deepest: Option<InsideItself> = None;
        for facet in 0..surface.all() {
            let nodes = surface.facet(facet).nodes;
            // The last node is the first of another facet.
            for &node in nodes.iter().enumerate().filter(|(k, _)| *k != 1).map(|(_, node)| node) {
                if !surface.covers(node, at) {
                    continue;
                }
                let nearest = (0..surface.all())
                    .filter(|&other| !self.facet_nodes(other).contains(&node))
                    .map(|other| {
                        let depth = surface.nearest(other, at.at(node), at).distance;
                        InsideItself { node, facet: other, depth }
                    })
                    .min_by(|a, b| a.depth.total_cmp(&b.depth));
                if let Some(found) = nearest
                    && deepest.is_none_or(|most| found.depth > most.depth)
                {
                    deepest = Some(found);
                }
            }
        }
        deepest
    }
}

impl Surface {
    /// Whether a node lies in another part of its own body.
    pub(crate) fn covers(&self, node: usize, y: Places) -> bool {
        self.seen_from(node, y) >= 2.0 * PI + SHARPEST
    }

    /// Whether a point of the facet with these nodes lies in another part of its own body.
    pub(crate) fn covers_point(&self, own: &[usize], point: Vector<2>, y: Places) -> bool {
        self.angle_around(point, |facet| self.facet(facet).nodes == own, y) >= 2.0 * PI + SHARPEST
    }

    /// Angle under which a node sees the facets of its own boundary that do not contain it.
    pub(crate) fn seen_from(&self, node: usize, y: Places) -> f64 {
        self.angle_around(y.at(node), |facet| self.facet(facet).nodes.contains(&node), y)
    }

    /// Angle under which a point sees the boundary without the facets on which it lies.
    fn angle_around(&self, from: Vector<2>, is_own: impl Fn(usize) -> bool, y: Places) -> f64 {
        let mut angle = 0.0;
        for facet in (0..self.all()).filter(|&facet| !is_own(facet)) {
            let place = |k: usize| self.facet(facet).at(y, 2.0 * k as f64 / CHORDS as f64 - 1.0).position;
            let mut start = place(0) - from;
            for k in 1..=CHORDS {
                let end = place(k) - from;
                angle += (start[0] * end[1] - start[1] * end[0]).atan2(start.dot(&end));
                start = end;
            }
        }
        angle
    }
}
