//! Corrections with an old tangent, accelerated: Anderson's mixing (D. G. Anderson, J. ACM 12 (1965) 547–560; H. F. Walker, P. Ni, SIAM J. Numer. Anal. 49
//! (2011) 1715–1735). With corrections c(z) at iterates z = (y, λ),
//!
//! ```text
//! γ = argmin ‖c_k − ΔC γ‖,    z_{k+1} = z_k + c_k − (ΔZ + ΔC) γ
//! ```
//!
//! where the columns of ΔZ and ΔC are the last changes of z and c: what the old tangent gets wrong in the directions gone along is known from them. On a
//! linear problem this is GMRES preconditioned with the old tangent. The norm is that of the positions.

use std::collections::VecDeque;

use crate::model::dot;

/// Pivot, as a share of the largest, below which a direction repeats the others.
const DEPENDENT: f64 = 1e-8;

/// Positions and multipliers.
type Iterate = [Vec<f64>; 2];

/// What one iteration has shown.
#[derive(Debug, Default)]
struct Change {
    /// Column of ΔC.
    correction: Iterate,
    /// Column of ΔZ + ΔC.
    both: Iterate,
    /// Products of the correction's change with itself and with older ones, the latest first.
    products: Vec<f64>,
}

/// What the last iterations with one factor and one set of contacts have shown.
#[derive(Debug, Default)]
pub(crate) struct Mixing {
    /// The last correction and the step that was taken for it, where there are any.
    last: Iterate,
    taken: Iterate,
    begun: bool,
    /// The latest first.
    changes: VecDeque<Change>,
    /// Memory to be used again.
    spare: Vec<Change>,
}

impl Mixing {
    /// Forgets all: with another factor or other contacts the old corrections say nothing.
    pub(crate) fn restart(&mut self) {
        self.begun = false;
        self.spare.extend(self.changes.drain(..));
    }

    /// Makes of a correction the step to take; `depth` changes are remembered.
    pub(crate) fn improve(&mut self, correction: [&mut [f64]; 2], depth: usize) {
        if depth == 0 {
            return;
        }
        if self.begun {
            let oldest = if self.changes.len() < depth { self.spare.pop() } else { self.changes.pop_back() };
            let mut change = oldest.unwrap_or_default();
            for k in 0..2 {
                let (now, last) = (correction[k].iter(), &self.last[k]);
                change.correction[k].clear();
                change.correction[k].extend(now.zip(last).map(|(now, last)| now - last));
                let of_both = change.correction[k].iter().zip(&self.taken[k]).map(|(c, z)| c + z);
                change.both[k].clear();
                change.both[k].extend(of_both);
            }
            change.products.clear();
            change.products.push(dot(&change.correction[0], &change.correction[0]));
            change.products.extend(self.changes.iter().map(|old| dot(&change.correction[0], &old.correction[0])));
            self.changes.push_front(change);
        }
        for (last, now) in self.last.iter_mut().zip(&correction) {
            last.clear();
            last.extend_from_slice(now);
        }
        let right: Vec<f64> = self.changes.iter().map(|change| dot(&change.correction[0], correction[0])).collect();
        let product = |i: usize, j: usize| self.changes[i.min(j)].products[i.abs_diff(j)];
        let shares = least_squares(product, right);
        for (k, step) in correction.into_iter().enumerate() {
            for (share, change) in shares.iter().zip(&self.changes) {
                step.iter_mut().zip(&change.both[k]).for_each(|(step, both)| *step -= share * both);
            }
            self.taken[k].clear();
            self.taken[k].extend_from_slice(step);
        }
        self.begun = true;
    }
}

/// Solves normal equations by elimination; unknowns whose direction repeats the earlier ones are zero.
fn least_squares(product: impl Fn(usize, usize) -> f64, mut right: Vec<f64>) -> Vec<f64> {
    let n = right.len();
    let mut matrix: Vec<f64> = (0..n * n).map(|k| product(k / n, k % n)).collect();
    let largest = (0..n).map(|i| matrix[i * n + i]).fold(0.0, f64::max);
    let mut used = vec![true; n];
    for k in 0..n {
        used[k] = matrix[k * n + k] > DEPENDENT * product(k, k).max(DEPENDENT * largest);
        for i in (k + 1..n).filter(|_| used[k]) {
            let factor = matrix[i * n + k] / matrix[k * n + k];
            for j in k..n {
                matrix[i * n + j] -= factor * matrix[k * n + j];
            }
            right[i] -= factor * right[k];
        }
    }
    for k in (0..n).rev() {
        let known: f64 = (k + 1..n).map(|j| matrix[k * n + j] * right[j]).sum();
        right[k] = if used[k] { (right[k] - known) / matrix[k * n + k] } else { 0.0 };
    }
    right
}

#[cfg(test)]
mod tests {
    use super::*;

    /// y = b − Ay with a matrix that contracts by 0.9 at worst: with as many directions as unknowns the solution is reached in one step more (Walker, Ni,
    /// theorem 2.2), without any hardly a digit is.
    #[test]
    fn linear_problems_end_after_as_many_steps_as_there_are_unknowns() {
        let old = [[0.9, 0.1, 0.0], [0.0, -0.4, 0.2], [0.1, 0.0, 0.5]];
        let solution = [1.0, -2.0, 3.0];
        for (depth, error) in [(0, 0.1..10.0), (1, 1e-8..1.0), (3, 0.0..1e-13)] {
            let mut mixing = Mixing::default();
            let mut y = [0.0; 3];
            for _ in 0..5 {
                let away: Vec<f64> = y.iter().zip(&solution).map(|(y, s)| s - y).collect();
                let correction: Vec<f64> =
                    (0..3).map(|i| away[i] - (0..3).map(|j| old[i][j] * away[j]).sum::<f64>()).collect();
                let (mut step, mut multiplier) = (correction.clone(), [2.0 * correction[0]]);
                mixing.improve([&mut step, &mut multiplier], depth);
                // What is linear in the positions stays so.
                assert!((multiplier[0] - 2.0 * step[0]).abs() < 1e-12);
                y.iter_mut().zip(&step).for_each(|(y, step)| *y += step);
            }
            let left = y.iter().zip(&solution).map(|(y, s)| (y - s).abs()).fold(0.0, f64::max);
            assert!(error.contains(&left), "{depth}: {left:e}");
        }
    }

    #[test]
    fn a_direction_that_repeats_another_is_left_out() {
        let products = [[2.0, 2.0, 1.0], [2.0, 2.0, 1.0], [1.0, 1.0, 5.0]];
        assert_eq!(least_squares(|i, j| products[i][j], vec![2.0, 2.0, 10.0]), vec![0.0, 0.0, 2.0]);
        assert_eq!(least_squares(|_, _| 0.0, vec![0.0]), vec![0.0]);
    }
}
