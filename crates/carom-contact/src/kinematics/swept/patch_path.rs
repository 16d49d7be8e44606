//! f = y_N − y_S of a node and a surface in space as control points over a box of (ξ, θ), with a
//! bound of their round-off: `path.rs` in one more dimension. Boxes of ξ are triangles or
//! rectangles, halved along their edges by de Casteljau's algorithm.
//!
//! Round-off, with u = 2⁻⁵³, m = max |x|₁ over the nodal values and Λ = Σ |weights| ≤ 10: weights
//! are those of a table (≤ 8u each), products and up to nine sums ten times (≤ 10 u Λ m), a halving
//! takes at most three means in sequence (≤ 3u Λ m), a scalar product ≤ 3u Λ m |a|₁. Together
//!
//! ```text
//! |error of a·c| ≤ (22 + 3 level) u Λ m |a|₁
//! ```
//!
//! of which 28 + 3 level are used.

use carom_algebra::Vector;
use carom_solid::{Direction, Net, Piece};

use super::path::{DEEPEST, Interval, Stop, UNIT_ROUNDOFF, excludes_zero, largest_of, mean, sum_of};
use crate::kinematics::space::cross;

/// Bound Λ of the sum of the absolute weights of a control point.
const WEIGHTS: f64 = 10.0;

type Points = [Vector<3>; Net::POINTS];

/// Difference f of the positions of a node and a point of a surface over a box of (ξ, θ).
#[derive(Clone, Copy, Debug)]
pub(super) struct PatchPath {
    /// Control points at both ends of the interval of θ.
    points: [Points; 2],
    count: usize,
    theta: Interval,
    /// Corners of the box of ξ.
    corners: [[f64; 2]; 4],
    sides: usize,
    degree: usize,
    level: u32,
    /// Unit u Λ m of the bounds of round-off.
    unit: f64,
    separation: f64,
}

/// Ball around the mean of vectors that contains them all.
pub(super) struct Ball {
    pub(super) centre: Vector<3>,
    pub(super) radius: f64,
}

impl Ball {
    pub(super) fn of(vectors: impl Iterator<Item = Vector<3>> + Clone) -> Self {
        let (sum, count) = vectors.clone().fold((Vector::ZERO, 0.0), |(sum, n), v| (sum + v, n + 1.0));
        let centre = sum * f64::recip(count);
        let radius = vectors.map(|v| (v - centre).norm()).fold(0.0, f64::max);
        Self { centre, radius }
    }
}

impl PatchPath {
    /// The whole path of a node and a facet in space.
    pub(super) fn new(net: &Net, node: [Vector<3>; 2], facet: [&[Vector<3>]; 2], separation: f64) -> Self {
        let mut points = [[Vector::ZERO; Net::POINTS]; 2];
        let mut largest = 0.0_f64;
        for end in 0..2 {
            for (k, point) in points[end][..net.points()].iter_mut().enumerate() {
                for (weight, x) in net.weights(k).iter().zip(facet[end]) {
                    let difference = node[end] - *x;
                    *point += difference * *weight;
                    let size = sum_of(difference);
                    // A NaN must not be lost, as it is by `max`.
                    largest = if size > largest || size.is_nan() { size } else { largest };
                }
            }
        }
        let mut corners = [[0.0; 2]; 4];
        corners[..net.corners().len()].copy_from_slice(net.corners());
        Self {
            points,
            count: net.points(),
            theta: Interval::WHOLE,
            corners,
            sides: net.corners().len(),
            degree: net.degree(),
            level: 0,
            unit: UNIT_ROUNDOFF * WEIGHTS * largest + f64::MIN_POSITIVE,
            separation,
        }
    }

    /// Coordinates ξ in the middle of the box.
    pub(super) fn xi(&self) -> [f64; 2] {
        let corners = &self.corners[..self.sides];
        [0, 1].map(|i| corners.iter().map(|corner| corner[i]).sum::<f64>() / self.sides as f64)
    }

    /// Sizes at which boxes are not halved any more, for a tolerance relative to the extents of the
    /// path.
    pub(super) fn stop(&self, net: &Net, tolerance: f64) -> Stop {
        let along = net.directions().iter().map(|direction| self.extent_along(direction));
        Stop { theta: tolerance, distance: tolerance * along.fold(self.extent_in_time(), f64::max) }
    }

    /// Both halves of the box along the parameter with the largest extent, or `None` if the box is
    /// small.
    pub(super) fn split(&self, net: &Net, stop: &Stop) -> Option<[Self; 2]> {
        if !self.unit.is_finite() {
            return None;
        }
        let extents = net.directions().iter().map(|direction| (self.extent_along(direction), direction));
        let (along, direction) = extents.reduce(|most, next| if next.0 > most.0 { next } else { most })?;
        let in_time = self.extent_in_time();
        let long = along > stop.distance && self.level < 2 * DEEPEST;
        let late = in_time > stop.distance && self.theta.level < DEEPEST;
        if long && (along >= in_time || !late) {
            Some(self.halves_along(direction))
        } else if late || self.theta.width > stop.theta {
            Some(self.halves_in_time())
        } else {
            None
        }
    }

