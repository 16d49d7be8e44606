//! The facet that a node without a pair may have reached in a step: the first one that its path
//! crosses, else the closest one that it was not behind before.

use carom_algebra::Vector;

use super::facets::{Facets, OnFacet};
use super::facing::{Closest, Reached};
use super::node_to_facet::{Detection, NodeToFacet, Tools};
use super::opposed::presses;
use super::swept::SweptTest;
use super::trajectory::crossing;
use super::way::Met;
use crate::constants::{AT_JOINT, FLUSH, KINK, MEETS, NEAR_END, PARALLEL, REACH_XI};
use crate::kinematics::Kinematics;
use crate::pair::Pair;
use crate::places::Places;

/// Whether a point is at an end of its facet, up to [`NEAR_END`] of the facet's length, or past it.
fn is_near_end(xi: f64) -> bool {
    xi.abs() >= 1.0 - 2.0 * NEAR_END
}

impl NodeToFacet {
    /// Finds the facets that a node may meet on its path.
    fn find(&self, tools: &mut Tools, node: usize, before: Places, now: Places) {
        tools.search.find(node, before, now);
        if let Some((folds, side)) = &self.folds {
            let Tools { search, turns, .. } = tools;
            search.retain(|facet| folds.admits(*side, node, facet) && folds.face(turns, node, facet));
        }
        let may_meet = |facet: usize| !self.primary.is_mirror(facet) && self.may_press(node, facet, before);
        tools.search.retain(may_meet);
    }

    /// The first crossing of a node's path with the path of a facet.
    pub(super) fn first(
        &self,
        tools: &mut Tools,
        place: usize,
        before: Places,
        now: Places,
    ) -> Option<Met<f64>> {
        let node = self.secondary[place];
        self.find(tools, node, before, now);
        self.first_of(&mut tools.swept, tools.search.found(), node, before, now)
    }

    fn first_of(
        &self,
        swept: &mut SweptTest,
        near: &[usize],
        node: usize,
        before: Places,
        now: Places,
    ) -> Option<Met<f64>> {
        let mut first: Option<Met<f64>> = None;
        for &facet in near {
            if let Some(c) = crossing(swept, self.primary.facet(facet), before, now, node)
                && first.is_none_or(|first| c.theta < first.theta)
            {
                first = Some(Met { theta: c.theta, facet, xi: c.xi });
            }
        }
        first
    }

    /// Possible contact of a node without a pair: the first crossing of paths, else the closest
    /// facet at `now` that the node was not behind before; none where a corner is kept out of the
    /// node's body instead.
    pub(super) fn candidate(
        &self,
        tools: &mut Tools,
        place: usize,
        before: Places,
        now: Places,
    ) -> Option<Reached> {
        let node = self.secondary[place];
        let is_corners = |reached: &Reached| {
            let closest = self.primary.facet(reached.facet).closest_point(now, now.at(node), REACH_XI);
            self.is_left_to_corner(node, reached.facet, closest.unwrap_or(reached.xi), before)
        };
        self.reached(tools, place, before, now).filter(|reached| !is_corners(reached))
    }

    fn reached(&self, tools: &mut Tools, place: usize, before: Places, now: Places) -> Option<Reached> {
        let node = self.secondary[place];
        let allowed = self.allowed(place);
        let slack = self.slack(place);
        self.find(tools, node, before, now);
        let near = tools.search.found();
        let ends = |c: &Closest| self.ends_at(node, c.facet, c.xi);
        let closest = self.primary.closest_facet(near, now.at(node), now).filter(|c| !ends(c));
        if allowed > 0.0 {
            // It may be inside, and is no candidate before it is too deep, or has moved too far to
            // tell from its end alone.
            let end = Vector(tools.search.drift().seen(1.0, &now.at(node).0));
            let moved = (Vector([end[0], end[1]]) - before.at(node)).norm();
            if moved < allowed && closest.is_none_or(|c| c.gap + slack >= 0.0) {
                return None;
            }
        }
        let first = self.first_of(&mut tools.swept, near, node, before, now);
        let is_at_end = |met: Met<f64>| is_near_end(met.xi).then_some((met.facet, met.xi));
        let is_between =
            |closest: Closest| self.is_between(node, &closest, now).then_some((closest.facet, closest.xi));
        let corner = first.map_or_else(|| closest.and_then(is_between), is_at_end);
        if corner.is_some_and(|(facet, xi)| self.is_left_to_corner(node, facet, xi, before)) {
            return None;
        }
        let entered_elsewhere = first.is_some_and(|first| !self.primary.is_of_side(first.facet));
        // A node that has entered near the end of a facet may be in front of another one now.
        let still_faced = |facet: usize| {
            let xi = self.primary.facet(facet).closest_point(now, now.at(node), REACH_XI);
            self.detection == Detection::Trajectory
                || xi.is_some_and(|xi| !self.primary.faces_nothing(facet, xi, now))
        };
        let entered = first.filter(|first| !entered_elsewhere && still_faced(first.facet));
        if let Some(Met { facet, xi, .. }) = entered {
            return Some(Reached { facet, xi, crossed: true });
        }
        let beside = || {
            let of_sides = |facet| self.primary.is_of_side(facet) || self.primary.is_of_sibling(facet);
            if first.is_some_and(|first| of_sides(first.facet)) {
                return None;
            }
            self.around_end(near, place, before, now)
        };
        let of_side = closest.filter(|c| self.primary.is_of_side(c.facet));
        let Some(Closest { facet, xi, .. }) = of_side else { return beside() };
        if first.is_some() && !entered_elsewhere {
            return Some(Reached { facet, xi, crossed: true });
        }
        let start = self.primary.facet(facet).closest_point(before, before.at(node), REACH_XI);
        let behind_by = if self.primary.is_whole() { FLUSH } else { MEETS };
        let depth = |length: f64| slack + behind_by * length;
        let behind = |s| self.gap(node, facet, s, before) < -depth(self.primary.length(facet, before));
        if start.map_or(entered_elsewhere, behind) {
            beside()
        } else {
            Some(Reached { facet, xi, crossed: false })
        }
    }

