//! The critical time step of an explicit scheme: Δt ≤ 2/ω_max, with ω_max² the largest eigenvalue
//! of M⁻¹K for the tangent at the start.
//!
//! The power iteration with M^{-½}K M^{-½} approximates it from below, by Rayleigh's quotient (for
//! the cluster at the end of a mesh's spectrum within a percent in some hundred products). The
//! largest eigenvalue of any single cell bounds it from above (Irons, Treharne 1971), and ‖M_e^{-½}
//! K_e M_e^{-½}‖_F bounds that one. Divided by this bound the matrix is stored in single precision:
//! it is the only matrix of an explicit run, and is freed before the first step. [`SAFETY`] covers
//! the first percent and some stiffening. A body that stiffens much more in compression needs a
//! shorter step; the energy guard detects that.

use carom_algebra::NodeMatrix;
use carom_algebra::sums::dot;
use carom_solid::{Ask, Configuration, Response, cell_lumped_mass};

use crate::cells;
use crate::linear::tangents::{coupled, each_tangent};
use crate::model::Model;

/// Fraction of 2/ω_max that is accepted as a step.
pub const SAFETY: f64 = 0.95;
/// Maximum number of products, and relative change of the quotient at convergence.
const PRODUCTS: usize = 500;
const SETTLED: f64 = 1e-6;

/// Limits of the explicit step, without safety.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
pub struct StableStep {
    /// 2/ω_max by power iteration.
    pub power: f64,
    /// The bound by single cells, never longer.
    pub cell: f64,
}

/// The bound by single cells, [`StableStep::cell`], at a configuration, which needs no matrix.
pub fn cell_step(model: &Model, at: &Configuration) -> Option<f64> {
    Some(2.0 / bound(model, at, &lumped(model))?.sqrt())
}

/// Bound on ω_max²; `None` if a cell is inverted or a free node is massless.
fn bound(model: &Model, at: &Configuration, mass: &[f64]) -> Option<f64> {
    if (0..model.dofs()).any(|dof| !model.fixed[dof] && mass[dof] <= 0.0) {
        return None;
    }
    Some(largest_of_cells(model, at)?.max(f64::MIN_POSITIVE))
}

/// Stable step of a model with lumped masses for its tangent at a configuration; `None` if a cell
/// is inverted or a free node is massless. Ties are left out: they lower the highest frequency.
pub fn stable_step(model: &Model, at: &Configuration) -> Option<StableStep> {
    let mass = lumped(model);
    let cell = bound(model, at, &mass)?;
    let mut matrix = scaled_tangent(model, at, &mass, cell)?;
    let mut x = vec![0.0; model.dofs()];
    for (i, dof) in (0..model.dofs()).filter(|dof| !model.fixed[*dof]).enumerate() {
        x[dof] = mass[dof].sqrt() * (12.9898 * (i as f64 + 1.0)).sin();
    }
    let mut product = vec![0.0; x.len()];
    let mut ratio = 0.0;
    for _ in 0..PRODUCTS {
        matrix.multiply_into(&x, &mut product);
        let weight = dot(&x, &x);
        let quotient = dot(&x, &product) / weight;
        let settled = (quotient - ratio).abs() <= SETTLED * quotient.abs();
        ratio = quotient;
        if settled {
            break;
        }
        let scale = weight.sqrt().recip() / quotient.abs().max(f64::MIN_POSITIVE);
        x.iter_mut().zip(&product).for_each(|(x, product)| *x = scale * product);
    }
    Some(StableStep { power: 2.0 / (ratio * cell).sqrt(), cell: 2.0 / cell.sqrt() })
}

/// M^{-½} K M^{-½}/ω² for the tangent at a configuration, with zero rows where a dof is
/// constrained: no entry is larger than 1 if ω² bounds the eigenvalues, so that single precision
/// suffices.
fn scaled_tangent(model: &Model, at: &Configuration, mass: &[f64], square: f64) -> Option<NodeMatrix> {
    let d = model.dimension;
    let mut matrix = NodeMatrix::new(d, coupled(model));
    let weight = |dof: u32| {
        let dof = dof as usize;
        if model.fixed[dof] { 0.0 } else { (mass[dof] * square).sqrt().recip() }
    };
    each_tangent(model, at, |part, cell, tangent| {
        let mesh = part.body.mesh();
        let dofs = part.cell_dofs(cell);
        let n = dofs.len();
        let nodes = mesh.cell(cell);
        for a in 0..nodes.len() {
            for b in (0..nodes.len()).filter(|b| nodes[a] <= nodes[*b]) {
                let Some(slot) = matrix.slot(part.first_node + nodes[a], part.first_node + nodes[b]) else {
                    continue;
                };
                for (k, entry) in matrix.block_mut(slot).iter_mut().enumerate() {
                    let [i, j] = [a * d + k / d, b * d + k % d];
                    *entry += (weight(dofs[i]) * tangent[i * n + j] * weight(dofs[j])) as f32;
                }
            }
        }
    })
    .ok()?;
    Some(matrix)
}

/// Diagonal of the lumped mass, per dof.
pub(crate) fn lumped(model: &Model) -> Vec<f64> {
    (0..model.dofs()).map(|dof| model.mass.row(dof / model.dimension).map(|(_, m)| m).sum()).collect()
}

/// Bound on the largest eigenvalue of any cell with its own lumped mass.
fn largest_of_cells(model: &Model, at: &Configuration) -> Option<f64> {
    let mut largest = 0.0_f64;
    for (part, at) in model.configurations(at) {
        let mesh = part.body.mesh();
        let n = mesh.element.nodes();
        let d = model.dimension;
        let dofs = mesh.element.dofs();
        let compute = |first: usize, squares: &mut [f64], _: &mut [f64]| {
            let mut work = vec![0.0; n * n];
            let mut mass = vec![0.0; n];
            let mut numbers = vec![0.0; dofs + dofs * dofs];
            for (k, square) in squares.iter_mut().enumerate() {
                cell_lumped_mass(&*part.body, first + k, &mut work, &mut mass);
                let out = Response {
                    numbers: &mut numbers,
                    energies: &mut [0.0],
                    memory: &mut [],
                    dissipated: &mut [],
                };
                part.body.respond(first + k, &at, Ask::Tangent, out)?;
                let tangent = numbers[dofs..].chunks_exact(dofs).enumerate();
                let scaled = tangent.flat_map(|(i, row)| {
                    let of_row = mass[i / d];
                    let masses = mass.iter().flat_map(move |m| std::iter::repeat_n(of_row * m, d));
                    row.iter().zip(masses).map(|(t, masses)| t * t / masses)
                });
                *square = scaled.sum::<f64>().sqrt();
            }
            Ok(None)
        };
        let add = |_: usize, squares: &[f64]| largest = squares.iter().fold(largest, |most, x| most.max(*x));
        cells::for_each(&model.threads, mesh.cell_count(), 1, compute, add).ok()?;
    }
    Some(largest)
}
