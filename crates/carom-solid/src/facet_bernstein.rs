//! Bernstein polynomials of facets, one per node and of the degree of the shape functions, at the
//! nodes:
//!
//! ```text
//! Bᵢ = ∏ C(k, lᵢ) tˡ (1 − t)ᵏ⁻ˡ along each axis;    on a triangle Bᵢ = k!/(l₀! l₁! l₂!) L₀^l₀ L₁^l₁ L₂^l₂
//! ```
//!
//! with the node at l/k of each axis. They are ≥ 0, sum to 1 and span the same functions as the
//! shape functions, Bᵢ = Σⱼ Bᵢ(xⱼ) φⱼ. (G. Farin, *Curves and Surfaces for CAGD*, 5th ed. 2002,
//! §§ 5, 15, 17.) Bᵢ vanishes on every corner, edge and face that does not contain node i: together
//! those of neighbouring facets are continuous.

use std::sync::OnceLock;

use crate::bernstein::factorial;
use crate::facet::{FacetShape, NODES};
use crate::shape::{Domain, Line2, Line3, Line4, Quad4, Quad9, Shape, Tri3, Tri6, Tri10, lattice};

/// Bᵢ(xⱼ), a row per node j; entries beyond the nodes of a facet are zero.
type AtNodes = [[f64; NODES]; NODES];

impl FacetShape {
    /// The Bernstein polynomials at the nodes.
    ///
    /// ```
    /// // On a line of three nodes: both ends, then the middle.
    /// let at_nodes = carom_solid::FacetShape::L3.bernstein_at_nodes();
    /// assert_eq!(at_nodes[2][..3], [0.25, 0.25, 0.5]);
    /// ```
    pub fn bernstein_at_nodes(self) -> &'static AtNodes {
        static KNOWN: [OnceLock<AtNodes>; 9] = [const { OnceLock::new() }; 9];
        KNOWN[self as usize].get_or_init(|| match self {
            Self::Point => {
                let mut one = [[0.0; NODES]; NODES];
                one[0][0] = 1.0;
                one
            }
            Self::L2 => table::<1, 2, Line2>(),
            Self::L3 => table::<1, 3, Line3>(),
            Self::L4 => table::<1, 4, Line4>(),
            Self::T3 => table::<2, 3, Tri3>(),
            Self::T6 => table::<2, 6, Tri6>(),
            Self::T10 => table::<2, 10, Tri10>(),
            Self::Q4 => table::<2, 4, Quad4>(),
            Self::Q9 => table::<2, 9, Quad9>(),
        })
    }
}

fn table<const R: usize, const N: usize, S: Shape<R, N>>() -> AtNodes {
    let nodes = lattice::<R, N, S>();
    let at = |node: usize, i: usize| {
        if S::Domain::TENSOR {
            on_box(S::DEGREE, nodes[node], nodes[i])
        } else {
            on_simplex(S::DEGREE, nodes[node], nodes[i])
        }
    };
    let value = |node: usize, i: usize| if node < N && i < N { at(node, i) } else { 0.0 };
    std::array::from_fn(|node| std::array::from_fn(|i| value(node, i)))
}

/// The product along the axes of the polynomials of degree k and index l at x/k.
fn on_box<const R: usize>(k: usize, x: [usize; R], l: [usize; R]) -> f64 {
    (0..R).map(|axis| on_simplex(k, [x[axis]], [l[axis]])).product()
}

/// The polynomial of degree k and exponents l at the point with barycentric coordinates x/k; those
/// of the first corner are what is missing to k.
fn on_simplex<const R: usize>(k: usize, x: [usize; R], l: [usize; R]) -> f64 {
    let missing = |of: [usize; R]| k - of.iter().sum::<usize>();
    let power = |x: usize, l: usize| (x as f64 / k as f64).powi(l as i32) / factorial(l);
    let rest: f64 = (0..R).map(|axis| power(x[axis], l[axis])).product();
    factorial(k) * power(missing(x), missing(l)) * rest
}
