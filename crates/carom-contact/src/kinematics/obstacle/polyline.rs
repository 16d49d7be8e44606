//! A chain of straight segments with the rigid material to the left of the direction of travel, and
//! a corner between neighbours: an arc of radius r ≥ 0 tangent to both.
//!
//! ```text
//! segment   g = (x − a)·n,  n = t rotated right         where 0 ≤ (x − a)·t ≤ length
//! corner    g = ±(|x − c| − r),  + where the chain turns left (convex)        where x − c lies between ±n of the neighbours
//! ```
//!
//! An arc of radius r removes r tan(φ/2) from both segments at a turn by φ. With r = 0 a convex
//! corner is its vertex: outside, distance and gradient are continuous across the ends of its cone,
//! while inside the cone is empty and a point belongs to one of the segments.
//!
//! The first and last segment of an open chain continue to infinity.

use super::corner::AtCorner;
use super::near::{Entry, Near, Point, Tip, around, distance};
use crate::constants::{KINK, ROUND_OFF};

/// A piece of a polyline.
#[derive(Clone, Copy, Debug)]
enum Piece {
    Segment { start: Point, tangent: Point, normal: Point, length: f64, ends: [bool; 2] },
    Corner { center: Point, radius: f64, side: f64, normals: [Point; 2] },
}

/// A polyline as a rigid surface.
#[derive(Clone, Debug)]
pub struct Polyline {
    /// Segments and corners of the polyline, alternately.
    pieces: Vec<Piece>,
    closed: bool,
}

/// Why points do not form a polyline; points are numbered from 1.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum PolylineError {
    /// Fewer than two points.
    #[error("a polyline has at least two points")]
    TooFew,
    /// Two consecutive points coincide.
    #[error("points {0} and {1} coincide")]
    Coincident(usize, usize),
    /// The chain turns back at a point.
    #[error("the chain turns back on itself at point {0}")]
    TurnsBack(usize),
    /// The arcs at the ends of a segment need more than its length.
    #[error(
        "between points {first} and {second} the rounded corners take {taken:.6e} of a segment of length {length:.6e}"
    )]
    TooRound {
        /// First point of the segment.
        first: usize,
        /// Second point of the segment.
        second: usize,
        /// Length that the arcs remove from the segment, r tan(φ/2) summed over both ends.
        taken: f64,
        /// Length of the segment.
        length: f64,
    },
}

impl Polyline {
    /// A chain through points of the plane with corners rounded by `radius` ≥ 0; closed if the last
    /// point repeats the first.
    ///
    /// # Errors
    /// Coincident points, a chain that turns back, arcs that do not fit.
    pub fn new(points: &[[f64; 2]], radius: f64) -> Result<Self, PolylineError> {
        let count = points.len();
        if count < 2 {
            return Err(PolylineError::TooFew);
        }
        let closed = count > 3 && points[0] == points[count - 1];
        let point = |k: usize| [points[k][0], points[k][1], 0.0];
        let mut tangents = Vec::with_capacity(count - 1);
        for k in 0..count - 1 {
            let length = distance(point(k), point(k + 1));
            if length <= 0.0 {
                return Err(PolylineError::Coincident(k + 1, k + 2));
            }
            let a = point(k);
            let b = point(k + 1);
            tangents.push(([(b[0] - a[0]) / length, (b[1] - a[1]) / length, 0.0], length));
        }
        let segments = tangents.len();
        // What the corner before each segment removes from it.
        let mut removed = vec![0.0; segments + 1];
        for k in usize::from(!closed)..segments {
            let before = tangents[(k + segments - 1) % segments].0;
            let after = tangents[k].0;
            let cosine = dot(before, after);
            if 1.0 + cosine < ROUND_OFF {
                return Err(PolylineError::TurnsBack(k + 1));
            }
            // tan(φ/2) = |sin φ| / (1 + cos φ)
            removed[k] = radius * cross(before, after).abs() / (1.0 + cosine);
        }
        removed[segments] = if closed { removed[0] } else { 0.0 };
        let mut pieces = Vec::with_capacity(2 * segments);
        for (k, &(tangent, length)) in tangents.iter().enumerate() {
            let taken = removed[k] + removed[k + 1];
            if taken > length {
                return Err(PolylineError::TooRound { first: k + 1, second: k + 2, taken, length });
            }
            let ends = [closed || k > 0, closed || k + 1 < segments];
            pieces.push(Piece::Segment {
                start: plus(point(k), removed[k], tangent),
                tangent,
                normal: right(tangent),
                length: length - taken,
                ends,
            });
            if ends[1] {
                let next = tangents[(k + 1) % segments].0;
                let side = if cross(tangent, next) >= 0.0 { 1.0 } else { -1.0 };
                let end = plus(point(k), length - removed[k + 1], tangent);
                let center = plus(end, -side * radius, right(tangent));
                pieces.push(Piece::Corner { center, radius, side, normals: [right(tangent), right(next)] });
            }
        }
        Ok(Self { pieces, closed })
    }

