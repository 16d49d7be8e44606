//! The interface of a body: forces, tangents, masses and stresses at given positions, cell by cell.

use crate::bounds::Bounds;
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
}

/// A deformable body: a mesh whose regions have one material each. Node numbers are the body's own;
/// D stands for the dimension of its mesh and N for the nodes of a cell.
///
/// Units follow the case: forces per unit thickness × thickness. `y` is always the positions of all
/// nodes of the body, flat and node-major, as every vector over nodes.
pub trait Body: Send + Sync {
    /// Mesh with reference positions.
    fn mesh(&self) -> &Mesh;

    /// Returns the strain energy of a cell and overwrites `force` (`N·D`, node-major) with ∂U/∂y.
    fn cell_force(&self, cell: usize, y: &[f64], force: &mut [f64]) -> Result<f64, Inverted>;

    /// [`Self::cell_force`] of consecutive cells from `first` on: overwrites `energies`, one per
    /// cell, and `forces`, one after the other.
    fn cell_forces(
        &self,
        first: usize,
        y: &[f64],
        forces: &mut [f64],
        energies: &mut [f64],
    ) -> Result<(), Inverted>;

    /// Adds the nodal vectors of consecutive cells from `first` on, `N·D` numbers each, to `sum`,
    /// one over all nodes.
    fn add_cells(&self, first: usize, locals: &[f64], sum: &mut [f64]);

    /// As [`Self::cell_force`], and overwrites `tangent` (`(N·D)²`, row-major, symmetric, both
    /// triangles) with ∂²U/∂y².
    fn cell_tangent(
        &self,
        cell: usize,
        y: &[f64],
        force: &mut [f64],
        tangent: &mut [f64],
    ) -> Result<f64, Inverted>;

    /// Discrete gradient of the strain energy between `before` and `now`: overwrites `force` with f
    /// such that f·(now − before) = U(now) − U(before) to round-off. Returns U(now).
    fn cell_between(
        &self,
        cell: usize,
        before: &[f64],
        now: &[f64],
        force: &mut [f64],
    ) -> Result<f64, Inverted>;

    /// Overwrites `product` (`N·D`) with ∂f/∂y · `change`, f that of [`Self::cell_force`] or, with
    /// `before`, of [`Self::cell_between`]. The tangent is not symmetrised.
    fn cell_product(
        &self,
        cell: usize,
        before: Option<&[f64]>,
        y: &[f64],
        change: &[f64],
        product: &mut [f64],
    ) -> Result<(), Inverted>;

    /// Consistent mass of a cell between its nodes (`N²`, row-major): ∫ρ₀ φᵃφᵇ dΩ₀.
    fn cell_mass(&self, cell: usize, mass: &mut [f64]);

    /// Nodal volumes of a cell (`N`): ∫φᵃ dΩ₀, the nodal forces of a unit body force.
    fn cell_volumes(&self, cell: usize, volumes: &mut [f64]);

    /// Visits the quadrature points of a cell for volume integrals: shape functions (`N`),
    /// reference position, reference volume (× thickness).
    fn each_volume_point(&self, cell: usize, visit: &mut dyn FnMut(&[f64], &[f64], f64));

    /// Visits the same points with the reference position, the position and H = ∂y/∂X − 1 there
    /// (`D²`, row-major), and the reference volume (× thickness).
    fn each_moved_point(&self, cell: usize, y: &[f64], visit: &mut dyn FnMut(&[f64], &[f64], &[f64], f64));

    /// Divergence ∂Pᵢᴶ/∂Xᴶ of the first Piola–Kirchhoff stress that the material of a cell has in a
    /// motion with H = ∂y/∂X − 1 (`D²`, row-major) and second derivatives ∂²yₖ/∂Xᴶ∂Xᴸ (`D³`, k
    /// first), into `out` (`D`).
    ///
    /// # Errors
    /// The determinant J if it is not positive.
    fn stress_divergence(&self, cell: usize, h: &[f64], second: &[f64], out: &mut [f64]) -> Result<(), f64>;

    /// Smallest J over the quadrature points of a cell.
    fn cell_min_det_f(&self, cell: usize, y: &[f64]) -> f64;

    /// Largest angle, in [0, π], of the rotation R of F = R U over the quadrature points of a cell,
    /// and the largest norm ‖E‖ of the strain E = (FᵀF − 1)/2.
    fn cell_turn(&self, cell: usize, y: &[f64]) -> [f64; 2];

    /// Certifies that J > 0 everywhere in a cell, not only at its quadrature points. Returns the
    /// distance by which every component of its nodes' positions may change, relative to a common
    /// translation, while that remains true; ∞ if the law permits J ≤ 0.
    ///
    /// # Errors
    /// J where it is not certified to be positive.
    fn cell_margin(&self, cell: usize, y: &[f64]) -> Result<f64, Inverted>;

    /// [`Self::cell_margin`] of consecutive cells from `first` on; overwrites `margins`.
    ///
    /// # Errors
    /// J of the first that is not certified.
    fn cell_margins(&self, first: usize, y: &[f64], margins: &mut [f64]) -> Result<(), Inverted>;

    /// A lower bound of the first θ at which J > 0 is not certified everywhere in a cell, while its
    /// nodes move on straight lines from `before`, θ = 0, to `now`, θ = 1; none if it is certified,
    /// or the law permits J ≤ 0.
    fn cell_lost_between(&self, cell: usize, before: &[f64], now: &[f64]) -> Option<f64>;

    /// Stress and strain at a point of a cell given in reference coordinates.
    fn point(&self, cell: usize, xi: &[f64], y: &[f64]) -> Result<PointState, Inverted>;

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

    /// Density ρ₀ of a cell.
    fn density(&self, cell: usize) -> f64;
}
