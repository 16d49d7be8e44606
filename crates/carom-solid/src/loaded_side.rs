//! What loads on a side put on its nodes, by quadrature over its facets (P. Wriggers, *Nonlinear Finite Element Methods*, Springer 2008, §4.2.5):
//!
//! ```text
//! dead traction t̄ per reference area    fᵃ = Σ w φᵃ t̄ |X′|
//! follower pressure p                    fᵃ = −Σ w φᵃ p R y′,     ∂fᵃ/∂yᵇ = −Σ w φᵃ p φᵇ′ R,     R = [0 1; −1 0]
//! ```
//!
//! R turns the tangent y′ right, out of the body, so R y′ dξ is the current area with its normal, and the force is linear in the positions. The
//! tangent is exact and not symmetric: ∫ (φᵃ φᵇ′ + φᵃ′ φᵇ) p dξ leaves what happens at the ends of the side and where p changes along it. In
//! dimension 1 a side is a cross-section: traction and pressure act on its area, and the tangent is zero.

use crate::mesh::{Facet, Mesh};
use crate::quadrature;
use crate::shape::{LineShape, line_shape};

/// Nodes of the largest facet.
pub const MAX_FACET_NODES: usize = 4;

/// A side with its quadrature points; nodes are numbered as the mesh's, plus `first_node`.
pub struct LoadedSide<const D: usize> {
    facets: Vec<Vec<usize>>,
    points: Vec<Point<D>>,
    thickness: f64,
    /// Dimension 1: direction out of the body, ±1.
    outward: f64,
}

struct Point<const D: usize> {
    facet: usize,
    position: [f64; D],
    weight: f64,
    /// Weight · |X′| · thickness.
    area: f64,
    shape: LineShape,
}

impl<const D: usize> LoadedSide<D> {
    /// Points of the facets of a side. `thickness` is the area of the cross-section in dimension 1.
    pub fn new(mesh: &Mesh<D>, facets: &[Facet], first_node: usize, thickness: f64) -> Self {
        // A curved facet's |X′| is no polynomial, and neither is a load's formula: twice the degree of the shape functions' products.
        let rule = quadrature::line(4 * mesh.element.degree() + 2);
        let mut points = Vec::new();
        let mut outward = 0.0;
        for (k, facet) in facets.iter().enumerate() {
            let at = |values: &[f64; 4]| -> [f64; D] {
                std::array::from_fn(|i| facet.nodes.iter().zip(values).map(|(&n, v)| v * mesh.nodes[n][i]).sum())
            };
            if D == 1 {
                let shape = line_shape(1, 0.0);
                let end = mesh.nodes[facet.nodes[0]][0];
                let cell = mesh.cell(facet.cell);
                outward = (end - cell.iter().map(|&n| mesh.nodes[n][0]).sum::<f64>() / cell.len() as f64).signum();
                points.push(Point { facet: k, position: at(&shape.values), weight: 1.0, area: thickness, shape });
                continue;
            }
            for (xi, weight) in rule.iter() {
                let shape = line_shape(facet.nodes.len(), xi[0]);
                let length = at(&shape.first).iter().map(|t| t * t).sum::<f64>().sqrt();
                let position = at(&shape.values);
                points.push(Point { facet: k, position, weight, area: weight * length * thickness, shape });
            }
        }
        let facets = facets.iter().map(|f| f.nodes.iter().map(|n| n + first_node).collect()).collect();
        Self { facets, points, thickness, outward }
    }

    /// Nodes of each facet.
    pub fn facets(&self) -> &[Vec<usize>] {
        &self.facets
    }

    /// Reference positions of the quadrature points.
    pub fn positions(&self) -> impl ExactSizeIterator<Item = &[f64; D]> {
        self.points.iter().map(|p| &p.position)
    }

