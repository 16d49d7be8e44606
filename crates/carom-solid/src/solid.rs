//! A body of one shape: cell forces and tangents by quadrature,
//!
//!   H = Σ (yᵃ − Xᵃ) ⊗ ∇₀φᵃ,   U = Σ w Ψ,   fᵃ = Σ w P ∇₀φᵃ,   Kᵃᵇ = Σ w ∂P/∂F : ∇₀φᵃ ∇₀φᵇ,
//!
//! (Coda, Paccola, Latin Am. J. Solids Struct. 4 (2007), positions as unknowns; Holzapfel,
//! Nonlinear Solid Mechanics, §8). Only here is y − X formed, so that small displacements keep
//! their accuracy. ∇₀φ and w = weight · det(∂X/∂ξ) · thickness are precomputed at every quadrature
//! point of a curved cell. Straight cells share the points of the reference cell and store one map
//! each, ∇₀φ = (∂X/∂ξ)⁻ᵀ ∂φ/∂ξ, which saves memory bandwidth. Four points are computed at once
//! (`points.rs`).
//!
//! Degrees of the rules for shape functions of degree k: one point for the force of a cell with
//! constant strain (`constant.rs`); other straight cells 2k for force and mass;
//! cells with curved edges 2k (k ≤ 2) or 4(k − 1) for force, 4k − 2 for mass; at least m (k − 1)
//! for a law whose energy is a polynomial of degree m in F.

use std::marker::PhantomData;
use std::ops::Range;
use std::sync::OnceLock;

use carom_algebra::{Mat, Vector};

use crate::material::{Mean, Past, Pointwise};
use crate::mesh::{Element, Facet, Mesh};
use crate::points::{LANES, Packed, Points};
use crate::quadrature::Rule;
use crate::reference::{self, Degenerate, gradient};
use crate::shape::{Domain, Hull, Shape};
use crate::tree::Tree;
use crate::validity::Validity;

/// Why a body cannot be built.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[allow(missing_docs)]
pub enum SolidError {
    #[error("element {element:?} has dimension {}, the space has {dimension}", .element.dimension())]
    Dimension { element: Element, dimension: usize },
    #[error("{length} node numbers are not a multiple of the {nodes} nodes of a cell")]
    Ragged { length: usize, nodes: usize },
    #[error("cell {cell} refers to node {node}, but there are {count} nodes")]
    MissingNode { cell: usize, node: usize, count: usize },
    #[error("a facet of side \"{side}\" refers to cell {cell} and nodes {nodes:?}, which the mesh lacks")]
    MissingFacet { side: String, cell: usize, nodes: Vec<usize> },
    #[error("the coordinates of node {node} are not finite")]
    NotFinite { node: usize },
    #[error(
        "cell {cell} is degenerate at {place:.4?}: the Jacobian of its reference shape is {jacobian:.3e}"
    )]
    Degenerate { cell: usize, place: Vec<f64>, jacobian: f64 },
    #[error("element {element:?} has no mean dilatation: it is for Q4 and Hex8")]
    NoMeanDilatation { element: Element },
    #[error("cell {cell} is of region {region}, but the body has {media} materials")]
    NoMedium { cell: usize, region: usize, media: usize },
    #[error("density {0} is not a finite number ≥ 0")]
    Density(f64),
    #[error("thickness {0} is not a finite number > 0")]
    Thickness(f64),
}

/// Quadrature points of a cell for forces.
struct Place<const D: usize> {
    points: Range<usize>,
    /// ∇₀φ is the transpose of this times the gradients of the points: (∂X/∂ξ)⁻¹ of a straight
    /// cell.
    inverse: Mat<D>,
    /// Volume of the cell per weight of the points.
    volume: f64,
}

/// Shape functions and their gradients by ξ at a point of the reference cell.
struct ShapePoint<const D: usize, const N: usize> {
    values: [f64; N],
    gradients: [Vector<D>; N],
    /// Weight of the point in a rule for masses.
    weight: f64,
}

impl<const D: usize, const N: usize> ShapePoint<D, N> {
    fn new<S: Shape<D, N>>(xi: &Vector<D>, weight: f64) -> Self {
        Self { values: S::values(xi), gradients: S::gradients(xi), weight }
    }
}

/// Material of the cells of a region.
pub(crate) struct Medium<const D: usize> {
    pub(crate) law: Box<dyn Pointwise<D>>,
    /// Mean dilatation: the law is then that without its volumetric part.
    pub(crate) mean: Option<Mean<D>>,
    pub(crate) density: f64,
}

