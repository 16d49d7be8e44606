//! Conjugate gradients under linear constraints,
//!
//! ```text
//! [ A  Gᵀ ] [x]   [b]
//! [ G  0  ] [λ] = [c]        A symmetric, positive definite where G x = 0
//! ```
//!
//! preconditioned by the same matrix with the diagonal blocks D of A in its place, (r, c) ↦
//! z = D⁻¹(r − Gᵀμ) with G D⁻¹Gᵀ μ = G D⁻¹r − c (N. I. M. Gould, M. E. Hribar, J. Nocedal, SIAM J.
//! Sci. Comput. 23 (2001) 1376–1395). Every direction then satisfies G p = 0, so the constraints
//! hold to round-off from the first iterate on, and A is only seen where it is positive definite.
//! In each iteration Gᵀμ is moved from the residual to the multipliers (ibid., §6), which keeps its
//! digits.
//!
//! A row with a compliance C > 0 is a spring: A contains GᵀC⁻¹G, and with C on the diagonal of
//! G D⁻¹Gᵀ so does the preconditioner.

use std::sync::Arc;

use crate::condensed::Condensed;
use crate::elimination::Elimination;
use crate::linear::LinearError;
use crate::pattern::Pattern;
use crate::precision::Precision;
use crate::threads::Threads;

/// Length of the blocks into which sums are divided.
const BLOCK: usize = 3 * 1024;
/// Fraction of the largest diagonal entry that replaces a block which is not positive definite.
const NONE: f64 = 1e-12;

/// The inverses of the diagonal blocks of a matrix over nodes.
#[derive(Clone, Debug, Default)]
pub struct DiagonalBlocks {
    dimension: usize,
    /// Inverse blocks by rows, one after the other.
    inverses: Vec<f64>,
}

impl DiagonalBlocks {
    /// Inverts the symmetric blocks of `dimension` ≤ 3 that `fill` writes by rows for each of the
    /// nodes. A block that is not positive definite is replaced by its diagonal.
    pub fn invert(&mut self, dimension: usize, nodes: usize, mut fill: impl FnMut(usize, &mut [f64])) {
        self.dimension = dimension;
        let size = dimension * dimension;
        self.inverses.resize(nodes * size, 0.0);
        let mut block = [0.0; 9];
        for (node, inverse) in self.inverses.chunks_exact_mut(size).enumerate() {
            let block = &mut block[..size];
            fill(node, block);
            if !invert(dimension, block, inverse) {
                inverse.fill(0.0);
                let largest = block.iter().step_by(dimension + 1).fold(0.0, |most: f64, x| most.max(x.abs()));
                for i in 0..dimension {
                    let pivot = block[i * dimension + i].abs().max(NONE * largest);
                    inverse[i * dimension + i] = if pivot > 0.0 { pivot.recip() } else { 1.0 };
                }
            }
        }
    }

    /// The inverse of a node's block, by rows.
    fn of(&self, node: usize) -> &[f64] {
        let size = self.dimension * self.dimension;
        &self.inverses[node * size..(node + 1) * size]
    }

    /// Computes D⁻¹ x for the nodes of a section of a vector that begins with the component
    /// `first`.
    fn apply(&self, first: usize, x: &[f64], out: &mut [f64]) {
        match self.dimension {
            1 => self.apply_to::<1, 1>(first, x, out),
            2 => self.apply_to::<2, 4>(first, x, out),
            _ => self.apply_to::<3, 9>(first, x, out),
        }
    }

    fn apply_to<const D: usize, const DD: usize>(&self, first: usize, x: &[f64], out: &mut [f64]) {
        let inverses = &self.inverses.as_chunks::<DD>().0[first / D..];
        for ((a, x), out) in inverses.iter().zip(x.as_chunks::<D>().0).zip(out.as_chunks_mut::<D>().0) {
            for i in 0..D {
                out[i] = (0..D).map(|j| a[i * D + j] * x[j]).sum();
            }
        }
    }
}

/// The inverse of a symmetric block by Cholesky; false if it is not positive definite.
fn invert(n: usize, block: &[f64], inverse: &mut [f64]) -> bool {
    let mut l = [0.0; 9];
    for j in 0..n {
        for i in j..n {
            let sum = block[i * n + j] - (0..j).map(|k| l[i * n + k] * l[j * n + k]).sum::<f64>();
            if i > j {
                l[i * n + j] = sum / l[j * n + j];
            } else if sum > NONE * block[j * n + j] {
                l[j * n + j] = sum.sqrt();
            } else {
                return false;
            }
        }
    }
    for column in 0..n {
        let mut x = [0.0; 3];
        for i in 0..n {
            let right = f64::from(u8::from(i == column));
            x[i] = (right - (0..i).map(|k| l[i * n + k] * x[k]).sum::<f64>()) / l[i * n + i];
        }
        for i in (0..n).rev() {
            x[i] = (x[i] - (i + 1..n).map(|k| l[k * n + i] * x[k]).sum::<f64>()) / l[i * n + i];
            inverse[i * n + column] = x[i];
        }
    }
    true
}

