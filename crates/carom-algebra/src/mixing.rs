//! Acceleration of corrections with an old tangent: Anderson's mixing (D. G. Anderson, J. ACM 12
//! (1965) 547–560; H. F. Walker, P. Ni, SIAM J. Numer. Anal. 49 (2011) 1715–1735). With corrections
//! c(z) at iterates z = (y, λ),
//!
//! ```text
//! γ = argmin ‖c_k − ΔC γ‖,    z_{k+1} = z_k + c_k − (ΔZ + ΔC) γ
//! ```
//!
//! where the columns of ΔZ and ΔC are the last changes of z and c, which reveal the error of the
//! old tangent in the directions taken. On a linear problem this is GMRES preconditioned with the
//! old tangent. The norm is that of the positions.

use std::collections::VecDeque;

use crate::sums::dot;
use crate::threads::Threads;

/// Length of the blocks in which vectors are traversed, so that each is read once.
const BLOCK: usize = 2048;
/// Pivot, relative to the square of a direction, below which the direction depends linearly on the
/// others.
const DEPENDENT: f64 = 1e-8;

/// An iterate or its change: positions and multipliers.
type Iterate = [Vec<f64>; 2];

/// Changes of correction and iterate in one iteration of the history.
#[derive(Debug, Default)]
struct Change {
    /// Change of the correction: a column of ΔC.
    correction: Iterate,
    /// Change of the iterate and the correction together: a column of ΔZ + ΔC.
    both: Iterate,
    /// Products of the correction's change with itself and with older ones, latest first.
    products: Vec<f64>,
}

/// Anderson's acceleration: the history of iterations with one factor and one set of contacts.
#[derive(Debug, Default)]
pub struct Mixing {
    /// The last correction.
    last: Iterate,
    /// The step taken for the last correction.
    taken: Iterate,
    begun: bool,
    /// Changes of the last iterations, latest first.
    changes: VecDeque<Change>,
    /// Memory of discarded changes, for reuse.
    spare: Vec<Change>,
    threads: Threads,
}

impl Mixing {
    /// A history that is computed on threads, on whose number the result does not depend.
    pub fn on(threads: &Threads) -> Self {
        Self { threads: threads.clone(), ..Self::default() }
    }

    /// Clears the history, which is meaningless for another factor or other contacts.
    pub fn restart(&mut self) {
        self.begun = false;
        self.spare.extend(self.changes.drain(..));
    }

    /// Replaces a correction by the accelerated step, with at most `depth` stored changes.
    pub fn improve(&mut self, correction: [&mut [f64]; 2], depth: usize) {
        if depth == 0 {
            return;
        }
        let mut right = self.record(&correction, depth);
        let product = |i: usize, j: usize| self.changes[i.min(j)].products[i.abs_diff(j)];
        least_squares(product, &mut right);
        let changes = &self.changes;
        for (k, step) in correction.into_iter().enumerate() {
            self.taken[k].resize(step.len(), 0.0);
            let blocks = step.chunks_mut(BLOCK).zip(self.taken[k].chunks_mut(BLOCK));
            self.threads.for_each(blocks, |block, (step, taken)| {
                for (share, change) in right.iter().zip(changes) {
                    let both = &change.both[k][block * BLOCK..];
                    step.iter_mut().zip(both).for_each(|(step, both)| *step -= share * both);
                }
                taken.copy_from_slice(step);
            });
        }
    }

    /// Stores a correction and its change from the last one. Returns products of the changes with
    /// the correction.
    fn record(&mut self, correction: &[&mut [f64]; 2], depth: usize) -> Vec<f64> {
        let full = self.changes.len() == depth;
        let oldest = if self.begun && full { self.changes.pop_back() } else { self.spare.pop() };
        let mut new = oldest.unwrap_or_default();
        for (k, now) in correction.iter().enumerate() {
            for vector in [&mut self.last[k], &mut self.taken[k], &mut new.correction[k], &mut new.both[k]] {
                vector.resize(now.len(), 0.0);
            }
        }
        // The norm is that of positions.
        let [positions, multipliers] = correction;
        let count = self.changes.len() + 1;
        let mut of_blocks = vec![[0.0; 2]; count * positions.len().div_ceil(BLOCK)];
        let Self { changes, last, taken, threads, .. } = self;
        let Change { correction: change, both, .. } = &mut new;
        let blocks = (last[0].chunks_mut(BLOCK).zip(change[0].chunks_mut(BLOCK)))
            .zip(both[0].chunks_mut(BLOCK))
            .zip(of_blocks.chunks_mut(count));
        threads.for_each(blocks, |block, (((last, change), both), products)| {
            let range = block * BLOCK..block * BLOCK + last.len();
            let now = &positions[range.clone()];
            difference(now, &taken[0][range.clone()], [last, change, both]);
            products[0] = [dot(change, change), dot(change, now)];
            for (products, old) in products[1..].iter_mut().zip(&*changes) {
                let old = &old.correction[0][range.clone()];
                *products = [dot(old, change), dot(old, now)];
            }
        });
        difference(multipliers, &taken[1], [&mut last[1], &mut change[1], &mut both[1]]);
        if !std::mem::replace(&mut self.begun, true) {
            self.spare.push(new);
            return Vec::new();
        }
        let mut sums = vec![[0.0; 2]; count];
        for of_block in of_blocks.chunks_exact(count) {
            for (sum, product) in sums.iter_mut().zip(of_block) {
                (0..2).for_each(|i| sum[i] += product[i]);
            }
        }
        new.products.clear();
        new.products.extend(sums.iter().map(|[of_change, _]| of_change));
        self.changes.push_front(new);
        sums.into_iter().map(|[_, of_correction]| of_correction).collect()
    }
}

/// Stores a correction as the last one, its change, and this change with that of the iterate.
fn difference(now: &[f64], taken: &[f64], [last, change, both]: [&mut [f64]; 3]) {
    for i in 0..now.len() {
        change[i] = now[i] - last[i];
        both[i] = change[i] + taken[i];
        last[i] = now[i];
    }
}

/// Overwrites the right-hand side of normal equations with their solution, by elimination; unknowns
/// with linearly dependent directions are zero.
pub fn least_squares(product: impl Fn(usize, usize) -> f64, right: &mut [f64]) {
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
}
