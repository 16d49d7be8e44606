//! Multifrontal factorisation (I. Duff, J. Reid, ACM Trans. Math. Softw. 9 (1983) 302–325). The
//! front of a node is assembled from the matrix and the update matrices of its children. Its own
//! update matrix, the Schur complement on the rows below, goes to its parent. Independent parts are
//! factored in parallel, large nodes in blocks of columns; the order of summation is fixed.

use std::sync::{Arc, Mutex, PoisonError};

use faer::linalg::matmul::matmul;
use faer::linalg::matmul::triangular::{self, BlockStructure};
use faer::linalg::triangular_solve::solve_lower_triangular_in_place;
use faer::prelude::{Reborrow, ReborrowMut};
use faer::{Accum, Mat, MatMut, MatRef, Par};

use crate::elimination::{Elimination, Subtree};
use crate::pivots::{Room, diagonal_size};
use crate::precision::Entry;
use crate::threads::Threads;

/// Number of columns of a block.
const BLOCK: usize = 128;
/// Number of multiplications above which work is shared among threads.
const SHARED: usize = 1_000_000;

/// A buffer aligned to a cache line, so that results never depend on how kernels group entries by
/// address.
#[derive(Default)]
pub(crate) struct Aligned<T> {
    numbers: Vec<T>,
    begin: usize,
}

impl<T: Entry> Aligned<T> {
    pub(crate) fn new(len: usize) -> Self {
        let numbers = vec![T::rounded(0.0); len + 64 / size_of::<T>()];
        let begin = numbers.as_ptr().align_offset(64).min(64 / size_of::<T>());
        Self { numbers, begin }
    }

    pub(crate) fn get(&self) -> &[T] {
        &self.numbers[self.begin..]
    }

    pub(crate) fn get_mut(&mut self) -> &mut [T] {
        &mut self.numbers[self.begin..]
    }
}

/// The update matrix that a supernode passes to its parent or to the last unknowns: column-major,
/// lower triangle.
struct Update<T> {
    node: usize,
    squares: Arc<Aligned<T>>,
    begin: usize,
}

/// The entries of a matrix as a function of their index. A trait object, since the factorisation
/// would otherwise be compiled for every matrix, in every crate that factors one.
pub(crate) type Value<'a> = &'a (dyn Fn(usize) -> f64 + Sync);

/// A matrix to be factored: `scale` times `value(k)` for entry k of the pattern.
pub(crate) struct Matrix<'a> {
    pub(crate) elimination: &'a Elimination,
    pub(crate) value: Value<'a>,
    pub(crate) scale: f64,
    pub(crate) threads: &'a Threads,
    /// Whether pivots may be negative.
    pub(crate) signed: bool,
    /// Places of the negative pivots.
    pub(crate) negative: Mutex<Vec<usize>>,
}

/// Workspace of the factorisation of a part.
struct Work<T> {
    squares: Aligned<T>,
    room: Room,
    runs: Vec<[usize; 3]>,
}

