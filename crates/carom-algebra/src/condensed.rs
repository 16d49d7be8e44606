//! Cholesky of a sparse positive definite matrix with chosen unknowns B eliminated last (static condensation),
//!
//! ```text
//! A = L Lᵀ,    S = A_BB − A_BI A_II⁻¹ A_IB = L_BB L_BBᵀ
//! ```
//!
//! so that any change of A on B alone, and any constraint on B alone, is a matter of the small dense S: forward through the inner unknowns, a dense
//! solve on B, backward. The factor is kept while B's neighbourhood changes as it likes.
//!
//! In single precision it is σ²A that is factored, L' = σL with σ a power of two.

use std::sync::Arc;

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::cholesky::llt::factor::{LltParams, LltRegularization};
use faer::linalg::matmul::triangular::{BlockStructure, matmul};
use faer::sparse::linalg::cholesky::supernodal::{
    SymbolicSupernodalCholesky, factorize_supernodal_numeric_llt, factorize_supernodal_numeric_llt_scratch,
};
use faer::sparse::{SparseColMatRef, SymbolicSparseColMatRef};
use faer::traits::RealField;
use faer::{Accum, MatMut, MatRef, Par, Spec};

use crate::elimination::Elimination;
use crate::linear::LinearError;
use crate::simd::{add_scaled, dot, wide};

/// Entries of a factor: all of their digits, or half of them in half of the memory and the time. What takes the factor for an approximation loses nothing.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Precision {
    /// 53 bits.
    Double,
    /// 24 bits.
    Single,
}

/// A number of the factor.
trait Entry: RealField + Copy + Into<f64> {
    /// Power of two that the largest entry of the matrix is brought to; none where the range is wide enough.
    const TOP: Option<i32>;

    fn rounded(value: f64) -> Self;
}

impl Entry for f64 {
    const TOP: Option<i32> = None;

    fn rounded(value: f64) -> Self {
        value
    }
}

/// Where mass prevails, entries of the factor fall off with the distance of their unknowns, below what 8 bits of exponent hold; and numbers with fewer bits
/// than 24 are slow. With the matrix near the upper end of the range they may fall by 55 decades instead of 38.
impl Entry for f32 {
    const TOP: Option<i32> = Some(110);

    fn rounded(value: f64) -> Self {
        value as f32
    }
}

/// A matrix in the order of elimination, and its factor.
struct Entries<T> {
    values: Vec<T>,
    factors: Vec<T>,
    /// The matrix was multiplied by the square of this, so that the factor is by itself.
    scale: f64,
    scratch: MemBuffer,
}

enum Numbers {
    Double(Entries<f64>),
    Single(Entries<f32>),
}

impl<T: Entry> Entries<T> {
    fn new(elimination: &Elimination) -> Result<Self, LinearError> {
        let raw = elimination.supernodes()?;
        let space = factorize_supernodal_numeric_llt_scratch::<u32, T>(raw, Par::Seq, Spec::<LltParams, T>::default());
        let engine = |reason: String| LinearError::Engine { size: elimination.place.len(), reason };
        let scratch = MemBuffer::try_new(space).map_err(|e| engine(format!("{e:?}")))?;
        Ok(Self { values: Vec::new(), factors: vec![T::rounded(0.0); raw.len_val()], scale: 1.0, scratch })
    }

    fn factor(&mut self, elimination: &Elimination, value: impl Fn(usize) -> f64) -> Result<(), LinearError> {
        let Elimination { starts, rows, slots, diagonal, place, .. } = elimination;
        let n = place.len();
        if let Some(top) = T::TOP {
            // The largest entry of a positive definite matrix is on its diagonal.
            let largest = diagonal.iter().map(|&k| value(k as usize).abs()).fold(f64::MIN_POSITIVE, f64::max);
            self.scale = 2f64.powi((top - largest.log2().ceil() as i32).div_euclid(2));
        }
        let square = self.scale * self.scale;
        self.values.resize(slots.len(), T::rounded(0.0));
        for (k, &slot) in slots.iter().enumerate() {
            self.values[slot as usize] = T::rounded(square * value(k));
        }
        let structure = SymbolicSparseColMatRef::new_unsorted_checked(n, n, starts, None, rows);
        factorize_supernodal_numeric_llt(
            &mut self.factors,
            SparseColMatRef::new(structure, &self.values),
            LltRegularization::default(),
            elimination.supernodes()?,
            Par::Seq,
            MemStack::new(&mut self.scratch),
            Spec::default(),
        )
        .map_err(|error| {
            let faer::linalg::cholesky::llt::factor::LltError::NonPositivePivot { index } = error;
            LinearError::Singular { size: n, pivot: index, value: 0.0 }
        })?;
        Ok(())
    }
}