    fn halves_along(&self, direction: &Direction) -> [Self; 2] {
        let mut parts = [*self; 2];
        for end in 0..2 {
            for places in &direction.lines {
                let mut line = [Vector::ZERO; 4];
                let last = places.len() - 1;
                places.iter().zip(&mut line).for_each(|(&place, x)| *x = self.points[end][place]);
                for k in 0..=last {
                    parts[0].points[end][places[k]] = line[0];
                    parts[1].points[end][places[last - k]] = line[last - k];
                    for r in 0..last - k {
                        line[r] = mean(line[r], line[r + 1]);
                    }
                }
            }
        }
        for &(start, end) in &direction.edges {
            let middle = [0, 1].map(|i| 0.5 * (self.corners[start][i] + self.corners[end][i]));
            parts[0].corners[end] = middle;
            parts[1].corners[start] = middle;
        }
        parts.iter_mut().for_each(|part| part.level += 1);
        parts
    }

    fn halves_in_time(&self) -> [Self; 2] {
        let mut parts = [*self; 2];
        for i in 0..self.count {
            let middle = mean(self.points[0][i], self.points[1][i]);
            parts[0].points[1][i] = middle;
            parts[1].points[0][i] = middle;
        }
        [parts[0].theta, parts[1].theta] = self.theta.halves();
        parts
    }

    /// Extent along a direction: the largest component of the sum of |Δc| between the control
    /// points on its lines.
    fn extent_along(&self, direction: &Direction) -> f64 {
        let of = |line: &Vec<usize>, points: &Points| {
            line.windows(2).map(|two| largest_of(points[two[1]] - points[two[0]])).sum::<f64>()
        };
        let lines = direction.lines.iter();
        lines.flat_map(|line| self.points.iter().map(|points| of(line, points))).fold(0.0, f64::max)
    }

    /// Extent in time: the largest component of the motion of a control point over the interval of
    /// θ.
    fn extent_in_time(&self) -> f64 {
        self.motions().map(largest_of).fold(0.0, f64::max)
    }

    /// Relative motion of all control points over the interval of θ.
    fn motions(&self) -> impl Iterator<Item = Vector<3>> + Clone {
        (0..self.count).map(|i| self.points[1][i] - self.points[0][i])
    }

    /// Bound of the round-off of a control point's component.
    fn error(&self) -> f64 {
        (28.0 + 3.0 * f64::from(self.theta.level + self.level)) * self.unit
    }

    /// Differences of the control points along a direction, from its start to its end.
    fn tangents<'a>(&'a self, direction: &'a Direction) -> impl Iterator<Item = Vector<3>> + Clone + 'a {
        let pairs = direction.lines.iter().flat_map(|line| line.windows(2));
        let each = |two: &'a [usize]| self.points.iter().map(move |c| c[two[0]] - c[two[1]]);
        pairs.flat_map(each)
    }

    /// Whether the node moves to the outer side wherever it meets the surface: n·∂f/∂θ > 0 with the
    /// normal n = τ₁ × τ₂, each factor anywhere in the ball around its control points. The tangents
    /// are −∂f/∂ξ.
    pub(super) fn only_separates(&self, net: &Net) -> bool {
        let motion = Ball::of(self.motions());
        // Of a triangle from its first corner, of a rectangle along its axes.
        let [first, second] = [0, 1].map(|i| Ball::of(self.tangents(&net.directions()[i])));
        let normal = cross(first.centre, second.centre);
        let slack = 4.0 * 3.0_f64.sqrt() * self.error();
        let [a, b, c] = [&first, &second, &motion].map(|ball| ball.centre.norm() + ball.radius + slack);
        let [p, q, r] = [&first, &second, &motion].map(|ball| ball.radius + slack);
        // |(a + p) × (b + q) · (c + r) − a × b · c|, all radii at their worst.
        let spread = normal.norm() * r + (p * b + a * q) * c;
        let outwards = normal.dot(&motion.centre) > spread * (1.0 + 1e-12) + 64.0 * UNIT_ROUNDOFF * a * b * c;
        // A NaN is no proof.
        outwards
    }
}

impl Piece for PatchPath {
    fn theta(&self) -> f64 {
        self.theta.low
    }

    fn level(&self) -> u32 {
        self.theta.level + self.level
    }

    /// Distinguishes all boxes of one size by their coordinate along an irrational direction.
    fn place(&self) -> f64 {
        let [x, y] = self.xi();
        x + y * 0.754_877_666_246_692_7
    }

    /// Whether a direction separates the node from the surface: tries the normal, the direction
    /// from the surface to the node, its part along the surface, and those perpendicular to the
    /// motion.
    fn is_clear(&self) -> bool {
        let corner = |k: usize| self.points[0][k] + self.points[1][k];
        let points = [&self.points[0][..self.count], &self.points[1][..self.count]];
        let sum = points.iter().flat_map(|c| c.iter()).fold(Vector::ZERO, |sum, x| sum + *x);
        let error = self.error();
        let separates = |direction: &Vector<3>| {
            // Both ends on the same side.
            (direction.dot(&points[0][0]) > 0.0) == (direction.dot(&points[1][0]) > 0.0)
                && points.iter().all(|c| excludes_zero(c, direction, self.separation, error))
        };
        let last = self.count - 1;
        let middle = if self.sides == 3 { last } else { last - self.degree };
        let normal = cross(corner(self.degree) - corner(0), corner(middle) - corner(0));
        if separates(&normal) || separates(&sum) {
            return true;
        }
        let square = normal.dot(&normal);
        let along = if square > 0.0 { sum - normal * (sum.dot(&normal) / square) } else { sum };
        let motion = (points[1][0] - points[0][0]) + (points[1][last] - points[0][last]);
        let size = motion.dot(&motion);
        let across = if size > 0.0 { sum - motion * (sum.dot(&motion) / size) } else { sum };
        separates(&along) || separates(&across) || separates(&cross(normal, motion))
    }
}
