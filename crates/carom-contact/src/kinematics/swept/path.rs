//! f = y_N − y_S of a node and a curve in the plane as Bernstein coefficients over a box of (ξ, θ),
//! with a bound of their round-off.
//!
//! Lines and parabolas are raised to cubics, so that one code serves all orders. From the nodal
//! values x of f (start, end, interior):
//!
//! ```text
//! line       c = x₀, (2x₀ + x₁)/3, (x₀ + 2x₁)/3, x₁
//! parabola   c = x₀, (4x₂ − x₁)/3, (4x₂ − x₀)/3, x₁
//! cubic      c = x₀, (−5x₀ + 2x₁ + 18x₂ − 9x₃)/6, (2x₀ − 5x₁ − 9x₂ + 18x₃)/6, x₁
//! ```
//!
//! Round-off, with u = 2⁻⁵³, m = max |x| (largest component) and Λ = 34/6 ≥ Σ |weights|, to first
//! order in u: the nodal values are differences of the given numbers, so a common translation of
//! the scene costs nothing (≤ u m); weights are rounded once, products and three sums four times
//! (≤ (1 + 5) u Λ m); a halving takes at most three means in sequence, each with one rounding
//! (≤ 3u Λ m); a scalar product with a direction a costs ≤ 2u Λ m |a|₁. Together
//!
//! ```text
//! |error of a·c| ≤ (8 + 3 level) u Λ m |a|₁
//! ```
//!
//! of which 12 + 3 level are used with Λ = 6, more than the terms of higher order.

use carom_algebra::Vector;
use carom_solid::{FacetShape, Piece};

pub(super) const UNIT_ROUNDOFF: f64 = f64::EPSILON / 2.0;
/// Bound Λ of the sum of the absolute weights of a coefficient.
const WEIGHTS: f64 = 6.0;
/// Number of halvings of ξ, and of θ, after which a box counts as small.
pub(super) const DEEPEST: u32 = 48;

/// Bernstein coefficients along ξ at one end of the interval of θ.
type Curve = [Vector<2>; 4];

/// Difference f of the positions of a node and a point of a curve over a box of (ξ, θ).
#[derive(Clone, Copy, Debug)]
pub(super) struct CurvePath {
    /// Bernstein coefficients at both ends of the interval of θ.
    coefficients: [Curve; 2],
    theta: Interval,
    along: Interval,
    /// Unit u Λ m of the bounds of round-off.
    unit: f64,
    separation: f64,
}

/// An interval obtained from [0, 1] by halvings, exact.
#[derive(Clone, Copy, Debug)]
pub(super) struct Interval {
    pub(super) low: f64,
    pub(super) width: f64,
    pub(super) level: u32,
}

impl Interval {
    pub(super) const WHOLE: Self = Self { low: 0.0, width: 1.0, level: 0 };

    pub(super) fn halves(self) -> [Self; 2] {
        let width = 0.5 * self.width;
        let level = self.level + 1;
        [Self { width, level, ..self }, Self { low: self.low + width, width, level }]
    }
}

/// Extents in θ and in space at which boxes are not halved any more.
pub(super) struct Stop {
    pub(super) theta: f64,
    pub(super) distance: f64,
}

impl CurvePath {
    /// The whole path of a node and a facet in the plane.
    #[inline]
    pub(super) fn new(
        shape: FacetShape,
        node: [Vector<2>; 2],
        facet: [&[Vector<2>]; 2],
        separation: f64,
    ) -> Self {
        let mut coefficients = [[Vector::ZERO; 4]; 2];
        let mut largest = 0.0;
        for end in 0..2 {
            let at = |a: usize| node[end] - facet[end][a];
            coefficients[end] = cubic(shape, at, &mut largest);
        }
        // The smallest normal number covers underflow.
        let unit = UNIT_ROUNDOFF * WEIGHTS * largest + f64::MIN_POSITIVE;
        Self { coefficients, theta: Interval::WHOLE, along: Interval::WHOLE, unit, separation }
    }

    /// Coordinate ξ in the middle of the box.
    pub(super) fn xi(&self) -> f64 {
        2.0 * (self.along.low + 0.5 * self.along.width) - 1.0
    }

    /// Sizes at which boxes are not halved any more, for a tolerance relative to the extents of the
    /// path.
    pub(super) fn stop(&self, tolerance: f64) -> Stop {
        let distance = tolerance * self.extent_along().max(self.extent_in_time());
        Stop { theta: tolerance, distance }
    }

