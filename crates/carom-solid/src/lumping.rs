//! Lumped mass by diagonal scaling: the diagonal of the consistent mass, scaled to the mass of the
//! cell (E. Hinton, T. Rock, O. C. Zienkiewicz, Earthquake Eng. Struct. Dyn. 4 (1976) 245–249). Row
//! sums would leave the corners of a T6 massless.

use crate::body::Body;

/// Lumped masses of a cell (`N`); `work` is a buffer of `N²` numbers.
pub fn cell_lumped_mass(body: &dyn Body, cell: usize, work: &mut [f64], masses: &mut [f64]) {
    body.cell_mass(cell, work);
    let n = masses.len();
    let total: f64 = work.iter().sum();
    for a in 0..n {
        masses[a] = work[a * n + a];
    }
    let trace: f64 = masses.iter().sum();
    // A massless body has no diagonal to scale.
    let scale = if trace > 0.0 { total / trace } else { 0.0 };
    for mass in masses {
        *mass *= scale;
    }
}
