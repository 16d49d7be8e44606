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
use crate::front::{Aligned, Matrix};
use crate::linear::LinearError;
use crate::pivots::{Room, diagonal_size};
use crate::precision::{Entry, Precision};
use crate::substitution::Solver;
use crate::threads::Threads;

/// The factor of a matrix multiplied by the square of `scale`.
struct Entries<T> {
    factors: Aligned<T>,
    /// Reciprocals of its diagonal.
    inverse: Vec<f64>,
    /// J; empty if it is the identity.
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
        value: impl Fn(usize) -> f64 + Sync,
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
            let (columns, first) = (elimination.columns(s), elimination.nodes[s].values);
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

/// A factor whose last unknowns are left for a dense solve.
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

    /// Shares the work among these threads. The result does not depend on them.
    pub fn on(self, threads: &Threads) -> Self {
        Self { threads: threads.clone(), ..self }
    }

    /// The structure.
    pub fn elimination(&self) -> &Arc<Elimination> {
        &self.elimination
    }

    /// Precision of its entries.
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
        let (elimination, threads, schur) = (&*self.elimination, &self.threads, &mut self.schur);
        let mut factor = |signed: bool| match &mut self.numbers {
            Numbers::Double(entries) => entries.factor(elimination, &value, signed, threads, schur),
            Numbers::Single(entries) => entries.factor(elimination, &value, signed, threads, schur),
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

    /// S, column by column; only the lower triangle is filled.
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
        for (value, &position) in out.iter_mut().zip(&self.elimination.positions) {
            *value = x[position as usize];
        }
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Pattern, Saddle};

    /// A grid of m × m nodes with two dofs each, springs to neighbours and between the dofs.
    fn grid(m: usize) -> (Pattern, Vec<f64>, Vec<usize>) {
        let mut entries = Vec::new();
        for (a, (row, column)) in (0..m * m).map(|a| (a, (a / m, a % m))) {
            entries.extend([(2 * a, 2 * a, 5.0), (2 * a + 1, 2 * a + 1, 6.0), (2 * a + 1, 2 * a, 0.5)]);
            for b in [(column + 1 < m).then_some(a + 1), (row + 1 < m).then_some(a + m)].into_iter().flatten()
            {
                entries.extend([(2 * b, 2 * a, -1.0), (2 * b + 1, 2 * a + 1, -1.2)]);
            }
        }
        let pattern = Pattern::from_entries(2 * m * m, entries.iter().map(|&(i, j, _)| (i, j)));
        let mut values = vec![0.0; pattern.len()];
        for (i, j, v) in entries {
            values[pattern.slot(i, j).unwrap()] += v;
        }
        (pattern, values, (0..2 * m * m).map(|i| i / 2).collect())
    }

    #[test]
    fn solves_with_any_choice_of_last_unknowns() {
        for (m, last) in [(1, vec![0]), (3, vec![]), (9, vec![7, 20, 21, 22, 80, 3]), (9, (0..162).collect())]
        {
            let (pattern, values, groups) = grid(m);
            let n = pattern.size();
            let exact: Vec<f64> = (0..n).map(|i| (i as f64 * 0.7).sin()).collect();
            let mut rhs = vec![0.0; n];
            pattern.multiply_add(&values, &exact, &mut rhs);
            let elimination = Arc::new(Elimination::new(&pattern, &groups, &last).unwrap());
            assert_eq!(elimination.schur_size(), last.len());
            for (precision, digits) in [(Precision::Double, 1e-13), (Precision::Single, 1e-5)] {
                let mut condensed = Condensed::new(&elimination, precision);
                condensed.factor(|k| values[k]).unwrap();
                let (mut x, mut out) = (Vec::new(), vec![0.0; n]);
                condensed.eliminate_into(&rhs, &mut x);
                let mut saddle = Saddle::default();
                saddle.begin(condensed.schur(), elimination.schur_size(), 0);
                saddle.factor().unwrap();
                saddle.solve(condensed.schur_part(&mut x), &mut []);
                condensed.substitute_into(&mut x, &mut out);
                let error = out.iter().zip(&exact).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
                assert!(error < digits, "{m} {}: {error:e}", last.len());
            }
        }
    }

    /// Any magnitude, and a dominant mass, where entries far from the diagonal underflow: each is
    /// about a thousandth of the one before.
    #[test]
    fn single_precision_has_the_range_it_needs() {
        for (factor, coupling) in [(1e-42, 1.0), (1e42, 1.0), (1.0, 1e-3)] {
            let (pattern, mut values, groups) = grid(30);
            for j in 0..pattern.size() {
                let column = pattern.starts[j]..pattern.starts[j + 1];
                column
                    .for_each(|k| values[k] *= if pattern.rows[k] == j { factor } else { factor * coupling });
            }
            let exact: Vec<f64> = (0..pattern.size()).map(|i| (i as f64 * 0.7).sin()).collect();
            let (mut rhs, mut out) = (vec![0.0; exact.len()], vec![0.0; exact.len()]);
            pattern.multiply_add(&values, &exact, &mut rhs);
            let elimination = Arc::new(Elimination::new(&pattern, &groups, &[]).unwrap());
            let mut condensed = Condensed::new(&elimination, Precision::Single);
            condensed.factor(|k| values[k]).unwrap();
            let mut x = Vec::new();
            condensed.eliminate_into(&rhs, &mut x);
            condensed.substitute_into(&mut x, &mut out);
            let error = out.iter().zip(&exact).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
            assert!(error < 1e-5, "{factor:e} {coupling:e}: {error:e}");
        }
    }