    /// Adds the nodal forces of a dead traction, given at the quadrature points per reference area, to `force`.
    pub fn add_traction(&self, traction: impl IntoIterator<Item = [f64; D]>, force: &mut [[f64; D]]) {
        for (point, traction) in self.points.iter().zip(traction) {
            for (&node, phi) in self.facets[point.facet].iter().zip(point.shape.values) {
                for i in 0..D {
                    force[node][i] += point.area * phi * traction[i];
                }
            }
        }
    }

    /// Adds the nodal forces of a pressure, given at the quadrature points per current area, at positions `y` to `force`.
    pub fn add_pressure(&self, pressure: &[f64], y: &[[f64; D]], force: &mut [[f64; D]]) {
        for (point, pressure) in self.points.iter().zip(pressure) {
            let nodes = &self.facets[point.facet];
            let push = if D == 1 {
                [-pressure * point.area * self.outward; D]
            } else {
                let tangent = |i: usize| nodes.iter().zip(point.shape.first).map(|(&n, d)| d * y[n][i]).sum::<f64>();
                let factor = -pressure * point.weight * self.thickness;
                let turned = [tangent(1) * factor, -tangent(0) * factor];
                std::array::from_fn(|i| turned[i])
            };
            for (&node, phi) in nodes.iter().zip(point.shape.values) {
                for i in 0..D {
                    force[node][i] += phi * push[i];
                }
            }
        }
    }

