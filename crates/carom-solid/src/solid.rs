//! A body of one shape and one law: cell forces and tangents by quadrature,
//!
//!   H = Σ (yᵃ − Xᵃ) ⊗ ∇₀φᵃ,   U = Σ w Ψ,   fᵃ = Σ w P ∇₀φᵃ,   Kᵃᵇ = Σ w ∂P/∂F : ∇₀φᵃ ∇₀φᵇ,
//!
//! (Coda, Paccola, Latin Am. J. Solids Struct. 4 (2007), positions as unknowns; Holzapfel, Nonlinear Solid Mechanics, §8). The difference
//! y − X is formed here, once, so that small motions keep their digits. ∇₀φ and w = weight · det(∂X/∂ξ) · thickness of every quadrature
//! point of a curved cell are computed when the body is made. Straight cells share the points of the reference cell, and have one map each, ∇₀φ = (∂X/∂ξ)⁻ᵀ ∂φ/∂ξ:
//! what is read less is not waited for. Four points are computed at once (`points.rs`).
//!
//! Degrees of the rules, shape functions of degree k: straight cells 2k for force and mass; cells with curved edges 2k (k ≤ 2) or 4(k − 1)
//! for force, 4k − 2 for mass; a law whose energy is a polynomial of degree m in F at least m (k − 1).

use std::marker::PhantomData;
use std::ops::Range;
use std::sync::OnceLock;

use carom_algebra::{Mat, Vector, wide};

use crate::body::{Body, Inverted, PointState};
use crate::bounds::Bounds;
use crate::discrete_gradient::{between, contracted, moduli_of, symmetric_part};
use crate::material::{Material, NotPositive};
use crate::mesh::{Element, Mesh};
use crate::points::{Blocks, LANES, Mats, Moduli, Points, get, set, set_moduli, sum};
use crate::quadrature::Rule;
use crate::reference::{self, Degenerate, gradient};
use crate::shape::{Domain, Hull, Shape};
use crate::tree::Tree;

/// Why a body cannot be made.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[allow(missing_docs)]
pub enum SolidError {
    #[error("element {element:?} has dimension {}, the space has {dimension}", .element.dimension())]
    Dimension { element: Element, dimension: usize },
    #[error("{length} node numbers do not make cells of {nodes} nodes")]
    Ragged { length: usize, nodes: usize },
    #[error("cell {cell} names node {node}, but there are {count} nodes")]
    MissingNode { cell: usize, node: usize, count: usize },
    #[error("node {node} is not at a finite place")]
    NotFinite { node: usize },
    #[error("cell {cell} is degenerate at {place:.4?}: the Jacobian of its reference shape is {jacobian:.3e}")]
    Degenerate { cell: usize, place: Vec<f64>, jacobian: f64 },
    #[error("density {0} is not a finite number ≥ 0")]
    Density(f64),
    #[error("thickness {0} is not a finite number > 0")]
    Thickness(f64),
}

/// Quadrature points of a cell for forces.
struct Place<const D: usize> {
    points: Range<usize>,
    /// ∇₀φ is the transpose of this times the gradients of the points: (∂X/∂ξ)⁻¹ of a straight cell.
    inverse: Mat<D>,
    /// Volume of the cell per weight of the points.
    volume: f64,
}

/// A body of cells of shape `S` (`D` reference coordinates, `N` nodes) and law `L`.
pub struct Solid<const D: usize, const N: usize, S, L> {
    mesh: Mesh,
    law: L,
    density: f64,
    thickness: f64,
    /// Where each cell has its quadrature points for forces.
    places: Vec<Place<D>>,
    /// Those of the reference cell first, then those of each curved cell.
    points: Vec<Points<D, N>>,
    curved: Vec<bool>,
    /// Rules for masses of straight and of curved cells.
    mass_rules: [Rule<D>; 2],
    hull: Hull,
    /// Of the cells' boxes in the reference position, once a point has been asked for.
    tree: OnceLock<Tree>,
    shape: PhantomData<S>,
}

