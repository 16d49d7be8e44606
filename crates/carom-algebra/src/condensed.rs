//! Cholesky of a sparse positive definite matrix with chosen unknowns B eliminated last (static condensation),
//!
//! ```text
//! A = L Lᵀ,    S = A_BB − A_BI A_II⁻¹ A_IB = L_BB L_BBᵀ
//! ```
//!
//! so that any change of A on B alone, and any constraint on B alone, is a matter of the small dense S: forward through the inner unknowns, a dense
//! solve on B, backward. The factor is kept while B's neighbourhood changes as it likes. B is one vertex of the graph that is ordered (approximate
//! minimum degree), then moved to the end.

// A loop is compiled for wide registers only where it is inlined into `wide`.
#![allow(clippy::inline_always)]

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::cholesky::llt::factor::{LltParams, LltRegularization};
use faer::linalg::matmul::matmul;
use faer::sparse::linalg::SupernodalThreshold;
use faer::sparse::linalg::cholesky::supernodal::{
    SymbolicSupernodalCholesky, factorize_supernodal_numeric_llt, factorize_supernodal_numeric_llt_scratch,
};
use faer::sparse::linalg::cholesky::{
    CholeskySymbolicParams, SymbolicCholesky, SymbolicCholeskyRaw, SymmetricOrdering, factorize_symbolic_cholesky,
};
use faer::sparse::{SparseColMatRef, SymbolicSparseColMatRef};
use faer::{Accum, MatMut, MatRef, Par, Side, Spec};

use crate::faer_engine::grouped_ordering;
use crate::linear::LinearError;
use crate::pattern::Pattern;
use crate::simd::{add_scaled, dot, wide};

/// A factor whose last unknowns are left for a dense solve.
#[derive(Default)]
pub struct Condensed {
    /// Place of each unknown in the elimination.
    place: Vec<u32>,
    inner: usize,
    starts: Vec<u32>,
    rows: Vec<u32>,
    /// Where each entry of the pattern went.
    slots: Vec<u32>,
    values: Vec<f64>,
    symbolic: Option<SymbolicCholesky<u32>>,
    factors: Vec<f64>,
    schur: Vec<f64>,
    trailing: Vec<f64>,
    gathered: Vec<f64>,
    scratch: Option<MemBuffer>,
}

impl Condensed {
    /// Orders and analyses a pattern; unknowns of one group stay together, those in `last` come last.
    ///
    /// # Errors
    /// The engine ran out of memory.
    pub fn analyse(&mut self, pattern: &Pattern, groups: &[usize], last: &[usize]) -> Result<(), LinearError> {
        let n = pattern.size();
        let engine = |reason: String| LinearError::Engine { size: n, reason };
        // The old factor is not wanted beside the new one.
        (self.symbolic, self.scratch, self.factors) = (None, None, Vec::new());
        let mut is_last = vec![false; n];
        last.iter().for_each(|&i| is_last[i] = true);
        let whole = groups.iter().max().map_or(0, |g| g + 1);
        let merged: Vec<usize> = (0..n).map(|i| if is_last[i] { whole } else { groups[i] }).collect();
        let mut names = merged.clone();
        names.sort_unstable();
        names.dedup();
        let merged: Vec<usize> = merged.iter().map(|g| names.partition_point(|name| name < g)).collect();
        let (forward, _) = grouped_ordering(pattern, &merged).map_err(engine)?;
        let order = forward.iter().filter(|&&i| !is_last[i]).chain(forward.iter().filter(|&&i| is_last[i]));
        self.place.clear();
        self.place.resize(n, 0);
        order.enumerate().for_each(|(place, &i)| self.place[i] = place as u32);
        self.inner = n - last.len();
        self.permute(pattern);
        let symbolic = self.structure(n).map_err(engine)?;
        let SymbolicCholeskyRaw::Supernodal(raw) = symbolic.raw() else {
            return Err(engine("no supernodes".into()));
        };
        self.factors.clear();
        self.factors.resize(raw.len_val(), 0.0);
        let space =
            factorize_supernodal_numeric_llt_scratch::<u32, f64>(raw, Par::Seq, Spec::<LltParams, f64>::default());
        self.scratch = Some(MemBuffer::try_new(space).map_err(|e| engine(format!("{e:?}")))?);
        self.symbolic = Some(symbolic);
        Ok(())
    }