    /// Large enough for nested parts, with random entries: factor, Schur complement and solution.
    #[test]
    fn same_bits_with_any_number_of_threads() {
        let (pattern, mut values, groups) = grid(110);
        let n = pattern.size();
        let mut random = 1_u64;
        for value in &mut values {
            random = random.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            *value *= 0.9 + 0.1 * (random >> 40) as f64 / f64::from(1 << 24);
        }
        let exact: Vec<f64> = (0..n).map(|i| (i as f64 * 0.7).sin()).collect();
        let mut rhs = vec![0.0; n];
        pattern.multiply_add(&values, &exact, &mut rhs);
        for last in [vec![], (0..40).chain(12_000..12_100).collect::<Vec<_>>()] {
            let elimination = Arc::new(Elimination::new(&pattern, &groups, &last).unwrap());
            let parts = elimination.root.parts.as_ref().unwrap();
            assert!(parts.iter().all(|part| part.parts.is_some()));
            for (precision, digits) in [(Precision::Double, 1e-13), (Precision::Single, 1e-4)] {
                let solve = |threads: usize| {
                    let mut condensed = Condensed::new(&elimination, precision).on(&Threads::new(threads));
                    condensed.factor(|k| values[k]).unwrap();
                    let (mut x, mut out) = (Vec::new(), vec![0.0; n]);
                    condensed.eliminate_into(&rhs, &mut x);
                    let mut saddle = Saddle::default();
                    saddle.begin(condensed.schur(), elimination.schur_size(), 0);
                    saddle.factor().unwrap();
                    saddle.solve(condensed.schur_part(&mut x), &mut []);
                    condensed.substitute_into(&mut x, &mut out);
                    let bits = |x: &[f64]| x.iter().map(|x| x.to_bits()).collect::<Vec<_>>();
                    (bits(condensed.schur()), bits(&out), out)
                };
                let one = solve(1);
                let mut residual = vec![0.0; n];
                pattern.multiply_add(&values, &one.2, &mut residual);
                let residual = residual.iter().zip(&rhs).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
                assert!(residual < digits, "{residual:e}");
                for threads in [2, 3] {
                    let other = solve(threads);
                    assert!(one.0 == other.0 && one.1 == other.1, "{threads} threads, {precision:?}");
                }
            }
        }
    }

    /// Negative pivots among the inner unknowns, among the last ones, and in both.
    #[test]
    fn an_indefinite_matrix_has_a_factor_with_signs() {
        for (m, last) in
            [(4, vec![]), (4, vec![30, 31]), (4, vec![5, 30]), (4, vec![5, 17]), (40, vec![5, 6, 7])]
        {
            let (pattern, mut values, groups) = grid(m);
            for i in [5, 17] {
                values[pattern.slot(i, i).unwrap()] = -1.0;
            }
            let n = pattern.size();
            let exact: Vec<f64> = (0..n).map(|i| (i as f64 * 0.7).sin()).collect();
            let (mut rhs, mut x, mut out) = (vec![0.0; n], Vec::new(), vec![0.0; n]);
            pattern.multiply_add(&values, &exact, &mut rhs);
            let elimination = Arc::new(Elimination::new(&pattern, &groups, &last).unwrap());
            let mut condensed = Condensed::new(&elimination, Precision::Double);
            assert_eq!(condensed.factor(|k| values[k]), Ok(false));
            condensed.eliminate_into(&rhs, &mut x);
            let mut saddle = Saddle::default();
            saddle.begin(condensed.schur(), elimination.schur_size(), 0);
            saddle.factor().unwrap();
            saddle.solve(condensed.schur_part(&mut x), &mut []);
            condensed.substitute_into(&mut x, &mut out);
            let error = out.iter().zip(&exact).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
            assert!(error < 1e-12, "{last:?}: {error:e}");
        }
        let (pattern, mut values, groups) = grid(4);
        values[pattern.slot(5, 5).unwrap()] = f64::NAN;
        let elimination = Arc::new(Elimination::new(&pattern, &groups, &[]).unwrap());
        let factor = Condensed::new(&elimination, Precision::Double).factor(|k| values[k]);
        assert!(matches!(factor, Err(LinearError::Singular { .. })));
    }
}
