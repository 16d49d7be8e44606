//! Shapes of facets, the cells of a body's boundary: a point at the end of a bar, a curve in the
//! plane, a surface in space.
//!
//! A facet of dimension D has D − 1 coordinates ξ, and D − 1 tangents. Its normal, as long as its
//! measure, is ±1 for a point, for a curve traversed with the body on its left the tangent rotated
//! to the right, and for a surface y,₁ × y,₂, its nodes counter-clockwise seen from outside.

use std::sync::OnceLock;

use carom_algebra::Vector;

use crate::quadrature;
use crate::shape::{LineShape, Quad4, Quad9, Shape, Tri3, Tri6, Tri10, line_shape};

/// Shape of a facet.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[allow(missing_docs)]
pub enum FacetShape {
    Point,
    L2,
    L3,
    L4,
    T3,
    T6,
    T10,
    Q4,
    Q9,
}

/// Most nodes of a facet.
pub(crate) const NODES: usize = 10;

/// ∂²φᵃ/∂ξ∂ξ, ∂²φᵃ/∂ξ∂η and ∂²φᵃ/∂η∂η of L(2L − 1) and 4LL.
const T6_SECOND: [[f64; 6]; 3] =
    [[4.0, 4.0, 0.0, -8.0, 0.0, 0.0], [4.0, 0.0, 0.0, -4.0, 4.0, -4.0], [4.0, 0.0, 4.0, 0.0, 0.0, -8.0]];

/// Shape functions of a facet at a point; entries beyond its nodes and its coordinates are zero.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FacetFunctions {
    /// φᵃ.
    pub values: [f64; NODES],
    /// ∂φᵃ/∂ξ by coordinate.
    pub slopes: [[f64; NODES]; 2],
}

impl FacetShape {
    /// Number of nodes.
    pub fn nodes(self) -> usize {
        match self {
            Self::Point => 1,
            Self::L2 => 2,
            Self::L3 | Self::T3 => 3,
            Self::L4 | Self::Q4 => 4,
            Self::T6 => 6,
            Self::Q9 => 9,
            Self::T10 => 10,
        }
    }

    /// Dimension of the space whose bodies have such facets.
    pub fn dimension(self) -> usize {
        match self {
            Self::Point => 1,
            Self::L2 | Self::L3 | Self::L4 => 2,
            Self::T3 | Self::T6 | Self::T10 | Self::Q4 | Self::Q9 => 3,
        }
    }

    /// Number of corners, which are its first nodes.
    pub fn corners(self) -> usize {
        match self {
            Self::Point => 1,
            Self::L2 | Self::L3 | Self::L4 => 2,
            Self::T3 | Self::T6 | Self::T10 => 3,
            Self::Q4 | Self::Q9 => 4,
        }
    }

    /// Polynomial degree; 0 for a point.
    pub fn degree(self) -> usize {
        match self {
            Self::Point => 0,
            Self::L2 | Self::T3 | Self::Q4 => 1,
            Self::L3 | Self::T6 | Self::Q9 => 2,
            Self::L4 | Self::T10 => 3,
        }
    }

    /// Shape functions of a point or a curve and their derivatives; for a point all derivatives are
    /// zero.
    ///
    /// # Panics
    /// For a surface.
    #[inline]
    pub fn at(self, xi: f64) -> LineShape {
        assert!(self.dimension() < 3, "a surface has two coordinates");
        line_shape(self.nodes(), xi)
    }

    /// Shape functions and their first derivatives at a point of any facet; unused coordinates are
    /// ignored.
    pub fn functions(self, xi: [f64; 2]) -> FacetFunctions {
        match self {
            Self::Point | Self::L2 | Self::L3 | Self::L4 => {
                let line = self.at(xi[0]);
                let wide = |narrow: [f64; 4]| std::array::from_fn(|a| narrow.get(a).copied().unwrap_or(0.0));
                FacetFunctions { values: wide(line.values), slopes: [wide(line.first), [0.0; NODES]] }
            }
            Self::T3 => surface::<3, Tri3>(xi),
            Self::T6 => surface::<6, Tri6>(xi),
            Self::T10 => surface::<10, Tri10>(xi),
            Self::Q4 => surface::<4, Quad4>(xi),
            Self::Q9 => surface::<9, Quad9>(xi),
        }
    }

