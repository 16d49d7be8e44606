//! Shape functions φᵃ(ξ) of the reference cells: Lagrange polynomials, φᵃ(ξᵇ) = δᵃᵇ, Σφᵃ = 1.
//!
//! Node order is VTK's: corners, then the nodes of each edge in its direction, then those of faces
//! and of the interior. One file per reference domain; `tests/all/shapes.rs` covers every shape.

mod hull;
mod line;
mod tensor;
mod tetrahedron;
mod triangle;

use carom_algebra::Vector;

pub use hull::Hull;
pub use line::{Line2, Line3, Line4, LineShape, line_powers, line_shape};
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

/// The nodes of a shape in the lattice that divides every edge by the degree.
pub(crate) fn lattice<const R: usize, const N: usize, S: Shape<R, N>>() -> Vec<[usize; R]> {
    let low = S::NODES[0][0];
    let scale = S::DEGREE as f64 / (1.0 - low);
    S::NODES.iter().map(|xi| xi.0.map(|x| (scale * (x - low)).round() as usize)).collect()
}