impl<const D: usize> Medium<D> {
    /// Whether the law permits J ≤ 0.
    fn may_invert(&self) -> bool {
        let mut mirrored = Mat::ZERO;
        mirrored.0[0][0] = -2.0;
        self.law.state_at(&mirrored, &Past::default()).is_ok()
    }
}

/// A body of cells of shape `S` (`D` reference coordinates, `N` nodes).
pub struct Solid<const D: usize, const N: usize, S> {
    mesh: Mesh,
    /// Materials by region.
    media: Vec<Medium<D>>,
    thickness: f64,
    /// Quadrature points for forces of each cell.
    places: Vec<Place<D>>,
    /// Of cells with constant strain, the same for four at once.
    packed: Vec<Packed<D>>,
    /// Points of the reference cell first, then those of each curved cell.
    points: Vec<Points<D, N>>,
    curved: Vec<bool>,
    /// Rules for forces of straight and of curved cells.
    force_rules: [Rule<D>; 2],
    /// Count of numbers that a cell remembers.
    memory: usize,
    /// Rules for masses of straight and of curved cells.
    mass_points: [Vec<ShapePoint<D, N>>; 2],
    hull: Hull,
    validity: Validity<D, N>,
    /// Whether the law of a region permits J ≤ 0.
    may_invert: Vec<bool>,
    /// Hierarchy of the cells' boxes in the reference configuration, built on the first query.
    tree: OnceLock<Tree>,
    shape: PhantomData<S>,
}

impl<const D: usize, const N: usize, S: Shape<D, N>> Solid<D, N, S> {
    /// Body of a mesh, the materials of its regions, with densities ≥ 0, and a thickness > 0
    /// (dimension 1: the area of the cross-section).
    ///
    /// # Errors
    /// If a number is out of range, a region has no material, or the reference shape of a cell is
    /// degenerate or inverted.
    pub(crate) fn new(mesh: Mesh, media: Vec<Medium<D>>, thickness: f64) -> Result<Self, SolidError> {
        check::<D, N>(&mesh, thickness)?;
        check_media(&mesh, &media)?;
        let k = S::DEGREE;
        // All cells of one shape share a rule: the one that every law needs.
        let energy_degree = media.iter().map(|medium| medium.law.energy_degree()).max().unwrap_or(0);
        let rule = |degree: usize| {
            let exact = degree.max(energy_degree * (k - 1));
            S::Domain::rule(if Self::HAS_CONSTANT_STRAIN { 0 } else { exact })
        };
        let force_rules = [rule(2 * k), rule((2 * k).max(4 * (k - 1)))];
        // The Jacobian of a curved quadrilateral or hexahedron has the degree Dk − 1 along each
        // axis, that of a simplex D(k − 1).
        let curved_mass = if S::Domain::TENSOR { (D + 2) * k - 1 } else { (D + 2) * k - D };
        let mass_points = [2 * k, curved_mass].map(|degree| {
            let rule = S::Domain::rule(degree);
            rule.iter().map(|(xi, weight)| ShapePoint::new::<S>(xi, weight)).collect::<Vec<_>>()
        });
        let cells = mesh.cell_count();
        let mut solid = Self {
            mesh,
            may_invert: media.iter().map(Medium::may_invert).collect(),
            media,
            thickness,
            places: Vec::with_capacity(cells),
            packed: Vec::new(),
            points: pack(force_rules[0].iter().map(|(xi, weight)| (S::gradients(xi), weight))),
            curved: Vec::with_capacity(cells),
            memory: 0,
            force_rules,
            mass_points,
            hull: Hull::of::<D, N, S>(),
            validity: Validity::of::<S>(),
            tree: OnceLock::new(),
            shape: PhantomData,
        };
        let shared = 0..solid.points.len();
        debug_assert!(!Self::HAS_CONSTANT_STRAIN || solid.force_rules[0].points.len() == 1);
        let centre = S::gradients(&S::Domain::CENTRE);
        let at_nodes = S::NODES.each_ref().map(|xi| ShapePoint::new::<S>(xi, 0.0));
        for cell in 0..cells {
            let x = solid.reference(cell);
            let curved = reference::is_curved::<D, N, S>(&x, &centre);
            let at = |Degenerate { place, jacobian }| SolidError::Degenerate {
                cell,
                place: place.to_vec(),
                jacobian,
            };
            let points = at_nodes.iter().chain(&solid.mass_points[usize::from(curved)]);
            // Every point of a cell with constant strain has the same Jacobian.
            for point in points.take(if Self::HAS_CONSTANT_STRAIN { 1 } else { usize::MAX }) {
                let derivative = gradient(&x, &point.gradients);
                reference::jacobian(&derivative).map_err(|jacobian| {
                    at(Degenerate { place: reference::interpolate(&point.values, &x).0, jacobian })
                })?;
            }
            // Between these points, the determinant of a curved cell may still change its sign.
            solid.validity.margin(&x).map_err(|loss| {
                let xi = loss.place;
                let place = reference::interpolate(&S::values(&xi), &x).0;
                at(Degenerate { place, jacobian: gradient(&x, &S::gradients(&xi)).det() })
            })?;
            let place = if curved {
                let mapped = solid.force_rules[1].iter().map(|(xi, weight)| {
                    let (gradients, jacobian) = reference::map::<D, N, S>(&x, xi).map_err(at)?;
                    Ok((gradients, weight * jacobian * thickness))
                });
                let own = pack(mapped.collect::<Result<Vec<_>, SolidError>>()?.into_iter());
                let first = solid.points.len();
                solid.points.extend(own);
                Place { points: first..solid.points.len(), inverse: Mat::identity(), volume: 1.0 }
            } else {
                let derivative = gradient(&x, &centre);
                Place {
                    points: shared.clone(),
                    inverse: derivative.inverse(),
                    volume: derivative.det() * thickness,
                }
            };
            solid.places.push(place);
            solid.curved.push(curved);
        }
        solid.pack_constant();
        solid.memory = solid.memory_of_cells();
        Ok(solid)
    }

