//! Nodal forces of loads on a side, by quadrature over its facets (P. Wriggers, *Nonlinear Finite
//! Element Methods*, Springer 2008, §4.2.5):
//!
//! ```text
//! dead traction t̄ per reference area    fᵃ = Σ w φᵃ t̄ |n(X′)|
//! follower pressure p                    fᵃ = −Σ w φᵃ p n(y′),    ∂fᵃ/∂yᵇ = −Σ w φᵃ p Σ_α ∂n/∂y,α φᵇ,α
//! ```
//!
//! n dξ is the current area vector, out of the body: ±1 at the end of a bar, whose measure is the
//! cross-section; y′ turned to the right in the plane; y,₁ × y,₂ in space. The tangent is exact and
//! not symmetric: terms remain at the ends of the side and where p varies along it.

use crate::facet::{FacetFunctions, FacetShape, NODES};
use crate::mesh::{Facet, Mesh};

/// A side with its quadrature points; nodes are numbered as in the mesh, plus `first_node`.
pub struct LoadedSide {
    shape: FacetShape,
    dimension: usize,
    facets: Vec<Vec<usize>>,
    orientations: Vec<f64>,
    /// Facet after facet.
    points: Vec<Point>,
    thickness: f64,
}

struct Point {
    facet: usize,
    position: [f64; 3],
    weight: f64,
    /// Weight · |n(X′)| · thickness.
    area: f64,
    functions: FacetFunctions,
}

impl LoadedSide {
    /// Points of the facets of a side. `thickness` is the area of the cross-section in dimension 1;
    /// it is not used in space.
    pub fn new(mesh: &Mesh, facets: &[Facet], first_node: usize, thickness: f64) -> Self {
        let shape = mesh.element.facet_shape();
        let dimension = mesh.dimension();
        let thickness = if dimension < 3 { thickness } else { 1.0 };
        // A curved facet's |X′| is not a polynomial, nor is the formula of a load: twice the degree
        // of the products of shape functions, where there are such rules.
        let degree = 4 * mesh.element.degree() + 2;
        let rule = shape.rule(if dimension < 3 { degree } else { degree.min(10) });
        let orientations: Vec<f64> = facets.iter().map(|facet| mesh.orientation(facet)).collect();
        let mut points = Vec::new();
        for (k, facet) in facets.iter().enumerate() {
            let at = |values: &[f64; NODES]| interpolated(&facet.nodes, values, mesh.nodes.flat(), dimension);
            for &(xi, weight) in &rule {
                let functions = shape.functions(xi);
                let [x, y, z] = shape.area_vector([0, 1].map(|i| at(&functions.slopes[i])), orientations[k]);
                let area = weight * (x * x + y * y + z * z).sqrt() * thickness;
                points.push(Point { facet: k, position: at(&functions.values), weight, area, functions });
            }
        }
        let facets = facets.iter().map(|f| f.nodes.iter().map(|n| n + first_node).collect()).collect();
        Self { shape, dimension, facets, orientations, points, thickness }
    }

    /// Nodes of each facet.
    pub fn facets(&self) -> &[Vec<usize>] {
        &self.facets
    }

    /// Reference positions of the quadrature points.
    pub fn positions(&self) -> impl ExactSizeIterator<Item = &[f64]> + Clone {
        self.points.iter().map(|p| &p.position[..self.dimension])
    }

    /// Adds the nodal forces of a dead traction, given at the quadrature points per reference area,
    /// to `force`, flat over nodes.
    pub fn add_traction<'a>(&self, traction: impl IntoIterator<Item = &'a [f64]>, force: &mut [f64]) {
        for (point, traction) in self.points.iter().zip(traction) {
            self.add(point, traction, point.area, force);
        }
    }

    /// Adds the nodal forces of a pressure, given at the quadrature points per current area, at
    /// positions `y` to `force`.
    pub fn add_pressure(&self, pressure: &[f64], y: &[f64], force: &mut [f64]) {
        for (point, pressure) in self.points.iter().zip(pressure) {
            let normal = self.shape.area_vector(self.tangents(point, y), self.orientations[point.facet]);
            self.add(point, &normal, -pressure * point.weight * self.thickness, force);
        }
    }

    /// Derivatives of the positions `y` by the coordinates of a facet.
    fn tangents(&self, point: &Point, y: &[f64]) -> [[f64; 3]; 2] {
        let nodes = &self.facets[point.facet];
        [0, 1].map(|i| interpolated(nodes, &point.functions.slopes[i], y, self.dimension))
    }

    /// fᵃ += factor φᵃ vector.
    fn add(&self, point: &Point, vector: &[f64], factor: f64, force: &mut [f64]) {
        for (&node, phi) in self.facets[point.facet].iter().zip(point.functions.values) {
            for i in 0..self.dimension {
                force[node * self.dimension + i] += factor * phi * vector[i];
            }
        }
    }

    /// Overwrites `tangent` (`(n·D)²`, row-major, n nodes of the facet) with ∂f/∂y of a facet at
    /// positions `y`, under a pressure given at all quadrature points of the side. It depends on
    /// the positions in space only.
    pub fn facet_tangent(&self, facet: usize, pressure: &[f64], y: &[f64], tangent: &mut [f64]) {
        tangent.fill(0.0);
        let n = self.facets[facet].len();
        let d = self.dimension;
        let count = self.points.len() / self.facets.len();
        let own = facet * count..(facet + 1) * count;
        for (point, pressure) in self.points[own.clone()].iter().zip(&pressure[own]) {
            let factor = -pressure * point.weight * self.thickness;
            let tangents = self.tangents(point, y);
            for j in 0..d {
                // n is linear in each tangent; a point has none.
                let by_tangent = |alpha: usize| {
                    let mut changed = tangents;
                    changed[alpha] = std::array::from_fn(|i| f64::from(u8::from(i == j)));
                    self.shape.area_vector(changed, self.orientations[facet])
                };
                for alpha in 0..d - 1 {
                    let turned = by_tangent(alpha);
                    for a in 0..n {
                        for b in 0..n {
                            for i in 0..d {
                                let slope = point.functions.slopes[alpha][b];
                                let value = factor * point.functions.values[a] * slope * turned[i];
                                tangent[(a * d + i) * n * d + b * d + j] += value;
                            }
                        }
                    }
                }
            }
        }
    }
}

/// Σ valuesᵃ xᵃ over the nodes of a facet; components beyond the dimension are zero.
fn interpolated(nodes: &[usize], values: &[f64; NODES], x: &[f64], dimension: usize) -> [f64; 3] {
    let mut sum = [0.0; 3];
    for (node, value) in nodes.iter().zip(values) {
        for i in 0..dimension {
            sum[i] += value * x[node * dimension + i];
        }
    }
    sum
}
