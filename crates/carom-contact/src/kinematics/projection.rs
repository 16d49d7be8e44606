//! Closest point of a curved facet: ξ with (y_N − y_S(ξ))·y_S'(ξ) = 0, a minimum of the distance
//! (book, "The gap and its derivatives").
//!
//! The derivative of −(y_N − y_S)·t is a = J² − (y_N − y_S)·y_S''; a > 0 marks a minimum.

use carom_algebra::Vector;
use carom_solid::{FacetShape, line_powers};

use crate::places::Places;

/// A facet in the plane: its shape, its nodes, and the sign of its normal if it is a point.
#[derive(Clone, Copy)]
pub struct Facet<'a> {
    pub shape: FacetShape,
    pub nodes: &'a [usize],
    pub orientation: f64,
}

/// Position of a facet in the plane at ξ, with its first two derivatives and its unit normal.
#[derive(Clone, Copy, Debug)]
pub struct FacetPoint {
    pub position: Vector<2>,
    pub tangent: Vector<2>,
    pub second: Vector<2>,
    pub normal: Vector<2>,
    /// Length of the derivative of the position by ξ; 1 for a point.
    pub measure: f64,
}

/// A facet relative to a place, by powers of ξ: cheap at many ξ.
#[derive(Clone, Copy)]
pub(crate) struct Curve {
    powers: [Vector<2>; 4],
}

impl Curve {
    /// Position relative to the place.
    pub(crate) fn position(&self, xi: f64) -> Vector<2> {
        let [p, q, r, s] = self.powers;
        p + (q + (r + s * xi) * xi) * xi
    }

    /// Derivative of the position by ξ.
    pub(crate) fn tangent(&self, xi: f64) -> Vector<2> {
        let [_, q, r, s] = self.powers;
        q + (r * 2.0 + s * (3.0 * xi)) * xi
    }

    /// Second derivative of the position by ξ.
    fn second(&self, xi: f64) -> Vector<2> {
        let [_, _, r, s] = self.powers;
        r * 2.0 + s * (6.0 * xi)
    }

    /// First and second derivative by ξ of half the squared distance from the place.
    fn distance_slope(&self, xi: f64) -> (f64, f64) {
        let position = self.position(xi);
        let tangent = self.tangent(xi);
        (position.dot(&tangent), tangent.dot(&tangent) + position.dot(&self.second(xi)))
    }
}

impl Facet<'_> {
    /// The facet relative to a place.
    pub(crate) fn curve(&self, from: Vector<2>, y: Places) -> Curve {
        let mut places = [Vector::ZERO; 4];
        places.iter_mut().zip(self.nodes).for_each(|(place, &node)| *place = y.at(node) - from);
        Curve { powers: line_powers(&places[..self.nodes.len()]) }
    }

    /// Position at ξ alone.
    pub(crate) fn position(&self, y: Places, xi: f64) -> Vector<2> {
        let first = y.at(self.nodes[0]);
        first + self.curve(first, y).position(xi)
    }

    /// Derivative of the position by ξ.
    pub(crate) fn tangent(&self, y: Places, xi: f64) -> Vector<2> {
        self.curve(y.at(self.nodes[0]), y).tangent(xi)
    }

    /// Coordinate ξ of one of its nodes: both ends come first.
    pub(crate) fn coordinate(&self, place: usize) -> f64 {
        match place {
            0 => -1.0,
            1 => 1.0,
            _ => -1.0 + 2.0 * (place - 1) as f64 / (self.nodes.len() - 1) as f64,
        }
    }

    /// Position of the facet at ξ, with its derivatives.
    pub fn at(&self, y: Places, xi: f64) -> FacetPoint {
        self.seen_from(Vector::ZERO, y, xi)
    }

    /// Position of the facet at ξ relative to a place, with its derivatives. Near a facet these are
    /// exact differences, however far from the origin both are.
    pub(crate) fn seen_from(&self, from: Vector<2>, y: Places, xi: f64) -> FacetPoint {
        let shape = self.shape.at(xi);
        let mut position = Vector::ZERO;
        let mut tangent = Vector::ZERO;
        let mut second = Vector::ZERO;
        for (k, &n) in self.nodes.iter().enumerate() {
            let x = y.at(n) - from;
            position += x * shape.values[k];
            tangent += x * shape.first[k];
            second += x * shape.second[k];
        }
        let normal = Vector(self.shape.normal(tangent.0, self.orientation));
        let measure = normal.norm();
        FacetPoint { position, tangent, second, normal: normal * measure.recip(), measure }
    }

    /// Whether the facet is a point, which has no coordinate and is its own closest point.
    fn is_point(&self) -> bool {
        self.shape == FacetShape::Point
    }

    /// Coordinate ξ of the closest point by Newton's method from a good guess; `None` if it does
    /// not converge to a minimum within |ξ| ≤ `reach`.
    pub fn closest_from(&self, y: Places, from: Vector<2>, start: f64, reach: f64) -> Option<f64> {
        if self.is_point() {
            return Some(0.0);
        }
        let curve = self.curve(from, y);
        let mut xi = start;
        for _ in 0..40 {
            let (slope, a) = curve.distance_slope(xi);
            if a <= 0.0 || !a.is_finite() {
                return None;
            }
            let step = (-slope / a).clamp(-0.5, 0.5);
            xi += step;
            if xi.abs() > reach {
                return None;
            }
            // Below the second bound, round-off, a step has no effect.
            if step.abs() <= 1e-15 * (1.0 + xi.abs()) || step.abs() <= 4e-15 {
                return Some(xi);
            }
        }
        None
    }

    /// Coordinate ξ of the closest stationary point within |ξ| ≤ `reach`, by sampling and
    /// refinement; `None` if the distance decreases towards an end.
    pub fn closest_point(&self, y: Places, from: Vector<2>, reach: f64) -> Option<f64> {
        const SAMPLES: usize = 12;
        if self.is_point() {
            return Some(0.0);
        }
        let at = |k: usize| reach * (2.0 * k as f64 / SAMPLES as f64 - 1.0);
        let curve = self.curve(from, y);
        let slope_at = |xi: f64| curve.position(xi).dot(&curve.tangent(xi));
        let mut best: Option<(f64, f64)> = None;
        let mut last = slope_at(at(0));
        for k in 1..=SAMPLES {
            let slope = slope_at(at(k));
            if last <= 0.0 && slope > 0.0 {
                let low = at(k - 1);
                let high = at(k);
                let xi = bisected(low, high, 0.5 * (low + high), |xi| curve.distance_slope(xi));
                let distance = curve.position(xi).norm();
                if best.is_none_or(|(d, _)| distance < d) {
                    best = Some((distance, xi));
                }
            }
            last = slope;
        }
        best.map(|(_, xi)| xi)
    }
}

/// Root of a function in [low, high], where it changes sign from − to +, by Newton's method from a
/// start, guarded by bisection; `slope` returns the function and its derivative.
pub(super) fn bisected(mut low: f64, mut high: f64, start: f64, slope: impl Fn(f64) -> (f64, f64)) -> f64 {
    let mut xi = start;
    for _ in 0..60 {
        let (value, a) = slope(xi);
        if value <= 0.0 {
            low = xi;
        } else {
            high = xi;
        }
        let newton = xi - value / a;
        let next = if a > 0.0 && newton > low && newton < high { newton } else { 0.5 * (low + high) };
        if (next - xi).abs() <= 1e-15 {
            return next;
        }
        xi = next;
    }
    xi
}