    /// The convex corners of the polyline.
    pub(crate) fn tips(&self) -> impl Iterator<Item = Tip> + '_ {
        self.pieces.iter().enumerate().filter_map(|(piece, of)| match of {
            Piece::Corner { center, radius, side, normals } if *side > 0.0 => {
                let [first, last] = *normals;
                let cosine = dot(first, last);
                let is_blunt = cosine >= KINK.cosine;
                // An arc through the middles of the segments has the chord tan(φ/2) of its radius.
                let tangent = cross(first, last).abs() / (1.0 + cosine);
                let arc = if is_blunt { 0.5 * self.shorter_beside(piece) / tangent } else { 0.0 };
                Some(Tip { center: *center, radius: *radius, size: radius + arc, normals: Some(*normals) })
            }
            _ => None,
        })
    }

    /// Length of the shorter one of the segments beside a corner; infinite if both continue to
    /// infinity.
    fn shorter_beside(&self, corner: usize) -> f64 {
        let length = |forward: bool| match self.pieces[self.neighbour(corner, forward)?] {
            Piece::Segment { length, ends: [true, true], .. } => Some(length),
            _ => None,
        };
        [false, true].into_iter().filter_map(length).fold(f64::INFINITY, f64::min)
    }

    /// Number of pieces of the polyline: segments and corners.
    pub(in super::super) fn pieces(&self) -> usize {
        self.pieces.len()
    }

    /// The next or previous piece of a polyline, if there is one.
    fn neighbour(&self, piece: usize, forward: bool) -> Option<usize> {
        let count = self.pieces.len();
        match (forward, self.closed) {
            (true, true) => Some((piece + 1) % count),
            (false, true) => Some((piece + count - 1) % count),
            (true, false) => Some(piece + 1).filter(|&next| next < count),
            (false, false) => piece.checked_sub(1),
        }
    }

    /// Whether the point of a piece's line or circle that is closest to a point lies on the piece.
    fn faces(&self, piece: usize, at: Point) -> bool {
        match &self.pieces[piece] {
            Piece::Segment { start, tangent, length, ends, .. } => {
                let along = dot(minus(at, *start), *tangent);
                (!ends[0] || along >= 0.0) && (!ends[1] || along <= *length)
            }
            Piece::Corner { center, side, normals: [first, last], .. } => {
                let arm = minus(at, *center).map(|x| side * x);
                side * cross(*first, arm) >= 0.0
                    && side * cross(arm, *last) >= 0.0
                    && dot(arm, *first) + dot(arm, *last) >= 0.0
            }
        }
    }

    /// The piece of the polyline closest to a point; the first one if there are several.
    pub(in super::super) fn nearest(&self, at: Point) -> usize {
        let facing = (0..self.pieces.len()).filter(|&piece| self.faces(piece, at));
        let distance = |piece: usize| self.near(piece, at).map_or(f64::INFINITY, |near| near.gap.abs());
        // At a shared end the segment wins over the corner: its normal exists everywhere.
        let order = |piece: &usize| (distance(*piece), piece % 2);
        facing.min_by(|a, b| order(a).0.total_cmp(&order(b).0).then(order(a).1.cmp(&order(b).1))).unwrap_or(0)
    }

    /// The segment at a sharp concave corner behind which a point is deeper, for that corner; the
    /// piece itself for others.
    pub(in super::super) fn with_normal(&self, piece: usize, at: Point) -> usize {
        if !self.is_notch(piece) {
            return piece;
        }
        let beside = [false, true].into_iter().filter_map(|forward| self.neighbour(piece, forward));
        beside.min_by(|a, b| self.gap(*a, at).total_cmp(&self.gap(*b, at))).unwrap_or(piece)
    }

    /// The segments over or under which a point lies, to within a distance past their ends.
    pub(in super::super) fn over(&self, at: Point, past: f64) -> Vec<usize> {
        let is_over = |piece: &usize| match &self.pieces[*piece] {
            Piece::Segment { start, tangent, length, ends, .. } => {
                let along = dot(minus(at, *start), *tangent);
                (!ends[0] || along >= -past) && (!ends[1] || along <= *length + past)
            }
            Piece::Corner { .. } => false,
        };
        (0..self.pieces.len()).filter(is_over).collect()
    }

    /// Signed distance from a piece of the polyline to a point, with its derivatives.
    pub(in super::super) fn near(&self, piece: usize, at: Point) -> Option<Near> {
        match self.pieces[piece] {
            Piece::Segment { start, normal, .. } => Some(Near::flat(dot(minus(at, start), normal), normal)),
            Piece::Corner { center, radius, side, .. } => around(minus(at, center), [0.0; 3], radius, side),
        }
    }

    fn gap(&self, piece: usize, at: Point) -> f64 {
        self.near(piece, at).map_or(f64::NEG_INFINITY, |near| near.gap)
    }

    fn is_sharp(&self, piece: usize) -> bool {
        matches!(self.pieces[piece], Piece::Corner { radius: 0.0, .. })
    }

    /// The neighbouring piece past whose common end with a piece a point lies, if any.
    fn beyond(&self, piece: usize, at: Point) -> Option<usize> {
        match &self.pieces[piece] {
            _ if self.faces(piece, at) => None,
            Piece::Segment { start, tangent, length, .. } => {
                self.neighbour(piece, dot(minus(at, *start), *tangent) > 0.5 * length)
            }
            Piece::Corner { center, side, normals: [first, last], .. } => {
                let arm = minus(at, *center).map(|x| side * x);
                self.neighbour(piece, dot(arm, *last) > dot(arm, *first))
            }
        }
    }

    /// The segments beside a segment at concave corners behind which a point lies, and not past
    /// their other ends.
    pub(in super::super) fn walls(&self, piece: usize, at: Point) -> Vec<usize> {
        let wall = |forward: bool| {
            let corner = self.neighbour(piece, forward).filter(|&corner| self.is_notch(corner))?;
            let wall = self.neighbour(corner, forward)?;
            let is_beside = self.faces(wall, at) || self.beyond(wall, at) == Some(corner);
            (is_beside && self.gap(wall, at) < 0.0).then_some(wall)
        };
        [false, true].into_iter().filter_map(wall).collect()
    }

    /// Whether a piece is a sharp concave corner.
    fn is_notch(&self, piece: usize) -> bool {
        matches!(self.pieces[piece], Piece::Corner { radius: 0.0, side, .. } if side < 0.0)
    }

    /// The piece of the polyline on which the gap of a node in contact is measured: the node slides
    /// through rounded corners, and past a sharp one on the line of its segment, since a vertex has
    /// no normal.
    pub(in super::super) fn followed(&self, mut piece: usize, at: Point) -> usize {
        for _ in 0..self.pieces.len() {
            let Some(next) = self.beyond(piece, at) else { break };
            let leaves_vertex = self.is_sharp(piece);
            if self.is_sharp(next) && !leaves_vertex {
                break;
            }
            // Behind the centre of an arc, or between pieces by round-off, there is no better one.
            if !self.faces(next, at) && self.beyond(next, at) == Some(piece) {
                break;
            }
            piece = next;
        }
        piece
    }

    /// The next piece of a node in contact with a segment, which may lie past a sharp corner.
    pub(in super::super) fn at_corner(&self, piece: usize, at: Point) -> AtCorner {
        let Piece::Segment { tangent, .. } = self.pieces[piece] else { return AtCorner::Stays };
        for forward in [true, false] {
            let Some(corner) = self.neighbour(piece, forward).filter(|&c| self.is_sharp(c)) else { continue };
            let Some(next) = self.neighbour(corner, forward) else { continue };
            let Piece::Corner { side, .. } = self.pieces[corner] else { continue };
            let Piece::Segment { tangent: other, .. } = self.pieces[next] else { continue };
            let past = self.beyond(piece, at) == Some(corner);
            let blunt = dot(tangent, other) >= KINK.cosine;
            if side < 0.0 {
                // In a dent the deeper wall constrains it; in a concave corner both do (`walls`).
                if blunt && self.gap(next, at) < self.gap(piece, at) && self.faces(next, at) {
                    return AtCorner::Goes(next);
                }
            } else if past {
                return match (blunt, self.beyond(next, at) == Some(corner)) {
                    (true, true) => AtCorner::Stays,
                    (true, false) => AtCorner::Goes(next),
                    (false, _) => AtCorner::Leaves,
                };
            }
        }
        AtCorner::Stays
    }

    /// Where a point on a straight path first enters through a segment or an arc.
    pub(in super::super) fn entered(&self, before: Point, now: Point) -> Option<Entry> {
        let path = minus(now, before);
        let at = |theta: f64| plus(before, theta, path);
        let mut first: Option<Entry> = None;
        for piece in 0..self.pieces.len() {
            let theta = match self.pieces[piece] {
                Piece::Segment { .. } => {
                    let from = self.gap(piece, before);
                    let to = self.gap(piece, now);
                    if from < 0.0 || to >= 0.0 {
                        continue;
                    }
                    from / (from - to)
                }
                Piece::Corner { radius: 0.0, .. } => continue,
                Piece::Corner { center, radius, side, .. } => {
                    // |b + θ d|² = r²: outwards the later root, inwards the earlier one.
                    let arm = minus(before, center);
                    let a = dot(path, path);
                    let b = dot(arm, path);
                    let c = dot(arm, arm) - radius * radius;
                    let root = b * b - a * c;
                    if root < 0.0 || a == 0.0 {
                        continue;
                    }
                    (-b - side * root.sqrt()) / a
                }
            };
            if (0.0..=1.0).contains(&theta)
                && self.faces(piece, at(theta))
                && first.is_none_or(|first| theta < first.theta)
            {
                first = Some(Entry { theta, piece });
            }
        }
        first
    }
}

fn dot(a: Point, b: Point) -> f64 {
    a[0] * b[0] + a[1] * b[1]
}

fn cross(a: Point, b: Point) -> f64 {
    a[0] * b[1] - a[1] * b[0]
}

fn minus(a: Point, b: Point) -> Point {
    [a[0] - b[0], a[1] - b[1], 0.0]
}

fn plus(a: Point, factor: f64, b: Point) -> Point {
    [a[0] + factor * b[0], a[1] + factor * b[1], 0.0]
}

fn right(a: Point) -> Point {
    [a[1], -a[0], 0.0]
}
