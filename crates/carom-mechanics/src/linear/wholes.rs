//! Correction of the bodies as wholes. Stresses have no resultant, so a translation u of a body, or
//! of a piece of it that shares no node with the rest, is resisted by the mass alone where supports
//! leave it free, and the linear problem of `linear_problem.rs` has the scalar equation
//!
//! ```text
//! w.mass a' (M u)·Δy + u·(Σ w λ∇F) Δy + u·Fᵀ Δλ = −u·r
//! ```
//!
//! A factor in single precision and conjugate gradients leave a rest of it: momentum that no force
//! has changed, 1e-12 of a body that bounces off. The last solves are completed by the translations
//! Δy += α u that close it, a coarse correction; but for bodies on springs of contacts, which the
//! translation of one body alone strains.

use crate::contact::constraints::Constraints;
use crate::model::{Model, Piece, tied_pieces};

/// A translation that supports leave to a piece.
#[derive(Debug)]
struct Whole {
    /// The dofs along it, ascending.
    dofs: Vec<usize>,
    /// M u at these.
    moved: Vec<f64>,
    /// u·M u.
    mass: f64,
}

/// The translations that supports leave to the pieces of the bodies.
#[derive(Debug, Default)]
pub(crate) struct Wholes(Vec<Whole>);

impl Wholes {
    pub(crate) fn new(model: &Model) -> Self {
        let d = model.dimension;
        let mut shift = vec![0.0; model.dofs()];
        let mut product = vec![0.0; model.dofs()];
        let mut wholes = Vec::new();
        for (nodes, axis) in pieces(model).iter().flat_map(|nodes| (0..d).map(move |axis| (nodes, axis))) {
            let dofs: Vec<usize> = nodes.iter().map(|node| node * d + axis).collect();
            if dofs.iter().any(|&dof| model.fixed[dof]) {
                continue;
            }
            shift.fill(0.0);
            dofs.iter().for_each(|&dof| shift[dof] = 1.0);
            model.mass.multiply_into(&shift, &mut product);
            let moved: Vec<f64> = dofs.iter().map(|&dof| product[dof]).collect();
            let mass = moved.iter().sum();
            if mass > 0.0 {
                wholes.push(Whole { dofs, moved, mass });
            }
        }
        Self(wholes)
    }

    /// Adds to an increment the translations that close the balance of each piece with `forces`,
    /// from which those of its contacts due to the increment are subtracted; `factor`: w.mass a'.
    /// The balance of one on springs is one with that of their other side.
    pub(crate) fn complete(&self, forces: &[f64], factor: f64, rows: &Constraints, increment: &mut [f64]) {
        let springs: Vec<usize> = (0..rows.len()).filter(|&r| rows.list[r].compliance > 0.0).collect();
        let is_on = |whole: &Whole, r: usize| rows.rows.row(r).entries().any(|(dof, _)| whole.has(dof));
        for whole in self.0.iter().filter(|whole| !springs.iter().any(|&r| is_on(whole, r))) {
            let mut force = 0.0;
            let mut inertia = 0.0;
            for (&dof, moved) in whole.dofs.iter().zip(&whole.moved) {
                force += forces[dof];
                inertia += moved * increment[dof];
            }
            let shift = (force - factor * inertia) / (factor * whole.mass);
            whole.dofs.iter().for_each(|&dof| increment[dof] += shift);
        }
    }
}

impl Whole {
    /// Whether it moves a dof.
    fn has(&self, dof: usize) -> bool {
        self.dofs.binary_search(&dof).is_ok()
    }
}

/// The nodes of each piece, and of those together that ties connect, ascending; each node of the
/// carrier of an obstacle is one.
fn pieces(model: &Model) -> Vec<Vec<usize>> {
    let nodes = |group: Vec<Piece>| {
        let mut nodes: Vec<usize> = group.into_iter().flat_map(|piece| piece.nodes).collect();
        nodes.sort_unstable();
        nodes
    };
    let of_bodies = tied_pieces(&model.parts, &model.points).into_iter().map(nodes);
    let carriers = model.parts.iter().filter(|part| part.is_rigid());
    of_bodies.chain(carriers.flat_map(|part| part.nodes().map(|node| vec![node]))).collect()
}
