//! Shape functions φᵃ(ξ) of the reference cells: Lagrange polynomials, φᵃ(ξᵇ) = δᵃᵇ, Σφᵃ = 1.
//!
//! Node order is VTK's: corners, then the nodes of each edge in its direction, then those of faces
//! and of the interior. One file per reference domain; the test at the end of this file covers
//! every shape.

mod hull;
mod line;
mod tensor;
mod tetrahedron;
mod triangle;

use carom_algebra::Vector;

pub use hull::Hull;
pub use line::{Line2, Line3, Line4, LineShape, line_shape};
pub use tensor::{Hex8, Hex27, Quad4, Quad9};
pub use tetrahedron::{Tet4, Tet10, Tet20};
pub use triangle::{Tri3, Tri6, Tri10};

use crate::quadrature::Rule;

/// A reference domain in `R` coordinates: the interval −1..1 or its powers, or the unit simplex.
pub trait Domain<const R: usize>: Send + Sync + 'static {
    /// Whether it is a product of intervals: a square or a cube. Its shape functions then have
    /// their degree along every axis, otherwise in total.
    const TENSOR: bool = false;

    /// Barycentre.
    const CENTRE: Vector<R>;

    /// Quadrature rule exact for polynomials of a total degree.
    fn rule(degree: usize) -> Rule<R>;

    /// How far a point lies outside the domain, in reference coordinates; ≤ 0 inside.
    fn excess(xi: &Vector<R>) -> f64;
}

/// Shape functions of a reference cell with `R` reference coordinates and `N` nodes.
pub trait Shape<const R: usize, const N: usize>: Send + Sync + 'static {
    /// Their domain.
    type Domain: Domain<R>;

    /// Polynomial degree.
    const DEGREE: usize;

    /// Reference coordinates of the nodes.
    const NODES: [Vector<R>; N];

    /// φᵃ(ξ).
    fn values(xi: &Vector<R>) -> [f64; N];

    /// ∂φᵃ/∂ξ.
    fn gradients(xi: &Vector<R>) -> [Vector<R>; N];
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn check<const R: usize, const N: usize, S: Shape<R, N>>(xi: [f64; 3]) {
        for (a, node) in S::NODES.iter().enumerate() {
            for (b, value) in S::values(node).iter().enumerate() {
                assert!((value - f64::from(u8::from(a == b))).abs() < 4e-15, "φ{b} at node {a} is {value}");
            }
            assert!(S::Domain::excess(node) < 1e-15);
        }
        let xi = Vector(std::array::from_fn(|i| xi[i]));
        let size: f64 = S::values(&xi).iter().map(|value| value.abs()).sum();
        assert!((S::values(&xi).iter().sum::<f64>() - 1.0).abs() < 1e-14 * (10.0 + size));
        let gradients = S::gradients(&xi);
        for i in 0..R {
            let size: f64 = gradients.iter().map(|g| g[i].abs()).sum();
            assert!(gradients.iter().map(|g| g[i]).sum::<f64>().abs() < 2e-14 * (1.0 + size));
            let h = 1e-4;
            let at = |s: f64| {
                let mut moved = xi;
                moved[i] += s * h;
                S::values(&moved)
            };
            // Fourth-order differences are exact for cubics.
            let (p, m, pp, mm) = (at(1.0), at(-1.0), at(2.0), at(-2.0));
            for a in 0..N {
                let slope = (8.0 * (p[a] - m[a]) - (pp[a] - mm[a])) / (12.0 * h);
                assert!(
                    (slope - gradients[a][i]).abs() < 1e-9 * (1.0 + size),
                    "∂φ{a}/∂ξ{i}: {slope} against {}",
                    gradients[a][i]
                );
            }
        }
    }

    proptest! {
        #[test]
        fn shapes_are_nodal_complete_and_have_exact_gradients(xi in [-1.3..1.3, -1.3..1.3, -1.3..1.3]) {
            check::<1, 2, Line2>(xi);
            check::<1, 3, Line3>(xi);
            check::<1, 4, Line4>(xi);
            check::<2, 3, Tri3>(xi);
            check::<2, 6, Tri6>(xi);
            check::<2, 10, Tri10>(xi);
            check::<2, 4, Quad4>(xi);
            check::<2, 9, Quad9>(xi);
            check::<3, 8, Hex8>(xi);
            check::<3, 27, Hex27>(xi);
            check::<3, 4, Tet4>(xi);
            check::<3, 10, Tet10>(xi);
            check::<3, 20, Tet20>(xi);
        }
    }
}
