//! The matrix of a contact problem: most contacts move only what a few others move.

use crate::LinearError;

/// Weight ε of the proximal step, relative to the diagonal of the matrix.
pub(super) const PROXIMAL: f64 = 1e-10;

/// A square matrix by rows, without the entries of contacts that are not coupled. Its pattern is
/// symmetric.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Couplings {
    /// Start of each row, and end of the last.
    starts: Vec<usize>,
    columns: Vec<usize>,
    values: Vec<f64>,
}

impl Couplings {
    /// A matrix with all entries, row by row.
    pub fn dense(size: usize, entries: Vec<f64>) -> Self {
        Self {
            starts: (0..=size).map(|row| row * size).collect(),
            columns: (0..size).flat_map(|_| 0..size).collect(),
            values: entries,
        }
    }

    /// Becomes a matrix of zeros with this pattern: `columns(row, columns)` adds the columns of a
    /// row in ascending order.
    ///
    /// # Errors
    /// If there is not enough memory for it.
    pub fn reset(
        &mut self,
        size: usize,
        mut columns: impl FnMut(usize, &mut Vec<usize>),
    ) -> Result<(), LinearError> {
        let memory = |_| LinearError::Memory { size };
        let mut row = Vec::new();
        self.columns.clear();
        self.starts.clear();
        self.starts.push(0);
        for i in 0..size {
            row.clear();
            columns(i, &mut row);
            self.columns.try_reserve(row.len()).map_err(memory)?;
            self.columns.extend_from_slice(&row);
            self.starts.push(self.columns.len());
        }
        self.values.clear();
        self.values.try_reserve_exact(self.columns.len()).map_err(memory)?;
        self.values.resize(self.columns.len(), 0.0);
        Ok(())
    }

    /// Number of rows.
    pub fn size(&self) -> usize {
        self.starts.len().saturating_sub(1)
    }

    /// Columns of the entries of a row, ascending.
    pub fn columns(&self, row: usize) -> &[usize] {
        &self.columns[self.starts[row]..self.starts[row + 1]]
    }

    /// Columns and entries of a row, by ascending columns.
    pub fn row(&self, row: usize) -> impl Iterator<Item = (usize, f64)> + '_ {
        let range = self.starts[row]..self.starts[row + 1];
        self.columns(row).iter().copied().zip(self.values[range].iter().copied())
    }

    /// Product of a row with a vector.
    pub fn along(&self, row: usize, x: &[f64]) -> f64 {
        self.row(row).map(|(column, value)| value * x[column]).sum()
    }

    /// An entry; zero if it is not in the pattern.
    pub fn at(&self, row: usize, column: usize) -> f64 {
        self.place(row, column).map_or(0.0, |place| self.values[place])
    }

    /// Overwrites an entry of the pattern.
    pub fn set(&mut self, row: usize, column: usize, value: f64) {
        if let Some(place) = self.place(row, column) {
            self.values[place] = value;
        }
    }

    fn place(&self, row: usize, column: usize) -> Option<usize> {
        let place = self.columns(row).binary_search(&column).ok()?;
        Some(self.starts[row] + place)
    }
}
