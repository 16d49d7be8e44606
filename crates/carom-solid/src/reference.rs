//! The reference map X(ξ) = Σ φᵃ Xᵃ of a cell: its gradient ∂X/∂ξ, the gradients ∇₀φ = (∂X/∂ξ)⁻ᵀ
//! ∂φ/∂ξ, and its inverse by Newton's method, which locates the cell of a point.

use carom_algebra::{Mat, Vector};

use crate::shape::{Domain, Shape};

/// A point at which a cell is degenerate or inverted.
pub(crate) struct Degenerate<const D: usize> {
    pub(crate) place: [f64; D],
    pub(crate) jacobian: f64,
}

/// Σ φᵃ xᵃ.
pub(crate) fn interpolate<const D: usize, const N: usize>(
    values: &[f64; N],
    x: &[Vector<D>; N],
) -> Vector<D> {
    let mut sum = Vector::ZERO;
    for a in 0..N {
        sum += x[a] * values[a];
    }
    sum
}

/// Σ xᵃ ⊗ gᵃ.
#[inline]
pub fn gradient<const D: usize, const N: usize>(x: &[Vector<D>; N], g: &[Vector<D>; N]) -> Mat<D> {
    let mut sum = Mat::ZERO;
    for a in 0..N {
        sum += x[a].outer(&g[a]);
    }
    sum
}

/// Reference gradients ∇₀φᵃ and the Jacobian det(∂X/∂ξ) > 0.
pub(crate) fn map<const D: usize, const N: usize, S: Shape<D, N>>(
    x: &[Vector<D>; N],
    xi: &Vector<D>,
) -> Result<([Vector<D>; N], f64), Degenerate<D>> {
    let local = S::gradients(xi);
    let derivative = gradient(x, &local);
    match jacobian(&derivative) {
        Ok(jacobian) => {
            let inverse_transposed = derivative.inverse().transposed();
            Ok((local.map(|g| inverse_transposed.apply(&g)), jacobian))
        }
        Err(jacobian) => Err(Degenerate { place: interpolate(&S::values(xi), x).0, jacobian }),
    }
}

/// Jacobian det(∂X/∂ξ) > 0 of the derivative ∂X/∂ξ at a point.
///
/// # Errors
/// The determinant, if the cell is degenerate or inverted there.
pub(crate) fn jacobian<const D: usize>(derivative: &Mat<D>) -> Result<f64, f64> {
    let jacobian = derivative.det();
    // Relative to the lengths of the columns, so that slivers are rejected at any scale.
    let size: f64 = derivative.transposed().0.map(|column| Vector(column).norm()).iter().product();
    if jacobian > 1e-12 * size { Ok(jacobian) } else { Err(jacobian) }
}

/// A point this far outside a cell, in reference coordinates, still belongs to it: input has about
/// six digits.
const TOLERANCE: f64 = 1e-6;

/// How far such a point may lie outside the hull of the cell's control points, relative to the size
/// of its box. Where barycentric coordinates are ≥ −ε the Bernstein polynomials of degree k sum to
/// at most (1 + 2dε)ᵏ in d ≤ 3 dimensions: the point is outside by at most dkε.
pub(crate) const MARGIN: f64 = 20.0 * TOLERANCE;

/// Whether the reference map is not affine; `centre`: gradients of the shape functions in the
/// centre.
pub(crate) fn is_curved<const D: usize, const N: usize, S: Shape<D, N>>(
    x: &[Vector<D>; N],
    centre: &[Vector<D>; N],
) -> bool {
    let corners = gradient(x, centre);
    let affine = |a: usize| x[0] + corners.apply(&(S::NODES[a] - S::NODES[0]));
    let size = (x[1] - x[0]).norm();
    (0..N).any(|a| (x[a] - affine(a)).norm() > 1e-10 * size)
}

/// Reference coordinates of a point of the cell, `None` if it lies outside.
pub(crate) fn invert<const D: usize, const N: usize, S: Shape<D, N>>(
    x: &[Vector<D>; N],
    point: &Vector<D>,
) -> Option<Vector<D>> {
    let mut xi = S::Domain::CENTRE;
    for _ in 0..30 {
        let step =
            gradient(x, &S::gradients(&xi)).inverse().apply(&(*point - interpolate(&S::values(&xi), x)));
        xi += step;
        if step.norm() < 1e-13 {
            break;
        }
    }
    let miss = (*point - interpolate(&S::values(&xi), x)).norm();
    (miss <= 1e-10 * (x[1] - x[0]).norm() && S::Domain::excess(&xi) <= TOLERANCE).then_some(xi)
}
