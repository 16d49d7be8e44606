//! Eigenvalues and eigenvectors of a symmetric tensor by Jacobi's rotations (C. G. J. Jacobi, J.
//! reine angew. Math. 30, 1846; the stable formulas of G. H. Golub and C. F. Van Loan, *Matrix
//! Computations*, § 8.5).

use crate::small::Mat;

/// Largest number of sweeps, more than are ever needed: convergence is quadratic.
const SWEEPS: usize = 12;

/// Eigenvalues and eigenvectors of a symmetric tensor.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PrincipalAxes<const D: usize> {
    /// Eigenvalues, in no order.
    pub values: [f64; D],
    /// Orthonormal eigenvectors, one in each column.
    pub axes: Mat<D>,
}

/// The eigenvalues and eigenvectors of a symmetric tensor with finite components.
///
/// ```
/// use carom_algebra::{Mat, principal_axes};
/// let found = principal_axes(&Mat([[0.0, 2.0], [2.0, 0.0]]));
/// assert_eq!(found.values.map(f64::abs), [2.0, 2.0]);
/// assert!((found.axes.0[0][0].abs() - 0.5_f64.sqrt()).abs() < 1e-15);
/// ```
#[inline]
pub fn principal_axes<const D: usize>(tensor: &Mat<D>) -> PrincipalAxes<D> {
    let mut a = *tensor;
    let mut axes = Mat::identity();
    for _ in 0..SWEEPS {
        let mut is_diagonal = true;
        for p in 0..D {
            for q in p + 1..D {
                is_diagonal &= a.0[p][q] == 0.0;
            }
        }
        if is_diagonal {
            break;
        }
        for p in 0..D {
            for q in p + 1..D {
                rotate(&mut a, &mut axes, p, q);
            }
        }
    }
    PrincipalAxes { values: std::array::from_fn(|i| a.0[i][i]), axes }
}

/// The eigenvalues of a symmetric 3 × 3 tensor in descending order, in its unit; NaN if a component
/// is.
///
/// ```
/// // Pure shear 3 on a pressure of 2.
/// let stress = [[-2.0, 0.0, 3.0], [0.0, -2.0, 0.0], [3.0, 0.0, -2.0]];
/// assert_eq!(carom_algebra::principal(stress), [1.0, -2.0, -5.0]);
/// ```
pub fn principal(tensor: [[f64; 3]; 3]) -> [f64; 3] {
    if tensor.iter().flatten().any(|x| !x.is_finite()) {
        return [f64::NAN; 3];
    }
    let mut values = principal_axes(&Mat(tensor)).values;
    values.sort_by(|x, y| y.total_cmp(x));
    values
}

/// Applies the rotation in the plane of axes p and q after which the off-diagonal component of a
/// symmetric tensor in that plane is zero, to the tensor and to the columns of `axes`.
#[inline(always)]
fn rotate<const D: usize>(tensor: &mut Mat<D>, axes: &mut Mat<D>, p: usize, q: usize) {
    let a = &mut tensor.0;
    let off = a[p][q];
    // What no longer changes the diagonal is zero.
    if off.abs() <= 1e-18 * (a[p][p].abs() + a[q][q].abs()) || off.abs() < f64::MIN_POSITIVE {
        a[p][q] = 0.0;
        a[q][p] = 0.0;
        return;
    }
    let tau = (a[q][q] - a[p][p]) / (2.0 * off);
    let tan = tau.signum() / (tau.abs() + (1.0 + tau * tau).sqrt());
    let cos = 1.0 / (1.0 + tan * tan).sqrt();
    let sin = tan * cos;
    a[p][p] -= tan * off;
    a[q][q] += tan * off;
    a[p][q] = 0.0;
    a[q][p] = 0.0;
    for r in 0..D {
        if r != p && r != q {
            let rp = a[r][p];
            let rq = a[r][q];
            a[r][p] = cos * rp - sin * rq;
            a[r][q] = sin * rp + cos * rq;
            a[p][r] = a[r][p];
            a[q][r] = a[r][q];
        }
        let of_p = axes.0[r][p];
        let of_q = axes.0[r][q];
        axes.0[r][p] = cos * of_p - sin * of_q;
        axes.0[r][q] = sin * of_p + cos * of_q;
    }
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
    /// The axes are orthonormal and diagonalise the tensor, with equal and with close eigenvalues.
    #[test]
    fn axes_diagonalise() {
        for close in [0.0, 1e-300, 1e-17, 1e-12, 1e-6, 0.3] {
            let a = Mat([[2.0, 1.0, 1.0 + close], [1.0, 2.0, 1.0], [1.0 + close, 1.0, 2.0]]);
            let PrincipalAxes { values, axes } = principal_axes(&a);
            let mut scaled = axes;
            for i in 0..3 {
                (0..3).for_each(|j| scaled.0[i][j] *= values[j]);
            }
            let error = scaled * axes.transposed() - a;
            assert!(error.double_dot(&error) < 1e-29, "{close}");
            let error = axes * axes.transposed() - Mat::identity();
            assert!(error.double_dot(&error) < 1e-30, "{close}");
        }
        assert_eq!(principal_axes(&Mat([[3.0]])).values, [3.0]);
    }
}
