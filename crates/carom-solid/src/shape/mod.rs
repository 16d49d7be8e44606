//! Shape functions φᵃ(ξ) of the reference cells: Lagrange polynomials, φᵃ(ξᵇ) = δᵃᵇ, Σφᵃ = 1.
//!
//! Node order is Gmsh's and VTK's: corners, then the nodes of each edge in its direction, then the
//! interior. One file per reference domain; the test at the end of this file covers every shape.

mod hull;
mod line;
mod tetrahedron;
mod triangle;

use carom_algebra::Vector;

pub use hull::Hull;
pub use line::{Line2, Line3, Line4, LineShape, line_shape};
pub use tetrahedron::Tet4;
pub use triangle::{Tri3, Tri6, Tri10};

use crate::quadrature::Rule;

/// A reference domain in `R` coordinates: the interval −1..1 or the unit simplex.
pub trait Domain<const R: usize>: Send + Sync + 'static {
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
        assert!((S::values(&xi).iter().sum::<f64>() - 1.0).abs() < 1e-13);
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
                    (slope - gradients[a][i]).abs() < 1e-9,
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
            check::<3, 4, Tet4>(xi);
        }
    }
}
