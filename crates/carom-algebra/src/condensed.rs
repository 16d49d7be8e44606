//! Cholesky of a sparse symmetric matrix with chosen unknowns B eliminated last (static
//! condensation),
//!
//! ```text
//! A = L Lᵀ,    S = A_BB − A_BI A_II⁻¹ A_IB = L_BB L_BBᵀ
//! ```
//!
//! so that any change of A on B alone, and any constraint on B alone, affects only the small dense
//! S: forward substitution of the inner unknowns, a dense solve on B, backward substitution. The
//! factor is reused while the neighbourhood of B changes.
//!
//! If A is indefinite, signs stand between L and Lᵀ (`pivots.rs`). In single precision σ²A is
//! factored, L' = σL, with σ a power of two.

use std::sync::{Arc, Mutex, PoisonError};

use faer::MatMut;

use crate::elimination::Elimination;
use crate::front::{Aligned, Matrix, Value};
use crate::linear::LinearError;
use crate::pivots::{Room, diagonal_size};
use crate::precision::{Entry, Precision};
use crate::substitution::Solver;
use crate::threads::Threads;

/// Unknowns that a thread permutes.
const BLOCK: usize = 4096;

/// The entries of a factor, for the matrix multiplied by the square of `scale`.
struct Entries<T> {
    factors: Aligned<T>,
    /// Reciprocals of the diagonal of the factor.
    inverse: Vec<f64>,
    /// Signs J between L and Lᵀ; empty if all are positive.
    signs: Vec<f64>,
    scale: f64,
}

enum Numbers {
    Double(Entries<f64>),
    Single(Entries<f32>),
}

impl<T: Entry> Entries<T> {
    fn new(elimination: &Elimination) -> Self {
        Self {
            factors: Aligned::new(elimination.len_values()),
            inverse: vec![0.0; elimination.inner],
            signs: Vec::new(),
            scale: 1.0,
        }
    }

    fn factor(
        &mut self,
        elimination: &Elimination,
        value: Value,
        signed: bool,
        threads: &Threads,
        schur: &mut Vec<f64>,
    ) -> Result<(), LinearError> {
        let n = elimination.place.len();
        if let Some(top) = T::TOP {
            // The largest entry of a positive definite matrix is on its diagonal.
            let diagonal = elimination.diagonal.iter();
            let largest = diagonal.map(|&k| value(k as usize).abs()).fold(f64::MIN_POSITIVE, f64::max);
            self.scale = 2f64.powi((top - largest.log2().ceil() as i32).div_euclid(2));
        }
        let square = self.scale * self.scale;
        let singular = |pivot| LinearError::Singular { size: n, pivot, value: 0.0 };
        let matrix =
            Matrix { elimination, value, scale: square, threads, signed, negative: Mutex::default() };
        matrix.factor(self.factors.get_mut(), schur).map_err(singular)?;
        schur.iter_mut().for_each(|value| *value /= square);
        for s in 0..elimination.nodes.len() - 1 {
            let columns = elimination.columns(s);
            let first = elimination.nodes[s].values;
            let height = columns.len() + elimination.rows(s).len();
            let diagonal = self.factors.get()[first..].iter().step_by(height + 1);
            for (inverse, value) in self.inverse[columns].iter_mut().zip(diagonal) {
                *inverse = (*value).into().recip();
            }
        }
        let negative = matrix.negative.into_inner().unwrap_or_else(PoisonError::into_inner);
        self.signs.clear();
        self.signs.resize(if negative.is_empty() { 0 } else { elimination.inner }, 1.0);
        negative.into_iter().for_each(|place| self.signs[place] = -1.0);
        Ok(())
    }
}

/// Sparse factor of a matrix whose last unknowns are left for a dense solve on their Schur
/// complement.
pub struct Condensed {
    elimination: Arc<Elimination>,
    numbers: Numbers,
    threads: Threads,
    schur: Vec<f64>,
}

impl Condensed {
    /// Allocates the factor of a matrix with this structure; the calling thread does the work.
    pub fn new(elimination: &Arc<Elimination>, precision: Precision) -> Self {
        let numbers = match precision {
            Precision::Double => Numbers::Double(Entries::new(elimination)),
            Precision::Single => Numbers::Single(Entries::new(elimination)),
        };
        let elimination = elimination.clone();
        Self { elimination, numbers, threads: Threads::one(), schur: Vec::new() }
    }

