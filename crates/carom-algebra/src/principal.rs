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