    /// The lower triangle in the order of elimination, columns compressed, rows as they come.
    fn permute(&mut self, pattern: &Pattern) {
        let n = pattern.size();
        let place = &self.place;
        let mut fill = vec![0_u32; n + 1];
        let entry = |i: usize, j: usize| (place[i].max(place[j]), place[i].min(place[j]) as usize);
        for j in 0..n {
            pattern.column(j).iter().for_each(|&i| fill[entry(i, j).1 + 1] += 1);
        }
        for j in 0..n {
            fill[j + 1] += fill[j];
        }
        self.starts.clone_from(&fill);
        self.rows.clear();
        self.rows.resize(pattern.len(), 0);
        self.slots.clear();
        self.slots.resize(pattern.len(), 0);
        for j in 0..n {
            for k in pattern.starts[j]..pattern.starts[j + 1] {
                let (row, column) = entry(pattern.rows[k], j);
                let slot = fill[column];
                fill[column] += 1;
                self.rows[slot as usize] = row;
                self.slots[k] = slot;
            }
        }
        self.values.clear();
        self.values.resize(pattern.len(), 0.0);
    }

    /// Symbolic factor of the upper triangle, the last unknowns tied together by the row of their first.
    fn structure(&self, n: usize) -> Result<SymbolicCholesky<u32>, String> {
        let first = self.inner as u32;
        let mut columns: Vec<Vec<u32>> = vec![Vec::new(); n];
        for j in 0..n {
            let (start, end) = (self.starts[j] as usize, self.starts[j + 1] as usize);
            self.rows[start..end].iter().for_each(|&i| columns[i as usize].push(j as u32));
        }
        columns.iter_mut().skip(self.inner).for_each(|column| column.push(first));
        let (mut starts, mut rows) = (vec![0_u32], Vec::new());
        for column in &mut columns {
            column.sort_unstable();
            column.dedup();
            rows.append(column);
            starts.push(rows.len() as u32);
        }
        let params = CholeskySymbolicParams {
            supernodal_flop_ratio_threshold: SupernodalThreshold::FORCE_SUPERNODAL,
            ..Default::default()
        };
        let upper = SymbolicSparseColMatRef::new_checked(n, n, &starts, None, &rows);
        factorize_symbolic_cholesky(upper, Side::Upper, SymmetricOrdering::Identity, params)
            .map_err(|e| format!("{e:?}"))
    }

    /// Number of unknowns eliminated last.
    pub fn kept(&self) -> usize {
        self.place.len() - self.inner
    }

    /// Place of an unknown among those eliminated last.
    pub fn kept_place(&self, unknown: usize) -> Option<usize> {
        (self.place[unknown] as usize).checked_sub(self.inner)
    }

    /// Sets the matrix: `value(k)` for entry k of the pattern.
    pub fn fill(&mut self, value: impl Fn(usize) -> f64) {
        for (k, &slot) in self.slots.iter().enumerate() {
            self.values[slot as usize] = value(k);
        }
    }

    /// Factors the matrix last set.
    ///
    /// # Errors
    /// It is not positive definite.
    pub fn factor(&mut self) -> Result<(), LinearError> {
        let n = self.place.len();
        let (Some(symbolic), Some(scratch)) = (&self.symbolic, &mut self.scratch) else {
            return Err(LinearError::Engine { size: n, reason: "factor before analyse".into() });
        };
        let SymbolicCholeskyRaw::Supernodal(raw) = symbolic.raw() else { return Ok(()) };
        let structure = SymbolicSparseColMatRef::new_unsorted_checked(n, n, &self.starts, None, &self.rows);
        factorize_supernodal_numeric_llt(
            &mut self.factors,
            SparseColMatRef::new(structure, &self.values),
            LltRegularization::default(),
            raw,
            Par::Seq,
            MemStack::new(scratch),
            Spec::default(),
        )
        .map_err(|error| {
            let faer::linalg::cholesky::llt::factor::LltError::NonPositivePivot { index } = error;
            LinearError::Singular { size: n, pivot: index, value: 0.0 }
        })?;
        if self.factors.iter().any(|x| !x.is_finite()) {
            return Err(LinearError::Inaccurate { size: n, residual: f64::NAN });
        }
        condense(raw, &self.factors, self.inner, n, &mut self.trailing, &mut self.schur);
        Ok(())
    }

    /// Gives the memory of the matrix back once it is factored for good; it is analysed anew before another is set.
    pub fn seal(&mut self) {
        (self.rows, self.slots, self.values) = (Vec::new(), Vec::new(), Vec::new());
    }

