//! The parts of a secondary facet that lie opposite to single facets of the primary, and the points
//! of quadrature on them, or else fixed points of quadrature with the facet that each faces.
//!
//! A point of the secondary side belongs to the facet of the primary between whose ends it lies:
//! at a joint v of two facets with unit tangents t and t', the border is the line
//!
//! ```text
//! (x − y_v)·(t + t') = 0,
//! ```
//!
//! on which both have the same gap, and at an end or a kink of more than 30° the normal (x − y_v)·t
//! = 0. At an end in a plane of symmetry, behind which the mirror image of the facet follows, it is
//! the plane. Points beyond an end have no partner and do not count. The gap is continuous at the
//! joints, so that the gradient of the weighted gap need not account for their motion, while its
//! derivative does (`joint.rs`); the motion of an end is in `border.rs`.

use carom_algebra::Vector;

use crate::constants::MORTAR_BEYOND;
use crate::constants::SHALLOW;
use crate::kinematics::facets::Facets;
use crate::kinematics::folds::{Folds, Turns};
use crate::kinematics::projection::{Facet, bisected};
use crate::kinematics::surface::{Kink, Surface};
use crate::places::Places;

/// Points at which weighted gaps of mortar contact are measured.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Quadrature {
    /// Points on each part of a secondary facet that faces a single facet of the primary: exact
    /// where both are flat.
    #[default]
    Segments,
    /// Fixed points on the secondary facets.
    Fixed,
}

/// Parts of a facet, in ξ, that are not worth integrating over.
const ROUND_OFF: f64 = 1e-14;

/// Region of the points that belong to a facet of the primary.
#[derive(Debug)]
pub(super) struct Region {
    /// A line at the start of the facet: a point on it, and the direction towards the facet.
    start: [Vector<2>; 2],
    /// A line at its end: a point on it, and the direction away from the facet.
    end: [Vector<2>; 2],
    /// Whether no other facet continues it smoothly, at the start and at the end.
    is_free: [bool; 2],
    /// Normals of the planes of symmetry in which it starts or ends without a corner.
    planes: [Option<Vector<2>>; 2],
    normal: Vector<2>,
    length: f64,
}

impl Region {
    /// The region of a facet of the primary at positions `y`.
    pub(super) fn of(primary: &Surface, facet: usize, y: Places) -> Self {
        let of = primary.facet(facet);
        let unit = |tangent: Vector<2>| tangent * tangent.norm().recip();
        // The neighbour that continues the facet, with the tangent there.
        let continuing = |forward: bool| {
            let next = primary.neighbour(facet, forward)?;
            if !primary.is_of_side(next) && !primary.is_mirror(next) {
                return None;
            }
            let [one, other] = if forward { [facet, next] } else { [next, facet] };
            let tangents = primary.tangents_at_joint(one, other, y);
            Kink::between(tangents).is_small().then(|| (next, unit(tangents[usize::from(forward)])))
        };
        let beyond = [false, true].map(continuing);
        let [before_it, after_it] = beyond.map(|next| next.map_or(Vector::ZERO, |(_, tangent)| tangent));
        let to_start = before_it + unit(of.tangent(y, -1.0));
        let to_end = unit(of.tangent(y, 1.0)) + after_it;
        let in_plane = beyond.map(|next| next.is_some_and(|(next, _)| primary.is_mirror(next)));
        let [first, last] = [0, 1].map(|end| y.at(of.nodes[end]));
        Self {
            start: [first, to_start],
            end: [last, to_end],
            is_free: [0, 1].map(|end| beyond[end].is_none() || in_plane[end]),
            planes: [0, 1].map(|end| in_plane[end].then(|| unit([to_start, to_end][end]))),
            normal: of.at(y, 0.0).normal,
            length: (last - first).norm(),
        }
    }

