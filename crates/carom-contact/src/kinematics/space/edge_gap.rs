//! Gap between two edges in space that cross each other, at their closest points, with its
//! derivatives. With r = x_A(ξ) − x_B(η), tangents τ_A = x_A′, τ_B = x_B′, n = ± τ_A × τ_B/|τ_A ×
//! τ_B| out of the body of B, and the weights w of a node: φᵃ(ξ) on A, −φᵃ(η) on B,
//!
//! ```text
//! r·τ_A = r·τ_B = 0,   g = r·n,   ∇g = (w n)
//! ∂n = −Σ_i τⁱ (n·∂τ_i),   i = A, B;   τⁱ·τ_j = δ_ij in their plane
//! J ∂(ξ, η) = −(∂r·τ_A + g n·∂τ_A, ∂r·τ_B + g n·∂τ_B) at fixed ξ, η
//! J = [ τ_A·τ_A + g n·x_A″   −τ_A·τ_B ;   τ_A·τ_B   −τ_B·τ_B + g n·x_B″ ]
//! ∇²g = (w n ∂ξ_i)′ + w ∂n
//! ```
//!
//! The gap has no kink at zero: the equations hold on both sides of it. Edges that run along each
//! other have none.
//!
//! The slip along a unit tangent e has the row H = w e − g e·∂n, so that rigid motions have none.

use carom_algebra::{Mat, Vector};
use carom_solid::shape::{LineShape, line_shape};

use super::patch::{cross, place};

/// Steps of Newton's method; straight edges need two.
const STEPS: usize = 40;
/// Largest |ξ| before it has converged.
const WANDER: f64 = 5.0;
/// Change of ξ that is round-off, and the same where it no longer becomes smaller.
const ROUND_OFF: f64 = 4e-15;
const SETTLED: f64 = 1e-9;
/// Sine of the angle between edges below which they run along each other.
const ALONG: f64 = 1e-3;

/// A line at one of its points, relative to a place near it: differences are exact there, however
/// far from the origin.
#[derive(Clone, Copy, Debug)]
struct LinePoint {
    position: Vector<3>,
    tangent: Vector<3>,
    second: Vector<3>,
}

impl LinePoint {
    fn new(nodes: &[usize], shape: &LineShape, from: Vector<3>, y: &[f64]) -> Self {
        let mut at = Self { position: Vector::ZERO, tangent: Vector::ZERO, second: Vector::ZERO };
        for (k, &node) in nodes.iter().enumerate() {
            let x = place(y, node) - from;
            at.position += x * shape.values[k];
            at.tangent += x * shape.first[k];
            at.second += x * shape.second[k];
        }
        at
    }
}

/// Two edges at their closest points.
#[derive(Clone, Copy, Debug)]
pub(super) struct EdgeGap {
    counts: [usize; 2],
    shapes: [LineShape; 2],
    /// The place that the lines are relative to.
    from: Vector<3>,
    lines: [LinePoint; 2],
    /// ξ on A and η on B.
    pub(super) xi: [f64; 2],
    /// n.
    pub(super) normal: Vector<3>,
    /// g.
    pub(super) distance: f64,
}

impl EdgeGap {
    /// Newton's method from `start`, for the nodes of A and of B, ends first; n has a positive part
    /// along `outwards`. None if they run along each other, or it does not converge.
    pub(super) fn closest(
        nodes: [&[usize]; 2],
        start: [f64; 2],
        y: &[f64],
        outwards: Vector<3>,
    ) -> Option<Self> {
        let (mut xi, mut last, from) = (start, f64::INFINITY, place(y, nodes[0][0]));
        for _ in 0..STEPS {
            let shapes = [0, 1].map(|i| line_shape(nodes[i].len(), xi[i]));
            let lines = [0, 1].map(|i| LinePoint::new(nodes[i], &shapes[i], from, y));
            let r = lines[0].position - lines[1].position;
            let [a, b] = lines.map(|line| line.tangent);
            let slope = Mat([
                [a.dot(&a) + r.dot(&lines[0].second), -a.dot(&b)],
                [a.dot(&b), -b.dot(&b) + r.dot(&lines[1].second)],
            ]);
            let mut step = slope.inverse().apply(&Vector([-r.dot(&a), -r.dot(&b)]));
            let length = step[0].abs().max(step[1].abs());
            if !length.is_finite() {
                return None;
            }
            if length <= ROUND_OFF || length <= SETTLED && length >= last {
                let across = cross(a, b);
                let size = across.norm();
                if size <= ALONG * a.norm() * b.norm() {
                    return None;
                }
                let sign = if across.dot(&outwards) < 0.0 { -1.0 } else { 1.0 };
                let normal = across * (sign / size);
                let counts = nodes.map(<[usize]>::len);
                return Some(Self { counts, shapes, from, lines, xi, normal, distance: r.dot(&normal) });
            }
            last = length;
            if length > 1.0 {
                step = step * length.recip();
            }
            xi = [xi[0] + step[0], xi[1] + step[1]];
            if xi.iter().any(|xi| xi.abs() > WANDER) {
                return None;
            }
        }
        None
    }

