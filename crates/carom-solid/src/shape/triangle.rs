//! Triangles of degree 1, 2 and 3 on (0,0) (1,0) (0,1), in barycentric coordinates L₀ = 1 − ξ − η,
//! L₁ = ξ, L₂ = η (Zienkiewicz, Taylor: The Finite Element Method, ch. 6).
//!
//! ```text
//! 2           2            2
//! | \         | \          | \
//! |   \       5   4        7   6
//! |     \     |     \      |     \
//! 0-------1   0---3---1    8   9   5
//!                          |         \
//!                          0---3---4---1
//! ```

use carom_algebra::Vector;

use super::{Domain, Shape};
use crate::quadrature::{self, Rule};

/// The triangle (0,0) (1,0) (0,1).
pub struct Triangle;

impl Domain<2> for Triangle {
    const CENTRE: Vector<2> = Vector([1.0 / 3.0, 1.0 / 3.0]);

    fn rule(degree: usize) -> Rule<2> {
        quadrature::triangle(degree)
    }

    fn excess(xi: &Vector<2>) -> f64 {
        (-xi[0]).max(-xi[1]).max(xi[0] + xi[1] - 1.0)
    }
}

/// The edges, in the order of their nodes.
const EDGES: [[usize; 2]; 3] = [[0, 1], [1, 2], [2, 0]];

fn barycentric(xi: &Vector<2>) -> [f64; 3] {
    [1.0 - xi[0] - xi[1], xi[0], xi[1]]
}

/// ∂φ/∂ξ from ∂φ/∂L.
fn chain(d: [f64; 3]) -> Vector<2> {
    Vector([d[1] - d[0], d[2] - d[0]])
}

/// Triangle of 3 nodes.
pub struct Tri3;

impl Shape<2, 3> for Tri3 {
    type Domain = Triangle;
    const DEGREE: usize = 1;
    const NODES: [Vector<2>; 3] = [Vector([0.0, 0.0]), Vector([1.0, 0.0]), Vector([0.0, 1.0])];

    fn values(xi: &Vector<2>) -> [f64; 3] {
        barycentric(xi)
    }

    fn gradients(_: &Vector<2>) -> [Vector<2>; 3] {
        [Vector([-1.0, -1.0]), Vector([1.0, 0.0]), Vector([0.0, 1.0])]
    }
}

/// Triangle of 6 nodes.
pub struct Tri6;

impl Shape<2, 6> for Tri6 {
    type Domain = Triangle;
    const DEGREE: usize = 2;
    const NODES: [Vector<2>; 6] = [
        Vector([0.0, 0.0]),
        Vector([1.0, 0.0]),
        Vector([0.0, 1.0]),
        Vector([0.5, 0.0]),
        Vector([0.5, 0.5]),
        Vector([0.0, 0.5]),
    ];

    fn values(xi: &Vector<2>) -> [f64; 6] {
        let l = barycentric(xi);
        std::array::from_fn(|a| {
            if a < 3 {
                l[a] * (2.0 * l[a] - 1.0)
            } else {
                let [i, j] = EDGES[a - 3];
                4.0 * l[i] * l[j]
            }
        })
    }

    fn gradients(xi: &Vector<2>) -> [Vector<2>; 6] {
        let l = barycentric(xi);
        std::array::from_fn(|a| {
            let mut d = [0.0; 3];
            if a < 3 {
                d[a] = 4.0 * l[a] - 1.0;
            } else {
                let [i, j] = EDGES[a - 3];
                d[i] = 4.0 * l[j];
                d[j] = 4.0 * l[i];
            }
            chain(d)
        })
    }
}

/// Triangle of 10 nodes.
pub struct Tri10;

const THIRD: f64 = 1.0 / 3.0;

impl Shape<2, 10> for Tri10 {
    type Domain = Triangle;
    const DEGREE: usize = 3;
    const NODES: [Vector<2>; 10] = [
        Vector([0.0, 0.0]),
        Vector([1.0, 0.0]),
        Vector([0.0, 1.0]),
        Vector([THIRD, 0.0]),
        Vector([2.0 * THIRD, 0.0]),
        Vector([2.0 * THIRD, THIRD]),
        Vector([THIRD, 2.0 * THIRD]),
        Vector([0.0, 2.0 * THIRD]),
        Vector([0.0, THIRD]),
        Vector([THIRD, THIRD]),
    ];

    fn values(xi: &Vector<2>) -> [f64; 10] {
        let l = barycentric(xi);
        std::array::from_fn(|a| match a {
            0..3 => 0.5 * l[a] * (3.0 * l[a] - 1.0) * (3.0 * l[a] - 2.0),
            9 => 27.0 * l[0] * l[1] * l[2],
            _ => {
                let (near, far) = edge_node(a);
                4.5 * l[near] * l[far] * (3.0 * l[near] - 1.0)
            }
        })
    }

    fn gradients(xi: &Vector<2>) -> [Vector<2>; 10] {
        let l = barycentric(xi);
        std::array::from_fn(|a| {
            let mut d = [0.0; 3];
            match a {
                0..3 => d[a] = 0.5 * (27.0 * l[a] * l[a] - 18.0 * l[a] + 2.0),
                9 => d = [27.0 * l[1] * l[2], 27.0 * l[0] * l[2], 27.0 * l[0] * l[1]],
                _ => {
                    let (near, far) = edge_node(a);
                    d[near] = 4.5 * l[far] * (6.0 * l[near] - 1.0);
                    d[far] = 4.5 * l[near] * (3.0 * l[near] - 1.0);
                }
            }
            chain(d)
        })
    }
}

/// The nearer and the farther corner of an edge node.
fn edge_node(a: usize) -> (usize, usize) {
    let [i, j] = EDGES[(a - 3) / 2];
    if a % 2 == 1 { (i, j) } else { (j, i) }
}
