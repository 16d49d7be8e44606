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

#[cfg(test)]
mod tests {
    use super::*;

    /// A stretch that is turned by a known angle about an axis.
    #[test]
    fn stretch_does_not_turn() {
        for theta in [0.0_f64, 1e-3, 0.3, 2.0, 3.1] {
            let (s, c) = theta.sin_cos();
            let plane = Mat([[c, -s], [s, c]]) * Mat([[1.5, 0.2], [0.2, 0.7]]);
            assert!((angle(&(plane - Mat::identity())) - theta).abs() < 1e-12, "{theta}");
            let stretch = Mat([[1.5, 0.2, 0.1], [0.2, 0.7, 0.0], [0.1, 0.0, 1.1]]);
            // About (1, 2, 2)/3: R = c 1 + s [n]× + (1 − c) n nᵀ.
            let n = [1.0 / 3.0, 2.0 / 3.0, 2.0 / 3.0];
            let cross = [[0.0, -n[2], n[1]], [n[2], 0.0, -n[0]], [-n[1], n[0], 0.0]];
            let space = Mat(std::array::from_fn(|i| {
                std::array::from_fn(|j| {
                    c * f64::from(u8::from(i == j)) + s * cross[i][j] + (1.0 - c) * n[i] * n[j]
                })
            }));
            let found = angle(&(space * stretch - Mat::identity()));
            assert!((found - theta).abs() < 1e-9, "{theta} {found}");
        }
        assert_eq!(angle(&Mat([[0.5]])), 0.0);
    }
}
