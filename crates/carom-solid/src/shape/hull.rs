//! Control points whose convex hull contains a curved line or cell: its map X(ξ) = Σ φᵃ Xᵃ in
//! Bernstein polynomials, which are ≥ 0 and sum to 1.
//!
//! The control point of k corners, possibly repeated, is the polar form of the map at them
//! (Ramshaw, Comput. Aided Geom. Design 6 (1989)):
//!
//! ```text
//! c(v₁ … vₖ) = 1/k! Σ (−1)ᵏ⁻ˢ sᵏ X(mean of S)    over all S ⊆ {1 … k} of s ≥ 1 corners
//! ```
//!
//! Lines: c = x₀, x₁, and of degree 2: 2x₂ − (x₀ + x₁)/2; of degree 3: (−5x₀ + 2x₁ + 18x₂ − 9x₃)/6,
//! (2x₀ − 5x₁ − 9x₂ + 18x₃)/6.

use carom_algebra::Vector;

use super::{Domain, Quad4, Quad9, Shape, Tri3, Tri6, Tri10, line_shape};
use crate::bounds::Bounds;
use crate::facet::FacetShape;

/// Control points of a line or a cell as weights of its nodes.
#[derive(Clone, Debug, PartialEq)]
pub struct Hull {
    nodes: usize,
    /// A row per control point.
    weights: Vec<f64>,
}

impl Hull {
    /// The hull of a cell of shape `S`; the corners of a simplex are its first nodes.
    #[must_use]
    pub fn of<const R: usize, const N: usize, S: Shape<R, N>>() -> Self {
        if S::Domain::TENSOR {
            return Self { nodes: N, weights: products(S::DEGREE, &S::NODES) };
        }
        let weights =
            control(S::DEGREE, &S::NODES[..=R], N, |xi, values| values.copy_from_slice(&S::values(xi)));
        Self { nodes: N, weights }
    }

    /// The hull of a line of 1 to 4 nodes on −`reach` ≤ ξ ≤ `reach`, extrapolated beyond 1.
    ///
    /// # Panics
    /// For any other number of nodes.
    ///
    /// ```
    /// let nodes = [[-1.0, 0.0], [1.0, 0.0], [0.0, 1.0]];
    /// // The tangents at the ends of the parabola meet at (0, 2).
    /// let bounds = carom_solid::Hull::line(3, 1.0).bounds(|node| &nodes[node]);
    /// assert_eq!(bounds.high(), [1.0, 2.0, 0.0]);
    /// ```
    #[must_use]
    pub fn line(nodes: usize, reach: f64) -> Self {
        let ends = [Vector([-reach]), Vector([reach])];
        let values =
            |xi: &Vector<1>, out: &mut [f64]| out.copy_from_slice(&line_shape(nodes, xi[0]).values[..nodes]);
        Self { nodes, weights: control(nodes - 1, &ends, nodes, values) }
    }

    /// The hull of a facet of any shape.
    #[must_use]
    pub fn facet(shape: FacetShape) -> Self {
        match shape {
            FacetShape::Point | FacetShape::L2 | FacetShape::L3 | FacetShape::L4 => {
                Self::line(shape.nodes(), 1.0)
            }
            FacetShape::T3 => Self::of::<2, 3, Tri3>(),
            FacetShape::T6 => Self::of::<2, 6, Tri6>(),
            FacetShape::T10 => Self::of::<2, 10, Tri10>(),
            FacetShape::Q4 => Self::of::<2, 4, Quad4>(),
            FacetShape::Q9 => Self::of::<2, 9, Quad9>(),
        }
    }

    /// Weights of the nodes in a control point.
    pub(crate) fn weights(&self, point: usize) -> &[f64] {
        &self.weights[point * self.nodes..(point + 1) * self.nodes]
    }

    /// The largest sum of absolute weights of a control point: it moves by at most this times the
    /// largest motion of a node.
    #[must_use]
    pub fn weight(&self) -> f64 {
        let rows = self.weights.chunks_exact(self.nodes);
        rows.map(|row| row.iter().map(|weight| weight.abs()).sum()).fold(0.0, f64::max)
    }

    /// Box around the control points, and hence around the whole line or cell, from the positions
    /// of its nodes. The caller adds a margin for round-off.
    #[must_use]
    pub fn bounds<'a, P: AsRef<[f64]> + ?Sized + 'a>(&self, position: impl Fn(usize) -> &'a P) -> Bounds {
        let mut bounds = Bounds::EMPTY;
        for weights in self.weights.chunks_exact(self.nodes) {
            let mut point = [0.0; 3];
            let mut dimension = 0;
            for (a, weight) in weights.iter().enumerate() {
                let x = position(a).as_ref();
                dimension = x.len();
                for i in 0..dimension {
                    point[i] += weight * x[i];
                }
            }
            bounds.add(&point[..dimension]);
        }
        bounds
    }
}

/// Rows of weights of the control points of a square or cube, the first axis fastest: products of
/// those of a line.
fn products<const R: usize, const N: usize>(degree: usize, nodes: &[Vector<R>; N]) -> Vec<f64> {
    let line = Hull::line(degree + 1, 1.0);
    // The nodes of a line are its ends, then the interior.
    let place = |xi: f64| match (0.5 * (xi + 1.0) * degree as f64).round() as usize {
        0 => 0,
        i if i == degree => 1,
        i => i + 1,
    };
    let mut rows = Vec::with_capacity(N * N);
    for code in 0..N {
        let along = |axis: usize| code / (degree + 1).pow(axis as u32) % (degree + 1);
        let weight = |node: &Vector<R>| {
            (0..R).map(|axis| line.weights(along(axis))[place(node[axis])]).product::<f64>()
        };
        rows.extend(nodes.iter().map(weight));
    }
    rows
}

/// Rows of weights of the control points of `degree` corners each, from the shape functions
/// `values(ξ, out)` of the nodes.
fn control<const R: usize>(
    degree: usize,
    corners: &[Vector<R>],
    nodes: usize,
    values: impl Fn(&Vector<R>, &mut [f64]),
) -> Vec<f64> {
    if degree == 0 {
        return vec![1.0];
    }
    let mut rows = Vec::new();
    let mut shape = vec![0.0; nodes];
    let factorial: usize = (1..=degree).product();
    for code in 0..corners.len().pow(degree as u32) {
        let chosen: Vec<_> =
            (0..degree).map(|k| code / corners.len().pow(k as u32) % corners.len()).collect();
        if !chosen.is_sorted() {
            continue;
        }
        let mut row = vec![0.0; nodes];
        for subset in 1_u32..1 << degree {
            let size = subset.count_ones() as usize;
            let mut sum = Vector::ZERO;
            (0..degree).filter(|k| subset >> k & 1 == 1).for_each(|k| sum += corners[chosen[k]]);
            values(&(sum * (1.0 / size as f64)), &mut shape);
            let sign = if (degree - size).is_multiple_of(2) { 1.0 } else { -1.0 };
            let weight = sign * size.pow(degree as u32) as f64 / factorial as f64;
            row.iter_mut().zip(&shape).for_each(|(row, shape)| *row += weight * shape);
        }
        rows.extend(row);
    }
    rows
}