    /// Points spread over a surface, five between two corners, and φᵃ there.
    pub fn samples(self) -> &'static [([f64; 2], [f64; NODES])] {
        static KNOWN: [OnceLock<Vec<([f64; 2], [f64; NODES])>>; 9] = [const { OnceLock::new() }; 9];
        KNOWN[self as usize].get_or_init(|| {
            let is_triangle = self.corners() == 3;
            let lines = (0..5_u8).flat_map(|i| (0..if is_triangle { 5 - i } else { 5 }).map(move |j| [i, j]));
            let at = lines.map(|line| line.map(|k| f64::from(k) / 4.0));
            let place = |x: [f64; 2]| if is_triangle { x } else { x.map(|x| 2.0 * x - 1.0) };
            at.map(|x| (place(x), self.functions(place(x)).values)).collect()
        })
    }

    /// ∂²φᵃ/∂ξ∂ξ, ∂²φᵃ/∂ξ∂η and ∂²φᵃ/∂η∂η of a surface: constant or, by central differences of the
    /// first derivatives, exact, because these are quadratic in each coordinate at most.
    pub fn second(self, xi: [f64; 2]) -> [[f64; NODES]; 3] {
        let mut second = [[0.0; NODES]; 3];
        match self {
            Self::T3 => {}
            Self::T6 => {
                for (second, constant) in second.iter_mut().zip(T6_SECOND) {
                    second[..6].copy_from_slice(&constant);
                }
            }
            _ => {
                for axis in 0..2 {
                    let [low, high] = [-0.5, 0.5].map(|step| {
                        let mut moved = xi;
                        moved[axis] += step;
                        self.functions(moved)
                    });
                    for (i, a) in (axis..2).flat_map(|i| (0..self.nodes()).map(move |a| (i, a))) {
                        second[axis + i][a] = high.slopes[i][a] - low.slopes[i][a];
                    }
                }
            }
        }
        second
    }

    /// Nodes of the edge from a corner of a surface to the next one, in the order of a line's, and
    /// how many there are.
    pub fn edge(self, edge: usize) -> ([usize; 4], usize) {
        let corners = self.corners();
        let inner = self.degree() - 1;
        let node = |k: usize| match k {
            0 => edge,
            1 => (edge + 1) % corners,
            _ => corners + inner * edge + k - 2,
        };
        (std::array::from_fn(node), inner + 2)
    }

    /// Quadrature points and weights exact for polynomials of a degree; a point has weight one.
    ///
    /// # Panics
    /// For a degree above 10 on a triangle.
    pub fn rule(self, degree: usize) -> Vec<([f64; 2], f64)> {
        match self {
            Self::Point => vec![([0.0; 2], 1.0)],
            Self::L2 | Self::L3 | Self::L4 => {
                quadrature::line(degree).iter().map(|(xi, w)| ([xi[0], 0.0], w)).collect()
            }
            Self::T3 | Self::T6 | Self::T10 => {
                quadrature::triangle(degree).iter().map(|(xi, w)| (xi.0, w)).collect()
            }
            Self::Q4 | Self::Q9 => quadrature::tensor(degree).iter().map(|(xi, w)| (xi.0, w)).collect(),
        }
    }

    /// Outward normal of a point or a curve with the length of the facet's measure per ξ, from the
    /// derivative y′ of its positions. `orientation`: see
    /// [`Mesh::orientation`](crate::Mesh::orientation). Components beyond the dimension are zero.
    ///
    /// # Panics
    /// For a surface.
    #[inline]
    pub fn normal(self, tangent: [f64; 2], orientation: f64) -> [f64; 2] {
        match self {
            Self::Point => [orientation, 0.0],
            Self::L2 | Self::L3 | Self::L4 => [orientation * tangent[1], -orientation * tangent[0]],
            Self::T3 | Self::T6 | Self::T10 | Self::Q4 | Self::Q9 => panic!("a surface has two tangents"),
        }
    }

    /// The same for every facet, from the derivatives of its positions by both coordinates.
    #[inline]
    pub fn area_vector(self, tangents: [[f64; 3]; 2], orientation: f64) -> [f64; 3] {
        let [t, s] = tangents;
        if self.dimension() < 3 {
            let [x, y] = self.normal([t[0], t[1]], orientation);
            return [x, y, 0.0];
        }
        [t[1] * s[2] - t[2] * s[1], t[2] * s[0] - t[0] * s[2], t[0] * s[1] - t[1] * s[0]]
            .map(|component| orientation * component)
    }
}

fn surface<const N: usize, S: Shape<2, N>>(xi: [f64; 2]) -> FacetFunctions {
    let own = S::values(&Vector(xi));
    let gradients = S::gradients(&Vector(xi));
    let mut functions = FacetFunctions { values: [0.0; NODES], slopes: [[0.0; NODES]; 2] };
    for a in 0..N {
        functions.values[a] = own[a];
        functions.slopes[0][a] = gradients[a][0];
        functions.slopes[1][a] = gradients[a][1];
    }
    functions
}
