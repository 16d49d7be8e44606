//! The tetrahedron of 4 nodes on the unit simplex: φ = (1 − ξ − η − ζ, ξ, η, ζ).

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

/// Tetrahedron of 4 nodes.
pub struct Tet4;

impl Shape<3, 4> for Tet4 {
    type Domain = Tetrahedron;
    const DEGREE: usize = 1;
    const NODES: [Vector<3>; 4] =
        [Vector([0.0; 3]), Vector([1.0, 0.0, 0.0]), Vector([0.0, 1.0, 0.0]), Vector([0.0, 0.0, 1.0])];

    fn values(xi: &Vector<3>) -> [f64; 4] {
        [1.0 - xi[0] - xi[1] - xi[2], xi[0], xi[1], xi[2]]
    }

    fn gradients(_: &Vector<3>) -> [Vector<3>; 4] {
        [Vector([-1.0; 3]), Vector([1.0, 0.0, 0.0]), Vector([0.0, 1.0, 0.0]), Vector([0.0, 0.0, 1.0])]
    }
}
