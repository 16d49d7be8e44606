//! Forces and tangents of a body's cells: computed by any number of threads, handed over one by one in the order of the cells, so that sums have the same
//! bits whatever the number of threads.

use carom_solid::{Body, Inverted};
use rayon::prelude::*;

/// Cells of a block: small enough for the cache, large enough to share among threads.
const BLOCK: usize = 64;

/// What one cell contributes.
#[derive(Clone)]
struct Contribution {
    strain: Result<f64, Inverted>,
    force: Vec<f64>,
    tangent: Vec<f64>,
}

/// Threads and buffers for the cells.
pub(crate) struct Cells {
    pool: Option<rayon::ThreadPool>,
    block: Vec<Contribution>,
}

impl Cells {
    /// With this many threads; with one, where the machine gives no more.
    pub(crate) fn new(threads: usize) -> Self {
        let pool = (threads > 1).then(|| rayon::ThreadPoolBuilder::new().num_threads(threads).build().ok()).flatten();
        let empty = Contribution { strain: Ok(0.0), force: Vec::new(), tangent: Vec::new() };
        Self { pool, block: vec![empty; BLOCK] }
    }

    /// Calls `add(cell, force, tangent)` for every cell in order; the strain energy of the body is returned. With `before`, the forces are the discrete
    /// gradient from there to `y`.
    pub(crate) fn for_each(
        &mut self,
        body: &dyn Body,
        before: Option<&[f64]>,
        y: &[f64],
        mut add: impl FnMut(usize, &[f64], &[f64]),
    ) -> Result<f64, Inverted> {
        let (count, dofs) = (body.mesh().cell_count(), body.mesh().element.dofs());
        for out in &mut self.block {
            out.force.resize(dofs, 0.0);
            out.tangent.resize(dofs * dofs, 0.0);
        }
        let compute = |cell: usize, out: &mut Contribution| {
            let (force, tangent) = (&mut out.force[..], &mut out.tangent[..]);
            out.strain = match before {
                None => body.cell_tangent(cell, y, force, tangent),
                Some(before) => body.cell_between(cell, before, y, force, Some(tangent)),
            };
        };
        let mut strain = 0.0;
        // What one thread has just computed is still in its cache.
        let size = if self.pool.is_some() { BLOCK } else { 1 };
        for first in (0..count).step_by(size) {
            let block = &mut self.block[..size.min(count - first)];
            match &self.pool {
                Some(pool) => {
                    pool.install(|| block.par_iter_mut().enumerate().for_each(|(k, out)| compute(first + k, out)));
                }
                None => block.iter_mut().enumerate().for_each(|(k, out)| compute(first + k, out)),
            }
            for (k, out) in block.iter().enumerate() {
                strain += out.strain?;
                add(first + k, &out.force, &out.tangent);
            }
        }
        Ok(strain)
    }
}