impl Matrix<'_> {
    /// Factors the columns of all inner unknowns; `schur` becomes the lower triangle of the Schur
    /// complement on the last unknowns.
    ///
    /// # Errors
    /// The place of a pivot that is not positive or, with signs, not finite.
    pub(crate) fn factor<T: Entry>(&self, values: &mut [T], schur: &mut Vec<f64>) -> Result<(), usize> {
        let all = self.elimination;
        let updates = self.part(&all.root, values)?;
        let size = all.schur_size();
        schur.clear();
        schur.resize(size * size, 0.0);
        let first = all.nodes.last().map_or(0, |end| end.entries as usize);
        for (&entry, &slot) in all.entries[first..].iter().zip(&all.slots[first..]) {
            schur[slot as usize] = self.scale * (self.value)(entry as usize);
        }
        for update in updates {
            let rows = &all.below[all.rows(update.node)];
            let square = &update.squares.get()[update.begin..][..rows.len().pow(2)];
            for (j, (column, &target)) in square.chunks_exact(rows.len()).zip(rows).enumerate() {
                let target = (target as usize - all.inner) * size;
                for (&row, value) in rows[j..].iter().zip(&column[j..]) {
                    schur[target + row as usize - all.inner] += (*value).into();
                }
            }
        }
        Ok(())
    }

    fn part<T: Entry>(&self, part: &Subtree, values: &mut [T]) -> Result<Vec<Update<T>>, usize> {
        let mut below = Vec::new();
        let mut values = values;
        if let Some(parts) = &part.parts {
            let [a, b] = &**parts;
            let begin = self.elimination.nodes[part.nodes.start].values - part.values;
            let (deeper, own) = values.split_at_mut(begin);
            let (for_a, for_b) = deeper.split_at_mut(b.values - a.values);
            let (of_a, of_b) = self.threads.join(|| self.part(a, for_a), || self.part(b, for_b));
            below = of_a?;
            below.extend(of_b?);
            values = own;
        }
        self.own(part, values, below)
    }

    /// Overwrites the columns of supernode s with the entries of the matrix.
    fn fill<T: Entry>(&self, s: usize, panel: &mut [T]) {
        let all = self.elimination;
        panel.fill(T::rounded(0.0));
        let entries = all.nodes[s].entries as usize..all.nodes[s + 1].entries as usize;
        for (&entry, &slot) in all.entries[entries.clone()].iter().zip(&all.slots[entries]) {
            panel[slot as usize] = T::rounded(self.scale * (self.value)(entry as usize));
        }
    }

    /// Factors the supernodes of a part without those of its child parts, whose updates are
    /// `below`.
    fn own<T: Entry>(
        &self,
        part: &Subtree,
        values: &mut [T],
        mut below: Vec<Update<T>>,
    ) -> Result<Vec<Update<T>>, usize> {
        let all = self.elimination;
        let parent = |node: usize| all.nodes[node].parent;
        // In reverse, so that the next one is popped.
        below.sort_by_key(|update| std::cmp::Reverse((parent(update.node), update.node)));
        let mut work =
            Work { squares: Aligned::<T>::new(part.room), room: Room::default(), runs: Vec::new() };
        let mut waiting: Vec<(usize, usize)> = Vec::new();
        let mut top = 0;
        let mut remaining = values;
        for s in part.nodes.clone() {
            let columns = all.columns(s);
            let count = all.rows(s).len();
            let (panel, after) = remaining.split_at_mut(all.nodes[s + 1].values - all.nodes[s].values);
            remaining = after;
            self.fill(s, panel);
            let height = columns.len() + count;
            let size = diagonal_size(panel.iter().step_by(height + 1).take(columns.len()).copied());
            let (stacked, free) = work.squares.get_mut().split_at_mut(top);
            let square = &mut free[..count * count];
            square.fill(T::rounded(0.0));
            while let Some(update) = below.pop_if(|update| parent(update.node) as usize == s) {
                all.extend_add(
                    (update.node, &update.squares.get()[update.begin..]),
                    (s, panel, square),
                    &mut work.runs,
                );
            }
            let mut begin = top;
            while let Some((node, start)) = waiting.pop_if(|(node, _)| parent(*node) as usize == s) {
                all.extend_add((node, &stacked[start..]), (s, panel, square), &mut work.runs);
                begin = start;
            }
            let panel = MatMut::from_column_major_slice_mut(panel, height, columns.len());
            let target = MatMut::from_column_major_slice_mut(square, count, count);
            let mut signs = vec![1.0; if self.signed { columns.len() } else { 0 }];
            eliminate(panel, target, size, &mut signs, self.threads, &mut work.room)
                .map_err(|index| columns.start + index)?;
            if self.signed {
                let negative = columns.zip(&signs).filter(|(_, sign)| **sign < 0.0).map(|(place, _)| place);
                self.negative.lock().unwrap_or_else(PoisonError::into_inner).extend(negative);
            }
            if count > 0 {
                work.squares.get_mut().copy_within(top..top + count * count, begin);
                waiting.push((s, begin));
            }
            top = begin + count * count;
        }
        let squares = Arc::new(work.squares);
        let mut passing: Vec<Update<T>> = below.into_iter().rev().collect();
        let passed = |(node, begin)| Update { node, squares: squares.clone(), begin };
        passing.extend(waiting.into_iter().map(passed));
        Ok(passing)
    }
}

impl Elimination {
    /// Adds the update matrix of a supernode `node` to the columns and the update matrix of
    /// supernode s.
    fn extend_add<T: Entry>(
        &self,
        (node, update): (usize, &[T]),
        (s, panel, square): (usize, &mut [T], &mut [T]),
        runs: &mut Vec<[usize; 3]>,
    ) {
        let rows = &self.below[self.rows(node)];
        let columns = self.columns(s);
        let below = &self.below[self.rows(s)];
        // Runs of rows contiguous in both: start in the source, start in the target, length.
        runs.clear();
        let mut place = 0;
        for (k, &row) in rows.iter().enumerate() {
            let target = if (row as usize) < columns.end {
                row as usize - columns.start
            } else {
                while below[place] < row {
                    place += 1;
                }
                columns.len() + place
            };
            match runs.last_mut() {
                Some([from, to, count]) if *to + *count == target && *from + *count == k => *count += 1,
                _ => runs.push([k, target, 1]),
            }
        }
        let height = columns.len() + below.len();
        let own = columns.len();
        let mut first = 0;
        for j in 0..rows.len() {
            while runs[first][0] + runs[first][2] <= j {
                first += 1;
            }
            let source = &update[j * rows.len()..(j + 1) * rows.len()];
            let column = runs[first][1] + j - runs[first][0];
            // The column of the target, and how many of the node's leading rows it does not store.
            let (target, missing) = match column.checked_sub(own) {
                None => (&mut panel[column * height..(column + 1) * height], 0),
                Some(column) => (&mut square[column * below.len()..(column + 1) * below.len()], own),
            };
            for &[from, to, count] in &runs[first..] {
                let skip = j.saturating_sub(from);
                let target = &mut target[to + skip - missing..to + count - missing];
                for (target, source) in target.iter_mut().zip(&source[from + skip..from + count]) {
                    *target += *source;
                }
            }
        }
    }
}