/// The rows G with the factor of G D⁻¹Gᵀ + C.
#[derive(Default)]
pub struct ConstraintRows {
    starts: Vec<usize>,
    dofs: Vec<usize>,
    slopes: Vec<f64>,
    compliances: Vec<f64>,
    /// Entries of the complement G D⁻¹Gᵀ below its diagonal.
    coupled: Vec<(usize, usize)>,
    /// Pattern of the complement and its elimination order.
    structure: Option<(Pattern, Arc<Elimination>)>,
    values: Vec<f64>,
    factor: Option<Condensed>,
    /// Node, row, and place of the first entry of that row at the node, for all rows at all nodes.
    at_nodes: Vec<(usize, usize, usize)>,
    inner: Vec<f64>,
}

impl ConstraintRows {
    /// Removes all rows.
    pub fn clear(&mut self) {
        self.starts.clear();
        self.starts.push(0);
        self.dofs.clear();
        self.slopes.clear();
        self.compliances.clear();
        self.factor = None;
    }

    /// Adds a row of G, given by its degrees of freedom and their coefficients; its compliance is
    /// zero for a constraint.
    pub fn push(&mut self, compliance: f64, entries: impl IntoIterator<Item = (usize, f64)>) {
        for (dof, slope) in entries {
            self.dofs.push(dof);
            self.slopes.push(slope);
        }
        self.starts.push(self.dofs.len());
        self.compliances.push(compliance);
    }

    /// Number of rows.
    pub fn len(&self) -> usize {
        self.compliances.len()
    }

    /// Whether there are no rows.
    pub fn is_empty(&self) -> bool {
        self.compliances.is_empty()
    }

    /// Whether a row is a spring.
    pub fn is_spring(&self, row: usize) -> bool {
        self.compliances[row] != 0.0
    }

    /// Adds the force Gᵀc/C of a spring with the row G x − C λ = c to the right-hand side of the
    /// balance.
    pub fn pull(&self, row: usize, gap: f64, right: &mut [f64]) {
        let multiplier = gap / self.compliances[row];
        self.row(row).for_each(|(dof, slope)| right[dof] += multiplier * slope);
    }

    /// Multiplier λ = (G x − c)/C of a spring with the row G x − C λ = c.
    pub fn pulled(&self, row: usize, gap: f64, x: &[f64]) -> f64 {
        (self.along(row, x) - gap) / self.compliances[row]
    }