/// A factor whose last unknowns are left for a dense solve.
pub struct Condensed {
    elimination: Arc<Elimination>,
    numbers: Numbers,
    schur: Vec<f64>,
    trailing: Vec<f64>,
    gathered: Vec<f64>,
}

impl Condensed {
    /// Room for the factor of a matrix with this structure.
    ///
    /// # Errors
    /// The engine ran out of memory.
    pub fn new(elimination: &Arc<Elimination>, precision: Precision) -> Result<Self, LinearError> {
        let numbers = match precision {
            Precision::Double => Numbers::Double(Entries::new(elimination)?),
            Precision::Single => Numbers::Single(Entries::new(elimination)?),
        };
        let elimination = elimination.clone();
        Ok(Self { elimination, numbers, schur: Vec::new(), trailing: Vec::new(), gathered: Vec::new() })
    }

    /// The structure.
    pub fn elimination(&self) -> &Arc<Elimination> {
        &self.elimination
    }

    /// What its entries are.
    pub fn precision(&self) -> Precision {
        match self.numbers {
            Numbers::Double(_) => Precision::Double,
            Numbers::Single(_) => Precision::Single,
        }
    }

    /// Factors a matrix: `value(k)` for entry k of the pattern.
    ///
    /// # Errors
    /// It is not positive definite.
    pub fn factor(&mut self, value: impl Fn(usize) -> f64) -> Result<(), LinearError> {
        let elimination = &*self.elimination;
        let (raw, inner) = (elimination.supernodes()?, elimination.inner);
        let (n, trailing, schur) = (elimination.place.len(), &mut self.trailing, &mut self.schur);
        match &mut self.numbers {
            Numbers::Double(entries) => {
                entries.factor(elimination, value)?;
                condense(raw, &entries.factors, (inner, n), entries.scale.recip(), trailing, schur);
            }
            Numbers::Single(entries) => {
                entries.factor(elimination, value)?;
                condense(raw, &entries.factors, (inner, n), entries.scale.recip(), trailing, schur);
            }
        }
        Ok(())
    }

    /// Gives the memory of the matrix back once it is factored for good.
    pub fn seal(&mut self) {
        match &mut self.numbers {
            Numbers::Double(entries) => entries.values = Vec::new(),
            Numbers::Single(entries) => entries.values = Vec::new(),
        }
    }

    /// S, column by column; only the lower triangle is filled.
    pub fn schur(&self) -> &[f64] {
        &self.schur
    }

    /// Right-hand side into the order of elimination, then forward through the inner unknowns: what is left on the last ones is their right-hand side.
    pub fn eliminate_into(&mut self, rhs: &[f64], x: &mut Vec<f64>) {
        x.clear();
        x.resize(rhs.len(), 0.0);
        let Elimination { inner, place, .. } = &*self.elimination;
        for (value, &place) in rhs.iter().zip(place) {
            x[place as usize] = *value;
        }
        let Ok(raw) = self.elimination.supernodes() else { return };
        if rhs.iter().all(|value| *value == 0.0) {
            return;
        }
        let (numbers, gathered) = (&self.numbers, &mut self.gathered);
        wide(
            #[inline(always)]
            || match numbers {
                Numbers::Double(entries) => forward(raw, &entries.factors, *inner, gathered, x),
                Numbers::Single(entries) => forward(raw, &entries.factors, *inner, gathered, x),
            },
        );
    }

    /// Backward through the inner unknowns, the last ones known, and into the order of the pattern.
    pub fn substitute_into(&mut self, x: &mut [f64], out: &mut [f64]) {
        let Elimination { inner, place, .. } = &*self.elimination;
        if let Ok(raw) = self.elimination.supernodes() {
            let (numbers, gathered) = (&self.numbers, &mut self.gathered);
            let x = &mut *x;
            if let Numbers::Single(Entries { scale, .. }) = numbers {
                // Forward left z/σ; backward solves L'ᵀx = σ²(z/σ) − L'_BIᵀ x_B.
                x[..*inner].iter_mut().for_each(|x| *x *= scale * scale);
            }
            wide(
                #[inline(always)]
                || match numbers {
                    Numbers::Double(entries) => backward(raw, &entries.factors, *inner, gathered, x),
                    Numbers::Single(entries) => backward(raw, &entries.factors, *inner, gathered, x),
                },
            );
        }
        for (value, &place) in out.iter_mut().zip(place) {
            *value = x[place as usize];
        }
    }

    /// The last unknowns of a vector in the order of elimination.
    pub fn kept_part<'a>(&self, x: &'a mut [f64]) -> &'a mut [f64] {
        &mut x[self.elimination.inner..]
    }
}

/// One supernode: its first column, its columns, the rows below them, its values (column-major, all rows).
struct Supernode<'a, T> {
    first: usize,
    columns: usize,
    below: &'a [u32],
    values: &'a [T],
}

