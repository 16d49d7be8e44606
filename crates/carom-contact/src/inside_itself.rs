//! Nodes of a boundary that lie inside their own body: where a fold has passed through itself,
//! places no longer face each other, and no pair says so.
//!
//! The angle under which a node sees the oriented boundary, without the facets that contain it, is
//! that of the body at the node, in (0, 2π), and 2π more where another part of the body covers it.

use std::f64::consts::PI;

use carom_algebra::Vector;

use crate::kinematics::Facets;
use crate::places::Places;
use crate::skin::{CHORDS, Skin};

/// Smallest angle of a body at a node that is told from the angle of a fold, 30°.
const SHARPEST: f64 = PI / 6.0;

impl Skin {
    /// The node that lies deepest inside its own body at positions `y`, the nearest facet that does
    /// not contain it, and the distance to it: on the flank of a slit, that to the other flank.
    pub fn deepest_in_itself(&self, y: &[f64]) -> Option<(usize, usize, f64)> {
        let at = Places::new(y, 2);
        let surface = self.surface();
        let mut deepest: Option<(usize, usize, f64)> = None;
        for facet in 0..surface.all() {
            let nodes = surface.facet(facet).nodes;
            // The last node is the first of another facet.
            for &node in nodes.iter().enumerate().filter(|(k, _)| *k != 1).map(|(_, node)| node) {
                if self.seen_from(node, at) < 2.0 * PI + SHARPEST {
                    continue;
                }
                let nearest = (0..surface.all())
                    .filter(|&other| !self.facet_nodes(other).contains(&node))
                    .map(|other| (other, surface.nearest(other, at.at(node), at).1))
                    .min_by(|a, b| a.1.total_cmp(&b.1));
                if let Some((other, distance)) = nearest
                    && deepest.is_none_or(|(.., most)| distance > most)
                {
                    deepest = Some((node, other, distance));
                }
            }
        }
        deepest
    }

    /// The angle under which a node sees the facets that do not contain it.
    fn seen_from(&self, node: usize, y: Places) -> f64 {
        let from: Vector<2> = y.at(node);
        let surface = self.surface();
        let mut angle = 0.0;
        for facet in (0..surface.all()).filter(|&f| !surface.facet(f).nodes.contains(&node)) {
            let place = |k: usize| surface.facet(facet).at(y, 2.0 * k as f64 / CHORDS as f64 - 1.0).position;
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

#[cfg(test)]
mod tests {
    use carom_solid::FacetShape;

    use super::*;
    use crate::kinematics::Surface;

    #[test]
    fn an_arm_pushed_through_the_side_of_its_own_body_is_found_with_its_depth() {
        // A C with its mouth to the right; its upper arm is bent down by 1.3 into the lower one.
        let mut y = vec![0.0, 0.0, 4.0, 0.0, 4.0, 1.0, 1.0, 1.0, 1.0, 2.0, 3.5, 2.0, 3.5, 3.0, 0.0, 3.0];
        let facets: Vec<Vec<usize>> = (0..8).map(|k| vec![k, (k + 1) % 8]).collect();
        let mut skin = Skin::new(Surface::new(FacetShape::L2, &facets, &[1.0; 8]));
        skin.update(&y);
        assert_eq!(skin.deepest_in_itself(&y), None);
        (y[11], y[13]) = (0.7, 1.7);
        skin.update(&y);
        let (node, facet, distance) = skin.deepest_in_itself(&y).unwrap();
        assert_eq!((node, facet), (5, 2));
        assert!((distance - 0.3).abs() < 1e-15, "{distance}");
    }
}
