//! faer's sparse LBLᵀ (Bunch–Kaufman inside supernodes) behind [`LinearSolver`].
//!
//! The matrix is equilibrated symmetrically (D A D with |diagonal| 1, multiplier rows scaled by their largest entry), ordered by approximate
//! minimum degree on the graph of groups, and factored on one thread: faer's sparse factorisations get slower with two.

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::cholesky::lblt::factor::LbltParams;
use faer::perm::PermRef;
use faer::sparse::linalg::cholesky::{
    CholeskySymbolicParams, IntranodeLbltRef, SymbolicCholesky, SymbolicCholeskyRaw, SymmetricOrdering,
    factorize_symbolic_cholesky,
};
use faer::sparse::linalg::{SupernodalThreshold, amd};
use faer::sparse::{SparseColMatRef, SymbolicSparseColMatRef};
use faer::{Conj, MatMut, Par, Side, Spec};

use crate::linear::{Inertia, LinearError, LinearSolver, SolveReport};
use crate::pattern::Pattern;

/// Residual at which iterative refinement stops.
const GOOD_RESIDUAL: f64 = 1e-15;
/// Residual above which a solution is refused.
const BAD_RESIDUAL: f64 = 1e-9;
const MAX_REFINEMENTS: usize = 3;

/// The default direct solver.
///
/// ```
/// use carom_algebra::{FaerSolver, LinearSolver, Pattern};
/// // A spring of stiffness 2 held by a multiplier: [2 1; 1 0] (x, λ) = (0, 3).
/// let pattern = Pattern::from_entries(2, [(1, 0)]);
/// let mut solver = FaerSolver::default();
/// solver.analyse(&pattern, &[0, 0]).unwrap();
/// solver.values().copy_from_slice(&[2.0, 1.0, 0.0]);
/// assert_eq!(solver.factor().unwrap().negative, 1);
/// let mut x = [0.0; 2];
/// solver.solve(&[0.0, 3.0], &mut x).unwrap();
/// assert!((x[0] - 3.0).abs() < 1e-14 && (x[1] + 6.0).abs() < 1e-14);
/// ```
#[derive(Default)]
pub struct FaerSolver {
    pattern: Pattern,
    values: Vec<f64>,
    scale: Vec<f64>,
    scaled: Vec<f64>,
    symbolic: Option<SymbolicCholesky<usize>>,
    factors: Vec<f64>,
    subdiagonal: Vec<f64>,
    pivots: Vec<usize>,
    pivots_inverse: Vec<usize>,
    scratch: Option<MemBuffer>,
    residual: Vec<f64>,
    correction: Vec<f64>,
}

impl FaerSolver {
    fn equilibrate(&mut self) {
        let n = self.pattern.size();
        self.scale.clear();
        self.scale.extend((0..n).map(|j| self.values[self.pattern.starts[j]].abs().sqrt().recip()));
        // A multiplier's diagonal is zero: scale its row by its largest entry after its dofs were scaled.
        let mut largest = vec![0.0_f64; 0];
        if self.scale.iter().any(|s| !s.is_finite()) {
            largest.resize(n, 0.0);
            for j in 0..n {
                for k in self.pattern.starts[j] + 1..self.pattern.starts[j + 1] {
                    let i = self.pattern.rows[k];
                    let value = self.values[k].abs();
                    if self.scale[j].is_finite() {
                        largest[i] = largest[i].max(value * self.scale[j]);
                    }
                    if self.scale[i].is_finite() {
                        largest[j] = largest[j].max(value * self.scale[i]);
                    }
                }
            }
        }
        for (j, &row) in largest.iter().enumerate() {
            if !self.scale[j].is_finite() {
                self.scale[j] = if row > 0.0 { row.recip() } else { 1.0 };
            }
        }
        self.scaled.clear();
        self.scaled.resize(self.values.len(), 0.0);
        for j in 0..n {
            for k in self.pattern.starts[j]..self.pattern.starts[j + 1] {
                self.scaled[k] = self.values[k] * self.scale[j] * self.scale[self.pattern.rows[k]];
            }
        }
    }

