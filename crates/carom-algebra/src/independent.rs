//! Sparse rows that are linearly independent, found one by one by Gaussian elimination.

use std::collections::BTreeMap;

/// Columns and entries of a row, an entry each, in any order.
pub type SparseRow = Vec<(usize, f64)>;

/// Rows that are linearly independent of each other. Columns are numbered in the order in which
/// they occur, so that a table over them is short.
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
    /// The numbers of the columns.
    numbers: BTreeMap<usize, usize>,
    accepted: Vec<Accepted>,
    /// Where each column is in the row at hand.
    places: Vec<Option<usize>>,
}

/// A row without its parts along earlier ones, divided by its largest entry.
#[derive(Clone, Debug)]
struct Accepted {
    entries: SparseRow,
    /// Column of its largest entry.
    pivot: usize,
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
        let row = self.numbered(row);
        let rest = self.rest(row, 0);
        self.add(rest, least)
    }

    /// Adds those combinations of two rows that do not depend on the rows added before.
    pub fn accept_plane(&mut self, rows: [SparseRow; 2], least: f64) -> Plane {
        let before = self.accepted.len();
        let rests = rows.map(|row| {
            let row = self.numbered(row);
            self.rest(row, 0)
        });
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

    /// A row with the numbers of its columns.
    fn numbered(&mut self, mut row: SparseRow) -> SparseRow {
        for (column, _) in &mut row {
            let next = self.numbers.len();
            *column = *self.numbers.entry(*column).or_insert(next);
        }
        self.places.resize(self.numbers.len(), None);
        row
    }

    /// A row without its parts along the rows added before, from the one with the index `from` on.
    fn rest(&mut self, mut row: SparseRow, from: usize) -> SparseRow {
        let places = &mut self.places;
        row.iter().enumerate().for_each(|(place, &(column, _))| places[column] = Some(place));
        // An added row contains pivots of later ones only: in ascending order each occurs once.
        for accepted in &self.accepted[from..] {
            let Some(pivot) = places[accepted.pivot] else { continue };
            let factor = row[pivot].1;
            if factor == 0.0 {
                continue;
            }
            for &(column, value) in &accepted.entries {
                if let Some(place) = places[column] {
                    row[place].1 -= factor * value;
                } else {
                    places[column] = Some(row.len());
                    row.push((column, -factor * value));
                }
            }
        }
        row.iter().for_each(|&(column, _)| places[column] = None);
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
        self.accepted.push(Accepted { entries: rest, pivot });
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