/// Factors the columns of a supernode and subtracts their product from its update matrix. Pivots
/// may be negative if `signs` is not empty.
///
/// # Errors
/// The index of a pivot that is not positive, or not finite.
fn eliminate<T: Entry>(
    mut panel: MatMut<T>,
    mut square: MatMut<T>,
    size: f64,
    signs: &mut [f64],
    threads: &Threads,
    room: &mut Room,
) -> Result<(), usize> {
    let (height, columns) = panel.shape();
    let alone = Threads::one();
    for start in (0..columns).step_by(BLOCK) {
        let width = BLOCK.min(columns - start);
        let threads = if width * (height - start).pow(2) > SHARED { threads } else { &alone };
        let remaining = panel.rb_mut().subrows_mut(start, height - start).subcols_mut(start, columns - start);
        let (block, mut after) = remaining.split_at_col_mut(width);
        let (mut diagonal, mut lower) = block.split_at_row_mut(width);
        let signs = if signs.is_empty() { &mut *signs } else { &mut signs[start..start + width] };
        let diagonal_block = diagonal.rb_mut();
        let made = if signs.is_empty() {
            room.cholesky(diagonal_block, size)
        } else {
            room.signed(diagonal_block, size, signs)
        };
        made.map_err(|index| start + index)?;
        let diagonal = diagonal.rb();
        threads.for_each(row_blocks(lower.rb_mut()), |_, rows| {
            solve_lower_triangular_in_place(diagonal, rows.transpose_mut(), Par::Seq);
        });
        // L Lᵀ, or L J Lᵀ from (L J) J (L J)ᵀ.
        let with_signs = signs.iter().any(|sign| *sign < 0.0).then(|| {
            let signed = lower.to_owned();
            for (j, sign) in signs.iter().enumerate() {
                lower.rb_mut().col_mut(j).iter_mut().for_each(|x| *x *= T::rounded(*sign));
            }
            signed
        });
        let lower = lower.rb();
        let other = with_signs.as_ref().map_or(lower, Mat::as_ref);
        let trailing_columns = columns - start - width;
        let (_, trailing) = after.rb_mut().split_at_row_mut(width);
        threads.for_each(column_blocks(trailing), |k, target| {
            subtract_product(target, [lower, other], k * BLOCK);
        });
        if square.nrows() > 0 {
            let rows = [lower, other].map(|lower| lower.subrows(trailing_columns, square.nrows()));
            threads.for_each(column_blocks(square.rb_mut()), |k, target| {
                subtract_product(target, rows, k * BLOCK);
            });
        }
    }
    Ok(())
}

/// Subtracts the symmetric product L Mᵀ from the lower triangle of the target, which is the columns
/// of a square matrix from `first` on.
fn subtract_product<T: Entry>(target: MatMut<'_, T>, rows: [MatRef<'_, T>; 2], first: usize) {
    let (height, width) = target.shape();
    let [lower, other] = rows.map(|rows| rows.subrows(first, height - first));
    let (_, target) = target.split_at_row_mut(first);
    let (square, below) = target.split_at_row_mut(width);
    let (top, bottom) = lower.split_at_row(width);
    let other = other.subrows(0, width).transpose();
    let half = BlockStructure::TriangularLower;
    let whole = BlockStructure::Rectangular;
    let minus = T::rounded(-1.0);
    triangular::matmul(square, half, Accum::Add, top, whole, other, whole, minus, Par::Seq);
    if below.nrows() > 0 {
        matmul(below, Accum::Add, bottom, other, minus, Par::Seq);
    }
}

fn column_blocks<T: Entry>(matrix: MatMut<'_, T>) -> impl Iterator<Item = MatMut<'_, T>> {
    let mut remaining = Some(matrix);
    std::iter::from_fn(move || {
        let matrix = remaining.take().filter(|matrix| matrix.ncols() > 0)?;
        let width = BLOCK.min(matrix.ncols());
        let (block, after) = matrix.split_at_col_mut(width);
        remaining = Some(after);
        Some(block)
    })
}

fn row_blocks<T: Entry>(matrix: MatMut<'_, T>) -> impl Iterator<Item = MatMut<'_, T>> {
    column_blocks(matrix.transpose_mut()).map(MatMut::transpose_mut)
}
