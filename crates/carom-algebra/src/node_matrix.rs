//! A sparse symmetric matrix of D × D blocks between nodes, both triangles, in single precision: of
//! a matrix of which only products are needed, and to few digits.

use crate::simd::wide;
use crate::threads::Threads;

/// Nodes per block of a product.
const BLOCK: usize = 1024;

/// Blocks by rows of nodes, columns ascending. Every node is coupled with itself.
#[derive(Clone, Debug, Default)]
pub struct NodeMatrix {
    dimension: usize,
    starts: Vec<usize>,
    columns: Vec<u32>,
    /// Blocks one after the other, each by rows.
    values: Vec<f32>,
    threads: Threads,
}

impl NodeMatrix {
    /// The structure of a matrix with `dimension` ≤ 3 components per node, from the nodes that each
    /// node is coupled with, in any order and possibly repeated.
    pub fn new(dimension: usize, mut coupled: Vec<Vec<u32>>) -> Self {
        let (mut starts, mut columns) = (vec![0], Vec::new());
        for (node, others) in coupled.iter_mut().enumerate() {
            others.push(node as u32);
            others.sort_unstable();
            others.dedup();
            columns.append(others);
            starts.push(columns.len());
        }
        columns.shrink_to_fit();
        let values = vec![0.0; columns.len() * dimension * dimension];
        Self { dimension, starts, columns, values, threads: Threads::one() }
    }

    /// Shares products among these threads. The result does not depend on them.
    #[must_use]
    pub fn on(self, threads: &Threads) -> Self {
        Self { threads: threads.clone(), ..self }
    }

    /// Number of nodes.
    pub fn nodes(&self) -> usize {
        self.starts.len().saturating_sub(1)
    }

    /// Position of the block of two nodes.
    pub fn slot(&self, row: usize, column: usize) -> Option<usize> {
        let start = self.starts[row];
        let columns = &self.columns[start..self.starts[row + 1]];
        columns.binary_search(&(column as u32)).ok().map(|k| start + k)
    }

    /// Sets all entries to zero.
    pub fn clear(&mut self) {
        self.values.fill(0.0);
    }

    /// The entries of a block, by rows.
    pub fn block(&self, slot: usize) -> &[f32] {
        let size = self.dimension * self.dimension;
        &self.values[slot * size..(slot + 1) * size]
    }

    /// The same, mutable.
    pub fn block_mut(&mut self, slot: usize) -> &mut [f32] {
        let size = self.dimension * self.dimension;
        &mut self.values[slot * size..(slot + 1) * size]
    }

    /// out = A x, both with all components of all nodes.
    pub fn multiply_into(&self, x: &[f64], out: &mut [f64]) {
        match self.dimension {
            1 => self.multiply::<1, 1>(x, out),
            2 => self.multiply::<2, 4>(x, out),
            3 => self.multiply::<3, 9>(x, out),
            _ => out.fill(0.0),
        }
    }

    fn multiply<const D: usize, const DD: usize>(&self, x: &[f64], out: &mut [f64]) {
        let (x, values) = (x.as_chunks::<D>().0, self.values.as_chunks::<DD>().0);
        self.threads.for_each_block(out.as_chunks_mut::<D>().0, BLOCK, |first, block| {
            wide(|| {
                for (range, out) in self.starts[first..].windows(2).zip(block) {
                    let range = range[0]..range[1];
                    // A sum for each entry of the blocks: none waits for another.
                    let mut sums = [0.0; DD];
                    for (&column, a) in self.columns[range.clone()].iter().zip(&values[range]) {
                        let x = &x[column as usize];
                        for k in 0..DD {
                            sums[k] += f64::from(a[k]) * x[k % D];
                        }
                    }
                    *out = std::array::from_fn(|i| sums[i * D..(i + 1) * D].iter().sum());
                }
            });
        });
    }
}
