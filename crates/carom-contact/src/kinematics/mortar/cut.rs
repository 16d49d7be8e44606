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
//! joints, so that the derivatives of the weighted gap need not account for their motion; at an end
//! they leave out what the motion of the end adds, the gap there times its path, which is zero in
//! contact.

use carom_algebra::Vector;

use crate::kinematics::projection::{Facet, bisected};
use crate::kinematics::surface::Surface;
use crate::places::Places;

/// Parts of a facet, in ξ, that are not worth integrating over.
const ROUND_OFF: f64 = 1e-14;

/// Region of the points that belong to a facet of the primary.
#[derive(Debug)]
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

    /// The part of a secondary facet with a normal, in ξ, that lies in the region of a facet that
    /// it faces.
    pub(super) fn part_of(&self, facet: Facet, normal: Vector<2>, y: Places) -> Option<[f64; 2]> {
        if normal.dot(&self.normal) >= 0.0 {
            return None;
        }
        let from = part_beyond(facet, y, self.start, 1.0)?;
        let to = part_beyond(facet, y, self.end, -1.0)?;
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

/// The part of a facet, in ξ, on one side of a line that it crosses once at most: where (x − x₀)·b
/// times a sign is not negative.
fn part_beyond(facet: Facet, y: Places, [on, along]: [Vector<2>; 2], sign: f64) -> Option<[f64; 2]> {
    let [at_start, at_end] = [0, 1].map(|end| sign * (y.at(facet.nodes[end]) - on).dot(&along));
    let root = |rises: f64| {
        let start = -1.0 + 2.0 * at_start / (at_start - at_end);
        bisected(-1.0, 1.0, start, |xi| {
            let at = facet.seen_from(on, y, xi);
            let factor = sign * rises;
            (factor * at.position.dot(&along), factor * at.tangent.dot(&along))
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

/// Part of a secondary facet that faces the primary.
#[derive(Debug, Default)]
pub(super) struct Facing {
    /// Points of quadrature in the order of ξ.
    pub(super) points: Vec<Opposed>,
    /// Range of ξ that faces the primary.
    pub(super) ends: Option<[f64; 2]>,
}

impl Facing {
    /// A facet of which all points face a rigid obstacle.
    pub(super) fn whole(rule: &[[f64; 2]]) -> Self {
        let points = rule.iter().map(|&[xi, weight]| Opposed { xi, weight, facet: 0, eta: 0.0 });
        Self { points: points.collect(), ends: Some([-1.0, 1.0]) }
    }
}

/// The part of a secondary facet that lies opposite to a facet of the primary.
struct Part<'a> {
    ends: [f64; 2],
    facet: usize,
    region: &'a Region,
}

/// Finds the part of a secondary facet that faces facets of the primary with these regions at
/// positions `y`;
/// `rule`: points and weights of quadrature on −1 … 1.
pub(super) fn facing(
    own: Facet,
    primary: &Surface,
    regions: &[(usize, Region)],
    rule: &[[f64; 2]],
    y: Places,
) -> Facing {
    let mut parts = Vec::new();
    let normal = own.at(y, 0.0).normal;
    for (facet, region) in regions {
        if let Some(ends) = region.part_of(own, normal, y) {
            parts.push(Part { ends, facet: *facet, region });
        }
    }
    let mut ends: Vec<f64> = parts.iter().flat_map(|part| part.ends).collect();
    ends.sort_unstable_by(f64::total_cmp);
    let own_length = (y.at(own.nodes[1]) - y.at(own.nodes[0])).norm();
    let mut found = Facing::default();
    for piece in ends.windows(2).filter(|piece| piece[1] - piece[0] > ROUND_OFF) {
        let middle = 0.5 * (piece[0] + piece[1]);
        let half = 0.5 * (piece[1] - piece[0]);
        let mut over = parts.iter().filter(|part| part.ends[0] <= middle && middle <= part.ends[1]);
        // Where walls stand behind each other, the nearest one counts. Behind a facet by more than
        // a facet's length, a point is not inside the body there.
        let gap = |part: &&Part| {
            let Opposed { facet, eta, .. } = opposed(own, primary, part, [middle, 0.0], y)?;
            let gap = primary.gap(facet, eta, own.at(y, middle).position, y);
            (gap > -part.region.length.max(own_length)).then_some(gap.abs())
        };
        let nearest =
            over.by_ref().filter_map(|part| Some((gap(&part)?, part))).min_by(|a, b| a.0.total_cmp(&b.0));
        let Some((_, part)) = nearest else { continue };
        for [at, weight] in rule {
            found.points.extend(opposed(own, primary, part, [middle + half * at, half * weight], y));
        }
        found.ends = Some([found.ends.map_or(piece[0], |ends| ends[0]), piece[1]]);
    }
    found
}

/// A point of a secondary facet over a facet of the primary; none without a unique closest point.
fn opposed(own: Facet, primary: &Surface, part: &Part, [xi, weight]: [f64; 2], y: Places) -> Option<Opposed> {
    let point = own.at(y, xi).position;
    let start = part.region.between(point);
    let opposite = primary.facet(part.facet);
    // Far away, Newton's method may never be still.
    let eta = opposite.closest_from(y, point, start, BEYOND);
    let eta = eta.or_else(|| opposite.closest_point(y, point, BEYOND))?;
    Some(Opposed { xi, weight, facet: part.facet, eta })
}

/// |η| up to which a closest point is followed past the end of a facet: at a kink of 30°, a point
/// as far away as the facet is long has its closest point 1 + 2 tan 15° from the middle.
const BEYOND: f64 = 1.6;
