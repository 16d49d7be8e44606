//! The facet that a node without a pair may have reached in a step: the first one that its path
//! crosses, else the nearest one that it was not behind before.

use carom_algebra::Vector;

use super::crossing::crossing;
use super::node_to_patch::NodeToPatch;
use super::patch::place;
use super::paths::Paths;
use crate::constants::{DEEP, EXTENDED, FLUSH, KINK, NEAR_END_SPACE, PARALLEL, REACHED_TOGETHER, ROUND_OFF};
use crate::kinematics::opposed::presses;
use crate::kinematics::way::Met;
use crate::kinematics::{Facets, Kinematics, OnFacet, SpaceHit, SweptPatch};
use crate::pair::Pair;

/// The closest facet in space that a node faces.
#[derive(Clone, Copy)]
struct Closest {
    facet: usize,
    xi: [f64; 2],
    gap: f64,
    /// Distance of the node from the facet, increased by the distance past its edges.
    distance: f64,
}

impl NodeToPatch {
    /// The first crossing of a node's path with the path of a facet near it; of facets that are
    /// reached together, one of the side.
    pub(super) fn first(
        &self,
        swept: &mut SweptPatch,
        near: &[usize],
        paths: &Paths,
        node: usize,
        before: &[f64],
        now: &[f64],
    ) -> Option<Met> {
        let mut first: [Option<Met>; 2] = [None; 2];
        let path = paths.path(node, [before, now]);
        for &facet in near.iter().filter(|&&facet| paths.may_cross(&path, facet)) {
            let first = &mut first[usize::from(self.is_met(node, facet, paths))];
            if let Some(SpaceHit { theta, xi }) =
                crossing(swept, self.primary.patch(facet), [before, now], 1.0, node)
                && first.is_none_or(|least| theta < least.theta)
            {
                *first = Some(Met { theta, facet, xi });
            }
        }
        match first {
            [Some(other), Some(side)] if other.theta < side.theta - REACHED_TOGETHER => first[0],
            [other, side] => side.or(other),
        }
    }

    /// The closest of the facets near a node that it faces at the end of a step.
    fn closest_faced(&self, near: &[usize], paths: &Paths, node: usize, now: &[f64]) -> Option<Closest> {
        let end = place(now, node);
        let mut closest: Option<Closest> = None;
        for &facet in near {
            let patch = self.primary.patch(facet);
            let Some(xi) = patch.closest_point(now, end, EXTENDED) else { continue };
            let gap = self.gap(facet, xi, end, now);
            let of_side = self.is_met(node, facet, paths);
            let length = patch.length(now);
            let beyond = patch.furthest(xi).max(0.0);
            let is_other = !of_side && (gap >= -ROUND_OFF * length || beyond > 0.0);
            let is_past = || self.faces_nothing(facet, xi, now) || self.ends_at(node, facet, xi, now);
            if is_other || of_side && is_past() {
                continue;
            }
            let distance = gap.abs() + beyond * length;
            let least = closest.map_or(f64::INFINITY, |closest| closest.distance);
            if distance < if of_side { least } else { (1.0 - ROUND_OFF) * least } {
                closest = Some(Closest { facet, xi, gap, distance });
            }
        }
        closest
    }

    /// The point of possible contact of a node without a pair; none where a sharp edge is kept out
    /// of the node's body instead.
    pub(super) fn candidate(
        &self,
        swept: &mut SweptPatch,
        near: &mut Vec<usize>,
        paths: &Paths,
        place_of: usize,
        before: &[f64],
        now: &[f64],
    ) -> Option<OnFacet<[f64; 2]>> {
        let node = self.secondary[place_of];
        let found = self.reached(swept, near, paths, place_of, before, now);
        // A node that is inside its facet needs a pair as soon as the sharp edge beside it stops
        // keeping it out, which may be at the end of this step.
        let is_inside = |OnFacet { facet, .. }| {
            let patch = self.primary.patch(facet);
            let start = place(before, node);
            let xi = patch.closest_point(before, start, EXTENDED);
            xi.is_some_and(|xi| self.gap(facet, xi, start, before) < -ROUND_OFF * patch.length(before))
        };
        let is_left = |at: OnFacet<[f64; 2]>| {
            self.is_left_to_edge(node, at, before) && (!is_inside(at) || self.is_left_to_edge(node, at, now))
        };
        found.filter(|at| !is_left(*at))
    }

