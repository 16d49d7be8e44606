//! Contributions of a body's cells: computed by any number of threads and added one by one in the
//! order of the cells, so that sums are bitwise independent of the number of threads.

use carom_algebra::Threads;
use carom_solid::Inverted;

/// Cells computed before they are added: enough to share among threads, few enough for their
/// caches.
const BLOCK: usize = 1024;
/// Cells per task of a thread.
const SHARE: usize = 64;
/// Cells below which a second thread does not pay.
const FEW: usize = 512;
/// Numbers that stay in the nearest cache between their computation and their addition.
const NEAR: usize = 2048;

/// Calls `compute(first, numbers, values)` for consecutive cells on all threads, `count` in all,
/// and `add(cell, numbers)` in the order of the cells. Returns the sum of the values in that order.
///
/// # Errors
/// The first inverted cell.
pub(crate) fn for_each(
    threads: &Threads,
    count: usize,
    numbers: usize,
    compute: impl Fn(usize, &mut [f64], &mut [f64]) -> Result<(), Inverted> + Sync,
    mut add: impl FnMut(usize, &[f64]),
) -> Result<f64, Inverted> {
    let mut sum = 0.0;
    let mut add_all = |first: usize, locals: &[f64], values: &[f64]| {
        for (k, (local, value)) in locals.chunks_exact(numbers).zip(values).enumerate() {
            sum += value;
            add(first + k, local);
        }
    };
    let is_serial = threads.count() == 1 || count < FEW;
    let size = if is_serial { (NEAR / numbers).clamp(1, SHARE) } else { BLOCK }.min(count);
    let (mut values, mut locals) = (vec![0.0; size], vec![0.0; size * numbers]);
    let mut results = vec![Ok(()); size.div_ceil(SHARE)];
    for first in (0..count).step_by(size.max(1)) {
        let here = size.min(count - first);
        let (values, locals) = (&mut values[..here], &mut locals[..here * numbers]);
        if is_serial {
            compute(first, locals, values)?;
        } else {
            let shares = locals.chunks_mut(SHARE * numbers).zip(values.chunks_mut(SHARE)).zip(&mut results);
            threads.for_each(shares, |share, ((locals, values), result)| {
                *result = compute(first + share * SHARE, locals, values);
            });
            results.iter().copied().collect::<Result<(), Inverted>>()?;
        }
        add_all(first, locals, values);
    }
    Ok(sum)
}

/// The computation of [`for_each`] by one for each cell.
pub(crate) fn one_by_one(
    numbers: usize,
    compute: impl Fn(usize, &mut [f64]) -> Result<f64, Inverted> + Sync,
) -> impl Fn(usize, &mut [f64], &mut [f64]) -> Result<(), Inverted> + Sync {
    move |first, locals, values| {
        for (k, (local, value)) in locals.chunks_exact_mut(numbers).zip(values).enumerate() {
            *value = compute(first + k, local)?;
        }
        Ok(())
    }
}