#[inline(always)]
fn supernode<'a, T>(raw: &'a SymbolicSupernodalCholesky<u32>, factors: &'a [T], s: usize) -> Supernode<'a, T> {
    let (first, end) = (raw.supernode_begin()[s] as usize, raw.supernode_end()[s] as usize);
    let rows = raw.col_ptr_for_row_idx()[s] as usize;
    let values = raw.col_ptr_for_val()[s] as usize..raw.col_ptr_for_val()[s + 1] as usize;
    let below = &raw.row_idx()[rows..][..raw.nnz_per_super()[s] as usize];
    Supernode { first, columns: end - first, below, values: &factors[values] }
}

#[inline(always)]
fn forward<T: Entry>(
    raw: &SymbolicSupernodalCholesky<u32>,
    factors: &[T],
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
            let value = x[node.first + c] / column[c].into();
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
fn backward<T: Entry>(
    raw: &SymbolicSupernodalCholesky<u32>,
    factors: &[T],
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
            x[node.first + c] = (x[node.first + c] - known) / column[c].into();
        }
    }
}

/// The lower triangle of S = L_BB L_BBᵀ from the last columns of the factor, to be multiplied by `scale`.
fn condense<T: Entry>(
    raw: &SymbolicSupernodalCholesky<u32>,
    factors: &[T],
    (inner, n): (usize, usize),
    scale: f64,
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
                trailing[target + node.first + r - inner] = scale * values[r].into();
            }
            for (&row, value) in node.below.iter().zip(&values[node.columns..]) {
                trailing[target + row as usize - inner] = scale * (*value).into();
            }
        }
    }
    let lower = MatRef::from_column_major_slice(trailing, kept, kept);
    let product = MatMut::from_column_major_slice_mut(schur, kept, kept);
    let (below, above) = (BlockStructure::TriangularLower, BlockStructure::TriangularUpper);
    matmul(product, below, Accum::Replace, lower, below, lower.transpose(), above, 1.0, Par::Seq);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Pattern, Saddle};

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
            let elimination = Arc::new(Elimination::new(&pattern, &groups, &last).unwrap());
            assert_eq!(elimination.kept(), last.len());
            for (precision, digits) in [(Precision::Double, 1e-13), (Precision::Single, 1e-5)] {
                let mut condensed = Condensed::new(&elimination, precision).unwrap();
                condensed.factor(|k| values[k]).unwrap();
                let (mut x, mut out) = (Vec::new(), vec![0.0; n]);
                condensed.eliminate_into(&rhs, &mut x);
                let mut saddle = Saddle::default();
                saddle.begin(condensed.schur(), elimination.kept(), 0);
                saddle.factor().unwrap();
                saddle.solve(condensed.kept_part(&mut x), &mut []);
                condensed.substitute_into(&mut x, &mut out);
                let error = out.iter().zip(&exact).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
                assert!(error < digits, "{m} {}: {error:e}", last.len());
            }
        }
    }

    /// Of any size, and where mass prevails so much that entries far from the diagonal are none: there one to another falls off a thousandfold.
    #[test]
    fn single_precision_has_the_range_it_needs() {
        for (factor, coupling) in [(1e-42, 1.0), (1e42, 1.0), (1.0, 1e-3)] {
            let (pattern, mut values, groups) = grid(30);
            for j in 0..pattern.size() {
                let column = pattern.starts[j]..pattern.starts[j + 1];
                column.for_each(|k| values[k] *= if pattern.rows[k] == j { factor } else { factor * coupling });
            }
            let exact: Vec<f64> = (0..pattern.size()).map(|i| (i as f64 * 0.7).sin()).collect();
            let (mut rhs, mut out) = (vec![0.0; exact.len()], vec![0.0; exact.len()]);
            pattern.multiply_add(&values, &exact, &mut rhs);
            let elimination = Arc::new(Elimination::new(&pattern, &groups, &[]).unwrap());
            let mut condensed = Condensed::new(&elimination, Precision::Single).unwrap();
            condensed.factor(|k| values[k]).unwrap();
            let mut x = Vec::new();
            condensed.eliminate_into(&rhs, &mut x);
            condensed.substitute_into(&mut x, &mut out);
            let error = out.iter().zip(&exact).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
            assert!(error < 1e-5, "{factor:e} {coupling:e}: {error:e}");
        }
    }

    #[test]
    fn an_indefinite_matrix_is_refused() {
        let (pattern, mut values, groups) = grid(4);
        values[pattern.slot(5, 5).unwrap()] = -1.0;
        let elimination = Arc::new(Elimination::new(&pattern, &groups, &[30, 31]).unwrap());
        let mut condensed = Condensed::new(&elimination, Precision::Double).unwrap();
        assert!(matches!(condensed.factor(|k| values[k]), Err(LinearError::Singular { .. })));
    }
}
