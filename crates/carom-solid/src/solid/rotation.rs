//! The angle of the rotation R in the polar decomposition F = R U.
//!
//! ```text
//! plane    θ = atan2(F₂₁ − F₁₂, F₁₁ + F₂₂)
//! space    R₀ = F,  R ← ½ (R + R⁻ᵀ);   2 sin θ = |axial(R − Rᵀ)|,  2 cos θ = tr R − 1
//! ```
//!
//! N. J. Higham, Computing the polar decomposition, SIAM J. Sci. Stat. Comput. 7 (1986).

use carom_algebra::Mat;

/// Iterations; they converge quadratically, from strains of 1 in six.
const MOST: usize = 30;

/// The angle in [0, π] of F = 1 + H; that of F itself where J ≤ 0 in space.
pub(super) fn angle<const D: usize>(h: &Mat<D>) -> f64 {
    let f = Mat::<D>::identity() + *h;
    match D {
        2 => (f.0[1][0] - f.0[0][1]).atan2(f.trace()).abs(),
        3 => {
            let r = orthogonal(f);
            let axial = [(2, 1), (0, 2), (1, 0)].map(|(i, j)| r.0[i][j] - r.0[j][i]);
            let sine = axial.iter().map(|x| x * x).sum::<f64>().sqrt();
            sine.atan2(r.trace() - 1.0)
        }
        _ => 0.0,
    }
}

/// ‖E‖ = ‖H + Hᵀ + HᵀH‖/2 of Green's strain, which a rotation does not change.
pub(super) fn strain<const D: usize>(h: &Mat<D>) -> f64 {
    let e = (*h + h.transposed() + h.transposed() * *h) * 0.5;
    e.double_dot(&e).sqrt()
}

fn orthogonal<const D: usize>(f: Mat<D>) -> Mat<D> {
    let mut r = f;
    if f.det() <= 0.0 {
        return r;
    }
    for _ in 0..MOST {
        let next = (r + r.inverse().transposed()) * 0.5;
        let change = next - r;
        r = next;
        if change.double_dot(&change) < 1e-20 {
            break;
        }
    }
    r
}
