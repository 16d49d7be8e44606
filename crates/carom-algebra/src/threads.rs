//! A thread pool shared by a computation. Results never depend on the number of threads: work is
//! divided by its structure alone, and every sum has a fixed order.

use std::sync::Arc;

use rayon::prelude::*;

use crate::sums::{max_abs, sums};

/// Numbers of a vector that a thread adds.
const BLOCK: usize = 1 << 14;

/// A number of threads; clones share them.
///
/// ```
/// use carom_algebra::Threads;
/// let threads = Threads::new(2);
/// let mut squares = vec![0; 100];
/// threads.for_each_block(&mut squares, 16, |first, block| {
///     for (i, square) in block.iter_mut().enumerate() {
///         *square = (first + i).pow(2);
///     }
/// });
/// assert_eq!(squares[99], 99 * 99);
/// assert_eq!(threads.join(|| 1, || 2), (1, 2));
/// ```
#[derive(Clone, Debug, Default)]
pub struct Threads {
    pool: Option<Arc<rayon::ThreadPool>>,
}

impl Threads {
    /// Runs all work on the calling thread.
    pub fn one() -> Self {
        Self::default()
    }

    /// A pool of `count` threads; one thread if no more can be started.
    pub fn new(count: usize) -> Self {
        let pool = || rayon::ThreadPoolBuilder::new().num_threads(count).build().ok().map(Arc::new);
        Self { pool: if count > 1 { pool() } else { None } }
    }

    /// Number of threads.
    pub fn count(&self) -> usize {
        self.pool.as_ref().map_or(1, |pool| pool.current_num_threads())
    }

    /// Runs `work` on one of the threads, so that nested parallel calls do not switch threads.
    pub fn within<R: Send>(&self, work: impl FnOnce() -> R + Send) -> R {
        match &self.pool {
            Some(pool) => pool.install(work),
            None => work(),
        }
    }

    /// Runs two functions, in parallel if there is a second thread, and returns both results.
    pub fn join<A: Send, B: Send>(
        &self,
        first: impl FnOnce() -> A + Send,
        second: impl FnOnce() -> B + Send,
    ) -> (A, B) {
        match &self.pool {
            Some(pool) => pool.install(|| rayon::join(first, second)),
            None => (first(), second()),
        }
    }

    /// Calls `work(k, item)` for every item k.
    pub fn for_each<T: Send>(&self, items: impl IntoIterator<Item = T>, work: impl Fn(usize, T) + Sync) {
        match &self.pool {
            Some(pool) => {
                let items: Vec<T> = items.into_iter().collect();
                let share =
                    || items.into_par_iter().with_max_len(1).enumerate().for_each(|(k, item)| work(k, item));
                pool.install(share);
            }
            None => items.into_iter().enumerate().for_each(|(k, item)| work(k, item)),
        }
    }

    /// Calls `work(first, block)` for blocks of `size` items, the last possibly shorter; `first` is
    /// the index of a block's first item.
    pub fn for_each_block<T: Send>(
        &self,
        items: &mut [T],
        size: usize,
        work: impl Fn(usize, &mut [T]) + Sync,
    ) {
        let size = size.max(1);
        if items.len() <= size {
            return work(0, items);
        }
        self.for_each(items.chunks_mut(size), |k, block| work(k * size, block));
    }

    /// Σ term(aᵢ, bᵢ, …) of several terms over vectors of the same length: sums of blocks, added in
    /// their order. Of short vectors the bits are those of [`sums`].
    pub fn sums<const K: usize, const T: usize>(
        &self,
        of: [&[f64]; K],
        terms: impl Fn([f64; K]) -> [f64; T] + Sync,
    ) -> [f64; T] {
        let length = of[0].len();
        if length <= BLOCK {
            return sums(of, terms);
        }
        let mut parts = vec![[0.0; T]; length.div_ceil(BLOCK)];
        self.for_each(&mut parts, |block, part| {
            let range = block * BLOCK..length.min((block + 1) * BLOCK);
            *part = sums(of.map(|x| &x[range.clone()]), &terms);
        });
        std::array::from_fn(|t| parts.iter().map(|part| part[t]).sum())
    }

    /// [`max_abs`] of a vector.
    pub fn max_abs(&self, x: &[f64]) -> f64 {
        if x.len() <= BLOCK {
            return max_abs(x);
        }
        let mut most = vec![0.0; x.len().div_ceil(BLOCK)];
        self.for_each(most.iter_mut().zip(x.chunks(BLOCK)), |_, (most, x)| *most = max_abs(x));
        most.into_iter().fold(0.0, f64::max)
    }
}
