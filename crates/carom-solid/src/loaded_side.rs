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
        let (shape, dimension) = (mesh.element.facet_shape(), mesh.dimension());
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
        let (n, d) = (self.facets[facet].len(), self.dimension);
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::generate;
    use crate::mesh::Element;

    fn side(mesh: &Mesh, name: &str) -> LoadedSide {
        LoadedSide::new(mesh, &mesh.sides[name], 0, 0.5)
    }

    fn total(force: &[f64]) -> [f64; 2] {
        force.as_chunks::<2>().0.iter().fold([0.0; 2], |s, f| [s[0] + f[0], s[1] + f[1]])
    }

    #[test]
    fn tractions_on_a_straight_side_and_an_arc_have_their_resultants() {
        let mesh = generate::rectangle(Element::T10, [0.0, 0.0], [2.0, 1.0], [3, 2]).unwrap();
        let top = side(&mesh, "top");
        let mut force = vec![0.0; 2 * mesh.nodes.len()];
        let traction: Vec<_> = top.positions().map(|x| [1.0, x[0].powi(3)]).collect();
        top.add_traction(traction.iter().map(|t| &t[..]), &mut force);
        let [fx, fy] = total(&force);
        assert!((fx - 1.0).abs() < 1e-14 && (fy - 2.0).abs() < 1e-14, "{fx} {fy}");
        // Also the moment of a cubic traction: φ reproduces x exactly.
        let moment: f64 = force.as_chunks::<2>().0.iter().zip(&mesh.nodes).map(|(f, x)| f[1] * x[0]).sum();
        assert!((moment - 0.5 * 32.0 / 5.0).abs() < 1e-14);

        // The circle's length by cubics through its points: the error is of fourth order.
        let errors = [0.5, 0.25].map(|size| {
            let mesh = generate::disc(Element::T10, 2.0, [0.0, 0.0], size).unwrap();
            let arc = side(&mesh, "arc");
            let mut force = vec![0.0; 2 * mesh.nodes.len()];
            arc.add_traction(std::iter::repeat_n(&[0.0, 1.0][..], arc.positions().len()), &mut force);
            total(&force)[1] / 0.5 - 4.0 * std::f64::consts::PI
        });
        assert!(errors[1].abs() < 1e-5 && (errors[0] / errors[1]).log2() > 3.9, "{errors:?}");
    }

    #[test]
    fn a_uniform_pressure_on_a_closed_side_is_balanced_and_points_inwards() {
        let mesh = generate::disc(Element::T6, 1.0, [0.3, -0.2], 0.4).unwrap();
        let arc = side(&mesh, "arc");
        let y: Vec<f64> =
            mesh.nodes.iter().flat_map(|x| [x[0] + 0.1 * x[1] * x[1], x[1] - 0.2 * x[0]]).collect();
        let mut force = vec![0.0; 2 * mesh.nodes.len()];
        arc.add_pressure(&vec![3.0; arc.positions().len()], &y, &mut force);
        let [fx, fy] = total(&force);
        assert!(fx.abs() + fy.abs() < 1e-13);
        // Virial: Σ f·y = −2 p A, with A the area enclosed by the same polynomials.
        let virial: f64 = force.iter().zip(&y).map(|(f, y)| f * y).sum();
        assert!(virial < 0.0);
    }

    #[test]
    fn the_tangent_of_the_pressure_is_its_derivative() {
        for element in [Element::T3, Element::T6, Element::T10] {
            let mesh = generate::half_disc(element, 1.0, [0.0, 0.0], 0.5).unwrap();
            let arc = side(&mesh, "arc");
            let pressure: Vec<f64> = arc.positions().map(|x| 1.0 + x[1] * x[0]).collect();
            let y: Vec<f64> =
                mesh.nodes.iter().flat_map(|x| [x[0] + 0.2 * x[1].sin(), x[1] + 0.1 * x[0]]).collect();
            let at = |y: &[f64]| {
                let mut force = vec![0.0; y.len()];
                arc.add_pressure(&pressure, y, &mut force);
                force
            };
            let direction = |dof: usize| (dof as f64 * 12.9898).sin();
            let moved =
                |h: f64| -> Vec<f64> { y.iter().enumerate().map(|(k, y)| y + h * direction(k)).collect() };
            let (plus, minus) = (at(&moved(0.5)), at(&moved(-0.5)));
            let mut product = vec![0.0; y.len()];
            for (f, nodes) in arc.facets().iter().enumerate() {
                let n = nodes.len();
                let mut tangent = vec![0.0; 4 * n * n];
                arc.facet_tangent(f, &pressure, &y, &mut tangent);
                for a in 0..2 * n {
                    for b in 0..2 * n {
                        product[2 * nodes[a / 2] + a % 2] +=
                            tangent[a * 2 * n + b] * direction(2 * nodes[b / 2] + b % 2);
                    }
                }
            }
            // The force is linear in y: the difference is exact.
            for dof in 0..y.len() {
                let difference = plus[dof] - minus[dof];
                assert!((difference - product[dof]).abs() < 1e-14, "{element:?} dof {dof}");
            }
        }
    }

    #[test]
    fn a_bar_is_loaded_on_its_cross_section() {
        let mesh = generate::interval(Element::L3, 1.0, 3.0, 4).unwrap();
        for (name, sign) in [("left", 1.0), ("right", -1.0)] {
            let end = LoadedSide::new(&mesh, &mesh.sides[name], 0, 0.25);
            let y = mesh.nodes.flat();
            let mut force = vec![0.0; y.len()];
            end.add_pressure(&[8.0], y, &mut force);
            assert_eq!(force.iter().sum::<f64>(), sign * 2.0);
            end.add_traction([&[-sign * 8.0][..]], &mut force);
            assert!(force.iter().all(|f| *f == 0.0));
        }
    }
}
