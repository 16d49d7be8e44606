//! Eigenvalues and eigenvectors of a symmetric tensor by Jacobi's rotations (C. G. J. Jacobi, J.
//! reine angew. Math. 30, 1846; the stable formulas of G. H. Golub and C. F. Van Loan, *Matrix
//! Computations*, § 8.5).

use crate::real::Real;
use crate::small::Mat;

/// Largest number of sweeps, more than are ever needed: convergence is quadratic.
const SWEEPS: usize = 12;

/// Share of the diagonal components below which one off the diagonal counts as zero: it no longer
/// changes them.
const NEGLIGIBLE: f64 = 1e-18;

/// Eigenvalues and eigenvectors of a symmetric tensor.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PrincipalAxes<const D: usize, T = f64> {
    /// Eigenvalues, in no order.
    pub values: [T; D],
    /// Orthonormal eigenvectors, one in each column.
    pub axes: Mat<D, T>,
}

/// The eigenvalues and eigenvectors of a symmetric tensor, or of several in lanes. The squares of
/// its components must be finite, and those of components that count no denormal numbers.
///
/// ```
/// use carom_algebra::{Mat, principal_axes};
/// let found = principal_axes(&Mat([[0.0_f64, 2.0], [2.0, 0.0]]));
/// assert_eq!(found.values.map(f64::abs), [2.0, 2.0]);
/// assert!((found.axes.0[0][0].abs() - 0.5_f64.sqrt()).abs() < 1e-15);
/// ```
#[inline(always)]
pub fn principal_axes<const D: usize, T: Real>(tensor: &Mat<D, T>) -> PrincipalAxes<D, T> {
    let mut a = *tensor;
    let mut axes = Mat::identity();
    for _ in 0..SWEEPS {
        let mut is_diagonal = true;
        for p in 0..D {
            for q in p + 1..D {
                is_diagonal &= effective(&a, p, q).find(|off| off != 0.0).is_none();
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
    let mut values = [T::ZERO; D];
    for i in 0..D {
        values[i] = a.0[i][i];
    }
    PrincipalAxes { values, axes }
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

/// The component p, q off the diagonal; zero where it is negligible.
#[inline(always)]
fn effective<const D: usize, T: Real>(tensor: &Mat<D, T>, p: usize, q: usize) -> T {
    let a = &tensor.0;
    let size = a[p][p].map(f64::abs) + a[q][q].map(f64::abs);
    let bound = (T::of(NEGLIGIBLE) * size).max(T::of(f64::MIN_POSITIVE));
    a[p][q].zip(bound, |off, bound| if off.abs() > bound { off } else { 0.0 })
}

/// Applies the rotation in the plane of axes p and q after which the component of a symmetric
/// tensor in that plane is zero, to the tensor and to the columns of `axes`. Where the component is
/// negligible, the rotation is the identity: a lane does not depend on the others.
///
/// With d = a_qq − a_pp: tan = 2 a_pq/(d ± √(d² + 4 a_pq²)), the sign that of d.
#[inline(always)]
fn rotate<const D: usize, T: Real>(tensor: &mut Mat<D, T>, axes: &mut Mat<D, T>, p: usize, q: usize) {
    let off = effective(tensor, p, q);
    let a = &mut tensor.0;
    let difference = a[q][q] - a[p][p];
    let twice = off + off;
    let root = (difference * difference + twice * twice).map(f64::sqrt);
    let divisor = difference
        .zip(root, |difference, root| if difference < 0.0 { difference - root } else { difference + root });
    let tan = twice / divisor.map(|divisor| if divisor == 0.0 { 1.0 } else { divisor });
    let cos = T::of(1.0) / (T::of(1.0) + tan * tan).map(f64::sqrt);
    let sin = tan * cos;
    a[p][p] = a[p][p] - tan * off;
    a[q][q] = a[q][q] + tan * off;
    a[p][q] = T::ZERO;
    a[q][p] = T::ZERO;
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
