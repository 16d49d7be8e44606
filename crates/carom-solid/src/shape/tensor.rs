//! Quadrilaterals and hexahedra of degree 1 and 2 on the square and the cube −1..1: products of the
//! shape functions of a line (Zienkiewicz, Taylor: The Finite Element Method, ch. 6).
//!
//! ```text
//! 3---6---2     corners; edges 01 12 23 30; centre
//! 7   8   5     hexahedra, in VTK's order: corners of the bottom, of the top; edges of the bottom,
//! 0---4---1     of the top, upright; faces −x +x −y +y −z +z; centre
//! ```

use carom_algebra::Vector;

use super::{Domain, LineShape, Shape, line_shape};
use crate::quadrature::{self, Rule};

/// The square −1..1 × −1..1.
pub struct Square;

/// The cube −1..1 × −1..1 × −1..1.
pub struct Cube;

macro_rules! domain {
    ($name:ident, $r:literal) => {
        impl Domain<$r> for $name {
            const TENSOR: bool = true;
            const CENTRE: Vector<$r> = Vector([0.0; $r]);

            fn rule(degree: usize) -> Rule<$r> {
                quadrature::tensor(degree)
            }

            fn excess(xi: &Vector<$r>) -> f64 {
                xi.0.iter().fold(0.0_f64, |most, x| most.max(x.abs())) - 1.0
            }
        }
    };
}

domain!(Square, 2);
domain!(Cube, 3);

/// The node of a line at −1, 0 or 1.
fn place(xi: f64) -> usize {
    match xi {
        -1.0 => 0,
        1.0 => 1,
        _ => 2,
    }
}

macro_rules! cell {
    ($name:ident, $what:literal, $domain:ident, $r:literal, $n:literal, $degree:literal, $nodes:expr) => {
        #[doc = concat!($what, " of ", stringify!($n), " nodes.")]
        pub struct $name;

        impl Shape<$r, $n> for $name {
            type Domain = $domain;
            const DEGREE: usize = $degree;
            const NODES: [Vector<$r>; $n] = $nodes;

            fn values(xi: &Vector<$r>) -> [f64; $n] {
                let along: [LineShape; $r] = xi.0.map(|x| line_shape($degree + 1, x));
                Self::NODES.map(|node| (0..$r).map(|i| along[i].values[place(node[i])]).product())
            }

            fn gradients(xi: &Vector<$r>) -> [Vector<$r>; $n] {
                let along: [LineShape; $r] = xi.0.map(|x| line_shape($degree + 1, x));
                Self::NODES.map(|node| {
                    Vector(std::array::from_fn(|j| {
                        let factor = |i: usize| if i == j { along[i].first } else { along[i].values };
                        (0..$r).map(|i| factor(i)[place(node[i])]).product()
                    }))
                })
            }
        }
    };
}

const fn flat(x: f64, y: f64) -> Vector<2> {
    Vector([x, y])
}

const fn at(x: f64, y: f64, z: f64) -> Vector<3> {
    Vector([x, y, z])
}

cell!(
    Quad4,
    "Quadrilateral",
    Square,
    2,
    4,
    1,
    [flat(-1.0, -1.0), flat(1.0, -1.0), flat(1.0, 1.0), flat(-1.0, 1.0)]
);

cell!(
    Quad9,
    "Quadrilateral",
    Square,
    2,
    9,
    2,
    [
        flat(-1.0, -1.0),
        flat(1.0, -1.0),
        flat(1.0, 1.0),
        flat(-1.0, 1.0),
        flat(0.0, -1.0),
        flat(1.0, 0.0),
        flat(0.0, 1.0),
        flat(-1.0, 0.0),
        flat(0.0, 0.0),
    ]
);

cell!(
    Hex8,
    "Hexahedron",
    Cube,
    3,
    8,
    1,
    [
        at(-1.0, -1.0, -1.0),
        at(1.0, -1.0, -1.0),
        at(1.0, 1.0, -1.0),
        at(-1.0, 1.0, -1.0),
        at(-1.0, -1.0, 1.0),
        at(1.0, -1.0, 1.0),
        at(1.0, 1.0, 1.0),
        at(-1.0, 1.0, 1.0),
    ]
);

cell!(
    Hex27,
    "Hexahedron",
    Cube,
    3,
    27,
    2,
    [
        at(-1.0, -1.0, -1.0),
        at(1.0, -1.0, -1.0),
        at(1.0, 1.0, -1.0),
        at(-1.0, 1.0, -1.0),
        at(-1.0, -1.0, 1.0),
        at(1.0, -1.0, 1.0),
        at(1.0, 1.0, 1.0),
        at(-1.0, 1.0, 1.0),
        at(0.0, -1.0, -1.0),
        at(1.0, 0.0, -1.0),
        at(0.0, 1.0, -1.0),
        at(-1.0, 0.0, -1.0),
        at(0.0, -1.0, 1.0),
        at(1.0, 0.0, 1.0),
        at(0.0, 1.0, 1.0),
        at(-1.0, 0.0, 1.0),
        at(-1.0, -1.0, 0.0),
        at(1.0, -1.0, 0.0),
        at(1.0, 1.0, 0.0),
        at(-1.0, 1.0, 0.0),
        at(-1.0, 0.0, 0.0),
        at(1.0, 0.0, 0.0),
        at(0.0, -1.0, 0.0),
        at(0.0, 1.0, 0.0),
        at(0.0, 0.0, -1.0),
        at(0.0, 0.0, 1.0),
        at(0.0, 0.0, 0.0),
    ]
);
