//! Products with a sparse symmetric matrix on any number of threads.

use std::ops::Range;

use crate::pattern::Pattern;
use crate::threads::Threads;

/// Blocks of columns that are multiplied at the same time.
const BLOCKS: usize = 8;
/// Entries that are worth a block.
const ENTRIES: usize = 10_000;

/// How to multiply with matrices of a pattern: columns in blocks, each with a sum of its own for the rows outside it. Sums have one order, whatever the
/// number of threads.
///
/// ```
/// use carom_algebra::{Pattern, Product, Threads};
/// let pattern = Pattern::from_entries(2, [(1, 0)]);
/// let mut product = Product::new(&pattern);
/// let mut out = [0.0; 2];
/// product.multiply_add(&[2.0, 1.0, 3.0], &[1.0, 10.0], &mut out, &Threads::one());
/// assert_eq!(out, [12.0, 31.0]);
/// ```
#[derive(Clone, Debug, Default)]
pub struct Product {
    blocks: Vec<Block>,
    /// Start of each column among the entries.
    starts: Vec<u32>,
    /// Row of each entry, in its block's numbering: own columns, then the rows outside.
    rows: Vec<u32>,
}

#[derive(Clone, Debug, Default)]
struct Block {
    columns: Range<usize>,
    /// Rows outside, ascending.
    outer: Vec<u32>,
    /// The vector and the sum in the block's numbering.
    x: Vec<f64>,
    sum: Vec<f64>,
}

impl Product {
    /// For matrices of this pattern.
    pub fn new(pattern: &Pattern) -> Self {
        let n = pattern.size();
        let blocks = (pattern.len() / ENTRIES).clamp(1, BLOCKS);
        let mut product = Self {
            blocks: Vec::new(),
            starts: pattern.starts.iter().map(|&start| start as u32).collect(),
            rows: Vec::with_capacity(pattern.len()),
        };
        let mut first = 0;
        for block in 0..blocks {
            // As many entries in each.
            let end = pattern.starts.partition_point(|&start| start * blocks < (block + 1) * pattern.len()).min(n);
            let end = if block + 1 == blocks { n } else { end.max(first) };
            let rows = pattern.rows.get(pattern.starts.get(first).copied().unwrap_or(0)..).unwrap_or(&[]);
            let rows = &rows[..(first..end).map(|j| pattern.column(j).len()).sum()];
            let mut outer: Vec<u32> = rows.iter().filter(|&&row| row >= end).map(|&row| row as u32).collect();
            outer.sort_unstable();
            outer.dedup();
            let number = |&row: &usize| {
                let outside = || end - first + outer.partition_point(|&other| (other as usize) < row);
                (if row < end { row - first } else { outside() }) as u32
            };
            product.rows.extend(rows.iter().map(number));
            let length = end - first + outer.len();
            product.blocks.push(Block { columns: first..end, outer, x: vec![0.0; length], sum: vec![0.0; length] });
            first = end;
        }
        product
    }

    /// out += A x for the symmetric matrix with these values in its lower triangle.
    pub fn multiply_add(&mut self, values: &[f64], x: &[f64], out: &mut [f64], threads: &Threads) {
        let Self { blocks, starts, rows } = self;
        threads.for_each(blocks.iter_mut(), |_, block| block.multiply(starts, rows, values, x));
        for block in blocks {
            let (own, outside) = block.sum.split_at(block.columns.len());
            for (out, sum) in out[block.columns.clone()].iter_mut().zip(own) {
                *out += sum;
            }
            for (&row, sum) in block.outer.iter().zip(outside) {
                out[row as usize] += sum;
            }
        }
    }
}

impl Block {
    fn multiply(&mut self, starts: &[u32], rows: &[u32], values: &[f64], x: &[f64]) {
        let Self { columns, outer, x: known, sum } = self;
        let (own, outside) = known.split_at_mut(columns.len());
        own.copy_from_slice(&x[columns.clone()]);
        for (known, &row) in outside.iter_mut().zip(&*outer) {
            *known = x[row as usize];
        }
        sum.fill(0.0);
        for (k, j) in columns.clone().enumerate() {
            let entries = starts[j] as usize..starts[j + 1] as usize;
            let (rows, values) = (&rows[entries.clone()], &values[entries]);
            let mut along = values[0] * known[k];
            for (&i, value) in rows[1..].iter().zip(&values[1..]) {
                sum[i as usize] += value * known[k];
                along += value * known[i as usize];
            }
            sum[k] += along;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn agrees_with_the_pattern_and_with_itself_on_any_number_of_threads() {
        for n in [0, 1, 7, 5000] {
            let entries = (0..n).flat_map(|i| [1, 2, 3, 50, 51, 52, 700].map(move |d| (i, (i + d) % n.max(1))));
            let pattern = Pattern::from_entries(n, entries);
            let values: Vec<f64> = (0..pattern.len()).map(|k| (k as f64 * 0.31).sin()).collect();
            let x: Vec<f64> = (0..n).map(|i| (i as f64 * 0.7).cos()).collect();
            let mut expected = vec![1.0; n];
            pattern.multiply_add(&values, &x, &mut expected);
            let mut product = Product::new(&pattern);
            let [one, two, three] = [1, 2, 3].map(|threads| {
                let mut out = vec![1.0; n];
                product.multiply_add(&values, &x, &mut out, &Threads::new(threads));
                out
            });
            assert!(one.iter().zip(&expected).all(|(a, b)| (a - b).abs() < 1e-13));
            assert!(one == two && one == three);
        }
    }
}