    /// S, column by column.
    pub fn schur(&self) -> &[f64] {
        &self.schur
    }

    /// Right-hand side into the order of elimination, then forward through the inner unknowns: what is left on the last ones is their right-hand side.
    pub fn eliminate_into(&mut self, rhs: &[f64], x: &mut Vec<f64>) {
        x.clear();
        x.resize(rhs.len(), 0.0);
        for (value, &place) in rhs.iter().zip(&self.place) {
            x[place as usize] = *value;
        }
        let Some(raw) = supernodes(self.symbolic.as_ref()) else { return };
        let (factors, inner, gathered) = (&self.factors, self.inner, &mut self.gathered);
        wide(
            #[inline(always)]
            || forward(raw, factors, inner, gathered, x),
        );
    }

    /// Backward through the inner unknowns, the last ones known, and into the order of the pattern.
    pub fn substitute_into(&mut self, x: &mut [f64], out: &mut [f64]) {
        if let Some(raw) = supernodes(self.symbolic.as_ref()) {
            let (factors, inner, gathered) = (&self.factors, self.inner, &mut self.gathered);
            let x = &mut *x;
            wide(
                #[inline(always)]
                || backward(raw, factors, inner, gathered, x),
            );
        }
        for (value, &place) in out.iter_mut().zip(&self.place) {
            *value = x[place as usize];
        }
    }

    /// The last unknowns of a vector in the order of elimination.
    pub fn kept_part<'a>(&self, x: &'a mut [f64]) -> &'a mut [f64] {
        &mut x[self.inner..]
    }
}

fn supernodes(symbolic: Option<&SymbolicCholesky<u32>>) -> Option<&SymbolicSupernodalCholesky<u32>> {
    match symbolic?.raw() {
        SymbolicCholeskyRaw::Supernodal(raw) => Some(raw),
        SymbolicCholeskyRaw::Simplicial(_) => None,
    }
}

/// One supernode: its first column, its columns, the rows below them, its values (column-major, all rows).
struct Supernode<'a> {
    first: usize,
    columns: usize,
    below: &'a [u32],
    values: &'a [f64],
}

#[inline(always)]
fn supernode<'a>(raw: &'a SymbolicSupernodalCholesky<u32>, factors: &'a [f64], s: usize) -> Supernode<'a> {
    let (first, end) = (raw.supernode_begin()[s] as usize, raw.supernode_end()[s] as usize);
    let rows = raw.col_ptr_for_row_idx()[s] as usize;
    let values = raw.col_ptr_for_val()[s] as usize..raw.col_ptr_for_val()[s + 1] as usize;
    let below = &raw.row_idx()[rows..][..raw.nnz_per_super()[s] as usize];
    Supernode { first, columns: end - first, below, values: &factors[values] }
}

#[inline(always)]
fn forward(
    raw: &SymbolicSupernodalCholesky<u32>,
    factors: &[f64],
    inner: usize,
    gathered: &mut Vec<f64>,
    x: &mut [f64],
) {
    for s in 0..raw.n_supernodes() {
        let node = supernode(raw, factors, s);
        if node.first >= inner {
            break;
        }
        let height = node.columns + node.below.len();
        let take = node.columns.min(inner - node.first);
        gathered.clear();
        gathered.resize(node.below.len(), 0.0);
        for c in 0..take {
            let column = &node.values[c * height..(c + 1) * height];
            let value = x[node.first + c] / column[c];
            x[node.first + c] = value;
            add_scaled(&mut x[node.first + c + 1..node.first + node.columns], -value, &column[c + 1..node.columns]);
            add_scaled(gathered, -value, &column[node.columns..]);
        }
        for (&row, value) in node.below.iter().zip(gathered.iter()) {
            x[row as usize] += value;
        }
    }
}

#[inline(always)]
fn backward(
    raw: &SymbolicSupernodalCholesky<u32>,
    factors: &[f64],
    inner: usize,
    gathered: &mut Vec<f64>,
    x: &mut [f64],
) {
    for s in (0..raw.n_supernodes()).rev() {
        let node = supernode(raw, factors, s);
        if node.first >= inner {
            continue;
        }
        let height = node.columns + node.below.len();
        let take = node.columns.min(inner - node.first);
        gathered.clear();
        gathered.extend(node.below.iter().map(|&row| x[row as usize]));
        for c in (0..take).rev() {
            let column = &node.values[c * height..(c + 1) * height];
            let known = dot(&column[node.columns..], gathered)
                + dot(&column[c + 1..node.columns], &x[node.first + c + 1..node.first + node.columns]);
            x[node.first + c] = (x[node.first + c] - known) / column[c];
        }
    }
}