impl<const D: usize, const N: usize, S: Shape<D, N>, L: Material<D>> Solid<D, N, S, L> {
    /// Body of a mesh, a law, a density ≥ 0 and a thickness > 0 (dimension 1: the area of the cross-section).
    ///
    /// # Errors
    /// If a number is out of its range or the reference shape of a cell is degenerate or turned over.
    pub fn new(mesh: Mesh, law: L, density: f64, thickness: f64) -> Result<Self, SolidError> {
        check::<D, N>(&mesh, density, thickness)?;
        let k = S::DEGREE;
        let rule = |degree: usize| S::Domain::rule(degree.max(L::ENERGY_DEGREE * (k - 1)));
        let force_rules = [rule(2 * k), rule((2 * k).max(4 * (k - 1)))];
        let mass_rules = [S::Domain::rule(2 * k), S::Domain::rule(4 * k - 2)];
        let cells = mesh.cell_count();
        let mut solid = Self {
            mesh,
            law,
            density,
            thickness,
            places: Vec::with_capacity(cells),
            points: pack(force_rules[0].iter().map(|(xi, weight)| (S::gradients(xi), weight))),
            curved: Vec::with_capacity(cells),
            mass_rules,
            hull: Hull::of::<D, N, S>(),
            tree: OnceLock::new(),
            shape: PhantomData,
        };
        let shared = 0..solid.points.len();
        for cell in 0..cells {
            let x = solid.reference(cell);
            let curved = reference::is_curved::<D, N, S>(&x);
            let at = |Degenerate { place, jacobian }| SolidError::Degenerate { cell, place: place.to_vec(), jacobian };
            for xi in S::NODES.iter().chain(&solid.mass_rules[usize::from(curved)].points) {
                reference::map::<D, N, S>(&x, xi).map_err(at)?;
            }
            let place = if curved {
                let mapped = force_rules[1].iter().map(|(xi, weight)| {
                    let (gradients, jacobian) = reference::map::<D, N, S>(&x, xi).map_err(at)?;
                    Ok((gradients, weight * jacobian * thickness))
                });
                let own = pack(mapped.collect::<Result<Vec<_>, SolidError>>()?.into_iter());
                let first = solid.points.len();
                solid.points.extend(own);
                Place { points: first..solid.points.len(), inverse: Mat::identity(), volume: 1.0 }
            } else {
                let derivative = gradient(&x, &S::gradients(&S::Domain::CENTRE));
                Place { points: shared.clone(), inverse: derivative.inverse(), volume: derivative.det() * thickness }
            };
            solid.places.push(place);
            solid.curved.push(curved);
        }
        Ok(solid)
    }

    /// Reference positions of a cell's nodes.
    fn reference(&self, cell: usize) -> [Vector<D>; N] {
        let nodes = self.nodes(cell);
        let places = self.mesh.nodes.of_dimension::<D>();
        std::array::from_fn(|a| Vector(places[nodes[a]]))
    }

    #[inline]
    fn nodes(&self, cell: usize) -> &[usize; N] {
        &self.mesh.cells.as_chunks().0[cell]
    }

    /// y − X at the nodes of a cell.
    #[inline(always)]
    fn displacements(&self, cell: usize, y: &[f64]) -> [Vector<D>; N] {
        let (nodes, places, y) = (self.nodes(cell), self.mesh.nodes.of_dimension::<D>(), y.as_chunks::<D>().0);
        let mut u = [Vector::ZERO; N];
        for a in 0..N {
            u[a] = Vector(y[nodes[a]]) - Vector(places[nodes[a]]);
        }
        u
    }

