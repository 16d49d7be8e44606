//! The interface of a body: forces, tangents, masses and stresses at given positions, cell by cell.

use std::ops::Range;

use crate::bounds::Bounds;
use crate::material::Past;
use crate::mesh::Mesh;

/// A cell is inverted (J ≤ 0) at a point, or not certified to be valid there.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[error("cell {cell} is inverted: J = {det_f:.3e}")]
pub struct Inverted {
    /// The cell.
    pub cell: usize,
    /// Determinant of the deformation gradient at that point.
    pub det_f: f64,
}

/// Kinematics and stress at a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PointState {
    /// Determinant of the (three-dimensional) deformation gradient.
    pub det_f: f64,
    /// Cauchy stress, 3 × 3 including the out-of-plane component.
    pub cauchy: [[f64; 3]; 3],
    /// Green–Lagrange strain E = (FᵀF − I)/2, 3 × 3 including the out-of-plane component.
    pub strain: [[f64; 3]; 3],
    /// Equivalent plastic strain.
    pub plastic_strain: f64,
    /// Share of the quadrature points of the cell that have yielded.
    pub yielded: f64,
}

/// Positions at which a body responds, and what its materials remember.
#[derive(Clone, Copy, Debug)]
pub struct Configuration<'a> {
    /// Positions at the start of a step: the response is then the discrete gradient between them
    /// and `y`. None: that at `y`.
    pub before: Option<&'a [f64]>,
    /// Positions.
    pub y: &'a [f64],
    /// Memory of all cells of the body at the start of the step; empty without memory.
    pub past: Past<'a>,
}

impl<'a> Configuration<'a> {
    /// The response at positions, of materials without memory.
    pub fn at(y: &'a [f64]) -> Self {
        Self { before: None, y, past: Past::default() }
    }
}

/// What is asked of cells.
#[derive(Clone, Copy, Debug)]
pub enum Ask<'a> {
    /// The force ∂U/∂y, `N·D` numbers of a cell, node-major; with positions before, the discrete
    /// gradient f with f·(y − before) = U(y) − U(before) to round-off. Of materials with memory U
    /// is the incremental potential.
    Force,
    /// The force at `y`, then its derivative, `(N·D)²` numbers by rows, symmetric, both triangles.
    Tangent,
    /// ∂f/∂y times a change of all positions, `N·D` numbers; not symmetrised.
    Product(&'a [f64]),
}

/// Results of consecutive cells, which are overwritten.
#[derive(Debug)]
pub struct Response<'a> {
    /// Numbers that are asked for, cell after cell.
    pub numbers: &'a mut [f64],
    /// Energy that each cell stores; zero of a product.
    pub energies: &'a mut [f64],
    /// Memory of each cell at the end of the step, [`Body::memory`] numbers; not asked for if
    /// empty.
    pub memory: &'a mut [f64],
    /// Energy that the material of each cell dissipates in the step, from what it remembers of the
    /// step's start; not asked for if empty.
    pub dissipated: &'a mut [f64],
}

/// The shape of a body: its mesh, shape functions, boxes and inverse maps. Node numbers are the
/// body's own; D stands for the dimension of its mesh and N for the nodes of a cell.
///
/// `y` is always the positions of all nodes of the body, flat and node-major, as every vector over
/// nodes.
pub trait Geometry: Send + Sync {
    /// Mesh with reference positions.
    fn mesh(&self) -> &Mesh;

    /// Adds the nodal vectors of consecutive cells from `first` on, `N·D` numbers each, to `sum`,
    /// one over all nodes.
    fn add_cells(&self, first: usize, locals: &[f64], sum: &mut [f64]);

    /// Nodal volumes of a cell (`N`): ∫φᵃ dΩ₀, the nodal forces of a unit body force.
    fn cell_volumes(&self, cell: usize, volumes: &mut [f64]);

    /// Visits the quadrature points of a cell for volume integrals: shape functions (`N`),
    /// reference position, reference volume (× thickness).
    fn each_volume_point(&self, cell: usize, visit: &mut dyn FnMut(&[f64], &[f64], f64));

