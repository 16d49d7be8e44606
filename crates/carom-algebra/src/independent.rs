//! Sparse rows that are linearly independent, found one by one by Gaussian elimination.

use std::collections::BTreeMap;

/// Columns and entries of a row, an entry each, in any order.
pub type SparseRow = Vec<(usize, f64)>;

/// Rows that are linearly independent of each other.
///
/// ```
/// use carom_algebra::Independent;
/// let mut set = Independent::default();
/// assert!(set.accept(vec![(0, 1.0), (1, 1.0)], 1e-8));
/// assert!(set.accept(vec![(1, 2.0)], 1e-8));
/// assert!(!set.accept(vec![(0, 3.0), (1, -1.0)], 1e-8));
/// ```
#[derive(Clone, Debug, Default)]
pub struct Independent {
    /// The rows, each without the parts along earlier ones and divided by its largest entry.
    accepted: Vec<SparseRow>,
    /// The accepted row whose largest entry is in this column.
    pivots: BTreeMap<usize, usize>,
}

/// Which combinations of two rows are independent of earlier ones.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Plane {
    /// Both rows depend on earlier ones.
    Nothing,
    /// Only multiples of i times the first row plus j times the second row are independent. The
    /// entries are the factors i and j, with i² + j² = 1.
    Line([f64; 2]),
    /// Both rows are independent.
    All,
}

impl Independent {
    /// Adds a row unless it depends on those added before, which is where no entry of what they
    /// leave of it is larger than `least`. Returns whether it was added.
    pub fn accept(&mut self, row: SparseRow, least: f64) -> bool {
        let rest = self.rest(row, 0);
        self.add(rest, least)
    }

    /// Adds those combinations of two rows that do not depend on the rows added before.
    pub fn accept_plane(&mut self, rows: [SparseRow; 2], least: f64) -> Plane {
        let before = self.accepted.len();
        let rests = rows.map(|row| self.rest(row, 0));
        // The longer one takes what is small in the other one with it.
        let [longer, other] = if square(&rests[0]) >= square(&rests[1]) { [0, 1] } else { [1, 0] };
        if !self.add(rests[longer].clone(), least) {
            return Plane::Nothing;
        }
        let rest = self.rest(rests[other].clone(), before);
        if self.add(rest, least) {
            return Plane::All;
        }
        // The two are parallel.
        let share = ratio(&rests[other], &rests[longer]);
        let mut line = [share; 2];
        line[longer] = 1.0;
        Plane::Line(line.map(|part| part / share.hypot(1.0)))
    }

    /// A row without its parts along the rows added before, from the one with the index `from` on.
    fn rest(&self, mut row: SparseRow, mut from: usize) -> SparseRow {
        // An added row contains pivots of later ones only: in ascending order each occurs once.
        while let Some((r, factor)) = row
            .iter()
            .filter_map(|(column, value)| Some((*self.pivots.get(column)?, *value)))
            .filter(|(r, value)| *r >= from && *value != 0.0)
            .min_by_key(|(r, _)| *r)
        {
            for &(column, value) in &self.accepted[r] {
                match row.iter_mut().find(|(other, _)| *other == column) {
                    Some((_, x)) => *x -= factor * value,
                    None => row.push((column, -factor * value)),
                }
            }
            from = r + 1;
        }
        row
    }

    fn add(&mut self, mut rest: SparseRow, least: f64) -> bool {
        let larger = |most: (usize, f64), &(column, x): &(usize, f64)| {
            if x.abs() > most.1.abs() { (column, x) } else { most }
        };
        let (pivot, largest) = rest.iter().fold((0, 0.0), larger);
        if largest.abs() <= least {
            return false;
        }
        rest.iter_mut().for_each(|(_, x)| *x /= largest);
        self.pivots.insert(pivot, self.accepted.len());
        self.accepted.push(rest);
        true
    }
}

/// Factor c for which c times the row `of` is nearest to another one.
fn ratio(row: &SparseRow, of: &SparseRow) -> f64 {
    let at = |column: usize| row.iter().find(|entry| entry.0 == column).map_or(0.0, |entry| entry.1);
    let common: f64 = of.iter().map(|&(column, value)| value * at(column)).sum();
    common / square(of)
}

/// Sum of the squares of the entries.
fn square(row: &SparseRow) -> f64 {
    row.iter().map(|(_, value)| value * value).sum()
}