    /// Forces and, if asked for, the tangent of a cell from `at(h)` for the gradients H of several displacement fields at a point: energy, P and the moduli.
    #[inline(always)]
    fn integrate<const M: usize>(
        &self,
        cell: usize,
        fields: [&[f64]; M],
        at: impl Fn([Mat<D>; M], bool) -> Result<(f64, Mat<D>, Option<Moduli<D>>), NotPositive>,
        force: &mut [f64],
        tangent: Option<&mut [f64]>,
    ) -> Result<f64, Inverted> {
        let mut u = [[Vector::ZERO; N]; M];
        for m in 0..M {
            u[m] = self.displacements(cell, fields[m]);
        }
        let mut f = [[[0.0; LANES]; D]; N];
        let mut blocks: Blocks<D, N> = [[[[[0.0; LANES]; D]; D]; N]; N];
        let mut energy = 0.0;
        let Place { points, inverse, volume } = &self.places[cell];
        for points in &self.points[points.clone()] {
            let mut gradients = [[[[0.0; LANES]; D]; D]; M];
            for m in 0..M {
                gradients[m] = points.gradient(&u[m], inverse);
            }
            let mut stresses = [[[0.0; LANES]; D]; D];
            let mut moduli = [[[[[0.0; LANES]; D]; D]; D]; D];
            for l in 0..points.count {
                let w = volume * points.weights[l];
                let mut h = [Mat::ZERO; M];
                for m in 0..M {
                    h[m] = get(&gradients[m], l);
                }
                let (density, stress, of_point) =
                    at(h, tangent.is_some()).map_err(|NotPositive(det_f)| Inverted { cell, det_f })?;
                energy += w * density;
                set(&mut stresses, l, &stress, w);
                if let Some(of_point) = of_point {
                    set_moduli(&mut moduli, l, &of_point, w);
                }
            }
            points.add_force(&stresses, inverse, &mut f);
            if tangent.is_some() {
                points.add_tangent(&moduli, inverse, &mut blocks);
            }
        }
        for (force, f) in force.iter_mut().zip(f.as_flattened()) {
            *force = sum(f);
        }
        if let Some(tangent) = tangent {
            spread(&blocks, tangent);
        }
        Ok(energy)
    }

    /// The same from the law at one position.
    #[inline(always)]
    fn integrate_at(
        &self,
        cell: usize,
        y: &[f64],
        force: &mut [f64],
        tangent: Option<&mut [f64]>,
    ) -> Result<f64, Inverted> {
        self.integrate(
            cell,
            [y],
            #[inline(always)]
            |[h], with_moduli| {
                let point = self.law.at(&h)?;
                let moduli = with_moduli.then(|| moduli_of(&self.law, &point));
                Ok((self.law.energy(&point), self.law.stress(&point), moduli))
            },
            force,
            tangent,
        )
    }

    /// The same from the discrete gradient between two positions.
    #[inline(always)]
    fn integrate_between(
        &self,
        cell: usize,
        ends: [&[f64]; 2],
        force: &mut [f64],
        tangent: Option<&mut [f64]>,
    ) -> Result<f64, Inverted> {
        self.integrate(
            cell,
            ends,
            #[inline(always)]
            |[start, end], with_moduli| {
                let (energy, stress, moduli) = between(&self.law, [&start, &end], with_moduli)?;
                Ok((energy, stress, moduli.map(|moduli| symmetric_part(&moduli))))
            },
            force,
            tangent,
        )
    }
}