    /// Material of a cell.
    #[inline(always)]
    fn medium(&self, cell: usize) -> &Medium<D> {
        &self.media[self.mesh.region(cell)]
    }

    /// Whether the law of a cell permits J ≤ 0.
    fn may_invert(&self, cell: usize) -> bool {
        self.may_invert[self.mesh.region(cell)]
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
        let nodes = self.nodes(cell);
        let places = self.mesh.nodes.of_dimension::<D>();
        let y = y.as_chunks::<D>().0;
        let mut u = [Vector::ZERO; N];
        for a in 0..N {
            u[a] = Vector(y[nodes[a]]) - Vector(places[nodes[a]]);
        }
        u
    }

    /// Shape functions and reference volume (× thickness) at the quadrature points for masses.
    fn each_mass_point(&self, cell: usize, mut visit: impl FnMut(&[f64; N], f64)) {
        let x = self.reference(cell);
        for point in &self.mass_points[usize::from(self.curved[cell])] {
            let jacobian = gradient(&x, &point.gradients).det();
            visit(&point.values, point.weight * jacobian * self.thickness);
        }
    }
}

/// Packs points into lanes, from their gradients and weights.
fn pack<const D: usize, const N: usize>(
    points: impl Iterator<Item = ([Vector<D>; N], f64)>,
) -> Vec<Points<D, N>> {
    points.collect::<Vec<_>>().chunks(LANES).map(Points::new).collect()
}

/// Checks ranges of numbers and completeness of cells.
fn check<const D: usize, const N: usize>(mesh: &Mesh, thickness: f64) -> Result<(), SolidError> {
    if mesh.element.dimension() != D || mesh.dimension() != D || mesh.element.nodes() != N {
        return Err(SolidError::Dimension { element: mesh.element, dimension: mesh.dimension() });
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
    for (side, facets) in &mesh.sides {
        let lacks =
            |facet: &&Facet| facet.cell >= mesh.cell_count() || facet.nodes.iter().any(|n| *n >= count);
        if let Some(Facet { cell, nodes }) = facets.iter().find(lacks) {
            return Err(SolidError::MissingFacet { side: side.clone(), cell: *cell, nodes: nodes.clone() });
        }
    }
    match mesh.nodes.iter().position(|x| x.iter().any(|c| !c.is_finite())) {
        Some(node) => Err(SolidError::NotFinite { node }),
        None => Ok(()),
    }
}

/// Checks that every cell has a material, and its density.
fn check_media<const D: usize>(mesh: &Mesh, media: &[Medium<D>]) -> Result<(), SolidError> {
    let is_valid = |density: f64| density.is_finite() && density >= 0.0;
    if let Some(medium) = media.iter().find(|medium| !is_valid(medium.density)) {
        return Err(SolidError::Density(medium.density));
    }
    let media = media.len();
    match (0..mesh.cell_count()).find(|&cell| mesh.region(cell) >= media) {
        Some(cell) => Err(SolidError::NoMedium { cell, region: mesh.region(cell), media }),
        None => Ok(()),
    }
}

mod body;
mod constant;
mod integrals;
mod mean;
mod memory;
#[doc(hidden)]
pub mod projection;
mod rotation;
