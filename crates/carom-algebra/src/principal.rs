//! Eigenvalues of a symmetric tensor by Jacobi's rotations (C. G. J. Jacobi, J. reine angew. Math.
//! 30, 1846; the stable formulas of G. H. Golub and C. F. Van Loan, *Matrix Computations*, § 8.5).

/// Largest number of sweeps, more than are ever needed: convergence is quadratic.
const SWEEPS: usize = 12;

/// The eigenvalues of a symmetric 3 × 3 tensor in descending order, in its unit; NaN if a component
/// is.
///
/// ```
/// // Pure shear 3 on a pressure of 2.
/// let stress = [[-2.0, 0.0, 3.0], [0.0, -2.0, 0.0], [3.0, 0.0, -2.0]];
/// assert_eq!(carom_algebra::principal(stress), [1.0, -2.0, -5.0]);
/// ```
pub fn principal(mut a: [[f64; 3]; 3]) -> [f64; 3] {
    if a.iter().flatten().any(|x| !x.is_finite()) {
        return [f64::NAN; 3];
    }
    for _ in 0..SWEEPS {
        if a[0][1] == 0.0 && a[0][2] == 0.0 && a[1][2] == 0.0 {
            break;
        }
        for (p, q) in [(0, 1), (0, 2), (1, 2)] {
            rotate(&mut a, p, q);
        }
    }
    let mut values = [a[0][0], a[1][1], a[2][2]];
    values.sort_by(|x, y| y.total_cmp(x));
    values
}

/// Applies the rotation in the plane of axes p and q after which the off-diagonal component of a
/// symmetric tensor in that plane is zero.
fn rotate(a: &mut [[f64; 3]; 3], p: usize, q: usize) {
    let off = a[p][q];
    // What no longer changes the diagonal is zero.
    if off.abs() <= 1e-18 * (a[p][p].abs() + a[q][q].abs()) || off.abs() < f64::MIN_POSITIVE {
        a[p][q] = 0.0;
        a[q][p] = 0.0;
        return;
    }
    let tau = (a[q][q] - a[p][p]) / (2.0 * off);
    let tan = tau.signum() / (tau.abs() + tau.hypot(1.0));
    let cos = 1.0 / tan.hypot(1.0);
    let sin = tan * cos;
    let r = 3 - p - q;
    let rp = a[r][p];
    let rq = a[r][q];
    a[p][p] -= tan * off;
    a[q][q] += tan * off;
    a[p][q] = 0.0;
    a[q][p] = 0.0;
    a[r][p] = cos * rp - sin * rq;
    a[r][q] = sin * rp + cos * rq;
    a[p][r] = a[r][p];
    a[q][r] = a[r][q];
}

#[cfg(test)]
mod tests {
    use super::*;

    fn near(found: [f64; 3], expected: [f64; 3]) {
        let size = expected.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
        assert!(
            found.iter().zip(expected).all(|(a, b)| (a - b).abs() <= 4e-16 * size),
            "{found:?} {expected:?}"
        );
    }

    /// By hand: pure shear 3 on a pressure of 2; the circulant with 2 and 1 has 4, 1, 1; and the
    /// plane stress 7, 1 with shear 4 has 4 ± 5.
    #[test]
    fn simple_states() {
        near(principal([[-2.0, 0.0, 3.0], [0.0, -2.0, 0.0], [3.0, 0.0, -2.0]]), [1.0, -2.0, -5.0]);
        near(principal([[2.0, 1.0, 1.0], [1.0, 2.0, 1.0], [1.0, 1.0, 2.0]]), [4.0, 1.0, 1.0]);
        near(principal([[7.0, 4.0, 0.0], [4.0, 1.0, 0.0], [0.0, 0.0, 0.0]]), [9.0, 0.0, -1.0]);
        near(principal([[0.0; 3]; 3]), [0.0; 3]);
        assert!(principal([[f64::NAN; 3]; 3])[0].is_nan());
    }

    /// The three invariants are those of the tensor.
    #[test]
    fn invariants_are_kept() {
        let mut state = 7_u64;
        let mut random = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
        };
        for _ in 0..1000 {
            let [a, b, c, d, e, f] = std::array::from_fn(|_| 1e6 * random());
            let [l, m, n] = principal([[a, d, f], [d, b, e], [f, e, c]]);
            let det = a * (b * c - e * e) - d * (d * c - e * f) + f * (d * e - b * f);
            assert!((l + m + n - a - b - c).abs() < 1e-8 && l >= m && m >= n);
            assert!((l * m + m * n + n * l - (a * b + b * c + c * a - d * d - e * e - f * f)).abs() < 1e-2);
            assert!((l * m * n - det).abs() < 1e4);
        }
    }
}
