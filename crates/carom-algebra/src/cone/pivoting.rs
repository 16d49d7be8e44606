//! The linear complementarity problem of a few unilateral contacts, 0 ≤ z ⊥ D z + b ≥ 0, with D
//! symmetric and positive definite. The solution is unique for any b.
//!
//! Block principal pivoting (Júdice and Pires 1994): all indices that violate their condition
//! change sides together. Without progress only the last one does (Murty 1974), which terminates
//! for every positive definite D. D is dense: its size is the number of nodes in contact.

use crate::LinearError;

/// Number of block pivots without progress after which single pivots follow.
const PATIENCE: usize = 10;
/// Violation of D z + b ≥ 0, as a fraction of |b|, that counts as zero: ties stay open.
const TIE: f64 = 1e-14;
/// Pivot, as a fraction of its diagonal entry, below which the matrix counts as singular.
const PIVOT: f64 = 1e-13;

/// Solves 0 ≤ z ⊥ D z + b ≥ 0 into `z`. `d` is the square matrix D, row by row; only its lower
/// triangle is read.
///
/// # Errors
/// D is not positive definite on the indices of positive z.
pub(super) fn complementarity(d: &[f64], b: &[f64], z: &mut Vec<f64>) -> Result<(), LinearError> {
    let n = b.len();
    let entry = |i: usize, j: usize| d[i.max(j) * n + i.min(j)];
    let tie = TIE * b.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
    let mut positive: Vec<bool> = b.iter().map(|&b| b < -tie).collect();
    let mut fewest = n + 1;
    let mut patience = PATIENCE;
    let mut factor = Vec::new();
    let mut part = Vec::new();
    let mut wrong = Vec::new();
    for _ in 0..1000 + 100 * n {
        let chosen: Vec<usize> = (0..n).filter(|&i| positive[i]).collect();
        cholesky(&chosen, entry, &mut factor)?;
        part.clear();
        part.extend(chosen.iter().map(|&i| -b[i]));
        substitute(&factor, &mut part);
        z.clear();
        z.resize(n, 0.0);
        for (&i, &value) in chosen.iter().zip(&part) {
            z[i] = value;
        }
        wrong.clear();
        for i in 0..n {
            let outside = if positive[i] {
                z[i] < 0.0
            } else {
                chosen.iter().map(|&j| entry(i, j) * z[j]).sum::<f64>() + b[i] < -tie
            };
            if outside {
                wrong.push(i);
            }
        }
        let Some(&last) = wrong.last() else { return Ok(()) };
        if wrong.len() < fewest {
            fewest = wrong.len();
            patience = PATIENCE;
        } else {
            patience = patience.saturating_sub(1);
        }
        if patience > 0 {
            wrong.iter().for_each(|&i| positive[i] = !positive[i]);
        } else {
            positive[last] = !positive[last];
        }
    }
    Err(LinearError::Engine {
        size: n,
        reason: "principal pivoting does not terminate: the matrix is not definite".into(),
    })
}

/// Cholesky factor L of the submatrix of the chosen indices, packed row by row.
fn cholesky(
    chosen: &[usize],
    entry: impl Fn(usize, usize) -> f64,
    factor: &mut Vec<f64>,
) -> Result<(), LinearError> {
    factor.clear();
    for (r, &i) in chosen.iter().enumerate() {
        let row = factor.len();
        for (c, &j) in chosen[..=r].iter().enumerate() {
            let column = c * (c + 1) / 2;
            let known: f64 = (0..c).map(|k| factor[row + k] * factor[column + k]).sum();
            let left = entry(i, j) - known;
            if c < r {
                factor.push(left / factor[column + c]);
            } else if left > PIVOT * entry(i, i) {
                factor.push(left.sqrt());
            } else {
                return Err(LinearError::Singular { size: chosen.len(), pivot: r, value: left });
            }
        }
    }
    Ok(())
}

/// Overwrites x with (L Lᵀ)⁻¹ x.
fn substitute(factor: &[f64], x: &mut [f64]) {
    let n = x.len();
    let at = |i: usize, j: usize| factor[i * (i + 1) / 2 + j];
    for i in 0..n {
        let known: f64 = (0..i).map(|j| at(i, j) * x[j]).sum();
        x[i] = (x[i] - known) / at(i, i);
    }
    for i in (0..n).rev() {
        let known: f64 = (i + 1..n).map(|j| at(j, i) * x[j]).sum();
        x[i] = (x[i] - known) / at(i, i);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Pseudo-random numbers in (−1, 1), reproducible.
    fn noise(k: usize) -> f64 {
        (k as f64 * 12.9898).sin() * 43758.5453 % 1.0
    }

    #[test]
    fn both_sides_and_their_product_hold_for_many_matrices() {
        for case in 0..200 {
            let n = 1 + case % 23;
            let a: Vec<f64> = (0..n * n).map(|k| noise(k + 1000 * case)).collect();
            let mut d = vec![0.0; n * n];
            for i in 0..n {
                for j in 0..n {
                    d[i * n + j] =
                        (0..n).map(|k| a[i * n + k] * a[j * n + k]).sum::<f64>() + f64::from(i == j) * 0.1;
                }
            }
            let b: Vec<f64> = (0..n).map(|k| noise(k + 77 * case)).collect();
            let mut z = Vec::new();
            complementarity(&d, &b, &mut z).unwrap();
            for i in 0..n {
                let w = (0..n).map(|j| d[i * n + j] * z[j]).sum::<f64>() + b[i];
                assert!(
                    z[i] >= 0.0 && w >= -1e-12 && (z[i] * w).abs() < 1e-11,
                    "case {case}: z {} w {w}",
                    z[i]
                );
            }
        }
    }

    #[test]
    fn a_stiff_chain_and_no_rows_at_all() {
        let n = 40;
        let d: Vec<f64> = (0..n * n).map(|k| f64::from(2 * (k / n).min(k % n) as u32 + 1)).collect();
        let b: Vec<f64> = (0..n).map(|k| noise(k) - 0.2).collect();
        let mut z = Vec::new();
        complementarity(&d, &b, &mut z).unwrap();
        for i in 0..n {
            let w = (0..n).map(|j| d[i * n + j] * z[j]).sum::<f64>() + b[i];
            assert!(z[i] >= 0.0 && w > -1e-11 && (z[i] * w).abs() < 1e-11);
        }
        complementarity(&[], &[], &mut z).unwrap();
        assert!(z.is_empty());
        assert!(matches!(
            complementarity(&[1.0, 1.0, 1.0, 1.0], &[-1.0, -2.0], &mut z),
            Err(LinearError::Singular { pivot: 1, .. })
        ));
    }
}