    /// Whether a part of a secondary facet with a normal may lie in the region of a facet that it
    /// faces: neither border has all of it behind. Where both cross the facet in the wrong order
    /// there is none in fact, and a window is wider than necessary.
    pub(super) fn may_have_part_of(&self, facet: Facet, normal: Vector<2>, y: Places) -> bool {
        let is_beyond = |line, sign| ends_beyond(facet, y, line, sign).iter().any(|end| *end >= 0.0);
        normal.dot(&self.normal) < 0.0 && is_beyond(self.start, 1.0) && is_beyond(self.end, -1.0)
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

    /// Whether a point of a surface with a normal lies between the ends, and the facet faces it.
    fn contains(&self, point: Vector<2>, normal: Vector<2>) -> bool {
        let from = (point - self.start[0]).dot(&self.start[1]);
        let to = (self.end[0] - point).dot(&self.end[1]);
        normal.dot(&self.normal) < 0.0 && from >= 0.0 && to >= 0.0
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
fn part_beyond(facet: Facet, y: Places, line: [Vector<2>; 2], sign: f64) -> Option<[f64; 2]> {
    let [on, along] = line;
    let [at_start, at_end] = ends_beyond(facet, y, line, sign);
    let root = |rises: f64| {
        let start = -1.0 + 2.0 * at_start / (at_start - at_end);
        let curve = facet.curve(on, y);
        let factor = sign * rises;
        bisected(-1.0, 1.0, start, |xi| {
            (factor * curve.position(xi).dot(&along), factor * curve.tangent(xi).dot(&along))
        })
    };
    match [at_start >= 0.0, at_end >= 0.0] {
        [true, true] => Some([-1.0, 1.0]),
        [false, false] => None,
        [false, true] => Some([root(1.0), 1.0]),
        [true, false] => Some([-1.0, root(-1.0)]),
    }
}

/// How far the ends of a facet lie beyond a line, times the length of its direction.
fn ends_beyond(facet: Facet, y: Places, [on, along]: [Vector<2>; 2], sign: f64) -> [f64; 2] {
    [0, 1].map(|end| sign * (y.at(facet.nodes[end]) - on).dot(&along))
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
    /// Places at which the primary ends.
    pub(super) borders: Vec<Crossing>,
    /// Joints of the primary, but for kinks.
    pub(super) joints: Vec<Meeting>,
}

/// A place on a secondary facet over an end of a facet of the primary.
#[derive(Clone, Copy, Debug)]
pub(super) struct Crossing {
    /// Coordinate on the secondary facet.
    pub(super) xi: f64,
    /// The facet that ends there, and its coordinate, −1 or 1.
    pub(super) facet: usize,
    pub(super) eta: f64,
    /// Normal of the plane of symmetry in which it ends.
    pub(super) plane: Option<Vector<2>>,
    /// Closest points of the primary for the secondary side before and after this place.
    pub(super) sides: [Option<Opposed>; 2],
}

/// A place on a secondary facet over a joint of two facets of the primary.
#[derive(Clone, Copy, Debug)]
pub(super) struct Meeting {
    /// Coordinate on the secondary facet.
    pub(super) xi: f64,
    /// The facets that it faces before and after this place.
    pub(super) facets: [usize; 2],
    /// Whether the second follows the first in the direction of traversal of the primary.
    pub(super) forward: bool,
}

/// A part of a secondary facet with the facet of the primary that it faces, if there is one.
struct Piece<'a> {
    ends: [f64; 2],
    faced: Option<(usize, &'a Region)>,
}

impl Facing {
    /// A facet of which all points face a rigid obstacle.
    pub(super) fn whole(rule: &Rule) -> Self {
        let points = rule.points.iter().map(|&[xi, weight]| Opposed { xi, weight, facet: 0, eta: 0.0 });
        Self { points: points.collect(), ends: Some([-1.0, 1.0]), ..Self::default() }
    }
}

/// Where and how a weighted gap is integrated over a secondary facet.
#[derive(Clone, Debug)]
pub(super) struct Rule {
    /// Points and weights on −1 … 1: on each part, or on the facet.
    pub(super) points: Vec<[f64; 2]>,
    pub(super) quadrature: Quadrature,
}

/// Number of parts of equal length in a facet with fixed points.
const PARTS: usize = 4;

impl Rule {
    /// A rule for facets of two degrees on parts of the secondary facet, which are polynomials
    /// over flat facets, or with k + 2 fixed points on each quarter of a secondary facet of degree
    /// k.
    pub(super) fn new(quadrature: Quadrature, [secondary, opposite]: [usize; 2]) -> Self {
        let [exact, parts] = match quadrature {
            Quadrature::Segments => [2 * secondary.max(opposite) + 3, 1],
            Quadrature::Fixed => [2 * secondary + 3, PARTS],
        };
        let share = (parts as f64).recip();
        let of_part = |part: usize| {
            let middle = -1.0 + share * (2 * part + 1) as f64;
            let rule = carom_solid::quadrature::line(exact);
            let placed: Vec<_> = rule.iter().map(|(xi, w)| [middle + share * xi[0], share * w]).collect();
            placed
        };
        Self { points: (0..parts).flat_map(of_part).collect(), quadrature }
    }
}

/// The facets of a primary side that count, with their regions, in one configuration.
#[derive(Debug, Default)]
pub(super) struct Regions {
    pub(super) of_facets: Vec<(usize, Region)>,
    /// Turns along the boundary, for contact of a side with itself.
    pub(super) turns: Turns,
}

/// A primary side in one configuration.
pub(super) struct Opposites<'a> {
    pub(super) surface: &'a Surface,
    pub(super) folds: Option<&'a Folds>,
    pub(super) regions: &'a Regions,
    pub(super) y: Places<'a>,
}

/// The part of a secondary facet that lies opposite to a facet of the primary.
struct Part<'a> {
    ends: [f64; 2],
    facet: usize,
    region: &'a Region,
}

impl Opposites<'_> {
    /// Finds the part of a secondary facet, given with its number, that faces these facets.
    pub(super) fn facing(&self, number: usize, own: Facet, rule: &Rule) -> Facing {
        let may_face = |(facet, _): &&(usize, Region)| {
            self.folds.is_none_or(|folds| meet(folds, &self.regions.turns, [number, *facet]))
        };
        let regions = self.regions.of_facets.iter().filter(may_face);
        match rule.quadrature {
            Quadrature::Segments => self.facing_in_parts(own, regions, &rule.points),
            Quadrature::Fixed => self.facing_at_points(own, &regions, &rule.points),
        }
    }

