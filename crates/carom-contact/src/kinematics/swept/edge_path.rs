//! f = x_A − x_B of two curved edges in space over a box of (a, b, θ): `patch_path.rs` for a curve
//! instead of a node, and a curve instead of a surface.
//!
//! ```text
//! f(a, b, θ) = Σᵢ βᵢ(a) Aᵢ(θ) − Σⱼ βⱼ(b) Bⱼ(θ),    β the Bernstein polynomials,
//! ```
//!
//! lies within the sum of the convex hulls of the control points of A and of −B: the control net
//! has the points Aᵢ − Bⱼ, and a direction excludes zero if the smallest component of the Aᵢ
//! exceeds the largest of the Bⱼ, at both ends of the interval of θ. Halving a divides the points
//! of A alone.
//!
//! Round-off as in `path.rs`, positions relative to the first node of B at the same θ, with m = max
//! |x|₁ and Λ ≤ 6: a control point is wrong by (8 + 3 level) u Λ m, a difference of two by twice
//! that and u Λ m, of which 20 + 6 level are used.

use carom_algebra::Vector;
use carom_solid::Piece;

use super::patch_path::Ball;
use super::path::{DEEPEST, Interval, Stop, UNIT_ROUNDOFF, largest_of, mean, sum_of};
use crate::kinematics::space::cross;

/// Bound Λ of the sum of the absolute weights of a control point.
const WEIGHTS: f64 = 6.0;

/// Control points of an edge.
type Points = [Vector<3>; 4];

/// Difference f of the positions on two moving edges over a box of (a, b, θ).
#[derive(Clone, Copy, Debug)]
pub(super) struct EdgePath {
    /// Control points of the edges A and B at both ends of the interval of θ.
    points: [[Points; 2]; 2],
    /// Polynomial degrees of the edges A and B.
    degrees: [usize; 2],
    along: [Interval; 2],
    theta: Interval,
    /// Unit u Λ m of the bounds of round-off.
    unit: f64,
    separation: f64,
}

impl EdgePath {
    /// The whole paths of two edges A and B whose nodes, ends first, move from those of `start` to
    /// those of `end`.
    pub(super) fn new([start, end]: [[&[Vector<3>]; 2]; 2], separation: f64) -> Self {
        let mut points = [[[Vector::ZERO; 4]; 2]; 2];
        let mut largest = 0.0_f64;
        for (at, edges) in [start, end].into_iter().enumerate() {
            let from = edges[1][0];
            for (of, nodes) in edges.into_iter().enumerate() {
                let mut local = [Vector::ZERO; 4];
                for (x, node) in local.iter_mut().zip(nodes) {
                    *x = *node - from;
                    let size = sum_of(*x);
                    // A NaN must not be lost, as it is by `max`.
                    largest = if size > largest || size.is_nan() { size } else { largest };
                }
                points[of][at] = control(&local, nodes.len());
            }
        }
        Self {
            points,
            degrees: [start[0].len() - 1, start[1].len() - 1],
            along: [Interval::WHOLE; 2],
            theta: Interval::WHOLE,
            unit: UNIT_ROUNDOFF * WEIGHTS * largest + f64::MIN_POSITIVE,
            separation,
        }
    }

    /// Coordinates ξ on A and B in the middle of the box.
    pub(super) fn xi(&self) -> [f64; 2] {
        self.along.map(|along| 2.0 * (along.low + 0.5 * along.width) - 1.0)
    }

    /// Sizes at which boxes are not halved any more, for a tolerance relative to the extents of the
    /// path.
    pub(super) fn stop(&self, tolerance: f64) -> Stop {
        let most = [0, 1].map(|of| self.extent_along(of)).into_iter().fold(self.extent_in_time(), f64::max);
        Stop { theta: tolerance, distance: tolerance * most }
    }