    /// Pivot signs; an error where one vanishes or is not finite.
    fn inertia(&self, symbolic: &SymbolicCholesky<usize>) -> Result<Inertia, LinearError> {
        let size = self.pattern.size();
        let mut inertia = Inertia::default();
        let mut count = |pivot: usize, value: f64| {
            if !value.is_finite() || value.abs() < f64::MIN_POSITIVE {
                return Err(LinearError::Singular { size, pivot, value });
            }
            if value > 0.0 {
                inertia.positive += 1;
            } else {
                inertia.negative += 1;
            }
            Ok(())
        };
        match symbolic.raw() {
            SymbolicCholeskyRaw::Simplicial(raw) => {
                for (j, &start) in raw.col_ptr()[..size].iter().enumerate() {
                    count(j, self.factors[start])?;
                }
            }
            SymbolicCholeskyRaw::Supernodal(raw) => {
                for s in 0..raw.n_supernodes() {
                    let (begin, end) = (raw.supernode_begin()[s], raw.supernode_end()[s]);
                    let first = raw.col_ptr_for_val()[s];
                    let height = (raw.col_ptr_for_val()[s + 1] - first) / (end - begin).max(1);
                    let diagonal = |j: usize| self.factors[first + (j - begin) * (height + 1)];
                    let mut j = begin;
                    while j < end {
                        let off = self.subdiagonal[j];
                        if off == 0.0 {
                            count(j, diagonal(j))?;
                            j += 1;
                        } else {
                            // Bunch–Kaufman takes a 2 × 2 block only where its determinant is negative: one pivot of each sign.
                            let det = diagonal(j) * diagonal(j + 1) - off * off;
                            count(j, det)?;
                            count(j + 1, if det < 0.0 { 1.0 } else { diagonal(j) })?;
                            j += 2;
                        }
                    }
                }
            }
        }
        Ok(inertia)
    }
}

/// Elimination order: AMD on the graph of groups, each group expanded in ascending order.
pub(crate) fn grouped_ordering(pattern: &Pattern, groups: &[usize]) -> Result<(Vec<usize>, Vec<usize>), String> {
    let n = pattern.size();
    let count = groups.iter().max().map_or(0, |g| g + 1);
    let entries = (0..n).flat_map(|j| pattern.column(j).iter().map(move |&i| (groups[i], groups[j])));
    let quotient = Pattern::from_entries(count, entries);
    let graph = SymbolicSparseColMatRef::new_checked(count, count, &quotient.starts, None, &quotient.rows);
    let (mut order, mut inverse) = (vec![0_usize; count], vec![0_usize; count]);
    let mut scratch = MemBuffer::try_new(amd::order_maybe_unsorted_scratch::<usize>(count, quotient.len()))
        .map_err(|e| format!("{e:?}"))?;
    amd::order_maybe_unsorted(&mut order, &mut inverse, graph, amd::Control::default(), MemStack::new(&mut scratch))
        .map_err(|e| format!("{e:?}"))?;
    let mut members: Vec<Vec<usize>> = vec![Vec::new(); count];
    for (i, &g) in groups.iter().enumerate() {
        members[g].push(i);
    }
    let forward: Vec<usize> = order.iter().flat_map(|&g| members[g].iter().copied()).collect();
    let mut backward = vec![0; n];
    for (place, &i) in forward.iter().enumerate() {
        backward[i] = place;
    }
    Ok((forward, backward))
}

