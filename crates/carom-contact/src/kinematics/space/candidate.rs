//! The facet that a node without a pair may have reached in a step: the first one that its path
//! crosses, else the nearest one that it was not behind before.

use super::crossing::crossing;
use super::node_to_patch::{NodeToPatch, PAST, REACH};
use super::patch::place;
use super::paths::{NOISE, Paths, path};
use crate::kinematics::candidate::AROUND;
use crate::kinematics::{Kinematics, OneWay, SweptPatch};
use crate::pair::Pair;

/// A node this far behind a facet, relative to its length, at the start of a step has not crossed
/// it.
const BEHIND: f64 = 0.02;
/// Difference in θ below which facets are reached together: where they meet, and a path lies in the
/// neighbouring side.
const TOGETHER: f64 = 1e-4;

/// Facets near a node, ascending, and the paths of all facets.
pub(super) type Near<'a> = (&'a [usize], &'a Paths);

impl NodeToPatch {
    /// θ and facet of the first crossing of trajectories of a node, of those near it; of facets
    /// that are reached together, one of the side.
    pub(super) fn first(
        &self,
        swept: &mut SweptPatch,
        (near, paths): Near,
        node: usize,
        before: &[f64],
        now: &[f64],
    ) -> Option<(f64, usize)> {
        let (mut first, path) = ([None; 2], path(node, [before, now]));
        for &facet in near.iter().filter(|&&facet| paths.may_cross(&path, facet)) {
            let first = &mut first[usize::from(self.is_met(node, facet, paths))];
            if let Some((theta, _)) = crossing(swept, self.primary.patch(facet), [before, now], 1.0, node)
                && first.is_none_or(|(least, _)| theta < least)
            {
                *first = Some((theta, facet));
            }
        }
        match first {
            [Some((other, _)), Some((side, _))] if other < side - TOGETHER => first[0],
            [other, side] => side.or(other),
        }
    }

    /// Facet and ξ of possible contact of a node without a pair.
    pub(super) fn candidate(
        &self,
        swept: &mut SweptPatch,
        (near, paths): (&mut Vec<usize>, &Paths),
        place_of: usize,
        before: &[f64],
        now: &[f64],
    ) -> Option<(usize, [f64; 2])> {
        let (node, slack) = (self.secondary[place_of], self.slack(place_of));
        self.retain_pressed(node, before, paths, near);
        if near.is_empty() {
            return None;
        }
        let (near, near_by): (&[usize], Near) = (near, (near, paths));
        let [start, end] = [before, now].map(|y| place(y, node));
        let is_met = |facet: usize| self.is_met(node, facet, paths);
        let mut closest: Option<(f64, usize, [f64; 2], f64)> = None;
        for &facet in near {
            let patch = self.primary.patch(facet);
            let Some(xi) = patch.closest_point(now, end, REACH) else { continue };
            let gap = self.gap(facet, xi, end, now);
            let (of_side, length) = (is_met(facet), patch.length(now));
            let beyond = patch.furthest(xi).1.max(0.0);
            let is_other = !of_side && (gap >= -NOISE * length || beyond > 0.0);
            let is_past = || self.faces_nothing(facet, xi, now) || self.ends_at(node, facet, xi, now);
            if is_other || of_side && is_past() {
                continue;
            }
            let distance = gap.abs() + beyond * length;
            let least = closest.map_or(f64::INFINITY, |(least, ..)| least);
            if distance < if of_side { least } else { (1.0 - PAST) * least } {
                closest = Some((distance, facet, xi, gap));
            }
        }
        if self.allowed(place_of) > 0.0 {
            // It may be inside, and is no candidate before it is too deep.
            let moved = (end - start).norm();
            if moved < self.allowed(place_of) && closest.is_none_or(|(.., gap)| gap + slack >= 0.0) {
                return None;
            }
        }
        let first = self.first(swept, near_by, node, before, now);
        let faced = |facet: usize| {
            let xi = self.primary.patch(facet).closest_point(now, end, REACH)?;
            (!self.faces_nothing(facet, xi, now) && !self.ends_at(node, facet, xi, now)).then_some(xi)
        };
        let entered = first.filter(|&(_, facet)| is_met(facet));
        if let Some((facet, xi)) = entered.and_then(|(_, facet)| Some((facet, faced(facet)?))) {
            return Some((facet, xi));
        }
        let beside = || {
            let of_sides = |facet| {
                self.folds.is_some() || self.primary.is_of_side(facet) || self.primary.is_of_sibling(facet)
            };
            if first.is_some_and(|(_, facet)| of_sides(facet)) {
                return None;
            }
            self.around_end(near_by, place_of, before, now)
        };
        let of_side = closest.filter(|&(_, facet, ..)| is_met(facet));
        let Some((_, facet, xi, _)) = of_side else { return beside() };
        let patch = self.primary.patch(facet);
        let limit = slack + BEHIND * patch.length(before);
        let behind = match patch.closest_point(before, start, REACH) {
            Some(xi) => self.gap(facet, xi, start, before) < -limit,
            // Of its own boundary a node is beside most facets that it may meet, or behind them.
            None if self.folds.is_some() => self.primary.height(facet, start, before).1 < -limit,
            None => entered.is_none() && first.is_some(),
        };
        if entered.is_none() && behind { beside() } else { Some((facet, xi)) }
    }