    /// Sine of the angle between the edges.
    pub(super) fn sine(&self) -> f64 {
        let [a, b] = self.lines.map(|line| line.tangent);
        cross(a, b).norm() / (a.norm() * b.norm())
    }

    /// The closest point on A or on B.
    pub(super) fn point(&self, of: usize) -> Vector<3> {
        self.from + self.lines[of].position
    }

    /// The tangent of A or B, of length one.
    pub(super) fn tangent(&self, of: usize) -> Vector<3> {
        let tangent = self.lines[of].tangent;
        tangent * tangent.norm().recip()
    }

    /// Number of nodes of both.
    fn count(&self) -> usize {
        self.counts[0] + self.counts[1]
    }

    /// The edge to which a node of the row belongs, its number there, and the sign of its weights.
    fn node(&self, p: usize) -> (usize, usize, f64) {
        if p < self.counts[0] { (0, p, 1.0) } else { (1, p - self.counts[0], -1.0) }
    }

    /// w.
    fn weight(&self, p: usize) -> f64 {
        let (edge, k, sign) = self.node(p);
        sign * self.shapes[edge].values[k]
    }

    /// ∂g/∂y of the nodes of A and then of B.
    pub(super) fn gradient(&self) -> impl Iterator<Item = Vector<3>> {
        (0..self.count()).map(|p| self.normal * self.weight(p))
    }

    /// ∂(ξ, η) and ∂n with one component of a node.
    fn changes(&self, q: usize, k: usize) -> ([f64; 2], Vector<3>) {
        let (edge, node, _) = self.node(q);
        let (n, g) = (self.normal, self.distance);
        let [a, b] = self.lines.map(|line| line.tangent);
        let mut driven = Vector([a, b].map(|tangent| -self.weight(q) * tangent[k]));
        let stretched = self.shapes[edge].first[node] * n[k];
        driven[edge] -= g * stretched;
        let bends = self.lines.map(|line| n.dot(&line.second));
        let slope = Mat([[a.dot(&a) + g * bends[0], -a.dot(&b)], [a.dot(&b), -b.dot(&b) + g * bends[1]]]);
        let xi = slope.inverse().apply(&driven);
        let mut tilts = [bends[0] * xi[0], bends[1] * xi[1]];
        tilts[edge] += stretched;
        let metric = Mat([[a.dot(&a), a.dot(&b)], [a.dot(&b), b.dot(&b)]]).inverse();
        let raised = metric.apply(&Vector(tilts));
        (xi.0, a * -raised[0] + b * -raised[1])
    }

    /// ∂²g/∂y∂y of all nodes: overwrites the first (3 count)² entries, row-major.
    pub(super) fn curvature_into(&self, curvature: &mut [f64]) {
        let size = 3 * self.count();
        for (q, k) in (0..self.count()).flat_map(|q| (0..3).map(move |k| (q, k))) {
            let (xi, turned) = self.changes(q, k);
            for p in 0..self.count() {
                let (edge, node, sign) = self.node(p);
                let moved = sign * self.shapes[edge].first[node] * xi[edge];
                let change = self.normal * moved + turned * self.weight(p);
                (0..3).for_each(|i| curvature[(3 * p + i) * size + 3 * q + k] = change[i]);
            }
        }
    }

    /// H of a tangent, of the nodes of A and then of B.
    pub(super) fn slip(&self, along: Vector<3>) -> impl Iterator<Item = Vector<3>> {
        (0..self.count()).map(move |q| {
            let turned = Vector([0, 1, 2].map(|k| self.changes(q, k).1.dot(&along)));
            along * self.weight(q) + turned * -self.distance
        })
    }
}