    /// Both halves of the box along the parameter with the largest extent, or `None` if the box is
    /// small.
    pub(super) fn split(&self, stop: &Stop) -> Option<[Self; 2]> {
        if !self.unit.is_finite() {
            return None;
        }
        let extents = [0, 1].map(|of| self.extent_along(of));
        let of = usize::from(extents[1] > extents[0]);
        let in_time = self.extent_in_time();
        let long = extents[of] > stop.distance && self.along[of].level < DEEPEST;
        let late = in_time > stop.distance && self.theta.level < DEEPEST;
        if long && (extents[of] >= in_time || !late) {
            Some(self.halves_along(of))
        } else if late || self.theta.width > stop.theta {
            Some(self.halves_in_time())
        } else {
            None
        }
    }

    fn halves_along(&self, of: usize) -> [Self; 2] {
        let mut parts = [*self; 2];
        let last = self.degrees[of];
        for end in 0..2 {
            let mut line = self.points[of][end];
            for k in 0..=last {
                parts[0].points[of][end][k] = line[0];
                parts[1].points[of][end][last - k] = line[last - k];
                for r in 0..last - k {
                    line[r] = mean(line[r], line[r + 1]);
                }
            }
        }
        [parts[0].along[of], parts[1].along[of]] = self.along[of].halves();
        parts
    }

    fn halves_in_time(&self) -> [Self; 2] {
        let mut parts = [*self; 2];
        for of in 0..2 {
            for k in 0..=self.degrees[of] {
                let middle = mean(self.points[of][0][k], self.points[of][1][k]);
                parts[0].points[of][1][k] = middle;
                parts[1].points[of][0][k] = middle;
            }
        }
        [parts[0].theta, parts[1].theta] = self.theta.halves();
        parts
    }

    /// The control points of one edge at one end of the interval of θ.
    fn of(&self, of: usize, end: usize) -> &[Vector<3>] {
        &self.points[of][end][..=self.degrees[of]]
    }

    /// Extent along an edge: the largest component of the sum of |Δc| between its control points.
    fn extent_along(&self, of: usize) -> f64 {
        let size =
            |end: usize| self.of(of, end).windows(2).map(|two| largest_of(two[1] - two[0])).sum::<f64>();
        size(0).max(size(1))
    }

    /// Extent in time: the largest component of the motion over the interval of θ.
    fn extent_in_time(&self) -> f64 {
        self.motions().map(largest_of).fold(0.0, f64::max)
    }

    /// Relative motion of all pairs of control points over the interval of θ.
    fn motions(&self) -> impl Iterator<Item = Vector<3>> + Clone {
        let moved = |of: usize, k: usize| self.points[of][1][k] - self.points[of][0][k];
        let [a, b] = self.degrees;
        (0..=a).flat_map(move |i| (0..=b).map(move |j| moved(0, i) - moved(1, j)))
    }

    /// Differences of the control points along an edge.
    fn tangents(&self, of: usize) -> impl Iterator<Item = Vector<3>> + Clone {
        let each = move |end: usize| self.of(of, end).windows(2).map(|two| two[1] - two[0]);
        (0..2).flat_map(each)
    }

    /// Bound of the round-off of a component of a difference of control points.
    fn error(&self) -> f64 {
        let level = self.theta.level + self.along[0].level + self.along[1].level;
        (20.0 + 6.0 * f64::from(level)) * self.unit
    }

