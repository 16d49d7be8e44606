//! The linear complementarity problem of a few unilateral contacts, 0 ≤ z ⊥ D z + b ≥ 0, with D
//! symmetric and positive definite. The solution is unique for any b.
//!
//! Block principal pivoting (Júdice and Pires 1994): all indices that violate their condition
//! change sides together. Without progress only the last one does (Murty 1974), which terminates
//! for every positive definite D. Factors have the entries of each row from its first coupling on:
//! contacts that are not coupled cost as many operations as there are.

use super::Couplings;
use crate::LinearError;

/// Number of block pivots without progress after which single pivots follow.
const PATIENCE: usize = 10;
/// Violation of D z + b ≥ 0, as a fraction of |b|, that counts as zero: ties stay open.
const TIE: f64 = 1e-14;
/// Pivot, as a fraction of its diagonal entry, below which the matrix counts as singular.
const PIVOT: f64 = 1e-13;

/// Solves 0 ≤ z ⊥ D z + b ≥ 0 into `z`. Only the lower triangle of D, `d`, is read.
///
/// # Errors
/// D is not positive definite on the indices of positive z.
pub fn complementarity(d: &Couplings, b: &[f64], z: &mut Vec<f64>) -> Result<(), LinearError> {
    let n = b.len();
    let tie = TIE * b.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
    let mut positive: Vec<bool> = b.iter().map(|&b| b < -tie).collect();
    let mut fewest = n + 1;
    let mut patience = PATIENCE;
    let mut factor = Envelope::default();
    let mut part = Vec::new();
    let mut wrong = Vec::new();
    for _ in 0..1000 + 100 * n {
        factor.of(d, &positive)?;
        let chosen = || (0..n).filter(|&i| positive[i]);
        part.clear();
        part.extend(chosen().map(|i| -b[i]));
        factor.substitute(&mut part);
        z.clear();
        z.resize(n, 0.0);
        for (i, &value) in chosen().zip(&part) {
            z[i] = value;
        }
        wrong.clear();
        for i in 0..n {
            let outside = if positive[i] {
                z[i] < 0.0
            } else {
                let moving = d.columns(i).iter().filter(|&&j| positive[j]);
                moving.map(|&j| d.at(i.max(j), i.min(j)) * z[j]).sum::<f64>() + b[i] < -tie
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

/// Cholesky factor L of a submatrix: of each row the entries from its first one on.
#[derive(Default)]
struct Envelope {
    /// Index of each chosen row of the matrix among them.
    places: Vec<usize>,
    /// Start of each row, and end of the last.
    starts: Vec<usize>,
    /// Column of the first entry of each row.
    first: Vec<usize>,
    /// The last row that has an entry of each column.
    last: Vec<usize>,
    entries: Vec<f64>,
}

impl Envelope {
    /// Becomes the factor of the rows and columns that are chosen.
    fn of(&mut self, d: &Couplings, chosen: &[bool]) -> Result<(), LinearError> {
        self.places.clear();
        self.places.resize(chosen.len(), 0);
        self.starts.clear();
        self.starts.push(0);
        self.first.clear();
        self.entries.clear();
        let size = chosen.iter().filter(|chosen| **chosen).count();
        for (r, i) in (0..chosen.len()).filter(|&i| chosen[i]).enumerate() {
            self.places[i] = r;
            let coupled = d.row(i).filter(|&(j, _)| j <= i && chosen[j]);
            let row = self.entries.len();
            for (j, value) in coupled {
                let column = self.places[j];
                if self.entries.len() == row {
                    self.first.push(column);
                }
                self.entries.resize(row + column - self.first.last().copied().unwrap_or(column), 0.0);
                self.entries.push(value);
            }
            if self.entries.len() == row {
                self.first.push(r);
                self.entries.push(0.0);
            }
            self.starts.push(self.entries.len());
            self.eliminate(r, size)?;
        }
        self.last.clear();
        self.last.extend(0..size);
        for (r, &first) in self.first.iter().enumerate() {
            self.last[first] = r;
        }
        for column in 1..size {
            self.last[column] = self.last[column].max(self.last[column - 1]);
        }
        Ok(())
    }

    /// Overwrites the entries of the last row with those of the factor.
    fn eliminate(&mut self, r: usize, size: usize) -> Result<(), LinearError> {
        let (above, row) = self.entries.split_at_mut(self.starts[r]);
        let first = self.first[r];
        for column in first..=r {
            let of_column = if column < r { &above[self.starts[column]..] } else { &[] };
            let begin = first.max(self.first[column]);
            let value = row[column - first];
            if column < r {
                let entries = begin..column;
                let known: f64 = entries.map(|k| row[k - first] * of_column[k - self.first[column]]).sum();
                row[column - first] = (value - known) / of_column[column - self.first[column]];
                continue;
            }
            let known: f64 = (begin..r).map(|k| row[k - first] * row[k - first]).sum();
            let left = value - known;
            if left <= PIVOT * value || left.is_nan() {
                return Err(LinearError::Singular { size, pivot: r, value: left });
            }
            row[r - first] = left.sqrt();
        }
        Ok(())
    }

    /// Entry of the factor; its row must have one in this column.
    fn at(&self, row: usize, column: usize) -> f64 {
        self.entries[self.starts[row] + column - self.first[row]]
    }

    /// Overwrites x with (L Lᵀ)⁻¹ x.
    fn substitute(&self, x: &mut [f64]) {
        let n = x.len();
        for i in 0..n {
            let known: f64 = (self.first[i]..i).map(|j| self.at(i, j) * x[j]).sum();
            x[i] = (x[i] - known) / self.at(i, i);
        }
        for i in (0..n).rev() {
            let below = (i + 1..=self.last[i]).filter(|&j| self.first[j] <= i);
            let known: f64 = below.map(|j| self.at(j, i) * x[j]).sum();
            x[i] = (x[i] - known) / self.at(i, i);
        }
    }
}