impl<const D: usize, const N: usize, S: Shape<D, N>, L: Material<D>> Solid<D, N, S, L> {
    /// Forces of the changes of stress `at(h, dh, count)` at points side by side, made of the gradients of fields and of a change of the last.
    #[inline(always)]
    fn differentiate<const M: usize>(
        &self,
        cell: usize,
        fields: [&[f64]; M],
        change: &[f64],
        at: impl Fn(&[Mats<D>; M], &Mats<D>, usize) -> Result<Mats<D>, NotPositive>,
        product: &mut [f64],
    ) -> Result<(), Inverted> {
        let mut u = [[Vector::ZERO; N]; M];
        for m in 0..M {
            u[m] = self.displacements(cell, fields[m]);
        }
        let (nodes, change) = (self.nodes(cell), change.as_chunks::<D>().0);
        let mut du = [Vector::ZERO; N];
        for a in 0..N {
            du[a] = Vector(change[nodes[a]]);
        }
        let mut f = [[[0.0; LANES]; D]; N];
        let Place { points, inverse, volume } = &self.places[cell];
        for points in &self.points[points.clone()] {
            let mut gradients = [[[[0.0; LANES]; D]; D]; M];
            for m in 0..M {
                gradients[m] = points.gradient(&u[m], inverse);
            }
            let mut stresses = at(&gradients, &points.gradient(&du, inverse), points.count)
                .map_err(|NotPositive(det_f)| Inverted { cell, det_f })?;
            for i in 0..D {
                for j in 0..D {
                    for l in 0..LANES {
                        stresses[i][j][l] *= volume * points.weights[l];
                    }
                }
            }
            points.add_force(&stresses, inverse, &mut f);
        }
        for (product, f) in product.iter_mut().zip(f.as_flattened()) {
            *product = sum(f);
        }
        Ok(())
    }
}

/// Points side by side, from their gradients and weights.
fn pack<const D: usize, const N: usize>(points: impl Iterator<Item = ([Vector<D>; N], f64)>) -> Vec<Points<D, N>> {
    points.collect::<Vec<_>>().chunks(LANES).map(Points::new).collect()
}

/// Numbers in range, cells whole, nodes there.
fn check<const D: usize, const N: usize>(mesh: &Mesh, density: f64, thickness: f64) -> Result<(), SolidError> {
    if mesh.element.dimension() != D || mesh.dimension() != D || mesh.element.nodes() != N {
        return Err(SolidError::Dimension { element: mesh.element, dimension: mesh.dimension() });
    }
    if !(density.is_finite() && density >= 0.0) {
        return Err(SolidError::Density(density));
    }
    if !(thickness.is_finite() && thickness > 0.0) {
        return Err(SolidError::Thickness(thickness));
    }
    if !mesh.cells.len().is_multiple_of(N) {
        return Err(SolidError::Ragged { length: mesh.cells.len(), nodes: N });
    }
    let count = mesh.nodes.len();
    if let Some(i) = mesh.cells.iter().position(|&node| node >= count) {
        return Err(SolidError::MissingNode { cell: i / N, node: mesh.cells[i], count });
    }
    match mesh.nodes.iter().position(|x| x.iter().any(|c| !c.is_finite())) {
        Some(node) => Err(SolidError::NotFinite { node }),
        None => Ok(()),
    }
}

/// Both halves of a symmetric matrix from the blocks a ≤ b.
#[inline(always)]
fn spread<const D: usize, const N: usize>(blocks: &Blocks<D, N>, tangent: &mut [f64]) {
    for b in 0..N {
        for a in 0..=b {
            for i in 0..D {
                for j in 0..D {
                    let (row, column, value) = (a * D + i, b * D + j, sum(&blocks[b][a][i][j]));
                    tangent[row * N * D + column] = value;
                    tangent[column * N * D + row] = value;
                }
            }
        }
    }
}

impl<const D: usize, const N: usize, S: Shape<D, N>, L: Material<D>> Body for Solid<D, N, S, L> {
    fn mesh(&self) -> &Mesh {
        &self.mesh
    }

    fn cell_force(&self, cell: usize, y: &[f64], force: &mut [f64]) -> Result<f64, Inverted> {
        wide(
            #[inline(always)]
            || self.integrate_at(cell, y, force, None),
        )
    }

    fn cell_tangent(&self, cell: usize, y: &[f64], force: &mut [f64], tangent: &mut [f64]) -> Result<f64, Inverted> {
        wide(
            #[inline(always)]
            || self.integrate_at(cell, y, force, Some(tangent)),
        )
    }

