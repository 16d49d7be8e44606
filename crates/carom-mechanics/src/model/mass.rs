//! Mass matrix M = ∫ρ₀ NᵀN dΩ₀ between nodes; equal in every direction.

use carom_algebra::Threads;
use carom_solid::cell_lumped_mass;

use super::body_instance::BodyInstance;

/// Nodes per block of a product.
const BLOCK: usize = 1024;

/// Symmetric matrix between nodes, compressed by rows, both triangles.
#[derive(Clone, Debug, Default)]
pub struct Mass {
    starts: Vec<usize>,
    columns: Vec<u32>,
    values: Vec<f64>,
    directions: usize,
    threads: Threads,
}

impl Mass {
    /// Assembles the bodies' masses, consistent or lumped: `lumped` has one entry per body.
    pub fn assemble(dimension: usize, parts: &[BodyInstance], lumped: &[bool]) -> Self {
        let mut mass = Self::zero(dimension, parts, lumped);
        for (part, lumped) in parts.iter().zip(lumped) {
            let mesh = part.body.mesh();
            let n = mesh.element.nodes();
            let mut local = vec![0.0; n * n];
            let mut diagonal = vec![0.0; n];
            for cell in 0..mesh.cell_count() {
                if *lumped {
                    cell_lumped_mass(&*part.body, cell, &mut local, &mut diagonal);
                    local.fill(0.0);
                    for p in 0..n {
                        local[p * n + p] = diagonal[p];
                    }
                } else {
                    part.body.cell_mass(cell, &mut local);
                }
                let nodes = mesh.cell(cell);
                for p in 0..n {
                    for q in 0..n {
                        mass.add(part.first_node + nodes[p], part.first_node + nodes[q], local[p * n + q]);
                    }
                }
            }
        }
        for part in parts.iter().filter(|part| part.point_mass > 0.0) {
            mass.add(part.first_node, part.first_node, part.point_mass);
        }
        mass.without_zeros()
    }

    /// The structure: the nodes that share a cell with each node, of lumped bodies the node alone.
    fn zero(dimension: usize, parts: &[BodyInstance], lumped: &[bool]) -> Self {
        let count: usize = parts.iter().map(|p| p.body.mesh().nodes.len()).sum();
        let mut rows: Vec<Vec<u32>> = vec![Vec::new(); count];
        for (part, lumped) in parts.iter().zip(lumped) {
            let mesh = part.body.mesh();
            let number = |node: &usize| (part.first_node + node) as u32;
            for nodes in (0..mesh.cell_count()).map(|cell| mesh.cell(cell)) {
                for node in nodes {
                    let row = &mut rows[part.first_node + node];
                    if *lumped {
                        row.clear();
                        row.push(number(node));
                    } else {
                        row.extend(nodes.iter().map(number));
                    }
                }
            }
        }
        // Rigid obstacles come behind the bodies, and only bodies are lumped or not.
        for part in parts.iter().filter(|part| part.point_mass > 0.0) {
            rows[part.first_node].push(part.first_node as u32);
        }
        let mut mass = Self { starts: vec![0], directions: dimension, ..Self::default() };
        for mut row in rows {
            row.sort_unstable();
            row.dedup();
            mass.columns.extend(row);
            mass.starts.push(mass.columns.len());
        }
        mass.columns.shrink_to_fit();
        mass.values = vec![0.0; mass.columns.len()];
        mass
    }

    /// Adds to an entry; none that the structure lacks is other than zero.
    fn add(&mut self, row: usize, column: usize, value: f64) {
        let range = self.starts[row]..self.starts[row + 1];
        if let Ok(place) = self.columns[range.clone()].binary_search(&(column as u32)) {
            self.values[range][place] += value;
        }
    }

    /// Without the entries that are zero.
    fn without_zeros(mut self) -> Self {
        let mut kept = 0;
        let mut start = 0;
        for row in 1..self.starts.len() {
            let end = self.starts[row];
            for k in start..end {
                if self.values[k] != 0.0 {
                    self.columns[kept] = self.columns[k];
                    self.values[kept] = self.values[k];
                    kept += 1;
                }
            }
            start = end;
            self.starts[row] = kept;
        }
        self.columns.truncate(kept);
        self.values.truncate(kept);
        self
    }

    /// Entries (row, column, value) of a node's row, columns ascending.
    pub fn row(&self, node: usize) -> impl Iterator<Item = (usize, f64)> + '_ {
        let range = self.starts[node]..self.starts[node + 1];
        self.columns[range.clone()]
            .iter()
            .map(|&column| column as usize)
            .zip(self.values[range].iter().copied())
    }

    /// The same, mutable.
    pub(super) fn row_mut(&mut self, node: usize) -> impl Iterator<Item = (usize, &mut f64)> + '_ {
        let range = self.starts[node]..self.starts[node + 1];
        self.columns[range.clone()].iter().map(|&column| column as usize).zip(&mut self.values[range])
    }

    /// Number of nodes.
    pub fn nodes(&self) -> usize {
        self.starts.len() - 1
    }

    /// out = M x over all dofs.
    pub fn multiply_into(&self, x: &[f64], out: &mut [f64]) {
        self.add_product(x, 1.0, 0.0, out);
    }

    /// out = `factor` M x + `share` out over all dofs; a share of 0 overwrites any content.
    pub fn add_product(&self, x: &[f64], factor: f64, share: f64, out: &mut [f64]) {
        match self.directions {
            1 => self.multiply::<1>(x, factor, share, out),
            2 => self.multiply::<2>(x, factor, share, out),
            3 => self.multiply::<3>(x, factor, share, out),
            directions => unreachable!("{directions} directions"),
        }
    }

    /// Sets the threads that compute products.
    pub(crate) fn on(&mut self, threads: &Threads) {
        self.threads = threads.clone();
    }

    fn multiply<const D: usize>(&self, x: &[f64], factor: f64, share: f64, out: &mut [f64]) {
        let x = x.as_chunks::<D>().0;
        self.threads.for_each_block(out.as_chunks_mut::<D>().0, BLOCK, |first, block| {
            for (range, out) in self.starts[first..].windows(2).zip(block) {
                let range = range[0]..range[1];
                let mut sum = [0.0; D];
                for (&column, value) in self.columns[range.clone()].iter().zip(&self.values[range]) {
                    let x = &x[column as usize];
                    for i in 0..D {
                        sum[i] += value * x[i];
                    }
                }
                for i in 0..D {
                    out[i] = if share == 0.0 { factor * sum[i] } else { factor * sum[i] + share * out[i] };
                }
            }
        });
    }

    /// Whether a node carries no mass at all.
    pub fn is_massless(&self, node: usize) -> bool {
        self.row(node).all(|(_, value)| value == 0.0)
    }
}