    /// Visits the same points with the reference position, the position and H = ∂y/∂X − 1 there
    /// (`D²`, row-major), and the reference volume (× thickness).
    fn each_moved_point(&self, cell: usize, y: &[f64], visit: &mut dyn FnMut(&[f64], &[f64], &[f64], f64));

    /// Largest angle, in [0, π], of the rotation R of F = R U over the quadrature points of a cell,
    /// and the largest norm ‖E‖ of the strain E = (FᵀF − 1)/2.
    fn cell_turn(&self, cell: usize, y: &[f64]) -> [f64; 2];

    /// Shape functions of a cell at reference coordinates (`N`).
    fn shape(&self, xi: &[f64], values: &mut [f64]);

    /// Reference coordinates of a cell's nodes (`N`).
    fn reference_nodes(&self) -> Vec<Vec<f64>>;

    /// Cells and reference coordinates at a reference point: one for an interior point, all cells
    /// that share a node or an edge point; empty outside the body.
    fn locate(&self, point: &[f64]) -> Vec<(usize, Vec<f64>)>;

    /// Box around a cell whose nodes are at `y`, large enough for every point that [`Self::invert`]
    /// accepts.
    fn cell_bounds(&self, cell: usize, y: &[f64]) -> Bounds;

    /// Reference coordinates of a point of a cell, including its boundary, whose nodes are at `y`;
    /// `None` if it lies outside.
    fn invert(&self, cell: usize, y: &[f64], point: &[f64]) -> Option<Vec<f64>>;
}

/// A deformable body: a mesh whose regions have one material each.
///
/// Units follow the case: forces per unit thickness × thickness.
pub trait Body: Geometry {
    /// Computes consecutive cells from `first` on, as many as `out` has energies. Returns the
    /// smallest J over their quadrature points where it comes with the forces: of cells with
    /// constant strain.
    ///
    /// # Errors
    /// The first cell that is inverted.
    fn respond(
        &self,
        first: usize,
        at: &Configuration,
        ask: Ask,
        out: Response,
    ) -> Result<Option<f64>, Inverted>;

    /// Count of numbers that the materials of a cell remember; all are zero at the start of a run.
    fn memory(&self) -> usize;

    /// Consistent mass of a cell between its nodes (`N²`, row-major): ∫ρ₀ φᵃφᵇ dΩ₀.
    fn cell_mass(&self, cell: usize, mass: &mut [f64]);

    /// Density ρ₀ of a cell.
    fn density(&self, cell: usize) -> f64;

    /// Divergence ∂Pᵢᴶ/∂Xᴶ of the first Piola–Kirchhoff stress that the material of a cell has in a
    /// motion with H = ∂y/∂X − 1 (`D²`, row-major) and second derivatives ∂²yₖ/∂Xᴶ∂Xᴸ (`D³`, k
    /// first), into `out` (`D`).
    ///
    /// # Errors
    /// The determinant J if it is not positive.
    fn stress_divergence(&self, cell: usize, h: &[f64], second: &[f64], out: &mut [f64]) -> Result<(), f64>;

    /// Smallest J over the quadrature points of consecutive cells, which remember `past`.
    fn min_det_f(&self, cells: Range<usize>, y: &[f64], past: &Past) -> f64;

    /// Largest equivalent plastic strain over all quadrature points, which remember `past`; NaN if
    /// a law does not tell it.
    fn plastic_strain(&self, past: &Past) -> f64;

    /// Stress and strain at the quadrature points of a cell, which remember `past`.
    ///
    /// # Errors
    /// J where it is not positive.
    fn quadrature_points(&self, cell: usize, y: &[f64], past: &Past) -> Result<Vec<PointState>, Inverted>;

    /// Certifies that J > 0 everywhere in consecutive cells from `first` on, not only at quadrature
    /// points. Overwrites `margins` with the distance of each by which every component of its
    /// nodes' positions may change, relative to a common translation, while that remains true; ∞ if
    /// the law permits J ≤ 0.
    ///
    /// # Errors
    /// J of the first cell where it is not certified to be positive.
    fn cell_margins(&self, first: usize, y: &[f64], margins: &mut [f64]) -> Result<(), Inverted>;

