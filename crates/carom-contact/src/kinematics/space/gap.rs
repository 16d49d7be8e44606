//! Gap of a node over a facet in space at its closest point, with its derivatives. With
//! d = x − y(ξ), n the normal, τ_α = ∂y/∂ξ_α, and rows over the node and the nodes of the facet:
//!
//! ```text
//! g = d·n     ∇g = (n; −φᵃ n)     N_α = (τ_α; −φᵃ τ_α)     T_α = (0; φᵃ,_α n)
//! m_αβ = τ_α·τ_β     κ_αβ = n·∂²y/∂ξ_α∂ξ_β     A = m − gκ     ∂ξ/∂y = A⁻¹ (N + gT)
//! ∇²g = −(NᵀA⁻¹T + TᵀA⁻¹N) − Nᵀ m⁻¹κA⁻¹ N − g TᵀA⁻¹T
//! ```
//!
//! In the plane this is the formula of `kinematics/gap.rs`. A > 0 at a unique closest point.

use carom_algebra::{Mat, Vector};
use carom_solid::FacetFunctions;

use super::patch::{Patch, PatchPoint, is_positive};

/// A node over a facet at its closest point.
pub(crate) struct PatchGap {
    at: PatchPoint,
    functions: FacetFunctions,
    /// The gap g.
    pub(crate) distance: f64,
    bend: Mat<2>,
    a: Mat<2>,
}

impl PatchGap {
    /// At the closest point ξ.
    pub(crate) fn new(patch: Patch, y: &[f64], from: Vector<3>, xi: [f64; 2]) -> Self {
        let at = patch.at(y, xi);
        let distance = (from - at.position).dot(&at.normal);
        let bend = at.bend(at.normal);
        let a = at.metric() - bend * distance;
        Self { at, functions: patch.shape.functions(xi), distance, bend, a }
    }

    /// det A, if A > 0; else a number that is not positive.
    pub(crate) fn regularity(&self) -> f64 {
        if is_positive(&self.a) { self.a.det() } else { self.a.det().min(0.0) }
    }

    /// ∂g/∂y of the node and of `count` nodes of the facet.
    pub(crate) fn gradient(&self, count: usize) -> impl Iterator<Item = Vector<3>> {
        let of_facet = (0..count).map(|k| self.at.normal * -self.functions.values[k]);
        std::iter::once(self.at.normal).chain(of_facet)
    }

    /// ∂²g/∂y∂y of the node and of `count` nodes of the facet: overwrites the first
    /// (3 + 3 `count`)² entries, row-major.
    pub(crate) fn curvature_into(&self, count: usize, curvature: &mut [f64]) {
        let (n, t) = (self.at.normal, self.at.tangents);
        let inverse = self.a.inverse();
        let turned = self.at.metric().inverse() * self.bend * inverse;
        let weight = |p: usize| if p == 0 { 1.0 } else { -self.functions.values[p - 1] };
        let slope =
            |p: usize| Vector(if p == 0 { [0.0; 2] } else { self.functions.slopes.map(|s| s[p - 1]) });
        // τ_α A⁻¹_αβ φ,_β of a node.
        let raised = |p: usize| {
            let s = inverse.apply(&slope(p));
            t[0] * s[0] + t[1] * s[1]
        };
        let mut along = Mat::<3>::ZERO;
        for (i, j) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
            along += t[i].outer(&t[j]) * turned.0[i][j];
        }
        let size = 3 * (1 + count);
        for p in 0..=count {
            for q in 0..=count {
                let mut block = raised(q).outer(&n) * -weight(p);
                block += n.outer(&raised(p)) * -weight(q);
                block += along * (-weight(p) * weight(q));
                block += n.outer(&n) * (-self.distance * slope(p).dot(&inverse.apply(&slope(q))));
                for (i, k) in (0..9).map(|e| (e / 3, e % 3)) {
                    curvature[(3 * p + i) * size + 3 * q + k] = block.0[i][k];
                }
            }
        }
    }
}