    /// Whether a node is kept out of a facet by the nodes of a sharp edge of it, which the other
    /// direction of contact keeps out of the node's body, as in the plane (`../candidate.rs`), or
    /// by the pair of a sharp edge of its own that crosses that one at the node: to the flank of a
    /// ridge a node that slides over it would be caught.
    pub(super) fn is_left_to_edge(&self, node: usize, at: OnFacet<[f64; 2]>, y: &[f64]) -> bool {
        let Some(own) = &self.own else { return false };
        let OnFacet { facet, xi } = at;
        // Where a piece folds, the nodes of an edge may be deeper than those that are left to them.
        let folds = self.folds.as_ref();
        if folds.is_some_and(|(folds, _)| !folds.is_of_another_piece(node, facet)) {
            return false;
        }
        let patch = self.primary.patch(facet);
        let is_sharp = |&(edge, _): &(usize, f64)| self.primary.is_sharp(facet, edge, y);
        let mut sharp = (0..patch.corners()).zip(patch.beyond(xi)).filter(is_sharp).peekable();
        if sharp.peek().is_none() {
            return false;
        }
        let around = own.facets_around(node);
        let normals = own.normals_at(node, y);
        // The normal where the node meets the facet: in the middle of a dented one it differs.
        let normal = patch.at(y, xi).normal;
        if presses(&normals, normal, PARALLEL.sine) {
            return false;
        }
        let meets = |point: Vector<3>| {
            around.iter().filter(|&&facet| !own.is_mirror(facet)).any(|&facet| {
                let patch = own.patch(facet);
                let gap = |xi| {
                    let at = patch.seen_from(point, y, xi);
                    at.position.dot(&at.normal).abs()
                };
                let xi = patch.closest_point(y, point, NEAR_END_SPACE);
                xi.is_some_and(|xi| gap(xi) <= FLUSH * patch.length(y))
            })
        };
        let is_far = !presses(&normals, normal, KINK.sine);
        let here = place(y, node);
        sharp.any(|(edge, beyond)| {
            let (nodes, count) = self.primary.shape().edge(edge);
            let mut points = nodes.into_iter().take(count).map(|k| place(y, patch.nodes[k]));
            let nearest = || patch.at(y, patch.along(edge, patch.nearest_on_edge(y, here, edge))).position;
            let along = place(y, patch.nodes[nodes[1]]) - place(y, patch.nodes[nodes[0]]);
            let crosses = || is_far && own.has_edge_across(node, along, y);
            (is_far || beyond > ROUND_OFF) && (points.any(meets) || crosses()) && meets(nearest())
        })
    }