    /// Whether a node inside the primary is as deep behind the next facet as behind the closest
    /// one.
    fn is_between(&self, node: usize, closest: &Closest, y: Places) -> bool {
        let next = self.primary.neighbour(closest.facet, closest.xi > 0.0);
        next.is_some_and(|next| {
            let xi = self.primary.facet(next).closest_point(y, y.at(node), REACH_XI);
            let apart = xi.map_or(f64::INFINITY, |xi| self.gap(node, next, xi, y) - closest.gap);
            apart.abs() <= AT_JOINT * self.primary.length(next, y)
        })
    }

    /// Whether a node is kept out of a facet by the corner at its end, which the other direction of
    /// contact keeps out of the node's body: with the facet it would push to one side. The node
    /// does not press on the facet, and the corner is at one of the facets at the node. Where a
    /// facet at the corner is parallel to one at the node, the corner is left to the node
    /// (`reversed.rs`).
    pub(super) fn is_left_to_corner(&self, node: usize, facet: usize, xi: f64, y: Places) -> bool {
        let forward = xi > 0.0;
        let Some((own, around)) = &self.own else { return false };
        let Some(around) = around.get(&node) else { return false };
        // A frozen contact point has no other direction of contact.
        if self.is_frozen() {
            return false;
        }
        let Some(next) = self.primary.neighbour(facet, forward) else { return false };
        let [first, second] = if forward { [facet, next] } else { [next, facet] };
        if !self.primary.is_corner(first, second, y) {
            return false;
        }
        let shape = self.primary.facet(facet);
        // The normal where the node meets the facet: in the middle of a dented one it differs.
        let normal = shape.at(y, xi.clamp(-1.0, 1.0)).normal;
        let normals: Vec<_> = own.normals_at(node, around, y).collect();
        let corner = shape.at(y, if forward { 1.0 } else { -1.0 }).position;
        let meets = |&facet: &usize| {
            // Below a dent the corner lies past the ends of both facets.
            let xi = own.facet(facet).closest_point(y, corner, 1.0 + 2.0 * NEAR_END);
            let near = FLUSH * own.length(facet, y);
            xi.is_some_and(|xi| own.gap(facet, xi, corner, y).abs() <= near)
        };
        if is_near_end(xi) {
            !presses(&normals, normal, PARALLEL.sine)
        } else {
            !presses(&normals, normal, KINK.sine) && around.iter().any(meets)
        }
    }

    /// Where a node that has pairs enters the side at another place: neither at the facets of its
    /// pairs nor at those next to them, to which a pair is handed over.
    pub(super) fn elsewhere(
        &self,
        tools: &mut Tools,
        place: usize,
        held: &[Pair],
        before: Places,
        now: Places,
    ) -> Option<OnFacet<f64>> {
        let node = self.secondary[place];
        let side = &self.primary;
        self.find(tools, node, before, now);
        let is_next = |pair: &Pair, facet: usize| {
            [false, true].iter().any(|&forward| side.neighbour(pair.facet, forward) == Some(facet))
        };
        let is_held = |facet: usize| held.iter().any(|pair| pair.facet == facet || is_next(pair, facet));
        tools.search.retain(|facet| !is_held(facet));
        let Met { facet, .. } = self.first_of(&mut tools.swept, tools.search.found(), node, before, now)?;
        let xi = side.facet(facet).closest_point(now, now.at(node), REACH_XI)?;
        let faces = side.is_of_side(facet) && !side.faces_nothing(facet, xi, now);
        let enters = faces
            && !self.ends_at(node, facet, xi)
            && self.gap(node, facet, xi, now) + self.slack(place) < 0.0;
        enters.then_some(OnFacet { facet, xi })
    }

    /// Possible contact of a node that has entered the body through the rest of the boundary, from
    /// past an end of the side and in front of its facet there, or that is nearest to the rest and
    /// was just behind the side. Where the ends of two sides meet, nodes change between being past
    /// the end and facing the side, and corners between being left to a node or not.
    fn around_end(&self, near: &[usize], place: usize, before: Places, now: Places) -> Option<Reached> {
        let node = self.secondary[place];
        let slack = self.slack(place);
        near.iter().filter(|&&facet| self.primary.is_of_side(facet)).find_map(|&facet| {
            let shape = self.primary.facet(facet);
            let xi = shape.closest_point(now, now.at(node), REACH_XI)?;
            let start = shape.closest_point(before, before.at(node), REACH_XI)?;
            let length = self.primary.length(facet, before);
            let past = NEAR_END * length;
            let enters = !self.primary.faces_nothing(facet, xi, now)
                && self.gap(node, facet, xi, now) + slack < 0.0
                && self.gap(node, facet, start, before) + slack >= -PARALLEL.sine * past;
            enters.then_some(Reached { facet, xi, crossed: false })
        })
    }
}
