//! The critical time step of an explicit scheme: Δt ≤ 2/ω_max, with ω_max² the largest eigenvalue
//! of M⁻¹K for the initial tangent.
//!
//! The power iteration x ← M⁻¹K x approximates it from below, by Rayleigh's quotient (for the
//! cluster at the end of a mesh's spectrum within a percent in some hundred products). The largest
//! eigenvalue of any single cell bounds it from above (Irons, Treharne 1971), and ‖M_e^{-½} K_e
//! M_e^{-½}‖_F bounds that one. [`SAFETY`] covers the first percent and some stiffening. A body
//! that stiffens much more in compression needs a shorter step; the energy guard detects that.

use carom_algebra::sums::dot;
use carom_solid::cell_lumped_mass;

use crate::linear::matrices::Matrices;
use crate::model::Model;

/// Fraction of 2/ω_max that is accepted as a step.
pub const SAFETY: f64 = 0.95;
/// Maximum number of products with M⁻¹K, and relative change of the quotient at convergence.
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

/// Stable step of a model with lumped masses for its initial tangent; `None` if a cell is inverted
/// or a free node is massless.
pub fn stable_step(model: &Model) -> Option<StableStep> {
    let mut system = Matrices::new(model);
    system.assemble(model, &model.initial_position).ok()?;
    let mass: Vec<f64> = lumped(model)
        .into_iter()
        .zip(&model.fixed)
        .filter(|(_, constrained)| !**constrained)
        .map(|(m, _)| m)
        .collect();
    if mass.iter().any(|m| *m <= 0.0) {
        return None;
    }
    let mut x: Vec<f64> = (0..mass.len()).map(|i| (12.9898 * (i as f64 + 1.0)).sin()).collect();
    let mut force = vec![0.0; x.len()];
    let mut square = 0.0;
    for _ in 0..PRODUCTS {
        force.fill(0.0);
        system.stiffness_product(&x, &mut force);
        let weight: f64 = x.iter().zip(&mass).map(|(x, m)| x * x * m).sum();
        let quotient = dot(&x, &force) / weight;
        if (quotient - square).abs() <= SETTLED * quotient.abs() {
            square = quotient;
            break;
        }
        square = quotient;
        let scale = weight.sqrt().recip() / quotient.abs().max(f64::MIN_POSITIVE);
        for ((x, f), m) in x.iter_mut().zip(&force).zip(&mass) {
            *x = scale * f / m;
        }
    }
    Some(StableStep { power: 2.0 / square.sqrt(), cell: 2.0 / largest_of_cells(model)?.sqrt() })
}

/// Diagonal of the lumped mass, per dof.
pub(crate) fn lumped(model: &Model) -> Vec<f64> {
    (0..model.dofs()).map(|dof| model.mass.row(dof / model.dimension).map(|(_, m)| m).sum()).collect()
}

/// Bound on the largest eigenvalue of any cell with its own lumped mass.
fn largest_of_cells(model: &Model) -> Option<f64> {
    let mut largest = 0.0_f64;
    for part in &model.parts {
        let mesh = part.body.mesh();
        let (n, d, dofs) = (mesh.element.nodes(), model.dimension, mesh.element.dofs());
        let (mut work, mut mass) = (vec![0.0; n * n], vec![0.0; n]);
        let (mut force, mut tangent) = (vec![0.0; dofs], vec![0.0; dofs * dofs]);
        for cell in 0..mesh.cell_count() {
            cell_lumped_mass(&*part.body, cell, &mut work, &mut mass);
            part.body.cell_tangent(cell, part.of(&model.reference), &mut force, &mut tangent).ok()?;
            let scaled =
                tangent.iter().enumerate().map(|(k, t)| t * t / (mass[k / dofs / d] * mass[k % dofs / d]));
            largest = largest.max(scaled.sum::<f64>().sqrt());
        }
    }
    Some(largest)
}
