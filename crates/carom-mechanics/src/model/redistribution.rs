//! Mass redistribution: a mass matrix without mass on contact nodes (H. B. Khenous, P. Laborde, Y.
//! Renard, Eur. J. Mech. A/Solids 27 (2008) 918–932). It lowers the index of the constrained
//! equations; the contact force depends continuously on time and does not ring.
//!
//! Rows and columns of the light nodes are zeroed, M → M'. The others receive δ on their diagonals,
//! the smallest change relative to M_nn that preserves the mass, the centre and the second moments,
//! and hence the momenta and energies of every affine motion:
//!
//! ```text
//! min Σ δ_n²/M_nn   with   Σ δ_n f(X_n) h(X_n) = fᵀM h − fᵀM'h   for all f, h ∈ {1, X, Y}
//! ```

use super::mass::Mass;

/// Moves the mass of the light nodes of `nodes`, a body's, to the others.
///
/// # Errors
/// In words, if the others cannot carry it.
pub fn redistribute(
    mass: &mut Mass,
    nodes: std::ops::Range<usize>,
    light: &[bool],
    dimension: usize,
    positions: &[f64],
) -> Result<(), String> {
    let count = nodes.len() as f64;
    let at = |n: usize, i: usize| positions[n * dimension + i];
    let center: Vec<f64> =
        (0..dimension).map(|i| nodes.clone().map(|n| at(n, i)).sum::<f64>() / count).collect();
    let away = |n: usize, i: usize| at(n, i) - center[i];
    let axes = nodes.clone().flat_map(|n| (0..dimension).map(move |i| (n, i)));
    let reach = axes.map(|(n, i)| away(n, i).abs()).fold(0.0, f64::max);
    // 1, X, Y at a node, of order one.
    let function = |n: usize, i: usize| if i == 0 { 1.0 } else { away(n, i - 1) / reach };
    let products: Vec<(usize, usize)> =
        (0..=dimension).flat_map(|i| (i..=dimension).map(move |j| (i, j))).collect();

    let mut lost = vec![0.0; products.len()];
    for n in nodes.clone() {
        for (m, value) in mass.row_mut(n).filter(|(m, _)| light[n] || light[*m]) {
            for (lost, &(i, j)) in lost.iter_mut().zip(&products) {
                *lost += *value * function(n, i) * function(m, j);
            }
            *value = 0.0;
        }
    }
    let heavy = nodes.clone().filter(|&n| !light[n]);
    let given =
        least_change(mass, heavy, &lost, |n, k| function(n, products[k].0) * function(n, products[k].1))?;
    for (n, given) in given {
        for (_, value) in mass.row_mut(n).filter(|(m, _)| *m == n) {
            *value += given;
            if *value <= 0.0 {
                return Err(format!(
                    "node {n} would be left with the mass {value:.3e}: the mesh is too coarse at the contact"
                ));
            }
        }
    }
    Ok(())
}

/// The mass that each heavy node receives, δ = W Cᵀ (C W Cᵀ)⁻¹ lost, with the moments of the nodes
/// in C and W = M_nn.
fn least_change(
    mass: &Mass,
    heavy: impl Iterator<Item = usize>,
    lost: &[f64],
    moment: impl Fn(usize, usize) -> f64,
) -> Result<Vec<(usize, f64)>, String> {
    let size = lost.len();
    let weighted: Vec<(usize, f64)> =
        heavy.map(|n| (n, mass.row(n).find(|(m, _)| *m == n).map_or(0.0, |(_, value)| value))).collect();
    let mut system = vec![vec![0.0; size + 1]; size];
    for k in 0..size {
        for l in 0..size {
            system[k][l] = weighted.iter().map(|&(n, w)| w * moment(n, k) * moment(n, l)).sum();
        }
        system[k][size] = lost[k];
    }
    let largest = (0..size).map(|k| system[k][k]).fold(0.0, f64::max);
    for k in 0..size {
        // Symmetric and positive definite: no pivoting is needed.
        let pivot = system[k].clone();
        if pivot[k] <= 1e-12 * largest {
            return Err(
                "too few nodes retain their mass to preserve the centre of mass and the second moments"
                    .into(),
            );
        }
        for row in system.iter_mut().skip(k + 1) {
            let factor = row[k] / pivot[k];
            row.iter_mut().zip(&pivot).for_each(|(x, p)| *x -= factor * p);
        }
    }
    let mut multipliers = vec![0.0; size];
    for k in (0..size).rev() {
        let known: f64 = (k + 1..size).map(|l| system[k][l] * multipliers[l]).sum();
        multipliers[k] = (system[k][size] - known) / system[k][k];
    }
    let received = |(n, w)| (n, w * (0..size).map(|k| multipliers[k] * moment(n, k)).sum::<f64>());
    Ok(weighted.into_iter().map(received).collect())
}