impl LinearSolver for FaerSolver {
    fn analyse(&mut self, pattern: &Pattern, groups: &[usize]) -> Result<(), LinearError> {
        let n = pattern.size();
        let engine = |reason: String| LinearError::Engine { size: n, reason };
        self.pattern.clone_from(pattern);
        self.values.clear();
        self.values.resize(pattern.len(), 0.0);
        self.symbolic = None;
        let (forward, backward) = grouped_ordering(pattern, groups).map_err(engine)?;
        let structure = SymbolicSparseColMatRef::new_checked(n, n, &pattern.starts, None, &pattern.rows);
        let params = CholeskySymbolicParams {
            supernodal_flop_ratio_threshold: SupernodalThreshold::FORCE_SUPERNODAL,
            ..Default::default()
        };
        let order = SymmetricOrdering::Custom(PermRef::new_checked(&forward, &backward, n));
        let symbolic =
            factorize_symbolic_cholesky(structure, Side::Lower, order, params).map_err(|e| engine(format!("{e:?}")))?;
        self.factors.clear();
        self.factors.resize(symbolic.len_val(), 0.0);
        self.subdiagonal.resize(n, 0.0);
        self.pivots.resize(n, 0);
        self.pivots_inverse.resize(n, 0);
        let space = symbolic
            .factorize_numeric_intranode_lblt_scratch::<f64>(Par::Seq, Spec::<LbltParams, f64>::default())
            .or(symbolic.solve_in_place_scratch::<f64>(1, Par::Seq));
        self.scratch = Some(MemBuffer::try_new(space).map_err(|e| engine(format!("{e:?}")))?);
        self.symbolic = Some(symbolic);
        Ok(())
    }

    fn values(&mut self) -> &mut [f64] {
        &mut self.values
    }

    fn factor(&mut self) -> Result<Inertia, LinearError> {
        let n = self.pattern.size();
        self.equilibrate();
        let (Some(symbolic), Some(scratch)) = (&self.symbolic, &mut self.scratch) else {
            return Err(LinearError::Engine { size: n, reason: "factor before analyse".into() });
        };
        let structure = SymbolicSparseColMatRef::new_checked(n, n, &self.pattern.starts, None, &self.pattern.rows);
        self.subdiagonal.fill(0.0);
        symbolic.factorize_numeric_intranode_lblt(
            &mut self.factors,
            &mut self.subdiagonal,
            &mut self.pivots,
            &mut self.pivots_inverse,
            SparseColMatRef::new(structure, &self.scaled),
            Side::Lower,
            Par::Seq,
            MemStack::new(scratch),
            Spec::default(),
        );
        self.inertia(symbolic)
    }

    fn solve(&mut self, rhs: &[f64], out: &mut [f64]) -> Result<SolveReport, LinearError> {
        let n = self.pattern.size();
        let (Some(symbolic), Some(scratch)) = (&self.symbolic, &mut self.scratch) else {
            return Err(LinearError::Engine { size: n, reason: "solve before factor".into() });
        };
        let pivots = PermRef::new_checked(&self.pivots, &self.pivots_inverse, n);
        let factors = IntranodeLbltRef::new(symbolic, &self.factors, &self.subdiagonal, pivots);
        self.residual.clear();
        self.residual.extend(rhs.iter().zip(&self.scale).map(|(b, s)| b * s));
        let rhs_norm = max_abs(&self.residual);
        let mut report = SolveReport::default();
        out.fill(0.0);
        loop {
            self.correction.clear();
            self.correction.extend_from_slice(&self.residual);
            let view = MatMut::from_column_major_slice_mut(&mut self.correction, n, 1);
            factors.solve_in_place_with_conj(Conj::No, view, Par::Seq, MemStack::new(scratch));
            for (x, c) in out.iter_mut().zip(&self.correction) {
                *x += c;
            }
            // Residual of the equilibrated system, whose entries are of order one.
            self.correction.fill(0.0);
            self.pattern.multiply_add(&self.scaled, out, &mut self.correction);
            for i in 0..n {
                self.residual[i] = rhs[i] * self.scale[i] - self.correction[i];
            }
            let size = rhs_norm + max_abs(out);
            let residual = if size > 0.0 { max_abs(&self.residual) / size } else { 0.0 };
            let stalled = report.refinements > 0 && residual > 0.5 * report.residual;
            report.residual = residual;
            if residual <= GOOD_RESIDUAL || stalled || report.refinements == MAX_REFINEMENTS || !residual.is_finite() {
                break;
            }
            report.refinements += 1;
        }
        for (x, s) in out.iter_mut().zip(&self.scale) {
            *x *= s;
        }
        if report.residual.is_finite() && report.residual <= BAD_RESIDUAL && out.iter().all(|x| x.is_finite()) {
            Ok(report)
        } else {
            Err(LinearError::Inaccurate { size: n, residual: report.residual })
        }
    }
}