    fn cell_between(
        &self,
        cell: usize,
        before: &[f64],
        now: &[f64],
        force: &mut [f64],
        tangent: Option<&mut [f64]>,
    ) -> Result<f64, Inverted> {
        // Two calls: the one for forces alone is compiled without what makes a tangent.
        wide(
            #[inline(always)]
            || match tangent {
                Some(tangent) => self.integrate_between(cell, [before, now], force, Some(tangent)),
                None => self.integrate_between(cell, [before, now], force, None),
            },
        )
    }

    fn cell_product(
        &self,
        cell: usize,
        before: Option<&[f64]>,
        y: &[f64],
        change: &[f64],
        product: &mut [f64],
    ) -> Result<(), Inverted> {
        wide(
            #[inline(always)]
            || match before {
                None => self.differentiate(
                    cell,
                    [y],
                    change,
                    #[inline(always)]
                    |[h], dh, count| self.law.changes(h, dh, count),
                    product,
                ),
                Some(before) => self.differentiate(
                    cell,
                    [before, y],
                    change,
                    #[inline(always)]
                    |[start, end], dh, count| {
                        let mut changes = [[[0.0; LANES]; D]; D];
                        for l in 0..count {
                            let (_, _, moduli) = between(&self.law, [&get(start, l), &get(end, l)], true)?;
                            let change = moduli.map_or(Mat::ZERO, |moduli| contracted(&moduli, &get(dh, l)));
                            set(&mut changes, l, &change, 1.0);
                        }
                        Ok(changes)
                    },
                    product,
                ),
            },
        )
    }

    fn cell_mass(&self, cell: usize, mass: &mut [f64]) {
        mass.fill(0.0);
        self.each_mass_point(cell, |values, volume| {
            for a in 0..N {
                for b in 0..N {
                    mass[a * N + b] += self.density * volume * values[a] * values[b];
                }
            }
        });
    }

    fn cell_volumes(&self, cell: usize, volumes: &mut [f64]) {
        volumes.fill(0.0);
        self.each_mass_point(cell, |values, volume| {
            for a in 0..N {
                volumes[a] += volume * values[a];
            }
        });
    }

    fn each_volume_point(&self, cell: usize, visit: &mut dyn FnMut(&[f64], &[f64], f64)) {
        let x = self.reference(cell);
        self.each_mass_point(cell, |values, volume| {
            let mut position = Vector::<D>::ZERO;
            for a in 0..N {
                position += x[a] * values[a];
            }
            visit(values, &position.0, volume);
        });
    }

    fn each_moved_point(&self, cell: usize, y: &[f64], visit: &mut dyn FnMut(&[f64], &[f64], &[f64], f64)) {
        let (x, u) = (self.reference(cell), self.displacements(cell, y));
        for (xi, weight) in self.mass_rules[usize::from(self.curved[cell])].iter() {
            let (values, local) = (S::values(xi), S::gradients(xi));
            let derivative = gradient(&x, &local);
            let inverse_transposed = derivative.inverse().transposed();
            let h = gradient(&u, &local.map(|g| inverse_transposed.apply(&g)));
            let place = reference::interpolate(&values, &x);
            let moved = place + reference::interpolate(&values, &u);
            visit(&place.0, &moved.0, h.0.as_flattened(), weight * derivative.det() * self.thickness);
        }
    }

    /// ∂Pᵢᴶ/∂Xᴶ = Σ ∂Pᵢᴶ/∂Fₖᴸ ∂²yₖ/∂Xᴶ∂Xᴸ.
    fn stress_divergence(&self, h: &[f64], second: &[f64], out: &mut [f64]) -> Result<(), f64> {
        let h = Mat(std::array::from_fn(|i| std::array::from_fn(|j| h[i * D + j])));
        let point = self.law.at(&h).map_err(|NotPositive(det_f)| det_f)?;
        let unit = Mat::<D>::identity().0.map(Vector);
        let mut sum = Vector::<D>::ZERO;
        for j in 0..D {
            for l in 0..D {
                let bent = Vector(std::array::from_fn(|k| second[(k * D + j) * D + l]));
                sum += self.law.tangent(&point, &unit[j], &unit[l]).apply(&bent);
            }
        }
        out.copy_from_slice(&sum.0);
        Ok(())
    }

