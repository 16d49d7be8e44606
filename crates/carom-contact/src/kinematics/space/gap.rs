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
//!
//! The slip along a unit tangent e has the row, with e = Σ c_β τ_β,
//!
//! ```text
//! H = (e; −φᵃ e + g s_a n),   s_a = Σ c_β φᵃ,_β            A ∂ξ/∂y = (H·τ_α) of all tangents
//! ∂e = Σ c_β (n·∂τ_β) n,   ∂n = −Σ τ^β (n·∂τ_β),   ∂c_β = −τ^β·Σ c_γ ∂τ_γ,   τ^α = m⁻¹_αβ τ_β
//! ```
//!
//! so that rigid motions have none, and its force neither a resultant nor a moment.

use carom_algebra::{Mat, Vector};
use carom_solid::FacetFunctions;

use super::patch::{Patch, PatchPoint, is_positive};

/// Gap of a node over a facet in space at its closest point, with its derivatives.
pub(crate) struct PatchGap {
    at: PatchPoint,
    functions: FacetFunctions,
    /// Gap g.
    pub(crate) distance: f64,
    bend: Mat<2>,
    a: Mat<2>,
}

impl PatchGap {
    /// Gap of a node at `from` over the closest point ξ of a facet.
    pub(crate) fn new(patch: Patch, y: &[f64], from: Vector<3>, xi: [f64; 2]) -> Self {
        let at = patch.seen_from(from, y, xi);
        let distance = -at.position.dot(&at.normal);
        let bend = at.bend(at.normal);
        let a = at.metric() - bend * distance;
        Self { at, functions: patch.shape.functions(xi), distance, bend, a }
    }

    /// Determinant of the second derivative A of half the squared distance if the closest point is
    /// unique, A > 0; otherwise a number that is not positive.
    pub(crate) fn regularity(&self) -> f64 {
        if is_positive(&self.a) { self.a.det() } else { self.a.det().min(0.0) }
    }

    /// Gradient ∂g/∂y of the gap: for the node, then for `count` nodes of the facet.
    pub(crate) fn gradient(&self, count: usize) -> impl Iterator<Item = Vector<3>> {
        let of_facet = (0..count).map(|k| self.at.normal * -self.functions.values[k]);
        std::iter::once(self.at.normal).chain(of_facet)
    }

    /// Second derivative ∂²g/∂y∂y of the gap by the node and `count` nodes of the facet: overwrites
    /// the first (3 + 3 `count`)² entries, row-major.
    pub(crate) fn curvature_into(&self, count: usize, curvature: &mut [f64]) {
        let n = self.at.normal;
        let t = self.at.tangents;
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

    /// Unit normal n of the facet at the closest point.
    pub(crate) fn normal(&self) -> Vector<3> {
        self.at.normal
    }

    /// Components c of a tangent vector e = Σ c_β τ_β in the tangents of the facet.
    fn components(&self, along: Vector<3>) -> Vector<2> {
        self.at.metric().inverse().apply(&Vector(self.at.tangents.map(|t| t.dot(&along))))
    }

    /// Row H of the slip along a tangent: for the node, then for `count` nodes of the facet.
    pub(crate) fn slip(&self, along: Vector<3>, count: usize) -> impl Iterator<Item = Vector<3>> {
        let n = self.at.normal;
        let c = self.components(along);
        let slopes = &self.functions.slopes;
        let of_facet = move |k: usize| {
            let turned = self.distance * (c[0] * slopes[0][k] + c[1] * slopes[1][k]);
            along * -self.functions.values[k] + n * turned
        };
        std::iter::once(along).chain((0..count).map(of_facet))
    }

    /// Derivative ∂H/∂y of the row of the slip along a tangent by the node and `count` nodes of the
    /// facet, whose shape functions have the second derivatives `second` by ξξ, ξη and ηη:
    /// overwrites the first (3 + 3 `count`)² entries, row-major.
    pub(crate) fn slip_derivative_into<T: AsRef<[f64]>>(
        &self,
        along: Vector<3>,
        second: &[T; 3],
        count: usize,
        matrix: &mut [f64],
    ) {
        let PatchPoint { tangents: t, normal: n, second: bent, .. } = self.at;
        let gap = self.distance;
        let size = 3 * (1 + count);
        let c = self.components(along);
        let inverse = self.a.inverse();
        let lifted = self.at.metric().inverse();
        let dual: [Vector<3>; 2] = std::array::from_fn(|i| t[0] * lifted.0[i][0] + t[1] * lifted.0[i][1]);
        // φ, its slopes and its second derivatives; those of the node itself are −1 and 0.
        let phi = |p: usize| if p == 0 { -1.0 } else { self.functions.values[p - 1] };
        let slope =
            |p: usize| Vector(if p == 0 { [0.0; 2] } else { self.functions.slopes.map(|s| s[p - 1]) });
        let curved = |p: usize| -> Mat<2> {
            let [a, b, d] = std::array::from_fn(|i| if p == 0 { 0.0 } else { second[i].as_ref()[p - 1] });
            Mat([[a, b], [b, d]])
        };
        for (q, k) in (0..=count).flat_map(|q| (0..3).map(move |k| (q, k))) {
            // Changes of ξ, of the tangents, of the direction and of the gap with one component of
            // one node.
            let driven = Vector(t.map(|t| -phi(q) * t[k])) + slope(q) * (gap * n[k]);
            let xi = inverse.apply(&driven);
            let stretched = [0, 1].map(|i| {
                let mut change = bent[i] * xi[0] + bent[i + 1] * xi[1];
                change.0[k] += slope(q)[i];
                change
            });
            let tilts = stretched.map(|change| n.dot(&change));
            let along_changed = n * (c[0] * tilts[0] + c[1] * tilts[1]);
            let normal_changed = dual[0] * -tilts[0] + dual[1] * -tilts[1];
            let pulled = stretched[0] * c[0] + stretched[1] * c[1];
            let c_changed = Vector(dual.map(|dual| -dual.dot(&pulled)));
            let opening = -phi(q) * n[k];
            for p in 0..=count {
                let share = slope(p).dot(&c);
                let share_changed = curved(p).apply(&xi).dot(&c) + slope(p).dot(&c_changed);
                let changed = along * -slope(p).dot(&xi)
                    + along_changed * -phi(p)
                    + n * (opening * share + gap * share_changed)
                    + normal_changed * (gap * share);
                (0..3).for_each(|i| matrix[(3 * p + i) * size + 3 * q + k] = changed[i]);
            }
        }
    }
}
