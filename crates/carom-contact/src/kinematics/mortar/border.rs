//! The place on a secondary facet at which the primary side ends, and its motion. Over a facet of
//! the primary that ends at v with the unit tangent t, the integral of a weighted gap ends at ξ,
//!
//! ```text
//! (x(ξ) − v)·t = 0,    ∂ξ = −((∂x − ∂v)·t + (x − v)·∂T/|T|) / (x'·t),    T = |T| t = Σ_l N_l' y_l
//! ```
//!
//! where ∂x is that at a fixed ξ. In a plane of symmetry t is the normal of the plane, which does
//! not turn: ∂T = 0. With the gap there, its motion adds g ∂ξ to the gradient of the integral, with
//! a negative sign where the primary begins. Without it, forces would have no potential where
//! bodies overhang, and with springs they would create energy. The second derivative
//!
//! ```text
//! ∂ξ ⊗ ∇g + ∇g ⊗ ∂ξ + g' ∂ξ ⊗ ∂ξ + g ∂²ξ,    g' = ∇_x g·x',
//! ```
//!
//! which only Newton's method uses, leaves out ∂²ξ, and ∇g if it is by other nodes than ∂ξ.

use carom_algebra::Vector;
use carom_solid::LineShape;

use crate::kinematics::projection::FacetPoint;

/// Most vectors on which the place depends: the point and the nodes of a facet.
pub(super) const MOST: usize = 5;

/// The gap that enters the integral at a border, with the derivatives of the border's place.
#[derive(Clone, Copy, Debug)]
pub(super) struct Border {
    /// Gradient ∂ξ by the point and the nodes of the facet.
    slopes: [Vector<2>; MOST],
    pub(super) count: usize,
    /// Jump of the weighted gap over the border, and of the weight.
    jumps: [f64; 2],
    /// Gradient of the former, if it is by the same nodes, and its derivative by ξ.
    of_jump: [Vector<2>; MOST],
    rate: f64,
}

/// The end of a facet of the primary.
pub(super) struct End<'a> {
    pub(super) place: Vector<2>,
    /// Unit normal of the border: the tangent t of the facet, or the normal of a plane of symmetry.
    pub(super) along: Vector<2>,
    /// 1/|T|; zero in a plane of symmetry.
    pub(super) turns: f64,
    pub(super) shape: &'a LineShape,
    pub(super) nodes: usize,
}

impl Border {
    /// The border at a point of the secondary side over an end of the primary; none where the
    /// secondary side runs along the line on which it lies. `jumps`: that of the weighted gap, and
    /// that of the weight; `of_jump`: gradient of the former.
    pub(super) fn new(
        point: &FacetPoint,
        end: &End,
        jumps: [f64; 2],
        of_jump: [Vector<2>; MOST],
    ) -> Option<Self> {
        let along = end.along;
        let rate = point.tangent.dot(&along);
        if rate == 0.0 {
            return None;
        }
        let across = (point.position - end.place) * end.turns;
        let mut slopes = [Vector::ZERO; MOST];
        slopes[0] = along * -rate.recip();
        for node in 0..end.nodes {
            let of_node = along * end.shape.values[node] - across * end.shape.first[node];
            slopes[1 + node] = of_node * rate.recip();
        }
        let rate = of_jump[0].dot(&point.tangent);
        Some(Self { slopes, count: 1 + end.nodes, jumps, of_jump, rate })
    }

    /// Calls a function with the gradients of the integral by the point and the nodes of the
    /// facet; `kept`: an initial depth by which gaps are larger.
    pub(super) fn gradient(&self, kept: f64, mut of: impl FnMut(usize, Vector<2>)) {
        let jump = self.jumps[0] + kept * self.jumps[1];
        (0..self.count).for_each(|p| of(p, self.slopes[p] * jump));
    }

    /// Overwrites the first entries of a matrix with the second derivative by the point and the
    /// nodes of the facet, two components each, row-major.
    pub(super) fn curvature_into(&self, matrix: &mut [f64]) {
        let size = 2 * self.count;
        for (row, values) in matrix[..size * size].chunks_exact_mut(size).enumerate() {
            for (column, value) in values.iter_mut().enumerate() {
                let of = |vectors: &[Vector<2>], at: usize| vectors[at / 2].0[at % 2];
                let [of_row, of_column] = [row, column].map(|at| of(&self.slopes, at));
                let mixed = of_row * of(&self.of_jump, column) + of(&self.of_jump, row) * of_column;
                *value = mixed + self.rate * of_row * of_column;
            }
        }
    }
}