/// S = L_BB L_BBᵀ from the last columns of the factor.
fn condense(
    raw: &SymbolicSupernodalCholesky<u32>,
    factors: &[f64],
    inner: usize,
    n: usize,
    trailing: &mut Vec<f64>,
    schur: &mut Vec<f64>,
) {
    let kept = n - inner;
    for square in [&mut *trailing, &mut *schur] {
        square.clear();
        square.resize(kept * kept, 0.0);
    }
    if kept == 0 {
        return;
    }
    for s in 0..raw.n_supernodes() {
        let node = supernode(raw, factors, s);
        let height = node.columns + node.below.len();
        for c in inner.saturating_sub(node.first)..node.columns {
            let (values, target) = (&node.values[c * height..(c + 1) * height], (node.first + c - inner) * kept);
            for r in c..node.columns {
                trailing[target + node.first + r - inner] = values[r];
            }
            for (&row, value) in node.below.iter().zip(&values[node.columns..]) {
                trailing[target + row as usize - inner] = *value;
            }
        }
    }
    let lower = MatRef::from_column_major_slice(trailing, kept, kept);
    let product = MatMut::from_column_major_slice_mut(schur, kept, kept);
    matmul(product, Accum::Replace, lower, lower.transpose(), 1.0, Par::Seq);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Saddle;

    /// A grid of m × m nodes with two dofs each, springs to neighbours and between the dofs.
    fn grid(m: usize) -> (Pattern, Vec<f64>, Vec<usize>) {
        let mut entries = Vec::new();
        for (a, (row, column)) in (0..m * m).map(|a| (a, (a / m, a % m))) {
            entries.extend([(2 * a, 2 * a, 5.0), (2 * a + 1, 2 * a + 1, 6.0), (2 * a + 1, 2 * a, 0.5)]);
            for b in [(column + 1 < m).then_some(a + 1), (row + 1 < m).then_some(a + m)].into_iter().flatten() {
                entries.extend([(2 * b, 2 * a, -1.0), (2 * b + 1, 2 * a + 1, -1.2)]);
            }
        }
        let pattern = Pattern::from_entries(2 * m * m, entries.iter().map(|&(i, j, _)| (i, j)));
        let mut values = vec![0.0; pattern.len()];
        for (i, j, v) in entries {
            values[pattern.slot(i, j).unwrap()] += v;
        }
        (pattern, values, (0..2 * m * m).map(|i| i / 2).collect())
    }

    #[test]
    fn solves_with_any_choice_of_last_unknowns() {
        for (m, last) in [(1, vec![0]), (3, vec![]), (9, vec![7, 20, 21, 22, 80, 3]), (9, (0..162).collect())] {
            let (pattern, values, groups) = grid(m);
            let n = pattern.size();
            let exact: Vec<f64> = (0..n).map(|i| (i as f64 * 0.7).sin()).collect();
            let mut rhs = vec![0.0; n];
            pattern.multiply_add(&values, &exact, &mut rhs);
            let mut condensed = Condensed::default();
            condensed.analyse(&pattern, &groups, &last).unwrap();
            condensed.fill(|k| values[k]);
            condensed.factor().unwrap();
            assert_eq!(condensed.kept(), last.len());
            let (mut x, mut out) = (Vec::new(), vec![0.0; n]);
            condensed.eliminate_into(&rhs, &mut x);
            let mut saddle = Saddle::default();
            saddle.begin(condensed.schur(), condensed.kept(), 0);
            saddle.factor().unwrap();
            saddle.solve(condensed.kept_part(&mut x), &mut []);
            condensed.substitute_into(&mut x, &mut out);
            let error = out.iter().zip(&exact).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
            assert!(error < 1e-13, "{m} {}: {error:e}", last.len());
        }
    }

    #[test]
    fn an_indefinite_matrix_is_refused() {
        let (pattern, mut values, groups) = grid(4);
        values[pattern.slot(5, 5).unwrap()] = -1.0;
        let mut condensed = Condensed::default();
        condensed.analyse(&pattern, &groups, &[30, 31]).unwrap();
        condensed.fill(|k| values[k]);
        assert!(matches!(condensed.factor(), Err(LinearError::Singular { .. })));
    }
}