    fn cell_min_det_f(&self, cell: usize, y: &[f64]) -> f64 {
        let u = self.displacements(cell, y);
        let Place { points, inverse, .. } = &self.places[cell];
        let ratios = self.points[points.clone()].iter().flat_map(|points| {
            let h = points.gradient(&u, inverse);
            (0..points.count).map(move |l| self.law.volume_ratio(&get(&h, l)))
        });
        ratios.fold(f64::INFINITY, f64::min)
    }

    fn point(&self, cell: usize, xi: &[f64], y: &[f64]) -> Result<PointState, Inverted> {
        let x = self.reference(cell);
        let inverse_transposed = gradient(&x, &S::gradients(&vector(xi))).inverse().transposed();
        let g = S::gradients(&vector(xi)).map(|g| inverse_transposed.apply(&g));
        let h = gradient(&self.displacements(cell, y), &g);
        let point = self.law.at(&h).map_err(|NotPositive(det_f)| Inverted { cell, det_f })?;
        let within = self.law.cauchy(&point);
        let lateral = self.law.lateral(&point);
        let cauchy = std::array::from_fn(|i| {
            std::array::from_fn(|j| match (i < D && j < D, i == j) {
                (true, _) => within.0[i][j],
                (false, true) => lateral,
                (false, false) => 0.0,
            })
        });
        Ok(PointState { det_f: self.law.volume_ratio(&h), cauchy })
    }

    fn shape(&self, xi: &[f64], values: &mut [f64]) {
        values.copy_from_slice(&S::values(&vector(xi)));
    }

    fn reference_nodes(&self) -> Vec<Vec<f64>> {
        S::NODES.iter().map(|x| x.0.to_vec()).collect()
    }

    fn locate(&self, point: &[f64]) -> Vec<(usize, Vec<f64>)> {
        let x = self.mesh.nodes.flat();
        let tree = self.tree.get_or_init(|| Tree::new(self.mesh.cell_count(), |cell| self.cell_bounds(cell, x)));
        let mut near = Vec::new();
        tree.find_into(&Bounds::of(point), &mut near);
        near.into_iter().filter_map(|cell| Some((cell, self.invert(cell, x, point)?))).collect()
    }

    fn cell_bounds(&self, cell: usize, y: &[f64]) -> Bounds {
        let (nodes, y) = (self.nodes(cell), y.as_chunks::<D>().0);
        let bounds = self.hull.bounds(|a| &y[nodes[a]]);
        bounds.grown(reference::MARGIN * bounds.size())
    }

    fn invert(&self, cell: usize, y: &[f64], point: &[f64]) -> Option<Vec<f64>> {
        let y = y.as_chunks::<D>().0;
        let nodes = self.nodes(cell).map(|node| Vector(y[node]));
        reference::invert::<D, N, S>(&nodes, &vector(point)).map(|xi| xi.0.to_vec())
    }

    fn density(&self) -> f64 {
        self.density
    }
}

impl<const D: usize, const N: usize, S: Shape<D, N>, L: Material<D>> Solid<D, N, S, L> {
    /// Shape functions and reference volume (× thickness) at the quadrature points for masses.
    fn each_mass_point(&self, cell: usize, mut visit: impl FnMut(&[f64; N], f64)) {
        let x = self.reference(cell);
        for (xi, weight) in self.mass_rules[usize::from(self.curved[cell])].iter() {
            let jacobian = gradient(&x, &S::gradients(xi)).det();
            visit(&S::values(xi), weight * jacobian * self.thickness);
        }
    }
}

/// Reference coordinates from a slice of `D` numbers.
fn vector<const D: usize>(xi: &[f64]) -> Vector<D> {
    Vector(std::array::from_fn(|i| xi[i]))
}

#[cfg(test)]
mod tests;