fn max_abs(x: &[f64]) -> f64 {
    x.iter().fold(0.0, |m, v| if v.is_nan() { f64::NAN } else { m.max(v.abs()) })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A chain of `m` nodes with two dofs each, springs between neighbours, and a multiplier on every third node.
    fn chain(m: usize) -> (Pattern, Vec<f64>, Vec<usize>, usize) {
        let rows: Vec<usize> = (0..m).step_by(3).collect();
        let n = 2 * m + rows.len();
        let mut entries = Vec::new();
        for a in 0..m {
            entries.push((2 * a, 2 * a, 3.0));
            entries.push((2 * a + 1, 2 * a + 1, 4.0));
            entries.push((2 * a + 1, 2 * a, 0.5));
            if a + 1 < m {
                entries.push((2 * a + 2, 2 * a, -1.0));
                entries.push((2 * a + 3, 2 * a + 1, -1.5));
            }
        }
        let mut groups: Vec<usize> = (0..2 * m).map(|i| i / 2).collect();
        for (k, &a) in rows.iter().enumerate() {
            groups.push(a);
            entries.push((2 * m + k, 2 * a, 0.6));
            entries.push((2 * m + k, 2 * a + 1, 0.8));
            if a + 1 < m {
                entries.push((2 * m + k, 2 * a + 3, -1.0));
            }
        }
        let pattern = Pattern::from_entries(n, entries.iter().map(|&(i, j, _)| (i, j)));
        let mut values = vec![0.0; pattern.len()];
        for (i, j, v) in entries {
            values[pattern.slot(i, j).unwrap()] += v;
        }
        (pattern, values, groups, rows.len())
    }

    #[test]
    fn solves_saddle_points_of_every_size_with_the_inertia_of_their_multipliers() {
        for m in [1, 2, 5, 40, 300] {
            let (pattern, values, groups, multipliers) = chain(m);
            let n = pattern.size();
            let exact: Vec<f64> = (0..n).map(|i| (i as f64 * 0.7).sin()).collect();
            let mut rhs = vec![0.0; n];
            pattern.multiply_add(&values, &exact, &mut rhs);
            let mut solver = FaerSolver::default();
            solver.analyse(&pattern, &groups).unwrap();
            solver.values().copy_from_slice(&values);
            let inertia = solver.factor().unwrap();
            assert_eq!(inertia, Inertia { positive: 2 * m, negative: multipliers, zero: 0 });
            let mut x = vec![0.0; n];
            let report = solver.solve(&rhs, &mut x).unwrap();
            assert!(report.residual < 1e-14);
            let error = x.iter().zip(&exact).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
            assert!(error < 1e-12, "{m}: {error:e}");
        }
    }

    #[test]
    fn badly_scaled_rows_keep_their_digits() {
        let (pattern, mut values, groups, multipliers) = chain(30);
        let n = pattern.size();
        let scale: Vec<f64> = (0..n).map(|i| if i < 60 { 1e6 } else { 1e-3 }).collect();
        for j in 0..n {
            for k in pattern.starts[j]..pattern.starts[j + 1] {
                values[k] *= scale[j] * scale[pattern.rows[k]];
            }
        }
        let exact: Vec<f64> = (0..n).map(|i| (i as f64 * 0.3).cos() / scale[i]).collect();
        let mut rhs = vec![0.0; n];
        pattern.multiply_add(&values, &exact, &mut rhs);
        let mut solver = FaerSolver::default();
        solver.analyse(&pattern, &groups).unwrap();
        solver.values().copy_from_slice(&values);
        assert_eq!(solver.factor().unwrap().negative, multipliers);
        let mut x = vec![0.0; n];
        solver.solve(&rhs, &mut x).unwrap();
        for i in 0..n {
            assert!(((x[i] - exact[i]) * scale[i]).abs() < 1e-11);
        }
    }

    #[test]
    fn a_singular_matrix_is_an_error_with_a_name() {
        let pattern = Pattern::from_entries(2, [(1, 0)]);
        let mut solver = FaerSolver::default();
        solver.analyse(&pattern, &[0, 0]).unwrap();
        solver.values().copy_from_slice(&[0.0, 0.0, 0.0]);
        assert!(matches!(solver.factor(), Err(LinearError::Singular { .. })));
    }
}
