//! A curved facet in space and its point closest to a given one: ξ with d·τ_α = 0, d = x − y(ξ),
//! τ_α = ∂y/∂ξ_α, a minimum of the distance.
//!
//! The derivative of −d·τ_α by ξ_β is A_αβ = τ_α·τ_β − d·∂²y/∂ξ_α∂ξ_β; A > 0 marks a minimum.

use carom_algebra::{Mat, Vector};
use carom_solid::shape::line_shape;
use carom_solid::{FacetShape, Net, longest_edge};

use crate::constants::NEAR_FACET;
use crate::kinematics::projection::bisected;

/// Position of a node in space, from positions flat over all nodes.
pub fn place(y: &[f64], node: usize) -> Vector<3> {
    Vector([y[3 * node], y[3 * node + 1], y[3 * node + 2]])
}

/// a × b.
pub fn cross(a: Vector<3>, b: Vector<3>) -> Vector<3> {
    Vector([a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]])
}

/// A curved facet in space: its shape and its nodes, counter-clockwise seen from outside.
#[derive(Clone, Copy)]
pub struct Patch<'a> {
    pub shape: FacetShape,
    pub nodes: &'a [usize],
}

/// Position of a facet in space at ξ, with its derivatives and its normal.
#[derive(Clone, Copy, Debug)]
pub struct PatchPoint {
    pub position: Vector<3>,
    pub tangents: [Vector<3>; 2],
    /// Second derivatives of the position by ξξ, ξη and ηη.
    pub second: [Vector<3>; 3],
    /// Outward unit normal of the facet.
    pub normal: Vector<3>,
}

/// The point of a facet, with its edges and corners, nearest to a given point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Nearest {
    pub xi: [f64; 2],
    pub at: Feature,
    pub distance: f64,
}

/// Part of a facet on which a point lies: its inside, an edge or a corner.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Feature {
    Inside,
    /// The edge from the corner with this number to the next one.
    Edge(usize),
    Corner(usize),
}

/// Largest number of steps of Newton's method for a closest point; it needs fewer than ten from any
/// good guess.
const STEPS: usize = 40;

impl PatchPoint {
    /// Metric τ_α·τ_β of the tangents.
    pub(crate) fn metric(&self) -> Mat<2> {
        let [t, s] = &self.tangents;
        Mat([[t.dot(t), t.dot(s)], [t.dot(s), s.dot(s)]])
    }

    /// Second derivatives of the position along a vector, v·∂²y/∂ξ_α∂ξ_β.
    pub(crate) fn bend(&self, v: Vector<3>) -> Mat<2> {
        let [a, b, c] = self.second.map(|second| second.dot(&v));
        Mat([[a, b], [b, c]])
    }
}

/// Whether a symmetric matrix is positive definite.
pub(crate) fn is_positive(a: &Mat<2>) -> bool {
    a.0[0][0] > 0.0 && a.det() > 0.0
}