    /// Overwrites `tangent` (`(n·D)²`, row-major, n nodes of the facet) with ∂f/∂y of a facet under a pressure given at all quadrature points of
    /// the side. It does not depend on the positions.
    pub fn facet_tangent(&self, facet: usize, pressure: &[f64], tangent: &mut [f64]) {
        tangent.fill(0.0);
        let n = self.facets[facet].len();
        if D == 1 {
            return;
        }
        for (point, pressure) in self.points.iter().zip(pressure).filter(|(p, _)| p.facet == facet) {
            let factor = -pressure * point.weight * self.thickness;
            for a in 0..n {
                for b in 0..n {
                    let value = factor * point.shape.values[a] * point.shape.first[b];
                    tangent[(a * D) * n * D + b * D + 1] += value;
                    tangent[(a * D + 1) * n * D + b * D] -= value;
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::generate;
    use crate::mesh::Element;

    fn side(mesh: &Mesh<2>, name: &str) -> LoadedSide<2> {
        LoadedSide::new(mesh, &mesh.sides[name], 0, 0.5)
    }

    fn total(force: &[[f64; 2]]) -> [f64; 2] {
        force.iter().fold([0.0; 2], |s, f| [s[0] + f[0], s[1] + f[1]])
    }

    #[test]
    fn tractions_on_a_straight_side_and_an_arc_have_their_resultants() {
        let mesh = generate::rectangle(Element::T10, [0.0, 0.0], [2.0, 1.0], [3, 2]).unwrap();
        let top = side(&mesh, "top");
        let mut force = vec![[0.0; 2]; mesh.nodes.len()];
        let traction: Vec<_> = top.positions().map(|x| [1.0, x[0].powi(3)]).collect();
        top.add_traction(traction, &mut force);
        let [fx, fy] = total(&force);
        assert!((fx - 1.0).abs() < 1e-14 && (fy - 2.0).abs() < 1e-14, "{fx} {fy}");
        // The moment of a cubic traction too: φ reproduces x exactly.
        let moment: f64 = force.iter().zip(&mesh.nodes).map(|(f, x)| f[1] * x[0]).sum();
        assert!((moment - 0.5 * 32.0 / 5.0).abs() < 1e-14);

        // The circle's length, by cubics through points of it: an error of the fourth order.
        let errors = [0.5, 0.25].map(|size| {
            let mesh = generate::disc(Element::T10, 2.0, [0.0, 0.0], size).unwrap();
            let arc = side(&mesh, "arc");
            let mut force = vec![[0.0; 2]; mesh.nodes.len()];
            arc.add_traction(vec![[0.0, 1.0]; arc.positions().len()], &mut force);
            total(&force)[1] / 0.5 - 4.0 * std::f64::consts::PI
        });
        assert!(errors[1].abs() < 1e-5 && (errors[0] / errors[1]).log2() > 3.9, "{errors:?}");
    }

    #[test]
    fn a_uniform_pressure_on_a_closed_side_is_balanced_and_points_inwards() {
        let mesh = generate::disc(Element::T6, 1.0, [0.3, -0.2], 0.4).unwrap();
        let arc = side(&mesh, "arc");
        let y: Vec<[f64; 2]> = mesh.nodes.iter().map(|x| [x[0] + 0.1 * x[1] * x[1], x[1] - 0.2 * x[0]]).collect();
        let mut force = vec![[0.0; 2]; mesh.nodes.len()];
        arc.add_pressure(&vec![3.0; arc.positions().len()], &y, &mut force);
        let [fx, fy] = total(&force);
        assert!(fx.abs() + fy.abs() < 1e-13);
        // Virial: Σ f·y = −2 p A, with A the enclosed area by the same polynomials.
        let virial: f64 = force.iter().zip(&y).map(|(f, y)| f[0] * y[0] + f[1] * y[1]).sum();
        assert!(virial < 0.0);
    }

    #[test]
    fn the_tangent_of_the_pressure_is_its_derivative() {
        for element in [Element::T3, Element::T6, Element::T10] {
            let mesh = generate::half_disc(element, 1.0, [0.0, 0.0], 0.5).unwrap();
            let arc = side(&mesh, "arc");
            let pressure: Vec<f64> = arc.positions().map(|x| 1.0 + x[1] * x[0]).collect();
            let y: Vec<[f64; 2]> = mesh.nodes.iter().map(|x| [x[0] + 0.2 * x[1].sin(), x[1] + 0.1 * x[0]]).collect();
            let at = |y: &[[f64; 2]]| {
                let mut force = vec![[0.0; 2]; y.len()];
                arc.add_pressure(&pressure, y, &mut force);
                force
            };
            let direction = |n: usize, i: usize| ((n * 2 + i) as f64 * 12.9898).sin();
            let moved = |h: f64| -> Vec<[f64; 2]> {
                y.iter().enumerate().map(|(n, y)| std::array::from_fn(|i| y[i] + h * direction(n, i))).collect()
            };
            let (plus, minus) = (at(&moved(0.5)), at(&moved(-0.5)));
            let mut product = vec![[0.0; 2]; y.len()];
            for (f, nodes) in arc.facets().iter().enumerate() {
                let n = nodes.len();
                let mut tangent = vec![0.0; 4 * n * n];
                arc.facet_tangent(f, &pressure, &mut tangent);
                for a in 0..2 * n {
                    for b in 0..2 * n {
                        product[nodes[a / 2]][a % 2] += tangent[a * 2 * n + b] * direction(nodes[b / 2], b % 2);
                    }
                }
            }
            // The force is linear in y: the difference is exact.
            for n in 0..y.len() {
                for i in 0..2 {
                    let difference = plus[n][i] - minus[n][i];
                    assert!((difference - product[n][i]).abs() < 1e-14, "{element:?} node {n}");
                }
            }
        }
    }

    #[test]
    fn a_bar_is_loaded_on_its_cross_section() {
        let mesh = generate::interval(Element::L3, 1.0, 3.0, 4).unwrap();
        for (name, sign) in [("left", 1.0), ("right", -1.0)] {
            let end = LoadedSide::new(&mesh, &mesh.sides[name], 0, 0.25);
            let y = mesh.nodes.clone();
            let mut force = vec![[0.0; 1]; y.len()];
            end.add_pressure(&[8.0], &y, &mut force);
            assert_eq!(force.iter().map(|f| f[0]).sum::<f64>(), sign * 2.0);
            end.add_traction([[-sign * 8.0]], &mut force);
            assert!(force.iter().all(|f| f[0] == 0.0));
        }
    }
}
