//! Cholesky of a dense symmetric matrix that may be indefinite: where a pivot is not positive, its diagonal entry is raised until it is.
//!
//! ```text
//! L Lᵀ = A + Σ δᵢ eᵢ eᵢᵀ      of as low a rank as A has eigenvalues that are not positive
//! ```
//!
//! As a preconditioner of A it leaves an identity and a matrix of that rank: Krylov methods end as many iterations later.

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::cholesky::llt::factor::{
    LltError, LltParams, LltRegularization, cholesky_in_place, cholesky_in_place_scratch,
};
use faer::prelude::{Reborrow, ReborrowMut};
use faer::{MatMut, Par, Spec};

use crate::precision::Entry;

/// What is left of a diagonal entry when its unknown depends on those before.
const NOTHING: f64 = 1e-13;
/// How often an entry is raised, each time to ten times as much.
const RAISES: u32 = 20;

/// Size of the diagonal that pivots are compared with.
pub(crate) fn diagonal_size(diagonal: impl Iterator<Item = impl Into<f64>>) -> f64 {
    diagonal.fold(0.0, |most, value| f64::max(most, value.into().abs()))
}

/// Room to factor in.
pub(crate) struct Room<T> {
    scratch: MemBuffer,
    size: usize,
    copy: Vec<T>,
}

impl<T: Entry> Default for Room<T> {
    fn default() -> Self {
        Self::new(0)
    }
}

impl<T: Entry> Room<T> {
    /// For matrices of up to so many rows.
    pub(crate) fn new(size: usize) -> Self {
        let space = cholesky_in_place_scratch::<T>(size, Par::Seq, Spec::<LltParams, T>::default());
        Self { scratch: MemBuffer::new(space), size, copy: Vec::new() }
    }

    /// Overwrites the lower triangle with the factor; `size` is that of the diagonal before anything was eliminated. How many entries were raised.
    ///
    /// # Errors
    /// The index of a pivot that stays what it is: no number, or zero where the whole diagonal is.
    pub(crate) fn cholesky(&mut self, mut matrix: MatMut<'_, T>, size: f64) -> Result<usize, usize> {
        let n = matrix.nrows();
        if self.size < n {
            *self = Self::new(2 * n);
        }
        self.copy.clear();
        (0..n).for_each(|j| self.copy.extend(matrix.rb().col(j).iter().copied()));
        let least = (NOTHING * size).sqrt();
        let mut raised: Vec<(usize, u32)> = Vec::new();
        loop {
            let stack = MemStack::new(&mut self.scratch);
            let made = cholesky_in_place(
                matrix.rb_mut(),
                LltRegularization::default(),
                Par::Seq,
                stack,
                Spec::<LltParams, T>::default(),
            );
            let low = match made {
                Ok(_) => (0..n).find(|&j| matrix[(j, j)].into() <= least),
                Err(LltError::NonPositivePivot { index }) => Some(index),
            };
            let Some(index) = low else { return Ok(raised.len()) };
            let place = raised.iter().position(|(place, _)| *place == index).unwrap_or(raised.len());
            if place == raised.len() {
                raised.push((index, 0));
            }
            raised[place].1 += 1;
            if raised[place].1 > RAISES || size == 0.0 {
                return Err(index);
            }
            for j in 0..n {
                (j..n).for_each(|i| matrix[(i, j)] = self.copy[j * n + i]);
            }
            for &(index, times) in &raised {
                let value: f64 = matrix[(index, index)].into() + size * 10f64.powi(times as i32 - 1);
                matrix[(index, index)] = T::rounded(value);
            }
        }
    }
}
