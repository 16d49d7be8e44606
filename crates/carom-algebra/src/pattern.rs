//! Lower triangle of a sparse symmetric matrix, column by column.

/// Positions of the stored entries of a sparse symmetric matrix: the lower triangle with its full
/// diagonal, compressed by columns, rows ascending.
///
/// ```
/// use carom_algebra::Pattern;
/// let pattern = Pattern::from_entries(3, [(2, 0), (0, 2), (1, 1)]);
/// assert_eq!(pattern.len(), 4); // three diagonal entries and (2, 0) once
/// assert_eq!(pattern.slot(0, 2), pattern.slot(2, 0));
/// ```
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Pattern {
    /// Start of each column in [`Self::rows`], and the end of the last.
    pub starts: Vec<usize>,
    /// Row of each entry.
    pub rows: Vec<usize>,
}

impl Pattern {
    /// Builds the pattern of size `n` from entries in any order, of either triangle, possibly
    /// repeated. The diagonal is always stored.
    pub fn from_entries(n: usize, entries: impl IntoIterator<Item = (usize, usize)>) -> Self {
        let ordered = |(i, j): (usize, usize)| [i.min(j) as u32, i.max(j) as u32];
        let entries: Vec<[u32; 2]> = entries.into_iter().map(ordered).collect();
        let mut starts = vec![0; n + 1];
        entries.iter().for_each(|[column, _]| starts[*column as usize + 1] += 1);
        (0..n).for_each(|j| starts[j + 1] += starts[j] + 1);
        let mut rows = vec![0; starts[n]];
        let mut next = starts.clone();
        let diagonal = (0..n as u32).map(|j| [j, j]);
        for [column, row] in entries.into_iter().chain(diagonal) {
            let place = &mut next[column as usize];
            rows[*place] = row as usize;
            *place += 1;
        }
        let mut kept = 0;
        for j in 0..n {
            let begin = std::mem::replace(&mut starts[j], kept);
            let column = &mut rows[begin..next[j]];
            column.sort_unstable();
            let mut last = None;
            for k in begin..next[j] {
                let row = rows[k];
                if last.replace(row) != Some(row) {
                    rows[kept] = row;
                    kept += 1;
                }
            }
        }
        starts[n] = kept;
        rows.truncate(kept);
        rows.shrink_to_fit();
        Self { starts, rows }
    }

    /// Number of rows and columns.
    pub fn size(&self) -> usize {
        self.starts.len().saturating_sub(1)
    }

    /// Number of stored entries.
    pub fn len(&self) -> usize {
        self.rows.len()
    }

    /// Whether there are no entries.
    pub fn is_empty(&self) -> bool {
        self.rows.is_empty()
    }

    /// Whether nothing but the diagonal is stored.
    pub fn is_diagonal(&self) -> bool {
        self.len() == self.size()
    }

    /// Rows stored in a column, ascending; the first is the diagonal.
    pub fn column(&self, j: usize) -> &[usize] {
        &self.rows[self.starts[j]..self.starts[j + 1]]
    }

    /// Index of the entry (i, j) or (j, i) among the stored ones, if it is stored.
    pub fn slot(&self, i: usize, j: usize) -> Option<usize> {
        let row = i.max(j);
        let column = i.min(j);
        self.column(column).binary_search(&row).ok().map(|k| self.starts[column] + k)
    }

    /// Adds the product A x to `out`, for the symmetric matrix A with these values in its lower
    /// triangle.
    pub fn multiply_add(&self, values: &[f64], x: &[f64], out: &mut [f64]) {
        for j in 0..self.size() {
            let start = self.starts[j];
            let end = self.starts[j + 1];
            out[j] += values[start] * x[j];
            let mut sum = 0.0;
            for k in start + 1..end {
                let i = self.rows[k];
                out[i] += values[k] * x[j];
                sum += values[k] * x[i];
            }
            out[j] += sum;
        }
    }
}
