//! Contributions of a body's cells: computed by any number of threads and added one by one in the
//! order of the cells, so that sums are bitwise independent of the number of threads.

use carom_algebra::Threads;
use carom_solid::{Inverted, LANES};

/// Cells computed while those before are added: enough to share among threads, few enough for their
/// caches.
const BLOCK: usize = 8192;
/// Numbers of a block, at most.
const NUMBERS: usize = 1 << 17;
/// Blocks into which the cells of a small body are divided: all but the last are added while others
/// are computed.
const BLOCKS: usize = 4;
/// Tasks of a block, at least.
const TASKS: usize = 8;
/// Cells per task of a thread, at most.
const SHARE: usize = 64;
/// Cells below which a second thread does not pay.
const FEW: usize = 512;
/// Numbers that stay in the nearest cache between their computation and their addition.
const NEAR: usize = 2048;

/// Consecutive cells: the first, their numbers and values.
#[derive(Default)]
struct Block {
    first: usize,
    locals: Vec<f64>,
    values: Vec<f64>,
}

impl Block {
    fn resize(&mut self, first: usize, count: usize, numbers: usize) {
        self.first = first;
        self.locals.resize(count * numbers, 0.0);
        self.values.resize(count, 0.0);
    }
}

/// Calls `compute(first, numbers, values)` for consecutive cells on all threads, `count` in all,
/// and `add(first, numbers)` for such blocks in the order of the cells. Returns the sum of the
/// values in that order, and the smallest number that `compute` returned, if it always did.
///
/// # Errors
/// The first inverted cell.
pub(crate) fn for_each(
    threads: &Threads,
    count: usize,
    numbers: usize,
    compute: impl Fn(usize, &mut [f64], &mut [f64]) -> Result<Option<f64>, Inverted> + Sync,
    mut add: impl FnMut(usize, &[f64]) + Send,
) -> Result<(f64, Option<f64>), Inverted> {
    let mut sum = 0.0;
    let mut least = Some(f64::INFINITY);
    let smaller = |one: Option<f64>, other: Option<f64>| Some(one?.min(other?));
    let mut add_all = |block: &Block| {
        block.values.iter().for_each(|value| sum += value);
        add(block.first, &block.locals);
    };
    let is_serial = threads.count() == 1 || count < FEW;
    let near = (NEAR / numbers).clamp(1, SHARE);
    let (size, share) = if is_serial {
        (near, near)
    } else {
        let size = (NUMBERS / numbers).min(count.div_ceil(BLOCKS).next_multiple_of(LANES)).clamp(1, BLOCK);
        (size, (size / TASKS).next_multiple_of(LANES).clamp(1, near))
    };
    let [mut done, mut next] = [Block::default(), Block::default()];
    for first in (0..count).step_by(size) {
        next.resize(first, size.min(count - first), numbers);
        if is_serial {
            least = smaller(least, compute(first, &mut next.locals, &mut next.values)?);
            add_all(&next);
            continue;
        }
        let Block { locals, values, .. } = &mut next;
        let mut results = vec![Ok(None); values.len().div_ceil(share)];
        let compute_all = || {
            let shares = locals.chunks_mut(share * numbers).zip(values.chunks_mut(share)).zip(&mut results);
            threads.for_each(shares, |k, ((locals, values), result)| {
                *result = compute(first + k * share, locals, values);
            });
        };
        threads.join(|| add_all(&done), compute_all);
        for result in results {
            least = smaller(least, result?);
        }
        std::mem::swap(&mut done, &mut next);
    }
    add_all(&done);
    Ok((sum, least))
}

/// The addition of [`for_each`] by one for each cell.
pub(crate) fn added_one_by_one(
    numbers: usize,
    mut add: impl FnMut(usize, &[f64]) + Send,
) -> impl FnMut(usize, &[f64]) + Send {
    move |first, locals| {
        locals.chunks_exact(numbers).enumerate().for_each(|(k, local)| add(first + k, local));
    }
}

/// The computation of [`for_each`] by one for each cell.
pub(crate) fn one_by_one(
    numbers: usize,
    compute: impl Fn(usize, &mut [f64]) -> Result<f64, Inverted> + Sync,
) -> impl Fn(usize, &mut [f64], &mut [f64]) -> Result<Option<f64>, Inverted> + Sync {
    move |first, locals, values| {
        for (k, (local, value)) in locals.chunks_exact_mut(numbers).zip(values).enumerate() {
            *value = compute(first + k, local)?;
        }
        Ok(None)
    }
}
