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

/// Calls `compute(cell, numbers)` for `count` cells on all threads, and `add(cell, numbers)` in the
/// order of the cells. Returns the sum of the values of `compute` in that order.
///
/// # Errors
/// The first inverted cell.
pub(crate) fn for_each(
    threads: &Threads,
    count: usize,
    numbers: usize,
    compute: impl Fn(usize, &mut [f64]) -> Result<f64, Inverted> + Sync,
    mut add: impl FnMut(usize, &[f64]),
) -> Result<f64, Inverted> {
    let mut sum = 0.0;
    if threads.count() == 1 || count < FEW {
        // The result is still in the cache.
        let mut local = vec![0.0; numbers];
        for cell in 0..count {
            sum += compute(cell, &mut local)?;
            add(cell, &local);
        }
        return Ok(sum);
    }
    let size = BLOCK.min(count);
    let (mut results, mut locals) = (vec![Ok(0.0); size], vec![0.0; size * numbers]);
    for first in (0..count).step_by(BLOCK) {
        let here = BLOCK.min(count - first);
        let shares =
            results[..here].chunks_mut(SHARE).zip(locals[..here * numbers].chunks_mut(SHARE * numbers));
        threads.for_each(shares, |share, (results, locals)| {
            for (k, (result, local)) in results.iter_mut().zip(locals.chunks_exact_mut(numbers)).enumerate() {
                *result = compute(first + share * SHARE + k, local);
            }
        });
        for (k, (result, local)) in results[..here].iter().zip(locals.chunks_exact(numbers)).enumerate() {
            sum += (*result)?;
            add(first + k, local);
        }
    }
    Ok(sum)
}
