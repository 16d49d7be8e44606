//! Gap of a node over a facet at ξ, with its derivatives. With d = y_N − y_S(ξ), t = y_S', J = |t|,
//! n = t rotated right / J:
//!
//! ```text
//! g = d·n        ∇g = N_n = (n; −ψᵅ n),        ψᵅ = φᵅ + τ φ'ᵅ
//! ∇²g = −(N_t T_nᵀ + T_n N_tᵀ)/a − κ/(a J²) N_t N_tᵀ − (g/a) T_n T_nᵀ,    N_t = (t; −ψᵅ t),  T_n = (0; φ'ᵅ n)
//! ```
//!
//! At the closest point τ = 0, κ = n·y_S'' and a = J² − gκ: ξ depends on the positions (book, "The
//! gap and its derivatives"). With ξ fixed, as printed in the paper, the node slides on the tangent
//! line at ξ: κ = 0, a = J², and τ = d·t/J² is the slip. Then −τ T_n is the extra term d·∂n/∂yᵅ of
//! eqs. (9) and (11); it moves the force to the point of the line below the node, so that moments
//! are balanced.
//!
//! The slip at the closest point has the row
//!
//! ```text
//! H = (N_t + g T_n)/J,      ∂ξ/∂y = J H/a
//! ```
//!
//! by the second of which rigid motions have none; the node's part has the length 1.
//!
//! For a point n = ±1, the outward direction, and ∇²g = 0.

use carom_algebra::{Mat, Vector};
use carom_solid::LineShape;

use super::projection::{Facet, FacetPoint};
use crate::places::Places;

/// Gap of a node over the point ξ of a facet in the plane, with its derivatives.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Gap {
    pub(crate) at: FacetPoint,
    pub(crate) shape: LineShape,
    /// Gap g.
    pub(crate) distance: f64,
    tau: f64,
    pub(crate) kappa: f64,
    /// Second derivative a of half the squared distance by ξ; positive at a unique closest point.
    pub(crate) a: f64,
}

impl Gap {
    /// Gap at the closest point ξ, which follows the positions.
    pub(crate) fn closest(facet: Facet, y: Places, from: Vector<2>, xi: f64) -> Self {
        let at = facet.seen_from(from, y, xi);
        let gap = -at.position.dot(&at.normal);
        let kappa = at.normal.dot(&at.second);
        let a = at.measure * at.measure - gap * kappa;
        Self { at, shape: facet.shape.at(xi), distance: gap, tau: 0.0, kappa, a }
    }

    /// Gap at a fixed ξ.
    pub(crate) fn fixed(facet: Facet, y: Places, from: Vector<2>, xi: f64) -> Self {
        let at = facet.seen_from(from, y, xi);
        let from_point = -at.position;
        let a = at.measure * at.measure;
        let tau = from_point.dot(&at.tangent) / a;
        Self { at, shape: facet.shape.at(xi), distance: from_point.dot(&at.normal), tau, kappa: 0.0, a }
    }

    /// Weight ψᵅ of a node of the facet in the gradient of the gap.
    fn weight(&self, node: usize) -> f64 {
        self.shape.values[node] + self.tau * self.shape.first[node]
    }

    /// Gradient ∂g/∂y of the gap: for the node, then for `count` nodes of the facet.
    pub(crate) fn gradient(&self, count: usize) -> impl Iterator<Item = Vector<2>> {
        let of_facet = (0..count).map(|k| self.at.normal * -self.weight(k));
        std::iter::once(self.at.normal).chain(of_facet)
    }

    /// Row H of the slip: for the node, then for `count` nodes of the facet.
    pub(crate) fn slip(&self, count: usize) -> impl Iterator<Item = Vector<2>> {
        let FacetPoint { tangent, normal, measure, .. } = self.at;
        let along = tangent * measure.recip();
        let of_facet = move |k: usize| {
            along * -self.shape.values[k] + normal * (self.distance * self.shape.first[k] / measure)
        };
        std::iter::once(along).chain((0..count).map(of_facet))
    }

    /// Derivative ∂H/∂y of the row of the slip by the node and `count` nodes of the facet in the
    /// plane: overwrites the first (2 + 2 `count`)² entries, row-major.
    pub(crate) fn slip_derivative_into(&self, count: usize, matrix: &mut [f64]) {
        let FacetPoint { tangent: t, normal: n, measure: j, second, .. } = self.at;
        let gap = self.distance;
        let along = t * j.recip();
        let size = 2 * (1 + count);
        // φ, φ' and φ'' of the facet's nodes; those of the node itself are −1, 0 and 0.
        let of = |p: usize, values: &[f64; 4], own: f64| if p == 0 { own } else { values[p - 1] };
        let phi = |p: usize| of(p, &self.shape.values, -1.0);
        let first = |p: usize| of(p, &self.shape.first, 0.0);
        for q in 0..=count {
            for k in 0..2 {
                // Changes of ξ, of the direction, of J and of the gap with one component of one
                // node.
                let xi = (-phi(q) * t.0[k] + gap * first(q) * n.0[k]) / self.a;
                let turn = (first(q) * n.0[k] + self.kappa * xi) / j;
                let longer = first(q) * along.0[k] + along.dot(&second) * xi;
                let opening = -phi(q) * n.0[k];
                let along_changed = n * turn;
                let normal_changed = along * -turn;
                let share_changed = opening / j - gap * longer / (j * j);
                for p in 0..=count {
                    let changed = along * (-first(p) * xi)
                        + along_changed * -phi(p)
                        + n * (share_changed * first(p) + gap / j * of(p, &self.shape.second, 0.0) * xi)
                        + normal_changed * (gap / j * first(p));
                    matrix[2 * p * size + 2 * q + k] = changed.0[0];
                    matrix[(2 * p + 1) * size + 2 * q + k] = changed.0[1];
                }
            }
        }
    }

    /// Second derivative ∂²g/∂y∂y of the gap by the node and `count` nodes of the facet, `d`
    /// components each: overwrites the first ((1 + `count`) `d`)² entries, row-major.
    pub(crate) fn curvature_into(&self, count: usize, d: usize, curvature: &mut [f64]) {
        let Self {
            at: FacetPoint { tangent: t, normal: n, measure: j, .. }, distance: gap, kappa, a, ..
        } = *self;
        let count = 1 + count;
        // Every vector of the stencil is a scalar per node times n or t.
        let phi = |p: usize| if p == 0 { 1.0 } else { -self.weight(p - 1) };
        let slope = |p: usize| if p == 0 { 0.0 } else { self.shape.first[p - 1] };
        let mixed = -a.recip();
        let of_tt = -kappa / (a * j * j);
        let of_nn = -gap / a;
        for q in 0..count {
            let beside_t = n * (mixed * slope(q)) + t * (of_tt * phi(q));
            let beside_n = t * (mixed * phi(q)) + n * (of_nn * slope(q));
            for p in 0..count {
                let block: Mat<2> = (t * phi(p)).outer(&beside_t) + (n * slope(p)).outer(&beside_n);
                for i in 0..d {
                    for k in 0..d {
                        curvature[(p * d + i) * count * d + q * d + k] = block.0[i][k];
                    }
                }
            }
        }
    }
}
