//! The order in which unknowns are eliminated, chosen ones B last, and the structure of the factor that follows from it. B is one vertex of the graph that is
//! ordered (approximate minimum degree; P. Amestoy, T. Davis, I. Duff, SIAM J. Matrix Anal. Appl. 17 (1996) 886–905), then moved to the end.

use faer::Side;
use faer::sparse::SymbolicSparseColMatRef;
use faer::sparse::linalg::SupernodalThreshold;
use faer::sparse::linalg::cholesky::supernodal::SymbolicSupernodalCholesky;
use faer::sparse::linalg::cholesky::{
    CholeskySymbolicParams, SymbolicCholesky, SymbolicCholeskyRaw, SymmetricOrdering, factorize_symbolic_cholesky,
};

use crate::faer_engine::grouped_ordering;
use crate::linear::LinearError;
use crate::pattern::Pattern;

/// What of a factor the pattern and the choice of last unknowns decide: several matrices share it.
#[derive(Debug)]
pub struct Elimination {
    /// Place of each unknown in the elimination.
    pub(crate) place: Vec<u32>,
    /// Number of unknowns that are not last.
    pub(crate) inner: usize,
    /// Columns of the lower triangle in the order of elimination.
    pub(crate) starts: Vec<u32>,
    pub(crate) rows: Vec<u32>,
    /// Where each entry of the pattern went.
    pub(crate) slots: Vec<u32>,
    /// The entries of the pattern's diagonal.
    pub(crate) diagonal: Vec<u32>,
    symbolic: SymbolicCholesky<u32>,
}

impl Elimination {
    /// Orders and analyses a pattern; unknowns of one group stay together, those in `last` come last.
    ///
    /// # Errors
    /// The engine ran out of memory.
    pub fn new(pattern: &Pattern, groups: &[usize], last: &[usize]) -> Result<Self, LinearError> {
        let n = pattern.size();
        let engine = |reason: String| LinearError::Engine { size: n, reason };
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
        let mut place = vec![0; n];
        order.enumerate().for_each(|(k, &i)| place[i] = k as u32);
        let inner = n - last.len();
        let (starts, rows, slots) = permuted(pattern, &place);
        let symbolic = structure(&starts, &rows, inner).map_err(engine)?;
        let diagonal = (0..n).filter_map(|i| pattern.slot(i, i)).map(|k| k as u32).collect();
        Ok(Self { place, inner, starts, rows, slots, diagonal, symbolic })
    }

    /// Number of unknowns eliminated last.
    pub fn kept(&self) -> usize {
        self.place.len() - self.inner
    }

    /// Place of an unknown among those eliminated last.
    pub fn kept_place(&self, unknown: usize) -> Option<usize> {
        (self.place[unknown] as usize).checked_sub(self.inner)
    }

    pub(crate) fn supernodes(&self) -> Result<&SymbolicSupernodalCholesky<u32>, LinearError> {
        match self.symbolic.raw() {
            SymbolicCholeskyRaw::Supernodal(raw) => Ok(raw),
            SymbolicCholeskyRaw::Simplicial(_) => {
                Err(LinearError::Engine { size: self.place.len(), reason: "no supernodes".into() })
            }
        }
    }
}

/// The lower triangle in the order of elimination, columns compressed, rows as they come: starts, rows, and where each entry of the pattern went.
fn permuted(pattern: &Pattern, place: &[u32]) -> (Vec<u32>, Vec<u32>, Vec<u32>) {
    let n = pattern.size();
    let mut fill = vec![0_u32; n + 1];
    let entry = |i: usize, j: usize| (place[i].max(place[j]), place[i].min(place[j]) as usize);
    for j in 0..n {
        pattern.column(j).iter().for_each(|&i| fill[entry(i, j).1 + 1] += 1);
    }
    for j in 0..n {
        fill[j + 1] += fill[j];
    }
    let starts = fill.clone();
    let (mut rows, mut slots) = (vec![0; pattern.len()], vec![0; pattern.len()]);
    for j in 0..n {
        for k in pattern.starts[j]..pattern.starts[j + 1] {
            let (row, column) = entry(pattern.rows[k], j);
            let slot = fill[column];
            fill[column] += 1;
            rows[slot as usize] = row;
            slots[k] = slot;
        }
    }
    (starts, rows, slots)
}

/// Symbolic factor, the last unknowns tied together by the row of their first.
fn structure(starts: &[u32], rows: &[u32], inner: usize) -> Result<SymbolicCholesky<u32>, String> {
    let n = starts.len() - 1;
    // The upper triangle: the columns of the lower one in ascending order fill each of its columns in ascending order.
    let tied = |row: usize| usize::from(row > inner);
    let mut fill = vec![0_u32; n + 1];
    rows.iter().for_each(|&i| fill[i as usize + 1] += 1);
    for i in 0..n {
        fill[i + 1] += fill[i] + tied(i) as u32;
    }
    let mut upper = vec![0_u32; *fill.last().unwrap_or(&0) as usize];
    let first = fill.clone();
    for j in 0..n {
        for &i in &rows[starts[j] as usize..starts[j + 1] as usize] {
            upper[fill[i as usize] as usize] = j as u32;
            fill[i as usize] += 1;
        }
    }
    let (mut columns, mut entries) = (vec![0_u32], Vec::with_capacity(upper.len()));
    for i in 0..n {
        let column = &mut upper[first[i] as usize..first[i + 1] as usize];
        if tied(i) == 1 {
            column[column.len() - 1] = inner as u32;
            column.sort_unstable();
        }
        let begin = entries.len();
        for &j in &*column {
            if entries.len() == begin || entries[entries.len() - 1] != j {
                entries.push(j);
            }
        }
        columns.push(entries.len() as u32);
    }
    let params = CholeskySymbolicParams {
        supernodal_flop_ratio_threshold: SupernodalThreshold::FORCE_SUPERNODAL,
        ..Default::default()
    };
    let upper = SymbolicSparseColMatRef::new_checked(n, n, &columns, None, &entries);
    factorize_symbolic_cholesky(upper, Side::Upper, SymmetricOrdering::Identity, params).map_err(|e| format!("{e:?}"))
}
