//! Symbolic analysis of a pattern by faer: an elimination order by approximate minimum degree (P.
//! Amestoy, T. Davis, I. Duff, SIAM J. Matrix Anal. Appl. 17 (1996) 886–905), the elimination tree,
//! and the supernodes of the factor.

use faer::dyn_stack::{MemBuffer, MemStack, StackReq};
use faer::sparse::linalg::cholesky::simplicial::{
    prefactorize_symbolic_cholesky, prefactorize_symbolic_cholesky_scratch,
};
use faer::sparse::linalg::cholesky::supernodal::{
    SymbolicSupernodalCholesky, factorize_supernodal_symbolic_cholesky,
    factorize_supernodal_symbolic_cholesky_scratch,
};
use faer::sparse::linalg::{SymbolicSupernodalParams, amd};
use faer::sparse::{FaerError, SymbolicSparseColMatRef};

use crate::pattern::Pattern;

/// The elimination tree of a permuted pattern.
pub(crate) struct EliminationTree {
    /// Parent of each column; negative for a root.
    pub(crate) parents: Vec<i32>,
    /// Number of entries in each column of the factor.
    pub(crate) counts: Vec<u32>,
}

/// The upper triangle of a permuted pattern. The columns of unknowns eliminated last store only
/// rows before them, on which the earlier columns depend.
pub(crate) struct Upper {
    starts: Vec<u32>,
    rows: Vec<u32>,
}

impl Upper {
    pub(crate) fn new(pattern: &Pattern, place: &[u32], inner: usize) -> Self {
        let n = pattern.size();
        let entry = |i: usize, j: usize| (place[i].min(place[j]), place[i].max(place[j]) as usize);
        let matters = |&(row, column): &(u32, usize)| row as usize == column || (row as usize) < inner;
        let mut fill = vec![0_u32; n + 1];
        for j in 0..n {
            let column = pattern.column(j).iter().map(|&i| entry(i, j));
            column.filter(matters).for_each(|(_, column)| fill[column + 1] += 1);
        }
        (0..n).for_each(|j| fill[j + 1] += fill[j]);
        let starts = fill.clone();
        let mut rows = vec![0_u32; starts[n] as usize];
        for j in 0..n {
            let column = pattern.column(j).iter().map(|&i| entry(i, j));
            for (row, column) in column.filter(matters) {
                rows[fill[column] as usize] = row;
                fill[column] += 1;
            }
        }
        Self { starts, rows }
    }

    fn view(&self) -> SymbolicSparseColMatRef<'_, u32> {
        let n = self.starts.len() - 1;
        SymbolicSparseColMatRef::new_unsorted_checked(n, n, &self.starts, None, &self.rows)
    }

    pub(crate) fn tree(&self) -> Result<EliminationTree, FaerError> {
        let n = self.starts.len() - 1;
        let mut parents = vec![0; n];
        let mut counts = vec![0; n];
        let mut scratch = memory(prefactorize_symbolic_cholesky_scratch::<u32>(n, self.rows.len()))?;
        prefactorize_symbolic_cholesky(&mut parents, &mut counts, self.view(), MemStack::new(&mut scratch));
        Ok(EliminationTree { parents, counts })
    }

    pub(crate) fn supernodes(&self) -> Result<SymbolicSupernodalCholesky<u32>, FaerError> {
        let n = self.starts.len() - 1;
        let mut parents = vec![0; n];
        let mut counts = vec![0; n];
        let mut scratch = memory(
            prefactorize_symbolic_cholesky_scratch::<u32>(n, self.rows.len())
                .or(factorize_supernodal_symbolic_cholesky_scratch::<u32>(n)),
        )?;
        let stack = MemStack::new(&mut scratch);
        let tree = prefactorize_symbolic_cholesky(&mut parents, &mut counts, self.view(), stack);
        factorize_supernodal_symbolic_cholesky(
            self.view(),
            tree,
            &counts,
            stack,
            SymbolicSupernodalParams::default(),
        )
    }
}

/// Elimination order by approximate minimum degree on the graph of groups, each group expanded in
/// ascending order.
pub(crate) fn grouped_ordering(pattern: &Pattern, groups: &[usize]) -> Result<Vec<usize>, FaerError> {
    let count = groups.iter().max().map_or(0, |g| g + 1);
    let entries =
        (0..pattern.size()).flat_map(|j| pattern.column(j).iter().map(move |&i| (groups[i], groups[j])));
    let quotient = Pattern::from_entries(count, entries);
    let graph = SymbolicSparseColMatRef::new_checked(count, count, &quotient.starts, None, &quotient.rows);
    let mut order = vec![0_usize; count];
    let mut inverse = vec![0_usize; count];
    let mut scratch = memory(amd::order_maybe_unsorted_scratch::<usize>(count, quotient.len()))?;
    amd::order_maybe_unsorted(
        &mut order,
        &mut inverse,
        graph,
        amd::Control::default(),
        MemStack::new(&mut scratch),
    )?;
    let mut members: Vec<Vec<usize>> = vec![Vec::new(); count];
    for (i, &g) in groups.iter().enumerate() {
        members[g].push(i);
    }
    Ok(order.iter().flat_map(|&g| members[g].iter().copied()).collect())
}

/// Memory for a factorisation.
pub fn memory(space: StackReq) -> Result<MemBuffer, FaerError> {
    MemBuffer::try_new(space).map_err(|_| FaerError::OutOfMemory)
}