    fn row(&self, row: usize) -> impl Iterator<Item = (usize, f64)> + '_ {
        let range = self.starts[row]..self.starts[row + 1];
        self.dofs[range.clone()].iter().copied().zip(self.slopes[range].iter().copied())
    }

    /// Product G x for a row.
    fn along(&self, row: usize, x: &[f64]) -> f64 {
        self.row(row).map(|(dof, slope)| slope * x[dof]).sum()
    }

    /// Factors the complement G D⁻¹Gᵀ + C.
    ///
    /// # Errors
    /// If the rows are linearly dependent.
    pub fn factor(&mut self, blocks: &DiagonalBlocks) -> Result<(), LinearError> {
        if self.is_empty() {
            return Ok(());
        }
        self.group_by_nodes(blocks.dimension);
        self.update_structure()?;
        self.assemble(blocks);
        let Some((_, elimination)) = &self.structure else { return Ok(()) };
        let mut factor = Condensed::new(elimination, Precision::Double);
        let values = &self.values;
        if !factor.factor(|k| values[k])? {
            return Err(LinearError::Singular { size: self.len(), pivot: 0, value: 0.0 });
        }
        self.factor = Some(factor);
        Ok(())
    }

    /// Lists the rows that have entries at each node.
    fn group_by_nodes(&mut self, d: usize) {
        self.at_nodes.clear();
        for row in 0..self.len() {
            let mut last = usize::MAX;
            for k in self.starts[row]..self.starts[row + 1] {
                if std::mem::replace(&mut last, self.dofs[k] / d) != self.dofs[k] / d {
                    self.at_nodes.push((self.dofs[k] / d, row, k));
                }
            }
        }
        self.at_nodes.sort_unstable();
    }

    /// Analyses the pattern of the complement G D⁻¹Gᵀ, unless it is that of the last call.
    fn update_structure(&mut self) -> Result<(), LinearError> {
        let mut coupled = std::mem::take(&mut self.coupled);
        let before = coupled.clone();
        coupled.clear();
        for group in self.at_nodes.chunk_by(|a, b| a.0 == b.0) {
            for (i, a) in group.iter().enumerate() {
                coupled.extend(group[..i].iter().map(|b| (a.1, b.1)));
            }
        }
        coupled.sort_unstable();
        coupled.dedup();
        let known = self.structure.as_ref().is_some_and(|(pattern, _)| pattern.size() == self.len());
        if !known || coupled != before {
            let pattern = Pattern::from_entries(self.len(), coupled.iter().copied());
            let names: Vec<usize> = (0..self.len()).collect();
            let elimination = Arc::new(Elimination::new(&pattern, &names, &[])?);
            self.structure = Some((pattern, elimination));
        }
        self.coupled = coupled;
        Ok(())
    }

    /// Fills the lower triangle of the complement G D⁻¹Gᵀ + C.
    fn assemble(&mut self, blocks: &DiagonalBlocks) {
        let d = blocks.dimension;
        let Some((pattern, _)) = &self.structure else { return };
        self.values.clear();
        self.values.resize(pattern.len(), 0.0);
        for (row, compliance) in self.compliances.iter().enumerate() {
            self.values[pattern.starts[row]] = *compliance;
        }
        // The components of a row at a node.
        let slopes = |&(node, row, from): &(usize, usize, usize)| {
            let mut slopes = [0.0; 3];
            for k in (from..self.starts[row + 1]).take_while(|k| self.dofs[*k] / d == node) {
                slopes[self.dofs[k] - node * d] += self.slopes[k];
            }
            slopes
        };
        for group in self.at_nodes.chunk_by(|a, b| a.0 == b.0) {
            let inverse = blocks.of(group[0].0);
            for (i, a) in group.iter().enumerate() {
                let left = slopes(a);
                let mut moved = [0.0; 3];
                for j in 0..d {
                    moved[j] = (0..d).map(|i| left[i] * inverse[i * d + j]).sum();
                }
                for b in &group[..=i] {
                    let right = slopes(b);
                    let value: f64 = (0..d).map(|j| moved[j] * right[j]).sum();
                    if let Some(slot) = pattern.slot(a.1, b.1) {
                        self.values[slot] += value;
                    }
                }
            }
        }
    }

    /// Overwrites right-hand sides with the solution μ of the system with the complement.
    fn solve(&mut self, x: &mut [f64]) {
        if let Some(factor) = &mut self.factor {
            factor.eliminate_into(x, &mut self.inner);
            factor.substitute_into(&mut self.inner, x);
        }
    }

    /// Subtracts the forces Gᵀμ of all rows, as motions D⁻¹Gᵀμ, from z, and those of constraints
    /// from the residual r.
    fn subtract(&self, blocks: &DiagonalBlocks, mu: &[f64], z: &mut [f64], r: &mut [f64]) {
        let d = blocks.dimension;
        for (row, mu) in mu.iter().enumerate() {
            for (dof, slope) in self.row(row) {
                let node = dof / d;
                let i = dof % d;
                let inverse = blocks.of(node);
                for j in 0..d {
                    z[node * d + j] -= mu * slope * inverse[j * d + i];
                }
                if self.compliances[row] == 0.0 {
                    r[dof] -= mu * slope;
                }
            }
        }
    }
}

/// The diagonal blocks D and the factored rows G of a preconditioner.
pub struct ConstraintPreconditioner<'a> {
    /// Inverses of the diagonal blocks D.
    pub blocks: &'a DiagonalBlocks,
    /// Rows G, factored with the same diagonal blocks.
    pub rows: &'a mut ConstraintRows,
}

/// Accuracy and cost at which conjugate gradients end.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Goal {
    /// Residual relative to the first, both in the norm of the preconditioner, at which to end.
    pub reduction: f64,
    /// Largest number of iterations.
    pub iterations: usize,
}

/// How conjugate gradients ended.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Ended {
    /// Number of iterations: of products with A.
    pub iterations: usize,
    /// Residual relative to the first, both in the norm of the preconditioner.
    pub reduction: f64,
    /// Whether A was found not to be positive definite where G x = 0; the solution is then that of
    /// the iteration before.
    pub is_indefinite: bool,
}

/// The method of conjugate gradients under linear constraints, with its buffers.
#[derive(Debug, Default)]
pub struct ConjugateGradients {
    residual: Vec<f64>,
    direction: Vec<f64>,
    preconditioned: Vec<f64>,
    product: Vec<f64>,
    right: Vec<f64>,
    sums: Vec<f64>,
}