    /// Facet and ξ where a node that has pairs enters the side elsewhere: neither at their facets
    /// nor at those around them, which hand pairs over.
    pub(super) fn elsewhere(
        &self,
        swept: &mut SweptPatch,
        (near, paths): (&mut Vec<usize>, &Paths),
        place_of: usize,
        held: &[Pair],
        [before, now]: [&[f64]; 2],
    ) -> Option<(usize, [f64; 2])> {
        let node = self.secondary[place_of];
        let path = path(node, [before, now]);
        near.retain(|&facet| held.iter().all(|pair| pair.facet != facet) && paths.may_cross(&path, facet));
        if near.is_empty() {
            return None;
        }
        near.retain(|facet| held.iter().all(|pair| !self.primary.ring(pair.facet).contains(facet)));
        self.retain_pressed(node, before, paths, near);
        let (_, facet) = self.first(swept, (near, paths), node, before, now)?;
        let end = place(now, node);
        let xi = self.primary.patch(facet).closest_point(now, end, REACH)?;
        let enters = self.is_met(node, facet, paths)
            && !self.faces_nothing(facet, xi, now)
            && !self.ends_at(node, facet, xi, now)
            && self.gap(facet, xi, end, now) + self.slack(place_of) < 0.0;
        enters.then_some((facet, xi))
    }

    /// The same of a node that has entered through the rest of the boundary, from past an end of
    /// the side and in front of its facet there, or is nearest to the rest and was just behind the
    /// side, as in the plane.
    fn around_end(
        &self,
        (near, paths): Near,
        place_of: usize,
        before: &[f64],
        now: &[f64],
    ) -> Option<(usize, [f64; 2])> {
        let (node, slack) = (self.secondary[place_of], self.slack(place_of));
        let [start, end] = [before, now].map(|y| place(y, node));
        near.iter().filter(|&&facet| self.is_met(node, facet, paths)).find_map(|&facet| {
            let patch = self.primary.patch(facet);
            let xi = patch.closest_point(now, end, REACH)?;
            let from = patch.closest_point(before, start, REACH)?;
            let past = Self::NEAR_END * patch.length(before);
            let enters = !self.faces_nothing(facet, xi, now)
                && self.gap(facet, xi, end, now) + slack < 0.0
                && self.gap(facet, from, start, before) + slack >= -AROUND * past;
            enters.then_some((facet, xi))
        })
    }
}

#[cfg(test)]
mod tests {
    use carom_solid::FacetShape;

    use super::*;
    use crate::Pairing;
    use crate::kinematics::space::boundary::Boundary;

    /// Four nodes over a square of four facets: one near it, one that enters, two far away. A
    /// search that repeats another one finds what a first one does.
    #[test]
    fn a_repeated_search_finds_the_same() {
        let grid = (0..9).flat_map(|k| [f64::from(k % 3), f64::from(k / 3), 0.0]);
        let grid: Vec<f64> = grid.collect();
        let facets: Vec<Vec<usize>> = [0, 1, 3, 4].map(|k| vec![k, k + 1, k + 4, k + 3]).to_vec();
        let contact = || NodeToPatch::new((9..13).collect(), Boundary::new(FacetShape::Q4, &facets, &[], 0));
        let at = |heights: [f64; 4]| {
            let xy = [[0.4, 0.3], [1.6, 1.2], [0.5, 1.5], [1.5, 0.4]];
            let nodes = xy.iter().zip(heights).flat_map(|([x, y], z)| [*x, *y, z]);
            [grid.clone(), nodes.collect()].concat()
        };
        let before = at([0.3, 0.2, 5.0, 5.0]);
        let (now, again) = (at([0.05, -0.1, 4.9, 4.9]), at([0.05 + 1e-9, -0.1, 4.9, 4.9]));
        let search = |contact: &NodeToPatch, now: &[f64], fresh: bool| {
            let mut pairing = Pairing { fresh, ..Pairing::new(Vec::new()) };
            let changed = contact.search(&before, now, &mut pairing, &mut Vec::new());
            (changed, pairing.pairs)
        };
        let (first, other) = (contact(), contact());
        let known = search(&first, &now, true);
        assert_eq!(known.1.iter().map(|pair| (pair.node, pair.facet)).collect::<Vec<_>>(), [(0, 0), (1, 3)]);
        assert_eq!(search(&first, &again, false), search(&other, &again, true));
        // Beyond what the certificates leave, everything is searched: the first node enters, too.
        let deep = at([-0.05, -0.1, 4.9, 4.9]);
        assert_eq!(search(&first, &deep, false), search(&contact(), &deep, true));
    }
}