    /// Both halves of the box along the parameter with the larger extent, or `None` if the box is
    /// small.
    pub(super) fn split(&self, stop: &Stop) -> Option<[Self; 2]> {
        if !self.unit.is_finite() {
            return None;
        }
        let along = self.extent_along();
        let in_time = self.extent_in_time();
        let long = along > stop.distance && self.along.level < DEEPEST;
        let late = in_time > stop.distance && self.theta.level < DEEPEST;
        if long && (along >= in_time || !late) {
            Some(self.halves_along())
        } else if late || self.theta.width > stop.theta {
            Some(self.halves_in_time())
        } else {
            None
        }
    }

    fn halves_along(&self) -> [Self; 2] {
        let mut parts = [*self; 2];
        for end in 0..2 {
            let c = &self.coefficients[end];
            let [d0, d1, d2] = [mean(c[0], c[1]), mean(c[1], c[2]), mean(c[2], c[3])];
            let [e0, e1] = [mean(d0, d1), mean(d1, d2)];
            let middle = mean(e0, e1);
            parts[0].coefficients[end] = [c[0], d0, e0, middle];
            parts[1].coefficients[end] = [middle, e1, d2, c[3]];
        }
        [parts[0].along, parts[1].along] = self.along.halves();
        parts
    }

    fn halves_in_time(&self) -> [Self; 2] {
        let mut parts = [*self; 2];
        for i in 0..4 {
            let middle = mean(self.coefficients[0][i], self.coefficients[1][i]);
            parts[0].coefficients[1][i] = middle;
            parts[1].coefficients[0][i] = middle;
        }
        [parts[0].theta, parts[1].theta] = self.theta.halves();
        parts
    }

    /// Extent along ξ: the largest component of the sum of |Δc| between the coefficients.
    fn extent_along(&self) -> f64 {
        let length = |c: &Curve| (0..3).map(|i| largest_of(c[i + 1] - c[i])).sum::<f64>();
        length(&self.coefficients[0]).max(length(&self.coefficients[1]))
    }

    /// Extent in time: the largest component of the motion of a coefficient over the interval of θ.
    fn extent_in_time(&self) -> f64 {
        let [before, now] = &self.coefficients;
        (0..4).map(|i| largest_of(now[i] - before[i])).fold(0.0, f64::max)
    }

    /// Bound of the round-off of a coefficient's component.
    fn error(&self) -> f64 {
        (12.0 + 3.0 * f64::from(self.theta.level + self.along.level)) * self.unit
    }

    /// Whether the node certainly starts on the facet, within the separation and round-off.
    pub(super) fn starts_in_contact(&self) -> bool {
        if self.theta.low > 0.0 {
            return false;
        }
        let mut along = 0.5;
        for _ in 0..4 {
            let [f, slope] = self.at_start(along);
            let step = f.dot(&slope) / slope.dot(&slope);
            along = if step.is_finite() { (along - step).clamp(0.0, 1.0) } else { along };
        }
        self.at_start(along)[0].norm() <= self.separation + 4.0 * self.error()
    }

    /// Difference f at θ = 0, and its derivative along the curve.
    fn at_start(&self, along: f64) -> [Vector<2>; 2] {
        let c = &self.coefficients[0];
        let between = |a: Vector<2>, b: Vector<2>| a * (1.0 - along) + b * along;
        let [d0, d1, d2] = [between(c[0], c[1]), between(c[1], c[2]), between(c[2], c[3])];
        let [e0, e1] = [between(d0, d1), between(d1, d2)];
        [between(e0, e1), (e1 - e0) * 3.0]
    }

    /// Whether the node moves to the outer side, the right of the curve, wherever it meets the
    /// curve: n·∂f/∂θ > 0, because all products of coefficients of n and of ∂f/∂θ are positive.
    /// The curve's tangent is −∂f/∂ξ. f is then also injective: between two points of the box its
    /// mean derivatives are means of these coefficients, and hence independent vectors.
    pub(super) fn only_separates(&self) -> bool {
        let [before, now] = &self.coefficients;
        let error = 2.0 * self.error();
        for c in &self.coefficients {
            for a in 0..3 {
                let normal = (c[a] - c[a + 1]).turned_right();
                for b in 0..4 {
                    let motion = now[b] - before[b];
                    let sizes = sum_of(normal) + sum_of(motion);
                    let slack = error * (sizes + 2.0 * error)
                        + 4.0 * UNIT_ROUNDOFF * sum_of(normal) * sum_of(motion)
                        + f64::MIN_POSITIVE;
                    // A NaN is no proof.
                    let outwards = normal.dot(&motion) > slack;
                    if !outwards {
                        return false;
                    }
                }
            }
        }
        true
    }

