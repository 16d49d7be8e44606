//! Gap of a point to a rigid obstacle, with its derivatives by the point and the nodes that carry
//! the obstacle (`carrier.rs`).
//!
//! With the signed distance G(p) of the shape, n = ∇G and H = ∇²G, the place p of the point x in
//! the coordinates of the shape, and γ = (1, −w₁, −w₂, …) over the point and the carrier,
//!
//! ```text
//! g = G(p)      δp = F⁻¹ r,   r = Σ γ_k δy_k      ∂g/∂y_k = γ_k N,   N = F⁻ᵀ n
//! ∂²g/∂y_k∂y_l = γ_k γ_l F⁻ᵀ H F⁻¹ − N ⊗ Ω_k γ_l − γ_k Ω_l ⊗ N      Ω_a = F⁻ᵀ ω_a of the carrier, 0 of the point
//! ```
//!
//! The rows of the slip are γ_k τ of every tangent τ ⊥ N, so that it is zero for every rigid motion
//! of point and obstacle: weights at the middle of a step are those of its ends. With m = N/|N|,
//!
//! ```text
//! ∂(γ_k τ)/∂y_l = −γ_k m ⊗ (γ_l F⁻ᵀ H F⁻¹ τ − (τ·Ω_l) N)/|N| − τ ⊗ Ω_k γ_l
//! ```

use super::near::{Near, Point, dot};
use crate::kinematics::carrier::Local;

/// Gap of a point to a piece of an obstacle.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ObstacleGap {
    /// Gap g.
    pub(crate) distance: f64,
    near: Near,
    local: Local,
    /// Gradient N by the point.
    normal: Point,
    /// Number of the point and the carrying nodes.
    pub(crate) count: usize,
}

impl ObstacleGap {
    /// The gap of a point at a distance `near` from a shape that these nodes carry.
    pub(crate) fn new(near: Near, local: Local, carriers: &[usize]) -> Self {
        let normal = local.forth(near.normal);
        Self { distance: near.gap, near, local, normal, count: 1 + carriers.len() }
    }

    /// Direction of the normal.
    pub(crate) fn direction(&self) -> Point {
        unit(self.normal)
    }

    /// The tangent in the plane: the normal rotated left by 90°.
    pub(crate) fn tangent(&self) -> Point {
        let n = self.direction();
        [-n[1], n[0], 0.0]
    }

    /// Weight γ_k of the point, 0, or of a carrying node.
    fn factor(&self, k: usize) -> f64 {
        if k == 0 { 1.0 } else { -self.local.weights[k - 1] }
    }

    /// Spatial gradient Ω_k of the weight of the point, 0, or of a carrying node.
    fn slope(&self, k: usize) -> Point {
        if k == 0 { [0.0; 3] } else { self.local.slope(k - 1) }
    }

    /// Gradient of the gap: for the point, then for the carrying nodes.
    pub(crate) fn gradient(&self) -> impl Iterator<Item = Point> + '_ {
        self.row(self.normal)
    }

    /// Vectors γ_k v: for the point, then for the carrying nodes.
    pub(crate) fn row(&self, v: Point) -> impl Iterator<Item = Point> + '_ {
        (0..self.count).map(move |k| v.map(|x| self.factor(k) * x))
    }

    /// Second derivative of the gap: overwrites the first `(count·d)²` entries of a matrix over the
    /// point and the carrying nodes, `d` components each, row-major.
    pub(crate) fn curvature_into(&self, d: usize, curvature: &mut [f64]) {
        let Self { near: Near { normal, bend, straight, .. }, local, normal: n, .. } = *self;
        let bent = |k: usize, i: usize| {
            let same = if i == k { 1.0 } else { 0.0 };
            bend * (same - (normal[i] * normal[k] + straight[i] * straight[k]))
        };
        // F⁻ᵀ H F⁻¹ by columns.
        let unit = |j: usize| -> Point { std::array::from_fn(|i| if i == j { 1.0 } else { 0.0 }) };
        let column = |j: usize| {
            let back = local.back(unit(j));
            local.forth(std::array::from_fn(|i| (0..3).map(|k| bent(k, i) * back[k]).sum()))
        };
        let shape = [column(0), column(1), column(2)];
        self.fill(d, curvature, |[k, l], [i, j]| {
            let turns = n[i] * self.slope(k)[j] * self.factor(l) + self.factor(k) * self.slope(l)[i] * n[j];
            self.factor(k) * self.factor(l) * shape[j][i] - turns
        });
    }

    /// Derivative of the row of the slip along a tangent: a matrix as of
    /// [`curvature_into`](Self::curvature_into), not symmetric.
    pub(crate) fn slip_derivative_into(&self, d: usize, along: Point, matrix: &mut [f64]) {
        let size = dot(self.normal, self.normal).sqrt();
        let bent = self.local.forth(self.near.bent(self.local.back(along)));
        self.fill(d, matrix, |[k, l], [i, j]| {
            let turned = (self.factor(l) * bent[j] - dot(along, self.slope(l)) * self.normal[j]) / size;
            -self.factor(k) * self.normal[i] / size * turned - along[i] * self.slope(k)[j] * self.factor(l)
        });
    }

    /// Overwrites a matrix over the point and the carrying nodes with `entry([k, l], [i, j])` for
    /// nodes k, l and axes i, j.
    fn fill(&self, d: usize, matrix: &mut [f64], entry: impl Fn([usize; 2], [usize; 2]) -> f64) {
        let size = self.count * d;
        for (row, values) in matrix[..size * size].chunks_exact_mut(size).enumerate() {
            for (column, value) in values.iter_mut().enumerate() {
                *value = entry([row / d, column / d], [row % d, column % d]);
            }
        }
    }
}

/// A vector scaled to length one; unchanged bitwise if it has that length to round-off.
fn unit(v: Point) -> Point {
    let size = dot(v, v).sqrt();
    if (size - 1.0).abs() <= f64::EPSILON { v } else { v.map(|x| x / size) }
}
