//! Which facet of the primary side a node faces. With the body on the left:
//!
//! ```text
//! joint, convex          a pair past the end is handed to the neighbour; past the ends of both, it keeps
//!                        its facet, which is extrapolated up to |ξ| = 1.2
//! concave corner         a node behind both facets, or that would be handed back within the step, has a
//!                        pair with either facet, g ≥ 0 for both: it may lie in the joint
//! plane of symmetry       a facet is extrapolated: its mirror image continues it
//! corner, end of side    nothing is faced past the end, |ξ| > 1.001; a pair that slides past it keeps its
//!                        facet to the end of the step and leaves at the start of the next one
//! ```

use carom_algebra::Vector;

use super::facets::Facets;
use super::hand_over::Next;
use super::surface::Surface;
use crate::constants::{PAST_END, PAST_SIDE, REACH_XI, ROUND_OFF};
use crate::pair::Pair;
use crate::places::Places;

impl Surface {
    /// The closest of the given facets that a node at the position `from` faces.
    pub(super) fn closest_facet(&self, facets: &[usize], from: Vector<2>, y: Places) -> Option<Closest> {
        let mut closest: Option<Closest> = None;
        for &facet in facets {
            let side = self.facet(facet);
            let Some(xi) = side.closest_point(y, from, REACH_XI) else { continue };
            let gap = self.gap(facet, xi, from, y);
            let of_side = self.is_of_side(facet);
            // A node beside the rest of the boundary may still face the side.
            if if of_side { self.faces_nothing(facet, xi, y) } else { gap >= 0.0 || xi.abs() > 1.0 } {
                continue;
            }
            let distance = gap.abs() + (xi.abs() - 1.0).max(0.0) * self.length(facet, y);
            // The facets of the side come first: one that is as near as the rest is preferred.
            if closest
                .is_none_or(|c| distance < if of_side { c.distance } else { (1.0 - ROUND_OFF) * c.distance })
            {
                closest = Some(Closest { facet, xi, gap, distance });
            }
        }
        closest
    }

    /// Facet to which a pair whose closest point lies past the end of its facet is handed over.
    pub(super) fn next_facet(
        &self,
        pair: &Pair,
        from: Vector<2>,
        came_from: Option<usize>,
        y: Places,
    ) -> Next {
        // A pair with both facets of a joint slides on either.
        let past = if pair.joint.is_some() { PAST_END } else { ROUND_OFF };
        if pair.xi.abs() <= 1.0 + past {
            return Next::Stay;
        }
        let forward = pair.xi > 0.0;
        let past_all = || if self.faces_nothing(pair.facet, pair.xi, y) { Next::Leave } else { Next::Stay };
        let Some(neighbour) = self.neighbour_of_side(pair.facet, forward) else { return past_all() };
        let [first, second] = if forward { [pair.facet, neighbour] } else { [neighbour, pair.facet] };
        if self.is_corner(first, second, y) {
            return past_all();
        }
        if came_from == Some(neighbour) {
            return Next::Concave(neighbour, [if forward { -1.0 } else { 1.0 }, 0.0]);
        }
        if let Some(xi) = self.facet(neighbour).closest_point(y, from, REACH_XI) {
            let inside = if forward { xi >= -1.0 } else { xi <= 1.0 };
            if inside {
                return Next::HandOver(neighbour, [xi, 0.0]);
            }
        }
        // Past both ends: behind both facets of a concave corner.
        if self.is_notch(first, second, y) {
            return Next::Concave(neighbour, [if forward { -1.0 } else { 1.0 }, 0.0]);
        }
        // In the vertex cone of a convex joint.
        let bridged = pair.xi.abs() <= REACH_XI && !self.faces_nothing(pair.facet, pair.xi, y);
        if bridged { Next::Stay } else { Next::Leave }
    }

    /// Gap of a point over a facet at ξ: its distance along the normal there.
    pub(super) fn gap(&self, facet: usize, xi: f64, from: Vector<2>, y: Places) -> f64 {
        let c = self.facet(facet).seen_from(from, y, xi);
        -c.position.dot(&c.normal)
    }

    /// Whether ξ lies past an end of a facet at which no blunt joint with another facet of the side
    /// follows.
    pub(super) fn faces_nothing(&self, facet: usize, xi: f64, y: Places) -> bool {
        if xi.abs() < 1.0 - ROUND_OFF {
            return false;
        }
        let neighbour = self.neighbour(facet, xi > 0.0);
        if neighbour.is_some_and(|neighbour| self.is_of_sibling(neighbour)) {
            return !(-1.0 + ROUND_OFF..=1.0 + ROUND_OFF).contains(&xi);
        }
        let is_continued = neighbour.is_some_and(|neighbour| self.is_mirror(neighbour));
        if xi.abs() <= 1.0 + PAST_SIDE || is_continued {
            return false;
        }
        let Some(neighbour) = neighbour.filter(|&neighbour| self.is_of_side(neighbour)) else {
            return true;
        };
        let [first, second] = if xi > 0.0 { [facet, neighbour] } else { [neighbour, facet] };
        self.is_corner(first, second, y)
    }
}

/// The closest facet that a node faces.
#[derive(Clone, Copy)]
pub(super) struct Closest {
    pub(super) facet: usize,
    pub(super) xi: f64,
    pub(super) gap: f64,
    /// Distance of the node from the facet, increased by the distance past its end.
    distance: f64,
}

/// The point of possible contact of a node without a pair.
pub(super) struct Reached {
    pub(super) facet: usize,
    pub(super) xi: f64,
    /// Whether the path of the node has crossed the side.
    pub(super) crossed: bool,
}
