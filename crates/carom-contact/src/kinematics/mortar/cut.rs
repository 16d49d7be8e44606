//! The parts of a secondary facet that lie opposite to single facets of the primary, and the points
//! of quadrature on them.
//!
//! A point of the secondary side belongs to the facet of the primary between whose ends it lies:
//! at a joint v of two facets with unit tangents t and t', the border is the line
//!
//! ```text
//! (x − y_v)·(t + t') = 0,
//! ```
//!
//! on which both have the same gap, and at an end or a kink of more than 30° the normal (x − y_v)·t
//! = 0. What lies beyond an end has no partner and does not count. The gap is continuous at the
//! borders, so that the derivatives of the weighted gap need not account for their motion.

use carom_algebra::Vector;

use crate::kinematics::projection::{Facet, bisected};
use crate::kinematics::surface::Surface;
use crate::places::Places;

/// Parts of a facet, in ξ, that are not worth integrating over.
const ROUND_OFF: f64 = 1e-14;

/// What belongs to a facet of the primary.
pub(super) struct Region {
    /// A line at the start of the facet: a point on it, and the direction towards the facet.
    start: [Vector<2>; 2],
    /// A line at its end: a point on it, and the direction away from the facet.
    end: [Vector<2>; 2],
    normal: Vector<2>,
    length: f64,
}

impl Region {
    /// The region of a facet of the primary at positions `y`.
    pub(super) fn of(primary: &Surface, facet: usize, y: Places) -> Self {
        let of = primary.facet(facet);
        let [first, middle, last] = [-1.0, 0.0, 1.0].map(|xi| of.at(y, xi));
        let unit = |tangent: Vector<2>| tangent * tangent.norm().recip();
        let blunt = |forward: bool| {
            let next = primary.neighbour_of_side(facet, forward)?;
            let [one, other] = if forward { [facet, next] } else { [next, facet] };
            primary.is_blunt(one, other, y).then_some(next)
        };
        let before = blunt(false).map_or(Vector::ZERO, |facet| unit(primary.facet(facet).at(y, 1.0).tangent));
        let after = blunt(true).map_or(Vector::ZERO, |facet| unit(primary.facet(facet).at(y, -1.0).tangent));
        Self {
            start: [first.position, before + unit(first.tangent)],
            end: [last.position, unit(last.tangent) + after],
            normal: middle.normal,
            length: (last.position - first.position).norm(),
        }
    }

    /// The part of a secondary facet, in ξ, that lies in the region of a facet which it faces.
    pub(super) fn part_of(&self, facet: Facet, y: Places) -> Option<[f64; 2]> {
        if facet.at(y, 0.0).normal.dot(&self.normal) >= 0.0 {
            return None;
        }
        let from = part_where(|xi| height(facet, y, xi, self.start, 1.0))?;
        let to = part_where(|xi| height(facet, y, xi, self.end, -1.0))?;
        let part = [from[0].max(to[0]), from[1].min(to[1])];
        (part[1] - part[0] > ROUND_OFF).then_some(part)
    }

    /// Where a point lies between the ends, from −1 to 1.
    fn between(&self, point: Vector<2>) -> f64 {
        let from = (point - self.start[0]).dot(&self.start[1]) / self.start[1].norm();
        let to = (self.end[0] - point).dot(&self.end[1]) / self.end[1].norm();
        if from + to > 0.0 { (2.0 * from / (from + to) - 1.0).clamp(-1.0, 1.0) } else { 0.0 }
    }
}

/// Height of a point of a facet over a line, times a sign, and its derivative by ξ.
fn height(facet: Facet, y: Places, xi: f64, [on, towards]: [Vector<2>; 2], sign: f64) -> [f64; 2] {
    let at = facet.seen_from(on, y, xi);
    [sign * at.position.dot(&towards), sign * at.tangent.dot(&towards)]
}

