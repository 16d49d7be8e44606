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
//! With ∂e = −(e·∂n) n, as the tangent turns with the normal (`../tangents.rs`),
//!
//! ```text
//! ∂H = w e ∂ξ_i′ − w n (e·∂n) − (e·∂n) ∂g
//! ```
//!
//! without −g e·∂²n: exact where the edges touch.

use carom_algebra::{Mat, Vector};
use carom_solid::shape::{LineShape, line_shape};

use super::patch::{cross, place};
use crate::constants::{ROUND_OFF, WANDER_XI};

/// Largest number of steps of Newton's method for closest points; straight edges need two.
const STEPS: usize = 40;
/// Change of ξ in a step of Newton's method that is round-off; a larger one that no longer becomes
/// smaller from step to step is round-off, too.
const LAST_DIGITS: f64 = 4e-15;
/// Sine of the angle between edges below which they run along each other.
const ALONG: f64 = 1e-3;

/// Position of a line at one of its points, with derivatives, relative to a place near it:
/// differences are exact there, however far from the origin.
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

/// Gap between two edges A and B at their closest points, with its derivatives.
#[derive(Clone, Copy, Debug)]
pub(super) struct EdgeGap {
    counts: [usize; 2],
    shapes: [LineShape; 2],
    /// Place relative to which the positions of both lines are given.
    from: Vector<3>,
    lines: [LinePoint; 2],
    /// Coordinates of the closest points: ξ on A and η on B.
    pub(super) xi: [f64; 2],
    /// Unit normal n out of the body of B.
    pub(super) normal: Vector<3>,
    /// Gap g along the normal.
    pub(super) distance: f64,
}

impl EdgeGap {
    /// Closest points of two edges A and B, given by their nodes, ends first, by Newton's method
    /// from `start`; the normal has a positive part along `outwards`. None if the edges run along
    /// each other, or the method does not converge.
    pub(super) fn closest(
        nodes: [&[usize]; 2],
        start: [f64; 2],
        y: &[f64],
        outwards: Vector<3>,
    ) -> Option<Self> {
        let mut xi = start;
        let mut last = f64::INFINITY;
        let from = place(y, nodes[0][0]);
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
            if length <= LAST_DIGITS || length <= ROUND_OFF && length >= last {
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
            if xi.iter().any(|xi| xi.abs() > WANDER_XI) {
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

    /// Position of the closest point on edge A (`of` = 0) or B (1).
    pub(super) fn point(&self, of: usize) -> Vector<3> {
        self.from + self.lines[of].position
    }

    /// Unit tangent of edge A (`of` = 0) or B (1) at its closest point.
    pub(super) fn tangent(&self, of: usize) -> Vector<3> {
        let tangent = self.lines[of].tangent;
        tangent * tangent.norm().recip()
    }

    /// Number of nodes of both edges.
    fn count(&self) -> usize {
        self.counts[0] + self.counts[1]
    }

    /// The edge to which the p-th node of the row belongs, the number of the node on that edge, and
    /// the sign of its weights.
    fn node(&self, p: usize) -> (usize, usize, f64) {
        if p < self.counts[0] { (0, p, 1.0) } else { (1, p - self.counts[0], -1.0) }
    }

    /// Weight w of the p-th node of the row in r = x_A(ξ) − x_B(η).
    fn weight(&self, p: usize) -> f64 {
        let (edge, k, sign) = self.node(p);
        sign * self.shapes[edge].values[k]
    }

    /// Gradient ∂g/∂y of the gap: for the nodes of A, then for those of B.
    pub(super) fn gradient(&self) -> impl Iterator<Item = Vector<3>> {
        (0..self.count()).map(|p| self.normal * self.weight(p))
    }

    /// Derivatives of the coordinates (ξ, η) and of the normal n by the k-th component of the q-th
    /// node of the row.
    fn changes(&self, q: usize, k: usize) -> ([f64; 2], Vector<3>) {
        let (edge, node, _) = self.node(q);
        let n = self.normal;
        let g = self.distance;
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

    /// Second derivative ∂²g/∂y∂y of the gap by all nodes: overwrites the first (3 count)² entries,
    /// row-major.
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

    /// Row H of the slip along a tangent: for the nodes of A, then for those of B.
    pub(super) fn slip(&self, along: Vector<3>) -> impl Iterator<Item = Vector<3>> {
        (0..self.count()).map(move |q| {
            let turned = Vector([0, 1, 2].map(|k| self.changes(q, k).1.dot(&along)));
            along * self.weight(q) + turned * -self.distance
        })
    }

    /// Derivative ∂H/∂y of the row of the slip along a tangent by all nodes: overwrites the first
    /// (3 count)² entries, row-major.
    pub(super) fn slip_derivative_into(&self, along: Vector<3>, matrix: &mut [f64]) {
        let size = 3 * self.count();
        let dofs = || (0..self.count()).flat_map(|q| (0..3).map(move |k| (q, k)));
        let changes: Vec<([f64; 2], f64)> = dofs()
            .map(|(q, k)| {
                let (xi, turned) = self.changes(q, k);
                (xi, turned.dot(&along))
            })
            .collect();
        for (column, (q, k)) in dofs().enumerate() {
            let (xi, turn) = changes[column];
            let opened = self.weight(q) * self.normal[k];
            for (row, (p, i)) in dofs().enumerate() {
                let (edge, node, sign) = self.node(p);
                let moved = sign * self.shapes[edge].first[node] * xi[edge] * along[i];
                let tilted = self.weight(p) * self.normal[i] * turn;
                matrix[row * size + column] = moved - tilted - changes[row].1 * opened;
            }
        }
    }
}