    fn facing_in_parts<'r>(
        &self,
        own: Facet,
        regions: impl Iterator<Item = &'r (usize, Region)>,
        rule: &[[f64; 2]],
    ) -> Facing {
        let mut parts = Vec::new();
        let normal = own.at(self.y, 0.0).normal;
        for (facet, region) in regions {
            if let Some(ends) = region.part_of(own, normal, self.y) {
                parts.push(Part { ends, facet: *facet, region });
            }
        }
        let mut ends: Vec<f64> = parts.iter().flat_map(|part| part.ends).collect();
        ends.sort_unstable_by(f64::total_cmp);
        let mut found = Facing::default();
        let mut pieces = Vec::new();
        for piece in ends.windows(2).filter(|piece| piece[1] - piece[0] > ROUND_OFF) {
            let middle = 0.5 * (piece[0] + piece[1]);
            let half = 0.5 * (piece[1] - piece[0]);
            let over = parts.iter().filter(|part| part.ends[0] <= middle && middle <= part.ends[1]);
            let over = over.map(|part| (part.facet, part.region));
            let faced = self.nearest(own, over, middle);
            pieces.push(Piece { ends: [piece[0], piece[1]], faced });
            let Some((facet, region)) = faced else { continue };
            for [at, weight] in rule {
                let at = [middle + half * at, half * weight];
                found.points.extend(self.opposed(own, facet, region, at));
            }
            found.ends = Some([found.ends.map_or(piece[0], |ends| ends[0]), piece[1]]);
        }
        found.borders = self.borders(own, &parts, &pieces);
        found.joints = pieces.windows(2).filter_map(|pieces| self.meeting(&pieces[0], &pieces[1])).collect();
        found
    }

    /// The joint between two pieces, if they meet there.
    fn meeting(&self, before: &Piece, after: &Piece) -> Option<Meeting> {
        let xi = before.ends[1];
        let (first, region) = before.faced?;
        let (second, _) = after.faced?;
        let meets = |forward: bool| {
            !region.is_free[usize::from(forward)]
                && self.surface.neighbour_of_side(first, forward) == Some(second)
        };
        let forward = [true, false].into_iter().find(|&forward| meets(forward))?;
        let is_between = after.ends[0] - xi <= ROUND_OFF && first != second;
        is_between.then_some(Meeting { xi, facets: [first, second], forward })
    }

    /// The places between pieces, or beside the first and the last one, at which a facet of the
    /// primary ends that nothing continues.
    fn borders(&self, own: Facet, parts: &[Part], pieces: &[Piece]) -> Vec<Crossing> {
        let mut borders = Vec::new();
        for part in parts {
            for end in [0, 1] {
                let xi = part.ends[end];
                // Rows do not extend over the nodes of other contacts.
                if xi.abs() >= 1.0 || !self.surface.is_of_side(part.facet) {
                    continue;
                }
                // The secondary side is not traversed in the direction of the primary.
                let is_start = (own.tangent(self.y, xi).dot(&part.region.start[1]) > 0.0) == (end == 0);
                if !part.region.is_free[usize::from(!is_start)] {
                    continue;
                }
                let beside = |end: usize| {
                    let piece = pieces.iter().find(|piece| (piece.ends[end] - xi).abs() <= ROUND_OFF)?;
                    let (facet, region) = piece.faced?;
                    self.opposed(own, facet, region, [xi, 0.0])
                };
                let sides = [beside(1), beside(0)];
                let facets = sides.map(|side| side.map(|opposed| opposed.facet));
                if facets[0] != facets[1] {
                    let eta = if is_start { -1.0 } else { 1.0 };
                    let plane = part.region.planes[usize::from(!is_start)];
                    borders.push(Crossing { xi, facet: part.facet, eta, plane, sides });
                }
            }
        }
        borders
    }

    fn facing_at_points<'r>(
        &self,
        own: Facet,
        regions: &(impl Iterator<Item = &'r (usize, Region)> + Clone),
        rule: &[[f64; 2]],
    ) -> Facing {
        let mut found = Facing::default();
        let normal = own.at(self.y, 0.0).normal;
        let mut end = -1.0;
        for &[xi, weight] in rule {
            let start = end;
            end += weight;
            let point = own.position(self.y, xi);
            let over = regions.clone().filter(|(_, region)| region.contains(point, normal));
            let over = over.map(|(facet, region)| (*facet, region));
            let Some((facet, region)) = self.nearest(own, over, xi) else { continue };
            let before = found.points.len();
            found.points.extend(self.opposed(own, facet, region, [xi, weight]));
            if found.points.len() > before {
                found.ends = Some([found.ends.map_or(start, |ends| ends[0]), end]);
            }
        }
        found
    }

    /// The nearest of the facets over which a point lies, if it is one of the side: walls may stand
    /// behind each other. Behind a facet by more than a facet's length, a point is not inside the
    /// body there, nor behind a facet of the same body where no other part of it covers the point,
    /// which costs a pass over the boundary.
    fn nearest<'r>(
        &self,
        own: Facet,
        over: impl Iterator<Item = (usize, &'r Region)>,
        xi: f64,
    ) -> Option<(usize, &'r Region)> {
        let own_length = (self.y.at(own.nodes[1]) - self.y.at(own.nodes[0])).norm();
        let gap = |facet: usize, region: &Region| {
            let Opposed { eta, .. } = self.opposed(own, facet, region, [xi, 0.0])?;
            let point = own.position(self.y, xi);
            let gap = self.surface.gap(facet, eta, point, self.y);
            let is_near = gap > -region.length.max(own_length);
            let is_shallow = self.folds.is_none() || gap >= -SHALLOW * region.length;
            (is_near && (is_shallow || self.surface.covers_point(own.nodes, point, self.y)))
                .then_some(gap.abs())
        };
        let with_gaps = over.filter_map(|(facet, region)| Some((gap(facet, region)?, facet, region)));
        let (_, facet, region) = with_gaps.min_by(|a, b| a.0.total_cmp(&b.0))?;
        self.surface.is_of_side(facet).then_some((facet, region))
    }

    /// A point of a secondary facet over a facet of the primary; none without a unique closest
    /// point.
    fn opposed(&self, own: Facet, facet: usize, region: &Region, [xi, weight]: [f64; 2]) -> Option<Opposed> {
        let point = own.position(self.y, xi);
        let opposite = self.surface.facet(facet);
        // Far away, Newton's method may never be still.
        let eta = opposite.closest_from(self.y, point, region.between(point), MORTAR_BEYOND);
        let eta = eta.or_else(|| opposite.closest_point(self.y, point, MORTAR_BEYOND))?;
        Some(Opposed { xi, weight, facet, eta })
    }
}

/// Whether a later and an earlier facet of one boundary may meet.
pub(super) fn meet(folds: &Folds, turns: &Turns, [own, other]: [usize; 2]) -> bool {
    folds.admits_facet(own, other) && folds.facets_face(turns, own, other)
}