/// The part of −1 … 1 where a function with at most one root is not negative; `of` returns the
/// function and its derivative.
fn part_where(of: impl Fn(f64) -> [f64; 2]) -> Option<[f64; 2]> {
    let [at_start, at_end] = [of(-1.0)[0], of(1.0)[0]];
    let root = |sign: f64| {
        let start = -1.0 + 2.0 * at_start / (at_start - at_end);
        bisected(-1.0, 1.0, start, |xi| {
            let [value, slope] = of(xi);
            (sign * value, sign * slope)
        })
    };
    match [at_start >= 0.0, at_end >= 0.0] {
        [true, true] => Some([-1.0, 1.0]),
        [false, false] => None,
        [false, true] => Some([root(1.0), 1.0]),
        [true, false] => Some([-1.0, root(-1.0)]),
    }
}

/// A point of quadrature on a secondary facet.
#[derive(Clone, Copy, Debug)]
pub(super) struct Opposed {
    /// Coordinate on the secondary facet.
    pub(super) xi: f64,
    /// Weight of quadrature, in ξ.
    pub(super) weight: f64,
    /// Facet of the primary that the point faces.
    pub(super) facet: usize,
    /// Coordinate of the closest point of that facet.
    pub(super) eta: f64,
}

/// The points of quadrature of a secondary facet at positions `y`, against the `facets` of the
/// primary; `rule`: points and weights on −1 … 1.
pub(super) fn points(
    own: Facet,
    primary: &Surface,
    facets: impl Iterator<Item = usize>,
    rule: &[[f64; 2]],
    y: Places,
) -> Vec<Opposed> {
    let mut parts: Vec<([f64; 2], usize, Region)> = Vec::new();
    for facet in facets {
        let region = Region::of(primary, facet, y);
        if let Some(part) = region.part_of(own, y) {
            parts.push((part, facet, region));
        }
    }
    let mut ends: Vec<f64> = parts.iter().flat_map(|(part, ..)| *part).collect();
    ends.sort_unstable_by(f64::total_cmp);
    let own_length = (own.at(y, 1.0).position - own.at(y, -1.0).position).norm();
    let mut found = Vec::new();
    for piece in ends.windows(2).filter(|piece| piece[1] - piece[0] > ROUND_OFF) {
        let [from, to] = [piece[0], piece[1]];
        let middle = 0.5 * (from + to);
        // Where walls stand behind each other, the nearest one counts.
        let nearest = parts
            .iter()
            .filter(|(part, ..)| part[0] <= middle && middle <= part[1])
            .filter_map(|(_, facet, region)| {
                let opposed = opposed(own, primary, *facet, region, [middle, 0.0], y)?;
                let gap = primary.gap(*facet, opposed.eta, own.at(y, middle).position, y);
                // Behind a facet by more than a facet's length, a point is not inside the body there.
                (gap > -region.length.max(own_length)).then_some((gap.abs(), *facet, region))
            })
            .min_by(|a, b| a.0.total_cmp(&b.0));
        let Some((_, facet, region)) = nearest else { continue };
        for [at, weight] in rule {
            let half = 0.5 * (to - from);
            found.extend(opposed(own, primary, facet, region, [middle + half * at, half * weight], y));
        }
    }
    found
}

/// A point of a secondary facet over a facet of the primary; none without a unique closest point.
fn opposed(
    own: Facet,
    primary: &Surface,
    facet: usize,
    region: &Region,
    [xi, weight]: [f64; 2],
    y: Places,
) -> Option<Opposed> {
    let point = own.at(y, xi).position;
    let eta = primary.facet(facet).closest_from(y, point, region.between(point), BEYOND)?;
    Some(Opposed { xi, weight, facet, eta })
}

/// |η| up to which a closest point is followed past the end of a facet: at a kink of 30°, a point
/// as far away as the facet is long has its closest point 1 + 2 tan 15° from the middle.
const BEYOND: f64 = 1.6;