    /// Whether edge A moves out of the body of B wherever the edges meet: n·∂f/∂θ > 0 with n along
    /// τ_A × τ_B to the side of `outwards`, each factor anywhere in the ball around its control
    /// points.
    pub(super) fn only_separates(&self, outwards: &Vector<3>) -> bool {
        let motion = Ball::of(self.motions());
        let [first, second] = [0, 1].map(|of| Ball::of(self.tangents(of)));
        let normal = cross(first.centre, second.centre);
        let slack = 4.0 * 3.0_f64.sqrt() * self.error();
        let [a, b, c] = [&first, &second, &motion].map(|ball| ball.centre.norm() + ball.radius + slack);
        let [p, q, r] = [&first, &second, &motion].map(|ball| ball.radius + slack);
        // |(τ_A + p) × (τ_B + q) − τ_A × τ_B|, and the same times the motion, all at their worst.
        let turned = p * b + a * q;
        let out = normal.dot(outwards);
        let is_oriented = out.abs() > turned * outwards.norm() * (1.0 + 1e-12);
        let spread = normal.norm() * r + turned * c;
        let along = normal.dot(&motion.centre) * out.signum();
        // A NaN is no proof.
        is_oriented && along > spread * (1.0 + 1e-12) + 64.0 * UNIT_ROUNDOFF * a * b * c
    }

    /// Whether a direction separates A from B at both ends of the interval of θ, on the same side.
    fn separates(&self, direction: &Vector<3>) -> bool {
        let slack = self.separation * direction.norm() * (1.0 + 4.0 * f64::EPSILON)
            + self.error() * sum_of(*direction)
            + f64::MIN_POSITIVE;
        let range = |of: usize, end: usize| {
            let each = self.of(of, end).iter().map(|x| direction.dot(x));
            each.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| {
                // A NaN must not be lost.
                if x.is_nan() { (x, x) } else { (low.min(x), high.max(x)) }
            })
        };
        let ends = [0, 1].map(|end| [range(0, end), range(1, end)]);
        ends.iter().all(|[a, b]| a.0 - b.1 > slack) || ends.iter().all(|[a, b]| b.0 - a.1 > slack)
    }
}

impl Piece for EdgePath {
    fn theta(&self) -> f64 {
        self.theta.low
    }

    fn level(&self) -> u32 {
        self.theta.level + self.along[0].level + self.along[1].level
    }

    /// Distinguishes all boxes of one size by their coordinate along an irrational direction.
    fn place(&self) -> f64 {
        let [a, b] = self.xi();
        a + b * 0.754_877_666_246_692_7
    }

    /// Whether a direction separates the edges: tries the normal of both, the direction from B to
    /// A, and those perpendicular to the motion.
    fn is_clear(&self) -> bool {
        let chord = |of: usize| {
            let last = self.degrees[of];
            [0, 1]
                .iter()
                .fold(Vector::ZERO, |sum, &end| sum + (self.points[of][end][last] - self.points[of][end][0]))
        };
        let middle = |of: usize, end: usize| {
            let points = self.of(of, end);
            points.iter().fold(Vector::ZERO, |sum, x| sum + *x) * (points.len() as f64).recip()
        };
        let apart = [0, 1].map(|end| middle(0, end) - middle(1, end));
        let sum = apart[0] + apart[1];
        let motion = apart[1] - apart[0];
        let a = chord(0);
        let b = chord(1);
        let size = motion.dot(&motion);
        let across = if size > 0.0 { sum - motion * (sum.dot(&motion) / size) } else { sum };
        let directions = [cross(a, b), sum, across, cross(a, motion), cross(b, motion)];
        directions.iter().any(|direction| self.separates(direction))
    }
}

/// Bernstein coefficients of a line of 2 to 4 nodes, given ends first (`path.rs`).
fn control(x: &Points, nodes: usize) -> Points {
    match nodes {
        2 => [x[0], x[1], Vector::ZERO, Vector::ZERO],
        3 => [x[0], x[2] * 2.0 - (x[0] + x[1]) * 0.5, x[1], Vector::ZERO],
        _ => {
            let sixth = 1.0 / 6.0;
            [
                x[0],
                x[0] * (-5.0 * sixth) + x[1] * (2.0 * sixth) + x[2] * 3.0 - x[3] * 1.5,
                x[0] * (2.0 * sixth) - x[1] * (5.0 * sixth) - x[2] * 1.5 + x[3] * 3.0,
                x[1],
            ]
        }
    }
}