    /// Shares the work among threads, on whose number the result does not depend.
    pub fn on(self, threads: &Threads) -> Self {
        Self { threads: threads.clone(), ..self }
    }

    /// Elimination order and structure of the factor.
    pub fn elimination(&self) -> &Arc<Elimination> {
        &self.elimination
    }

    /// Precision of the entries of the factor.
    pub fn precision(&self) -> Precision {
        match self.numbers {
            Numbers::Double(_) => Precision::Double,
            Numbers::Single(_) => Precision::Single,
        }
    }

    /// Factors the matrix with `value(k)` at entry k; returns whether it is positive definite.
    ///
    /// # Errors
    /// A pivot is not finite, or a whole diagonal vanishes.
    pub fn factor(&mut self, value: impl Fn(usize) -> f64 + Sync) -> Result<bool, LinearError> {
        self.factor_values(&value)
    }

    fn factor_values(&mut self, value: Value) -> Result<bool, LinearError> {
        let elimination = &*self.elimination;
        let threads = &self.threads;
        let schur = &mut self.schur;
        let mut factor = |signed: bool| match &mut self.numbers {
            Numbers::Double(entries) => entries.factor(elimination, value, signed, threads, schur),
            Numbers::Single(entries) => entries.factor(elimination, value, signed, threads, schur),
        };
        if factor(false).is_err() {
            factor(true)?;
            return Ok(false);
        }
        let mut copy = schur.clone();
        let size = diagonal_size(copy.iter().step_by(elimination.schur_size() + 1).copied());
        let square = MatMut::from_column_major_slice_mut(
            &mut copy,
            elimination.schur_size(),
            elimination.schur_size(),
        );
        Ok(Room::default().cholesky(square, size).is_ok())
    }

    /// Whether the block of the unknowns that are eliminated is positive definite.
    pub fn is_inner_positive(&self) -> bool {
        match &self.numbers {
            Numbers::Double(entries) => entries.signs.is_empty(),
            Numbers::Single(entries) => entries.signs.is_empty(),
        }
    }

    /// The Schur complement S, column by column; only the lower triangle is filled.
    pub fn schur(&self) -> &[f64] {
        &self.schur
    }

    /// Permutes the right-hand side and eliminates the inner unknowns. The last entries of `x`
    /// become the right-hand side of the Schur complement.
    pub fn eliminate_into(&mut self, rhs: &[f64], x: &mut Vec<f64>) {
        x.resize(self.elimination.root.length, 0.0);
        if rhs.iter().all(|value| *value == 0.0) {
            x.fill(0.0);
            return;
        }
        match &self.numbers {
            Numbers::Double(entries) => self.solver(entries).forward(&self.elimination.root, rhs, x),
            Numbers::Single(entries) => self.solver(entries).forward(&self.elimination.root, rhs, x),
        }
        for (value, &i) in
            self.schur_part(x).iter_mut().zip(&self.elimination.order[self.elimination.inner..])
        {
            *value += rhs[i as usize];
        }
    }

    /// Substitutes backward from the known last unknowns and permutes to the order of the pattern.
    pub fn substitute_into(&mut self, x: &mut [f64], out: &mut [f64]) {
        match &self.numbers {
            Numbers::Double(entries) => self.solver(entries).backward(&self.elimination.root, x),
            Numbers::Single(entries) => self.solver(entries).backward(&self.elimination.root, x),
        }
        let positions = &self.elimination.positions;
        self.threads.for_each_block(out, BLOCK, |first, out| {
            for (value, &position) in out.iter_mut().zip(&positions[first..]) {
                *value = x[position as usize];
            }
        });
    }

    /// The last unknowns of a vector in elimination order.
    pub fn schur_part<'a>(&self, x: &'a mut [f64]) -> &'a mut [f64] {
        let first = x.len() - self.elimination.schur_size();
        &mut x[first..]
    }

    fn solver<'a, T: Entry>(&'a self, entries: &'a Entries<T>) -> Solver<'a, T> {
        Solver {
            elimination: &self.elimination,
            factors: entries.factors.get(),
            inverse: &entries.inverse,
            signs: &entries.signs,
            square: entries.scale * entries.scale,
            threads: &self.threads,
        }
    }
}
