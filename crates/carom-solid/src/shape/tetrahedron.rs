//! Tetrahedra of degree 1, 2 and 3 on the unit simplex, in barycentric coordinates L₀ = 1 − ξ − η −
//! ζ, L₁ = ξ, L₂ = η, L₃ = ζ. The node with coordinates n/k has
//!
//! ```text
//! φ = ∏ᵢ P_nᵢ(Lᵢ),    P_n(L) = ∏_{m<n} (kL − m)/(m + 1)
//! ```
//!
//! (P. Silvester, Int. J. Engng Sci. 7 (1969) 849–861). The order of nodes is VTK's: corners, the
//! edges 01 12 20 03 13 23 in their directions, the faces 013 123 203 021.

use carom_algebra::Vector;

use super::{Domain, Shape};
use crate::quadrature::{self, Rule};

/// The tetrahedron (0,0,0) (1,0,0) (0,1,0) (0,0,1).
pub struct Tetrahedron;

impl Domain<3> for Tetrahedron {
    const CENTRE: Vector<3> = Vector([0.25; 3]);

    fn rule(degree: usize) -> Rule<3> {
        quadrature::tetrahedron(degree)
    }

    fn excess(xi: &Vector<3>) -> f64 {
        (-xi[0]).max(-xi[1]).max(-xi[2]).max(xi[0] + xi[1] + xi[2] - 1.0)
    }
}

/// The node at k times its coordinates.
const fn at<const K: usize>(x: usize, y: usize, z: usize) -> Vector<3> {
    Vector([x as f64 / K as f64, y as f64 / K as f64, z as f64 / K as f64])
}

/// P_n and its derivative.
fn factor(degree: f64, n: usize, l: f64) -> (f64, f64) {
    (0..n).map(|m| m as f64).fold((1.0, 0.0), |(value, slope), m| {
        let term = (degree * l - m) / (m + 1.0);
        let rise = degree / (m + 1.0);
        (value * term, slope * term + value * rise)
    })
}

/// The factors of a node's shape function, with their derivatives.
fn factors(degree: usize, node: &Vector<3>, xi: &Vector<3>) -> [(f64, f64); 4] {
    let barycentric = |x: &Vector<3>| [1.0 - x[0] - x[1] - x[2], x[0], x[1], x[2]];
    let of_node = barycentric(node);
    let here = barycentric(xi);
    let degree = degree as f64;
    std::array::from_fn(|i| factor(degree, (degree * of_node[i]).round() as usize, here[i]))
}

macro_rules! tetrahedron {
    ($name:ident, $n:literal, $degree:literal, $nodes:expr) => {
        #[doc = concat!("Tetrahedron of ", stringify!($n), " nodes.")]
        pub struct $name;

        impl Shape<3, $n> for $name {
            type Domain = Tetrahedron;
            const DEGREE: usize = $degree;
            const NODES: [Vector<3>; $n] = $nodes;

            fn values(xi: &Vector<3>) -> [f64; $n] {
                Self::NODES
                    .each_ref()
                    .map(|node| factors($degree, node, xi).map(|(value, _)| value).iter().product())
            }

            fn gradients(xi: &Vector<3>) -> [Vector<3>; $n] {
                Self::NODES.each_ref().map(|node| {
                    let [a, b, c, d] = factors($degree, node, xi);
                    let along = a.1 * b.0 * c.0 * d.0;
                    Vector([
                        a.0 * b.1 * c.0 * d.0 - along,
                        a.0 * b.0 * c.1 * d.0 - along,
                        a.0 * b.0 * c.0 * d.1 - along,
                    ])
                })
            }
        }
    };
}

tetrahedron!(Tet4, 4, 1, [at::<1>(0, 0, 0), at::<1>(1, 0, 0), at::<1>(0, 1, 0), at::<1>(0, 0, 1)]);

tetrahedron!(
    Tet10,
    10,
    2,
    [
        at::<2>(0, 0, 0),
        at::<2>(2, 0, 0),
        at::<2>(0, 2, 0),
        at::<2>(0, 0, 2),
        at::<2>(1, 0, 0),
        at::<2>(1, 1, 0),
        at::<2>(0, 1, 0),
        at::<2>(0, 0, 1),
        at::<2>(1, 0, 1),
        at::<2>(0, 1, 1),
    ]
);

tetrahedron!(
    Tet20,
    20,
    3,
    [
        at::<3>(0, 0, 0),
        at::<3>(3, 0, 0),
        at::<3>(0, 3, 0),
        at::<3>(0, 0, 3),
        at::<3>(1, 0, 0),
        at::<3>(2, 0, 0),
        at::<3>(2, 1, 0),
        at::<3>(1, 2, 0),
        at::<3>(0, 2, 0),
        at::<3>(0, 1, 0),
        at::<3>(0, 0, 1),
        at::<3>(0, 0, 2),
        at::<3>(2, 0, 1),
        at::<3>(1, 0, 2),
        at::<3>(0, 2, 1),
        at::<3>(0, 1, 2),
        at::<3>(1, 0, 1),
        at::<3>(1, 1, 1),
        at::<3>(0, 1, 1),
        at::<3>(1, 1, 0),
    ]
);
