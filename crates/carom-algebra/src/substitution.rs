//! Triangular solves with the inner part of a factor, L y = b and Lᵀ x = J y. Independent parts of
//! the elimination run in parallel.

use crate::elimination::{Elimination, Subtree};
use crate::precision::Entry;
use crate::simd::{dot, subtract, subtract_both, wide};
use crate::threads::Threads;

/// Triangular solves with the inner part of a factor, part by part. Parts exchange values only at
/// their outer rows, in a fixed order.
pub(crate) struct Solver<'a, T> {
    pub(crate) elimination: &'a Elimination,
    pub(crate) factors: &'a [T],
    pub(crate) inverse: &'a [f64],
    /// Signs J between L and Lᵀ; empty if all are positive.
    pub(crate) signs: &'a [f64],
    /// Square of the scale of the factor.
    pub(crate) square: f64,
    pub(crate) threads: &'a Threads,
}

impl<T: Entry> Solver<'_, T> {
    pub(crate) fn forward(&self, part: &Subtree, rhs: &[f64], x: &mut [f64]) {
        let mut x = x;
        if let Some(parts) = &part.parts {
            let [a, b] = &**parts;
            let (deeper, remaining) = x.split_at_mut(a.length + b.length);
            let (of_a, of_b) = deeper.split_at_mut(a.length);
            self.threads.join(|| self.forward(a, rhs, of_a), || self.forward(b, rhs, of_b));
            self.take(part, rhs, remaining);
            for (part, x) in [(a, of_a), (b, of_b)] {
                for (&row, value) in part.outer.iter().zip(&x[x.len() - part.outer.len()..]) {
                    remaining[row as usize] += value;
                }
            }
            x = remaining;
        } else {
            self.take(part, rhs, x);
        }
        wide(
            #[inline(always)]
            || {
                let mut rows = vec![0.0; part.height];
                for s in part.nodes.clone() {
                    self.forward_node(s, part.columns.start, &mut rows, x);
                }
            },
        );
    }

    /// Sets the section of a part in a vector to the right-hand side on its own columns and to zero
    /// on its outer rows.
    fn take(&self, part: &Subtree, rhs: &[f64], x: &mut [f64]) {
        let (own, outside) = x.split_at_mut(part.columns.len());
        for (value, &i) in own.iter_mut().zip(&self.elimination.order[part.columns.clone()]) {
            *value = rhs[i as usize];
        }
        outside.fill(0.0);
    }

    pub(crate) fn backward(&self, part: &Subtree, x: &mut [f64]) {
        let deeper = part.parts.iter().flat_map(|parts| parts.iter()).map(|part| part.length).sum();
        let (deeper, x) = x.split_at_mut(deeper);
        wide(
            #[inline(always)]
            || {
                let mut rows = vec![0.0; part.height];
                for s in part.nodes.clone().rev() {
                    self.backward_node(s, part.columns.start, &mut rows, x);
                }
            },
        );
        if let Some(parts) = &part.parts {
            let [a, b] = &**parts;
            let (of_a, of_b) = deeper.split_at_mut(a.length);
            let known = &*x;
            let half = |part: &Subtree, x: &mut [f64]| {
                let first = x.len() - part.outer.len();
                for (value, &row) in x[first..].iter_mut().zip(&part.outer) {
                    *value = known[row as usize];
                }
                self.backward(part, x);
            };
            self.threads.join(|| half(a, of_a), || half(b, of_b));
        }
    }

    /// Data of a supernode: its first column and its rows below in the numbering of the part, its
    /// values (column-major, all rows), and the reciprocals of its diagonal.
    #[inline(always)]
    fn node(&self, s: usize, start: usize) -> (usize, &[u32], &[T], &[f64]) {
        let columns = self.elimination.columns(s);
        let all = self.elimination;
        let values = &self.factors[all.nodes[s].values..all.nodes[s + 1].values];
        (columns.start - start, &all.local[all.rows(s)], values, &self.inverse[columns])
    }

    #[inline(always)]
    fn forward_node(&self, s: usize, start: usize, rows: &mut [f64], x: &mut [f64]) {
        let (first, below, values, inverse) = self.node(s, start);
        let columns = inverse.len();
        let height = inverse.len() + below.len();
        let rows = &mut rows[..height];
        rows[..columns].copy_from_slice(&x[first..first + columns]);
        for (value, &row) in rows[columns..].iter_mut().zip(below) {
            *value = x[row as usize];
        }
        for c in (0..columns - columns % 2).step_by(2) {
            let (a, b) = values[c * height..(c + 2) * height].split_at(height);
            let first = inverse[c] * rows[c];
            let second = inverse[c + 1] * (rows[c + 1] - first * a[c + 1].into());
            rows[c] = first;
            rows[c + 1] = second;
            subtract_both(&mut rows[c + 2..], [first, second], [&a[c + 2..], &b[c + 2..]]);
        }
        if columns % 2 == 1 {
            let c = columns - 1;
            rows[c] *= inverse[c];
            let (known, remaining) = rows[c..].split_at_mut(1);
            subtract(remaining, known[0], &values[c * height + columns..]);
        }
        x[first..first + columns].copy_from_slice(&rows[..columns]);
        for (value, &row) in rows[columns..].iter().zip(below) {
            x[row as usize] = *value;
        }
    }

    /// Backward substitution of a supernode, L'ᵀx = σ²(z/σ) − L'_BIᵀ x_B, from the z/σ of the
    /// forward substitution.
    #[inline(always)]
    fn backward_node(&self, s: usize, start: usize, rows: &mut [f64], x: &mut [f64]) {
        let (first, below, values, inverse) = self.node(s, start);
        let columns = inverse.len();
        let height = inverse.len() + below.len();
        let outside = &mut rows[..below.len()];
        for (value, &row) in outside.iter_mut().zip(below) {
            *value = x[row as usize];
        }
        let own = &mut x[first..first + columns];
        own.iter_mut().for_each(|x| *x *= self.square);
        if !self.signs.is_empty() {
            own.iter_mut().zip(&self.signs[self.elimination.columns(s)]).for_each(|(x, sign)| *x *= sign);
        }
        // The long sum does not depend on the previous column.
        for c in (0..columns).rev() {
            let (near, far) = values[c * height + c + 1..(c + 1) * height].split_at(columns - c - 1);
            let known = dot(far, outside) + dot(near, &own[c + 1..]);
            own[c] = inverse[c] * (own[c] - known);
        }
    }
}
