//! Lines of 1 to 4 equally spaced nodes on −1..1: both ends, then the interior from start to end.
//!
//! ```text
//! 0-----------1     0-----2-----1     0---2---3---1
//! ```

use carom_algebra::Vector;

use super::{Domain, Shape};
use crate::quadrature::{self, Rule};

/// Shape functions of a line and their first and second derivatives; entries beyond its nodes are
/// zero.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct LineShape {
    /// φᵃ.
    pub values: [f64; 4],
    /// φᵃ′.
    pub first: [f64; 4],
    /// φᵃ″.
    pub second: [f64; 4],
}

/// Shape functions of the line with 1 (a point), 2, 3 or 4 nodes at `xi`, which may lie outside
/// −1..1: the polynomials extrapolate.
///
/// # Panics
/// For any other number of nodes.
///
/// ```
/// let arc = carom_solid::shape::line_shape(3, 0.0);
/// assert_eq!((arc.values, arc.second), ([0.0, 0.0, 1.0, 0.0], [1.0, 1.0, -2.0, 0.0]));
/// ```
#[inline]
pub fn line_shape(nodes: usize, xi: f64) -> LineShape {
    match nodes {
        1 => LineShape { values: [1.0, 0.0, 0.0, 0.0], ..LineShape::default() },
        2 => LineShape {
            values: [0.5 * (1.0 - xi), 0.5 * (1.0 + xi), 0.0, 0.0],
            first: [-0.5, 0.5, 0.0, 0.0],
            second: [0.0; 4],
        },
        3 => LineShape {
            values: [0.5 * xi * (xi - 1.0), 0.5 * xi * (xi + 1.0), (1.0 - xi) * (1.0 + xi), 0.0],
            first: [xi - 0.5, xi + 0.5, -2.0 * xi, 0.0],
            second: [1.0, 1.0, -2.0, 0.0],
        },
        4 => {
            let t = 3.0 * xi;
            let e = (3.0 * xi - 1.0) * (3.0 * xi + 1.0) / 16.0;
            let i = 9.0 / 16.0 * (1.0 - xi) * (1.0 + xi);
            LineShape {
                values: [(1.0 - xi) * e, (1.0 + xi) * e, (1.0 - t) * i, (1.0 + t) * i],
                first: [
                    (1.0 + xi * (18.0 - 27.0 * xi)) / 16.0,
                    (-1.0 + xi * (18.0 + 27.0 * xi)) / 16.0,
                    (-27.0 + xi * (-18.0 + 81.0 * xi)) / 16.0,
                    (27.0 + xi * (-18.0 - 81.0 * xi)) / 16.0,
                ],
                second: [
                    (9.0 - 27.0 * xi) / 8.0,
                    (9.0 + 27.0 * xi) / 8.0,
                    (-9.0 + 81.0 * xi) / 8.0,
                    (-9.0 - 81.0 * xi) / 8.0,
                ],
            }
        }
        _ => panic!("a line has 1 to 4 nodes, not {nodes}"),
    }
}

/// The curve through 1 (a point) to 4 nodes, Σ φᵃ xᵃ, by powers of ξ from ξ⁰ on.
///
/// # Panics
/// For any other number of nodes.
///
/// ```
/// use carom_algebra::Vector;
/// let arc = carom_solid::line_powers(&[Vector([0.0]), Vector([2.0]), Vector([3.0])]);
/// assert_eq!(arc.map(|power| power[0]), [3.0, 1.0, -2.0, 0.0]);
/// ```
#[inline]
pub fn line_powers<const D: usize>(nodes: &[Vector<D>]) -> [Vector<D>; 4] {
    match *nodes {
        [x] => [x, Vector::ZERO, Vector::ZERO, Vector::ZERO],
        [start, end] => [(start + end) * 0.5, (end - start) * 0.5, Vector::ZERO, Vector::ZERO],
        [start, end, middle] => [middle, (end - start) * 0.5, (start + end) * 0.5 - middle, Vector::ZERO],
        [start, end, early, late] => {
            let outer = start + end;
            let inner = early + late;
            let across = end - start;
            let within = late - early;
            [
                (inner * 9.0 - outer) * 0.0625,
                (within * 27.0 - across) * 0.0625,
                (outer - inner) * 0.5625,
                (across - within * 3.0) * 0.5625,
            ]
        }
        _ => panic!("a line has 1 to 4 nodes, not {}", nodes.len()),
    }
}

/// The interval −1..1.
pub struct Interval;

impl Domain<1> for Interval {
    const CENTRE: Vector<1> = Vector([0.0]);

    fn rule(degree: usize) -> Rule<1> {
        quadrature::line(degree)
    }

    fn excess(xi: &Vector<1>) -> f64 {
        xi[0].abs() - 1.0
    }
}

macro_rules! line {
    ($name:ident, $n:literal, $nodes:expr) => {
        #[doc = concat!("Line of ", stringify!($n), " nodes.")]
        pub struct $name;

        impl Shape<1, $n> for $name {
            type Domain = Interval;
            const DEGREE: usize = $n - 1;
            const NODES: [Vector<1>; $n] = $nodes;

            fn values(xi: &Vector<1>) -> [f64; $n] {
                let all = line_shape($n, xi[0]).values;
                std::array::from_fn(|a| all[a])
            }

            fn gradients(xi: &Vector<1>) -> [Vector<1>; $n] {
                let all = line_shape($n, xi[0]).first;
                std::array::from_fn(|a| Vector([all[a]]))
            }
        }
    };
}

line!(Line2, 2, [Vector([-1.0]), Vector([1.0])]);
line!(Line3, 3, [Vector([-1.0]), Vector([1.0]), Vector([0.0])]);
line!(Line4, 4, [Vector([-1.0]), Vector([1.0]), Vector([-1.0 / 3.0]), Vector([1.0 / 3.0])]);