    fn reached(
        &self,
        swept: &mut SweptPatch,
        near: &mut Vec<usize>,
        paths: &Paths,
        place_of: usize,
        before: &[f64],
        now: &[f64],
    ) -> Option<OnFacet<[f64; 2]>> {
        let node = self.secondary[place_of];
        let slack = self.slack(place_of);
        self.retain_pressed(node, before, paths, near);
        if near.is_empty() {
            return None;
        }
        let [start, end] = [before, now].map(|y| place(y, node));
        let is_met = |facet: usize| self.is_met(node, facet, paths);
        let closest = self.closest_faced(near, paths, node, now);
        if self.allowed(place_of) > 0.0 {
            // It may be inside, and is no candidate before it is too deep.
            let moved = (Vector(paths.drift().seen(1.0, &end.0)) - start).norm();
            if moved < self.allowed(place_of) && closest.is_none_or(|closest| closest.gap + slack >= 0.0) {
                return None;
            }
        }
        let first = self.first(swept, near, paths, node, before, now);
        let faced = |facet: usize| {
            let xi = self.primary.patch(facet).closest_point(now, end, EXTENDED)?;
            (!self.faces_nothing(facet, xi, now) && !self.ends_at(node, facet, xi, now)).then_some(xi)
        };
        let entered = first.filter(|first| is_met(first.facet));
        if let Some(Met { facet, .. }) = entered
            && let Some(xi) = faced(facet)
        {
            return Some(OnFacet { facet, xi });
        }
        let beside = || {
            let of_sides = |facet| {
                self.folds.is_some() || self.primary.is_of_side(facet) || self.primary.is_of_sibling(facet)
            };
            if first.is_some_and(|first| of_sides(first.facet)) {
                return None;
            }
            self.around_end(near, paths, place_of, before, now)
        };
        let of_side = closest.filter(|closest| is_met(closest.facet));
        let Some(Closest { facet, xi, .. }) = of_side else { return beside() };
        let patch = self.primary.patch(facet);
        let limit = slack + DEEP * patch.length(before);
        let behind = match patch.closest_point(before, start, EXTENDED) {
            // Past a sharp edge there is no body that it could have entered unseen.
            Some(xi) if self.is_past_end(facet, xi, ROUND_OFF, before) => {
                self.gap(facet, xi, start, before) < -slack - ROUND_OFF * patch.length(before)
            }
            Some(xi) => self.gap(facet, xi, start, before) < -limit,
            // Of its own boundary a node is beside most facets that it may meet, or behind them.
            None if self.folds.is_some() => self.primary.height(facet, start, before).height < -limit,
            None => entered.is_none() && first.is_some(),
        };
        if entered.is_none() && behind { beside() } else { Some(OnFacet { facet, xi }) }
    }

    /// Where a node that has pairs enters the side at another place: neither at the facets of its
    /// pairs nor at those around them, to which a pair is handed over.
    pub(super) fn elsewhere(
        &self,
        swept: &mut SweptPatch,
        near: &mut Vec<usize>,
        paths: &Paths,
        place_of: usize,
        held: &[Pair],
        [before, now]: [&[f64]; 2],
    ) -> Option<OnFacet<[f64; 2]>> {
        let node = self.secondary[place_of];
        let path = paths.path(node, [before, now]);
        near.retain(|&facet| held.iter().all(|pair| pair.facet != facet) && paths.may_cross(&path, facet));
        if near.is_empty() {
            return None;
        }
        near.retain(|facet| held.iter().all(|pair| !self.primary.ring(pair.facet).contains(facet)));
        self.retain_pressed(node, before, paths, near);
        let Met { facet, .. } = self.first(swept, near, paths, node, before, now)?;
        let end = place(now, node);
        let xi = self.primary.patch(facet).closest_point(now, end, EXTENDED)?;
        let enters = self.is_met(node, facet, paths)
            && !self.faces_nothing(facet, xi, now)
            && !self.ends_at(node, facet, xi, now)
            && self.gap(facet, xi, end, now) + self.slack(place_of) < 0.0;
        enters.then_some(OnFacet { facet, xi })
    }

    /// Possible contact of a node that has entered the body through the rest of the boundary, from
    /// past an end of the side and in front of its facet there, or that is nearest to the rest and
    /// was just behind the side, as in the plane.
    fn around_end(
        &self,
        near: &[usize],
        paths: &Paths,
        place_of: usize,
        before: &[f64],
        now: &[f64],
    ) -> Option<OnFacet<[f64; 2]>> {
        let node = self.secondary[place_of];
        let slack = self.slack(place_of);
        let [start, end] = [before, now].map(|y| place(y, node));
        near.iter().filter(|&&facet| self.is_met(node, facet, paths)).find_map(|&facet| {
            let patch = self.primary.patch(facet);
            let xi = patch.closest_point(now, end, EXTENDED)?;
            let from = patch.closest_point(before, start, EXTENDED)?;
            let past = NEAR_END_SPACE * patch.length(before);
            let enters = !self.faces_nothing(facet, xi, now)
                && self.gap(facet, xi, end, now) + slack < 0.0
                && self.gap(facet, from, start, before) + slack >= -PARALLEL.sine * past;
            enters.then_some(OnFacet { facet, xi })
        })
    }
}
