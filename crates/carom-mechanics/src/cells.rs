//! What the cells of a body contribute: computed by any number of threads, handed over one by one in the order of the cells, so that sums have the same bits
//! whatever the number of threads.

use carom_algebra::Threads;
use carom_solid::Inverted;

/// Cells that are computed before they are handed over: enough to share among threads, few enough for their caches.
const BLOCK: usize = 512;
/// Cells that a thread takes at once.
const SHARE: usize = 32;

/// Calls `compute(cell, numbers)` for `count` cells, on all threads, and `add(cell, numbers)` with its results in the order of the cells; what `compute`
/// returns is added up in that order.
///
/// # Errors
/// The first cell that is inverted.
pub(crate) fn for_each(
    threads: &Threads,
    count: usize,
    numbers: usize,
    compute: impl Fn(usize, &mut [f64]) -> Result<f64, Inverted> + Sync,
    mut add: impl FnMut(usize, &[f64]),
) -> Result<f64, Inverted> {
    let mut sum = 0.0;
    if threads.count() == 1 || count < 2 * SHARE {
        // What has just been computed is still in the cache.
        let mut local = vec![0.0; numbers];
        for cell in 0..count {
            sum += compute(cell, &mut local)?;
            add(cell, &local);
        }
        return Ok(sum);
    }
    let mut block: Vec<(Result<f64, Inverted>, Vec<f64>)> = vec![(Ok(0.0), vec![0.0; numbers]); BLOCK.min(count)];
    for first in (0..count).step_by(BLOCK) {
        let block = &mut block[..BLOCK.min(count - first)];
        threads.for_each_block(block, SHARE, |from, cells| {
            for (k, (result, local)) in cells.iter_mut().enumerate() {
                *result = compute(first + from + k, local);
            }
        });
        for (k, (result, local)) in block.iter().enumerate() {
            sum += (*result)?;
            add(first + k, local);
        }
    }
    Ok(sum)
}
