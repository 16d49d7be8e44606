//! Any kernel on the test oscillator a + ω²u = 0: its amplification matrix as a numeric map, and
//! the properties of its eigenvalues.
//!
//! The matrix A maps (u, Δt v, Δt² a) over one step of Ω = ωΔt; that of a two-step kernel maps (u,
//! Δt v, Δt² a, d, Δt v₋) with d and v₋ of the previous step. Its columns are steps of the kernel
//! from unit vectors, so that it is no second derivation. Ω → ∞ is the map with u constrained to
//! zero at every stage's end. Definitions of damping and period error: Hilber and Hughes 1978.
use crate::analysis::Principal;
use crate::cubic::Root;
use crate::oscillator::Oscillator;
use crate::polynomial::{characteristic, roots};
use crate::stage::{Kernel, Stage};

/// A as rows.
pub fn amplification(kernel: &dyn Kernel, omega_dt: f64) -> Vec<Vec<f64>> {
    let oscillator = Oscillator { mass: 1.0, stiffness: omega_dt * omega_dt, force: 0.0 };
    columns(kernel, |before, start, stage| oscillator.step_after(kernel, 1.0, before, start, stage))
}

/// The map of a dof whose position is constrained to zero at every stage's end, as by contact; A as
/// Ω → ∞.
pub fn constrained_amplification(kernel: &dyn Kernel) -> Vec<Vec<f64>> {
    let free = Oscillator { mass: 1.0, stiffness: 0.0, force: 0.0 };
    columns(kernel, |before, start, stage| {
        free.constrained_step_after(kernel, 1.0, before, start, stage, 0.0)
    })
}

fn columns(
    kernel: &dyn Kernel,
    mut step: impl FnMut(Option<[f64; 2]>, [f64; 3], &mut Stage) -> [f64; 3],
) -> Vec<Vec<f64>> {
    let size = if kernel.two_step() { 5 } else { 3 };
    let mut stage = Stage::default();
    let mut matrix = vec![vec![0.0; size]; size];
    for column in 0..size {
        let mut unit = [0.0; 5];
        unit[column] = 1.0;
        let [u, v, a, d, w] = unit;
        let next = step(kernel.two_step().then_some([d, w]), [u, v, a], &mut stage);
        for (row, value) in next.into_iter().chain([next[0] - u, v]).take(size).enumerate() {
            matrix[row][column] = value;
        }
    }
    matrix
}

/// Eigenvalues of a map, after a similarity transform that balances it: velocities scaled by Ω,
/// accelerations by Ω².
fn eigenvalues(mut matrix: Vec<Vec<f64>>, omega_dt: f64) -> Vec<Root> {
    let s = omega_dt.max(1.0);
    let scales = [1.0, s, s * s, 1.0, s];
    for (row, values) in matrix.iter_mut().enumerate() {
        for (column, value) in values.iter_mut().enumerate() {
            *value *= scales[column] / scales[row];
        }
    }
    roots(&characteristic(&matrix))
}

/// Largest modulus of the eigenvalues at Ω.
pub fn spectral_radius(kernel: &dyn Kernel, omega_dt: f64) -> f64 {
    largest(&eigenvalues(amplification(kernel, omega_dt), omega_dt))
}

/// ρ∞, from the constrained map.
pub fn spectral_radius_at_infinity(kernel: &dyn Kernel) -> f64 {
    largest(&eigenvalues(constrained_amplification(kernel), 1.0))
}

/// The oscillating pair at Ω, if it exists: the least damped one.
pub fn principal(kernel: &dyn Kernel, omega_dt: f64) -> Option<Principal> {
    let oscillating =
        eigenvalues(amplification(kernel, omega_dt), omega_dt).into_iter().filter(|z| z.im > 1e-7);
    let z = oscillating.max_by(|a, b| a.modulus().total_cmp(&b.modulus()))?;
    let (log_modulus, angle) = (z.modulus().ln(), z.im.atan2(z.re));
    Some(Principal {
        modulus: z.modulus(),
        damping_ratio: -log_modulus / angle,
        period_error: omega_dt / angle - 1.0,
    })
}

/// Order of convergence on smooth motion, measured: the principal root deviates from exp(iΩ) as
/// Ω^(p + 1). Zero if nothing oscillates.
pub fn order(kernel: &dyn Kernel) -> u8 {
    let defect = |omega_dt: f64| {
        principal(kernel, omega_dt).map(|p| {
            let angle = omega_dt / (1.0 + p.period_error);
            p.modulus.ln().hypot(angle - omega_dt)
        })
    };
    match (defect(0.1), defect(0.05)) {
        (Some(coarse), Some(fine)) => ((coarse / fine).log2() - 1.0).round().clamp(0.0, 9.0) as u8,
        _ => 0,
    }
}

fn largest(roots: &[Root]) -> f64 {
    roots.iter().map(|root| root.modulus()).fold(0.0, f64::max)
}
