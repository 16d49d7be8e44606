//! Cholesky of a dense symmetric matrix, with signs where it is indefinite:
//!
//! ```text
//! A = L J Lᵀ,   J = diag(±1)
//! ```
//!
//! J is the identity if A is positive definite; otherwise it has as many negative entries as A has
//! negative eigenvalues (Sylvester). Rows are not exchanged: a tangent has so few negative pivots
//! that the others hardly ever become small, and the Krylov method recovers the lost accuracy.

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::cholesky::{ldlt, llt};
use faer::prelude::ReborrowMut;
use faer::{MatMut, Par, Spec};

use crate::precision::Entry;

/// Pivot, as a fraction of the diagonal, below which an unknown depends linearly on others.
const NOTHING: f64 = 1e-13;

/// Largest absolute value on the diagonal, with which pivots are compared.
pub(crate) fn diagonal_size(diagonal: impl Iterator<Item = impl Into<f64>>) -> f64 {
    diagonal.fold(0.0, |most, value| f64::max(most, value.into().abs()))
}

/// Workspace of a dense factorisation.
#[derive(Default)]
pub(crate) struct Room {
    scratch: Option<MemBuffer>,
    bytes: usize,
}

impl Room {
    fn stack<T: Entry>(&mut self, size: usize) -> &mut MemStack {
        if self.bytes < size * size_of::<T>() {
            self.scratch = None;
            self.bytes = 2 * size * size_of::<T>();
        }
        let scratch = self.scratch.get_or_insert_with(|| {
            let one = llt::factor::cholesky_in_place_scratch::<T>(2 * size, Par::Seq, Spec::default());
            MemBuffer::new(one.or(ldlt::factor::cholesky_in_place_scratch::<T>(
                2 * size,
                Par::Seq,
                Spec::default(),
            )))
        });
        MemStack::new(scratch)
    }

    /// Overwrites the lower triangle of a positive definite matrix with L. `size` is the magnitude
    /// of its diagonal before the elimination.
    ///
    /// # Errors
    /// The index of a pivot that is not positive.
    pub(crate) fn cholesky<T: Entry>(&mut self, mut matrix: MatMut<'_, T>, size: f64) -> Result<(), usize> {
        let n = matrix.nrows();
        let stack = self.stack::<T>(n);
        let least = (NOTHING * size).sqrt();
        let regularization = llt::factor::LltRegularization::default();
        match llt::factor::cholesky_in_place(
            matrix.rb_mut(),
            regularization,
            Par::Seq,
            stack,
            Spec::default(),
        ) {
            Ok(_) => (0..n).find(|&j| matrix[(j, j)].into() <= least).map_or(Ok(()), Err),
            Err(llt::factor::LltError::NonPositivePivot { index }) => Err(index),
        }
    }

    /// Overwrites the lower triangle of an indefinite matrix with L, and `signs` with J. Negligible
    /// pivots are regularised.
    ///
    /// # Errors
    /// The index of a pivot that is not finite, or zero with a zero diagonal.
    pub(crate) fn signed<T: Entry>(
        &mut self,
        mut matrix: MatMut<'_, T>,
        size: f64,
        signs: &mut [f64],
    ) -> Result<(), usize> {
        let n = matrix.nrows();
        let stack = self.stack::<T>(n);
        let regularization = ldlt::factor::LdltRegularization {
            dynamic_regularization_signs: None,
            dynamic_regularization_delta: T::rounded(NOTHING * size),
            dynamic_regularization_epsilon: T::rounded(NOTHING * size),
        };
        ldlt::factor::cholesky_in_place(matrix.rb_mut(), regularization, Par::Seq, stack, Spec::default())
            .map_err(|ldlt::factor::LdltError::ZeroPivot { index }| index)?;
        for (j, sign) in signs.iter_mut().enumerate() {
            let pivot: f64 = matrix[(j, j)].into();
            if !pivot.is_finite() {
                return Err(j);
            }
            let root = T::rounded(pivot.abs().sqrt());
            *sign = pivot.signum();
            matrix[(j, j)] = root;
            (j + 1..n).for_each(|i| matrix[(i, j)] *= root);
        }
        Ok(())
    }
}