impl Patch<'_> {
    /// Number of corners of the facet.
    pub(crate) fn corners(&self) -> usize {
        self.shape.corners()
    }

    /// Coordinates ξ of a corner.
    pub(crate) fn corner(&self, corner: usize) -> [f64; 2] {
        match (self.corners(), corner) {
            (3, 0) => [0.0, 0.0],
            (3, 1) => [1.0, 0.0],
            (3, _) => [0.0, 1.0],
            (_, 0) => [-1.0, -1.0],
            (_, 1) => [1.0, -1.0],
            (_, 2) => [1.0, 1.0],
            _ => [-1.0, 1.0],
        }
    }

    /// Coordinates ξ of a point on an edge, between its first corner, s = 0, and the next one, s =
    /// 1.
    pub(crate) fn along(&self, edge: usize, s: f64) -> [f64; 2] {
        let [a, b] = [edge, (edge + 1) % self.corners()].map(|corner| self.corner(corner));
        std::array::from_fn(|i| a[i] + s * (b[i] - a[i]))
    }

    /// Distance of ξ past each edge, relative to the height of the facet; negative inside.
    pub(crate) fn beyond(&self, [x, y]: [f64; 2]) -> [f64; 4] {
        if self.corners() == 3 {
            [-y, x + y - 1.0, -x, f64::NEG_INFINITY]
        } else {
            [-1.0 - y, x - 1.0, y - 1.0, -1.0 - x].map(|excess| 0.5 * excess)
        }
    }

    /// Largest distance of ξ past an edge, relative to the height of the facet; negative inside.
    pub fn furthest(&self, xi: [f64; 2]) -> f64 {
        let [first, others @ ..] = self.beyond(xi);
        others.into_iter().fold(first, |most, beyond| if beyond > most { beyond } else { most })
    }

    /// Position of the facet at ξ, with its derivatives.
    pub fn at(&self, y: &[f64], xi: [f64; 2]) -> PatchPoint {
        self.seen_from(Vector::ZERO, y, xi)
    }

    /// Position of the facet at ξ relative to a place, with its derivatives. Near a facet these are
    /// exact differences, however far from the origin both are.
    pub(crate) fn seen_from(&self, from: Vector<3>, y: &[f64], xi: [f64; 2]) -> PatchPoint {
        let functions = self.shape.functions(xi);
        let second = self.shape.second(xi);
        let mut at = PatchPoint {
            position: Vector::ZERO,
            tangents: [Vector::ZERO; 2],
            second: [Vector::ZERO; 3],
            normal: Vector::ZERO,
        };
        for (k, &node) in self.nodes.iter().enumerate() {
            let x = place(y, node) - from;
            at.position += x * functions.values[k];
            (0..2).for_each(|i| at.tangents[i] += x * functions.slopes[i][k]);
            (0..3).for_each(|i| at.second[i] += x * second[i][k]);
        }
        let normal = cross(at.tangents[0], at.tangents[1]);
        at.normal = normal * normal.norm().recip();
        at
    }

    /// Position of the facet at ξ relative to a place.
    fn offset(&self, from: Vector<3>, y: &[f64], xi: [f64; 2]) -> Vector<3> {
        let values = self.shape.functions(xi).values;
        let nodes = self.nodes.iter().zip(values);
        nodes.fold(Vector::ZERO, |sum, (&n, value)| sum + (place(y, n) - from) * value)
    }

    /// Length of the facet: that of its longest edge.
    pub(crate) fn length(&self, y: &[f64]) -> f64 {
        longest_edge(self.nodes, y, 3)
    }

    /// Coordinates of the closest point by Newton's method from a good guess, on the facet and its
    /// extension by `reach` of its height; `None` if it does not converge to a minimum there.
    pub(crate) fn closest_from(
        &self,
        y: &[f64],
        from: Vector<3>,
        start: [f64; 2],
        reach: f64,
    ) -> Option<[f64; 2]> {
        let mut xi = start;
        for _ in 0..STEPS {
            let at = self.seen_from(from, y, xi);
            let d = -at.position;
            let a = at.metric() - at.bend(d);
            if !is_positive(&a) {
                return None;
            }
            let slope = Vector(at.tangents.map(|tangent| d.dot(&tangent)));
            let mut step = a.inverse().apply(&slope);
            let length = step[0].abs().max(step[1].abs());
            if !length.is_finite() {
                return None;
            }
            if length > 0.5 {
                step = step * (0.5 / length);
            }
            xi = [xi[0] + step[0], xi[1] + step[1]];
            if self.furthest(xi) > reach {
                return None;
            }
            // Below this, round-off, a step has no effect.
            if length <= 4e-15 {
                return Some(xi);
            }
        }
        None
    }

    /// Coordinates of the closest stationary point on the facet and its extension by `reach` of its
    /// height; `None` if the distance decreases towards an edge.
    pub(crate) fn closest_point(&self, y: &[f64], from: Vector<3>, reach: f64) -> Option<[f64; 2]> {
        self.closest_from(y, from, self.nearest_sample(y, from), reach)
    }

    fn nearest_sample(&self, y: &[f64], from: Vector<3>) -> [f64; 2] {
        let mut best = ([0.0; 2], f64::INFINITY);
        let mut nodes = [Vector::ZERO; Net::POINTS];
        nodes.iter_mut().zip(self.nodes).for_each(|(x, &node)| *x = place(y, node) - from);
        for (xi, values) in self.shape.samples() {
            let terms = nodes[..self.nodes.len()].iter().zip(values);
            let d = terms.fold(Vector::ZERO, |sum, (x, value)| sum + *x * *value);
            let square = d.dot(&d);
            if square < best.1 {
                best = (*xi, square);
            }
        }
        best.0
    }

    /// The nearest point of the facet with its edges and corners.
    pub fn nearest(&self, y: &[f64], from: Vector<3>) -> Nearest {
        let distance = |xi: [f64; 2]| self.offset(from, y, xi).norm();
        // On the way to a point beside an edge, Newton's method may pass it.
        let inside = self.closest_point(y, from, NEAR_FACET).filter(|&xi| self.furthest(xi) <= 0.0);
        let inside = inside.map(|xi| Nearest { xi, at: Feature::Inside, distance: distance(xi) });
        let mut nearest = inside;
        for edge in 0..self.corners() {
            if nearest.is_some_and(|nearest| nearest.distance < self.edge_bound(y, from, edge)) {
                continue;
            }
            let s = self.nearest_on_edge(y, from, edge);
            let xi = self.along(edge, s);
            let found = distance(xi);
            let at = match s {
                0.0 => Feature::Corner(edge),
                1.0 => Feature::Corner((edge + 1) % self.corners()),
                _ => Feature::Edge(edge),
            };
            if nearest.is_none_or(|nearest| found < nearest.distance) {
                nearest = Some(Nearest { xi, at, distance: found });
            }
        }
        nearest.unwrap_or(Nearest { xi: self.corner(0), at: Feature::Corner(0), distance: f64::INFINITY })
    }

    /// A lower bound of the distance of a point to an edge: the distance to the box around its
    /// nodes, grown by the excess of the curve through them, (Σ|φ| − 1)/2 ≤ 0.32 of its extents.
    fn edge_bound(&self, y: &[f64], from: Vector<3>, edge: usize) -> f64 {
        let (nodes, count) = self.shape.edge(edge);
        let mut square = 0.0;
        for i in 0..3 {
            let mut low = f64::INFINITY;
            let mut high = f64::NEG_INFINITY;
            for &node in &nodes[..count] {
                let x = y[3 * self.nodes[node] + i] - from[i];
                low = low.min(x);
                high = high.max(x);
            }
            let beyond = if count > 2 { 0.32 * (high - low) } else { 0.0 };
            let away = (low - beyond).max(-beyond - high).max(0.0);
            square += away * away;
        }
        square.sqrt()
    }

    /// Coordinate s of the nearest point of an edge: the best sample, refined between its
    /// neighbours by Newton's method guarded by bisection.
    pub(super) fn nearest_on_edge(&self, y: &[f64], from: Vector<3>, edge: usize) -> f64 {
        const PIECES: usize = 4;
        let (nodes, count) = self.shape.edge(edge);
        let slope = |s: f64| {
            let line = line_shape(count, 2.0 * s - 1.0);
            let mut d = Vector::ZERO;
            let mut first = Vector::ZERO;
            let mut second = Vector::ZERO;
            for (k, &node) in nodes[..count].iter().enumerate() {
                let x = place(y, self.nodes[node]) - from;
                d += x * -line.values[k];
                first += x * (2.0 * line.first[k]);
                second += x * (4.0 * line.second[k]);
            }
            (-d.dot(&first), first.dot(&first) - d.dot(&second), d.dot(&d))
        };
        let at = |k: usize| k as f64 / PIECES as f64;
        let best = (0..=PIECES)
            .map(|k| (k, slope(at(k)).2))
            .fold((0, f64::INFINITY), |best, sample| if sample.1 < best.1 { sample } else { best });
        let low = at(best.0.saturating_sub(1));
        let high = at((best.0 + 1).min(PIECES));
        if slope(low).0 >= 0.0 {
            return low;
        }
        if slope(high).0 <= 0.0 {
            return high;
        }
        bisected(low, high, at(best.0), |s| {
            let (first, second, _) = slope(s);
            (first, second)
        })
    }
}
