//! A sparse symmetric matrix of D × D blocks between nodes, in single precision: of a matrix of
//! which only products are needed, and to few digits.
//!
//! Products are limited by the memory that they read. Of A = L + D + Lᵀ only D and U = Lᵀ are
//! stored, and a block that has been read acts twice,
//!
//! ```text
//! out_i += A_ij x_j,    out_j += A_ijᵀ x_i        j > i
//! ```
//!
//! Rows are divided into sections of consecutive nodes, whatever the number of threads. A section
//! has its own copy of x and of its results, for its nodes and for later ones that it is coupled
//! with (its halo); these results are added in the order of the sections.

use crate::simd::wide;
use crate::threads::Threads;

/// Number of nodes of a section.
const SECTION: usize = 2048;

/// A sparse symmetric matrix of blocks between nodes in single precision, stored by rows of nodes;
/// each row begins with its diagonal block, later columns ascending.
#[derive(Clone, Debug, Default)]
pub struct NodeMatrix {
    dimension: usize,
    nodes: usize,
    starts: Vec<usize>,
    columns: Vec<u32>,
    /// Entries of the blocks, one block after the other, each by rows.
    values: Vec<f32>,
    sections: Vec<Section>,
    threads: Threads,
}

/// A section of the matrix: the rows of consecutive nodes.
#[derive(Clone, Debug, Default)]
struct Section {
    first: usize,
    rows: usize,
    /// Later nodes that the nodes of the section are coupled with, ascending.
    halo: Vec<u32>,
    /// Column of each block, as a position among the nodes of the section and its halo behind them.
    columns: Vec<u32>,
    x: Vec<[f32; 4]>,
    out: Vec<[f32; 4]>,
}

impl Section {
    fn new(first: usize, rows: usize, of_rows: &[u32]) -> Self {
        let end = first + rows;
        let mut halo: Vec<u32> = of_rows.iter().copied().filter(|column| *column as usize >= end).collect();
        halo.sort_unstable();
        halo.dedup();
        let place = |&column: &u32| match (column as usize).checked_sub(end) {
            None => column - first as u32,
            Some(_) => (rows + halo.binary_search(&column).unwrap_or_default()) as u32,
        };
        let columns = of_rows.iter().map(place).collect();
        let size = rows + halo.len();
        Self { first, rows, columns, x: vec![[0.0; 4]; size], out: vec![[0.0; 4]; size], halo }
    }

    /// Computes the share of the section in a product, for its own nodes and those of its halo.
    fn multiply<const D: usize, const DD: usize>(
        &mut self,
        starts: &[usize],
        values: &[[f32; DD]],
        x: &[[f64; D]],
    ) {
        let nodes = (self.first..self.first + self.rows).chain(self.halo.iter().map(|node| *node as usize));
        for (place, node) in self.x.iter_mut().zip(nodes) {
            (0..D).for_each(|i| place[i] = x[node][i] as f32);
        }
        let Self { columns, x, out, rows, .. } = self;
        out.fill([0.0; 4]);
        let first = starts[0];
        wide(|| {
            for row in 0..*rows {
                let range = starts[row] - first..starts[row + 1] - first;
                let own = x[row];
                // A sum for each entry of the blocks: none waits for another.
                let mut sums: [f32; DD] = std::array::from_fn(|k| values[range.start][k] * own[k % D]);
                let others = range.start + 1..range.end;
                for (&column, a) in columns[others.clone()].iter().zip(&values[others]) {
                    let other = &x[column as usize];
                    let out = &mut out[column as usize];
                    for k in 0..DD {
                        sums[k] += a[k] * other[k % D];
                    }
                    for j in 0..D {
                        out[j] += (0..D).map(|i| a[i * D + j] * own[i]).sum::<f32>();
                    }
                }
                for i in 0..D {
                    out[row][i] += sums[i * D..(i + 1) * D].iter().sum::<f32>();
                }
            }
        });
    }
}

impl NodeMatrix {
    /// The structure of a matrix with `dimension` ≤ 3 components per node, from the nodes that each
    /// node is coupled with, in any order and possibly repeated; every node is coupled with itself.
    pub fn new(dimension: usize, mut coupled: Vec<Vec<u32>>) -> Self {
        let nodes = coupled.len();
        let mut starts = vec![0];
        let mut columns = Vec::new();
        for (node, others) in coupled.iter_mut().enumerate() {
            others.push(node as u32);
            others.sort_unstable();
            others.dedup();
            columns.extend(others.iter().filter(|other| **other as usize >= node));
            others.clear();
            starts.push(columns.len());
        }
        columns.shrink_to_fit();
        let values = vec![0.0; columns.len() * dimension * dimension];
        let section = |first: usize| {
            let rows = SECTION.min(nodes - first);
            Section::new(first, rows, &columns[starts[first]..starts[first + rows]])
        };
        let sections = (0..nodes).step_by(SECTION).map(section).collect();
        Self { dimension, nodes, starts, columns, values, sections, threads: Threads::one() }
    }

    /// Shares products among threads, on whose number the result does not depend.
    #[must_use]
    pub fn on(self, threads: &Threads) -> Self {
        Self { threads: threads.clone(), ..self }
    }

    /// Number of nodes.
    pub fn nodes(&self) -> usize {
        self.nodes
    }

    /// Position of the block that couples two nodes, `row` ≤ `column`, if they are coupled.
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

    /// The entries of a block, by rows, for changes.
    pub fn block_mut(&mut self, slot: usize) -> &mut [f32] {
        let size = self.dimension * self.dimension;
        &mut self.values[slot * size..(slot + 1) * size]
    }

    /// Computes the product A x to single precision; both vectors have all components of all nodes.
    pub fn multiply_into(&mut self, x: &[f64], out: &mut [f64]) {
        match self.dimension {
            1 => self.multiply::<1, 1>(x, out),
            2 => self.multiply::<2, 4>(x, out),
            3 => self.multiply::<3, 9>(x, out),
            dimension => unreachable!("dimension {dimension}"),
        }
    }

    fn multiply<const D: usize, const DD: usize>(&mut self, x: &[f64], out: &mut [f64]) {
        let x = x.as_chunks::<D>().0;
        let out = out.as_chunks_mut::<D>().0;
        let starts = &self.starts;
        let values = self.values.as_chunks::<DD>().0;
        self.threads.for_each(self.sections.iter_mut().zip(out.chunks_mut(SECTION)), |_, (section, out)| {
            let starts = &starts[section.first..=section.first + section.rows];
            section.multiply(starts, &values[starts[0]..], x);
            for (out, sum) in out.iter_mut().zip(&section.out) {
                *out = std::array::from_fn(|i| f64::from(sum[i]));
            }
        });
        for section in &self.sections {
            for (node, sum) in section.halo.iter().zip(&section.out[section.rows..]) {
                (0..D).for_each(|i| out[*node as usize][i] += f64::from(sum[i]));
            }
        }
    }
}