    /// A lower bound of the first θ at which J > 0 is not certified everywhere in a cell, while its
    /// nodes move on straight lines from `before`, θ = 0, to `now`, θ = 1; none if it is certified,
    /// or the law permits J ≤ 0.
    fn cell_lost_between(&self, cell: usize, before: &[f64], now: &[f64]) -> Option<f64>;

    /// Stress and strain at points of a cell given in reference coordinates; of materials with
    /// memory projected from the quadrature points, which remember `past`.
    fn points(
        &self,
        cell: usize,
        places: &[Vec<f64>],
        y: &[f64],
        past: &Past,
    ) -> Vec<Result<PointState, Inverted>>;

    /// Stress and strain at a point of a cell.
    ///
    /// # Errors
    /// J where it is not positive.
    fn point(&self, cell: usize, xi: &[f64], y: &[f64], past: &Past) -> Result<PointState, Inverted> {
        self.points(cell, &[xi.to_vec()], y, past).swap_remove(0)
    }
}

/// Single cells of materials without memory.
impl dyn Body + '_ {
    /// Overwrites `force` with that of a cell, and returns its energy.
    ///
    /// # Errors
    /// If the cell is inverted.
    pub fn cell_force(&self, cell: usize, y: &[f64], force: &mut [f64]) -> Result<f64, Inverted> {
        self.of_cell(cell, &Configuration::at(y), Ask::Force, force)
    }

    /// Overwrites `tangent` with that of a cell, after `force`, and returns its energy.
    ///
    /// # Errors
    /// If the cell is inverted.
    pub fn cell_tangent(
        &self,
        cell: usize,
        y: &[f64],
        force: &mut [f64],
        tangent: &mut [f64],
    ) -> Result<f64, Inverted> {
        let mut both = vec![0.0; force.len() + tangent.len()];
        let energy = self.of_cell(cell, &Configuration::at(y), Ask::Tangent, &mut both)?;
        let (of_force, of_tangent) = both.split_at(force.len());
        force.copy_from_slice(of_force);
        tangent.copy_from_slice(of_tangent);
        Ok(energy)
    }

    /// Overwrites `force` with the discrete gradient of a cell, and returns its energy at the end.
    ///
    /// # Errors
    /// If the cell is inverted.
    pub fn cell_between(
        &self,
        cell: usize,
        before: &[f64],
        now: &[f64],
        force: &mut [f64],
    ) -> Result<f64, Inverted> {
        let at = Configuration { before: Some(before), ..Configuration::at(now) };
        self.of_cell(cell, &at, Ask::Force, force)
    }

    /// Overwrites `product` with the tangent of a cell, or of its discrete gradient, times a
    /// change.
    ///
    /// # Errors
    /// If the cell is inverted.
    pub fn cell_product(
        &self,
        cell: usize,
        before: Option<&[f64]>,
        y: &[f64],
        change: &[f64],
        product: &mut [f64],
    ) -> Result<(), Inverted> {
        let at = Configuration { before, ..Configuration::at(y) };
        self.of_cell(cell, &at, Ask::Product(change), product).map(|_| ())
    }

    /// [`Body::cell_margins`] of one cell.
    ///
    /// # Errors
    /// J where it is not certified to be positive.
    pub fn cell_margin(&self, cell: usize, y: &[f64]) -> Result<f64, Inverted> {
        let mut margin = [0.0];
        self.cell_margins(cell, y, &mut margin)?;
        Ok(margin[0])
    }

    fn of_cell(
        &self,
        cell: usize,
        at: &Configuration,
        ask: Ask,
        numbers: &mut [f64],
    ) -> Result<f64, Inverted> {
        let mut energy = [0.0];
        let out = Response { numbers, energies: &mut energy, memory: &mut [], dissipated: &mut [] };
        self.respond(cell, at, ask, out)?;
        Ok(energy[0])
    }
}