    /// Whether a direction separates the coefficients from zero by more than the separation and
    /// round-off.
    #[inline]
    fn separates(&self, coefficients: &[Vector<2>], direction: &Vector<2>) -> bool {
        excludes_zero(coefficients, direction, self.separation, self.error())
    }
}

impl Piece for CurvePath {
    fn theta(&self) -> f64 {
        self.theta.low
    }

    fn level(&self) -> u32 {
        self.theta.level + self.along.level
    }

    fn place(&self) -> f64 {
        self.along.low
    }

    /// Whether a direction separates the node from the curve: tries those in which the box is thin,
    /// or its centre far: perpendicular to the curve, along it, perpendicular to the motion, and
    /// from the curve to the node.
    #[inline]
    fn is_clear(&self) -> bool {
        let [before, now] = &self.coefficients;
        let all = self.coefficients.as_flattened();
        let chord = (before[3] - before[0]) + (now[3] - now[0]);
        if self.separates(all, &chord.turned_right()) {
            return true;
        }
        let centre = (before[0] + before[3]) + (now[0] + now[3]);
        let motion = (now[0] - before[0]) + (now[3] - before[3]);
        [chord, centre, motion.turned_right()].iter().any(|a| self.separates(all, a))
    }
}

/// Whether all points with these coefficients, which are wrong by up to `error` per component, are
/// farther than `separation` from zero, because they lie on one side of it in a direction.
#[inline]
pub(super) fn excludes_zero<const D: usize>(
    coefficients: &[Vector<D>],
    direction: &Vector<D>,
    separation: f64,
    error: f64,
) -> bool {
    let slack = separation * direction.norm() * (1.0 + 4.0 * f64::EPSILON)
        + error * sum_of(*direction)
        + f64::MIN_POSITIVE;
    // Most directions fail at one of the first points. A NaN is no proof.
    let Some(first) = coefficients.first().map(|c| direction.dot(c)) else { return false };
    if first > slack {
        coefficients.iter().all(|c| direction.dot(c) > slack)
    } else {
        first < -slack && coefficients.iter().all(|c| direction.dot(c) < -slack)
    }
}

/// Bernstein coefficients of degree 3 of a curve from its nodal values, whose largest component is
/// recorded.
#[inline]
fn cubic(shape: FacetShape, at: impl Fn(usize) -> Vector<2>, largest: &mut f64) -> Curve {
    const THIRD: f64 = 1.0 / 3.0;
    const SIXTH: f64 = 1.0 / 6.0;
    let mut value = |a: usize| {
        let x = at(a);
        // A NaN must not be lost, as it is by `max`.
        let size = x[0].abs() + x[1].abs();
        *largest = if size > *largest || size.is_nan() { size } else { *largest };
        x
    };
    match shape.degree() {
        0 => [value(0); 4],
        1 => {
            let a = value(0);
            let b = value(1);
            [a, a * (2.0 * THIRD) + b * THIRD, a * THIRD + b * (2.0 * THIRD), b]
        }
        2 => {
            let a = value(0);
            let b = value(1);
            let c = value(2);
            let third = THIRD;
            let c = c * (4.0 * THIRD);
            [a, c - b * third, c - a * third, b]
        }
        _ => {
            let a = value(0);
            let b = value(1);
            let c = value(2);
            let d = value(3);
            [
                a,
                a * (-5.0 * SIXTH) + b * (2.0 * SIXTH) + c * 3.0 - d * 1.5,
                a * (2.0 * SIXTH) - b * (5.0 * SIXTH) - c * 1.5 + d * 3.0,
                b,
            ]
        }
    }
}

pub(super) fn mean<const D: usize>(a: Vector<D>, b: Vector<D>) -> Vector<D> {
    (a + b) * 0.5
}

pub(super) fn largest_of<const D: usize>(a: Vector<D>) -> f64 {
    a.0.iter().fold(0.0, |most: f64, x| most.max(x.abs()))
}

pub(super) fn sum_of<const D: usize>(a: Vector<D>) -> f64 {
    a.0.iter().map(|x| x.abs()).sum()
}