impl ConjugateGradients {
    /// Overwrites `x` and `multipliers` (zero for springs) with the solution for `forces` and
    /// `gaps`, to the accuracy of `goal`. `product(x, out)`: A x. Where a component is constrained,
    /// forces, entries of G and products are zero.
    pub fn solve(
        &mut self,
        threads: &Threads,
        mut product: impl FnMut(&[f64], &mut [f64]),
        ConstraintPreconditioner { blocks, rows }: ConstraintPreconditioner,
        [forces, gaps]: [&[f64]; 2],
        [x, multipliers]: [&mut [f64]; 2],
        goal: Goal,
    ) -> Ended {
        let n = forces.len();
        for buffer in [&mut self.residual, &mut self.direction, &mut self.preconditioned, &mut self.product] {
            buffer.resize(n, 0.0);
        }
        self.right.resize(rows.len(), 0.0);
        multipliers.fill(0.0);
        x.fill(0.0);
        self.residual.copy_from_slice(forces);
        if gaps.iter().any(|gap| *gap != 0.0) {
            self.satisfy(&mut product, blocks, rows, gaps, x);
        }
        let mut size = self.precondition(threads, blocks, rows, multipliers);
        self.direction.copy_from_slice(&self.preconditioned);
        let enough = goal.reduction * goal.reduction * size;
        let mut ended = Ended { iterations: 0, reduction: 0.0, is_indefinite: false };
        let first = size;
        while size > enough && size > 0.0 && ended.iterations < goal.iterations {
            product(&self.direction, &mut self.product);
            ended.iterations += 1;
            let curvature = dot(threads, &mut self.sums, &self.direction, &self.product);
            if curvature <= 0.0 || curvature.is_nan() {
                ended.is_indefinite = true;
                break;
            }
            let length = size / curvature;
            let direction = &self.direction;
            let products = &self.product;
            let both = x.chunks_mut(BLOCK).zip(self.residual.chunks_mut(BLOCK));
            threads.for_each(both, |k, (x, r)| {
                let range = k * BLOCK..k * BLOCK + x.len();
                for ((x, r), (p, q)) in
                    x.iter_mut().zip(r).zip(direction[range.clone()].iter().zip(&products[range]))
                {
                    *x += length * p;
                    *r -= length * q;
                }
            });
            let next = self.precondition(threads, blocks, rows, multipliers);
            let share = next / size;
            size = next;
            let preconditioned = &self.preconditioned;
            threads.for_each_block(&mut self.direction, BLOCK, |first, direction| {
                for (p, z) in direction.iter_mut().zip(&preconditioned[first..]) {
                    *p = z + share * *p;
                }
            });
        }
        ended.reduction = if first > 0.0 { (size.max(0.0) / first).sqrt() } else { 0.0 };
        ended
    }

    /// Overwrites x = 0 with a solution of the constraints, and updates the residual.
    fn satisfy(
        &mut self,
        product: &mut impl FnMut(&[f64], &mut [f64]),
        blocks: &DiagonalBlocks,
        rows: &mut ConstraintRows,
        gaps: &[f64],
        x: &mut [f64],
    ) {
        self.right.iter_mut().zip(gaps).for_each(|(right, gap)| *right = -gap);
        rows.solve(&mut self.right);
        self.product.fill(0.0);
        rows.subtract(blocks, &self.right, x, &mut self.product);
        product(x, &mut self.product);
        self.residual.iter_mut().zip(&self.product).for_each(|(r, q)| *r -= q);
    }

    /// Applies the preconditioner to the residual r, moves the forces Gᵀμ of constraints from r to
    /// the multipliers, and returns r·z of the result z.
    fn precondition(
        &mut self,
        threads: &Threads,
        blocks: &DiagonalBlocks,
        rows: &mut ConstraintRows,
        multipliers: &mut [f64],
    ) -> f64 {
        let residual = &self.residual;
        threads.for_each_block(&mut self.preconditioned, BLOCK, |first, z| {
            blocks.apply(first, &residual[first..first + z.len()], z);
        });
        if !rows.is_empty() {
            for (row, right) in self.right.iter_mut().enumerate() {
                *right = rows.along(row, &self.preconditioned);
            }
            rows.solve(&mut self.right);
            rows.subtract(blocks, &self.right, &mut self.preconditioned, &mut self.residual);
            for ((multiplier, mu), compliance) in
                multipliers.iter_mut().zip(&self.right).zip(&rows.compliances)
            {
                *multiplier += if *compliance == 0.0 { *mu } else { 0.0 };
            }
        }
        dot(threads, &mut self.sums, &self.residual, &self.preconditioned)
    }
}

/// Scalar product of two vectors, summed by blocks that do not depend on the number of threads.
fn dot(threads: &Threads, sums: &mut Vec<f64>, a: &[f64], b: &[f64]) -> f64 {
    sums.resize(a.len().div_ceil(BLOCK), 0.0);
    threads.for_each(sums.iter_mut(), |k, sum| {
        let range = k * BLOCK..((k + 1) * BLOCK).min(a.len());
        *sum = crate::sums::dot(&a[range.clone()], &b[range]);
    });
    sums.iter().sum()
}
