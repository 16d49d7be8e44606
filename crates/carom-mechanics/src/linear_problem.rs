//! The linear problem of a Newton iteration: the tangent applied cell by cell and never formed, the
//! kept factor as preconditioner.
//!
//! ```text
//! [ K  Gᵀ ] [Δy]   [−r]       K = w.mass a' M + w.internal K_int − w.external K_ext + Σ w.contact λ∇²g   at the iterate
//! [ G  −C ] [Δλ] = [−c]
//! ```
//!
//! Each correction is that of the factor for what the ones before leave over; mixed (`mixing.rs`)
//! they are the iterates of GMRES preconditioned from the left, and the first is the correction
//! that an iteration with the kept factor alone would take: where that is enough, nothing is
//! applied. As long as factor and rows stay and full steps are taken, what has been learnt serves
//! the next iteration too. K need not be symmetric (pressures that follow, discrete gradients), nor
//! positive definite.

use carom_algebra::LinearError;

use crate::constraints::Constraints;
use crate::equations::{Equations, Evaluation};
use crate::mixing::Mixing;
use crate::rejected::Rejected;
use crate::renewal::Renewal;
use crate::sums::max_abs;
use crate::tangent_factor::TangentFactor;
use crate::timings::{Timings, timed};

/// Solves of one linear problem; then what has been found is taken as it is.
const MOST_SOLVES: u32 = 30;

/// The step of a Newton iteration.
#[derive(Debug, Default)]
pub(crate) struct Correction {
    /// Δy.
    pub increment: Vec<f64>,
    /// Δλ, one per row; of springs it means nothing, their multiplier is that of their gap.
    pub multipliers: Vec<f64>,
    /// ‖·‖∞ of the first correction and of the last.
    pub first: f64,
    pub last: f64,
    /// Solves it took.
    pub solves: u32,
}

/// How far a linear problem is to be solved.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Goal {
    /// Share of its first correction that may be left over.
    pub forcing: f64,
    /// Correction that ends the stage.
    pub step: f64,
    /// The factor was made at this iterate: another one would be the same.
    pub fresh: bool,
    /// A first correction larger than this is of no use: it is returned as it is.
    pub trust: f64,
}

/// Right-hand sides and buffers, and what the last corrections have shown.
#[derive(Debug, Default)]
pub(crate) struct LinearProblem {
    forces: Vec<f64>,
    gaps: Vec<f64>,
    increment: Vec<f64>,
    multipliers: Vec<f64>,
    product: Vec<f64>,
    mixing: Mixing,
    /// Size of the last correction, where the next one compares with it.
    comparable: Option<f64>,
    rows: Vec<(usize, usize)>,
}

impl LinearProblem {
    /// With another factor, other rows, or after a shortened step, the corrections so far say
    /// nothing.
    pub(crate) fn restart(&mut self) {
        self.comparable = None;
        self.mixing.restart();
    }

    /// Solves to the goal, or until a new factor is due; `depth` earlier corrections are
    /// remembered.
    ///
    /// # Errors
    /// A cell is inverted where the tangent is applied, or a solve failed.
    pub(crate) fn solve(
        &mut self,
        equations: &Equations,
        now: &Evaluation,
        rows: &Constraints,
        factor: &mut TangentFactor,
        renewal: &mut Renewal,
        goal: Goal,
        depth: usize,
        timings: &mut Timings,
    ) -> Result<Correction, Rejected> {
        if goal.fresh || self.rows != rows.places {
            self.restart();
            self.rows.clone_from(&rows.places);
        }
        self.begin(equations, now, rows, timings)?;
        let mut total = Correction::default();
        (total.increment, total.multipliers) = (self.increment.clone(), vec![0.0; rows.len()]);
        loop {
            self.correct(equations, factor, depth, &mut total, timings)?;
            if let Some(last) = self.comparable.replace(total.last) {
                renewal.observe(total.last / last);
            }
            if total.first > goal.trust {
                return Ok(total);
            }
            renewal.due = !goal.fresh && renewal.pays(total.last, goal.step);
            let enough = renewal.solves(total.last, goal.forcing * total.first) <= 0.0;
            if renewal.due || enough || total.solves == MOST_SOLVES {
                return Ok(total);
            }
            self.take_off(equations, now, rows, timings)?;
        }
    }

    /// Right-hand sides, less what the way that moved supports still have to go brings; that way is
    /// in `increment`.
    fn begin(
        &mut self,
        equations: &Equations,
        now: &Evaluation,
        rows: &Constraints,
        timings: &mut Timings,
    ) -> Result<(), Rejected> {
        self.forces.clear();
        self.forces.extend(now.residual.iter().map(|r| -r));
        self.gaps.clear();
        self.gaps.extend(rows.weights.iter().zip(&rows.open).map(|(w, open)| -w * open));
        self.increment.clear();
        self.increment.resize(now.residual.len(), 0.0);
        self.multipliers.clear();
        self.multipliers.resize(rows.len(), 0.0);
        let mut remaining = false;
        for (dof, left) in equations.remaining(&now.at) {
            self.increment[dof] = left;
            remaining |= left != 0.0;
        }
        if remaining { self.take_off(equations, now, rows, timings) } else { Ok(()) }
    }

    /// One more correction with the factor, into `increment` and `multipliers`, and added up.
    fn correct(
        &mut self,
        equations: &Equations,
        factor: &mut TangentFactor,
        depth: usize,
        total: &mut Correction,
        timings: &mut Timings,
    ) -> Result<(), LinearError> {
        timed(&mut timings.solve, || {
            factor.solve(
                equations.model,
                &self.forces,
                &self.gaps,
                &mut self.increment,
                &mut self.multipliers,
            )
        })?;
        total.last = max_abs(&self.increment);
        if total.solves == 0 {
            total.first = total.last;
        }
        total.solves += 1;
        self.mixing.improve([&mut self.increment, &mut self.multipliers], depth);
        total.increment.iter_mut().zip(&self.increment).for_each(|(total, part)| *total += part);
        total.multipliers.iter_mut().zip(&self.multipliers).for_each(|(total, part)| *total += part);
        Ok(())
    }

    /// The matrix times increments and multipliers, for tests.
    #[cfg(test)]
    pub(crate) fn product(
        equations: &Equations,
        now: &Evaluation,
        rows: &Constraints,
        [increment, multipliers]: [Vec<f64>; 2],
    ) -> [Vec<f64>; 2] {
        let (forces, gaps) = (vec![0.0; increment.len()], vec![0.0; multipliers.len()]);
        let mut problem = Self { forces, gaps, increment, multipliers, ..Self::default() };
        problem.take_off(equations, now, rows, &mut Timings::default()).unwrap();
        [problem.forces, problem.gaps].map(|right| right.iter().map(|value| -value).collect())
    }

    /// Takes what the last correction brings off the right-hand sides.
    fn take_off(
        &mut self,
        equations: &Equations,
        now: &Evaluation,
        rows: &Constraints,
        timings: &mut Timings,
    ) -> Result<(), Rejected> {
        self.product.resize(self.forces.len(), 0.0);
        equations.product_into(now, &self.increment, &mut self.product, timings)?;
        self.forces.iter_mut().zip(&self.product).for_each(|(right, product)| *right -= product);
        for r in 0..rows.len() {
            let (row, weight) = (rows.rows.row(r), rows.weights[r]);
            let approach = row.along(&self.increment);
            let multiplier = if rows.compliances[r] == 0.0 {
                self.gaps[r] -= weight * approach;
                self.multipliers[r]
            } else {
                approach / rows.compliances[r]
            };
            row.add_to(-weight * multiplier, &mut self.forces);
            let curvature = rows.curvatures[r].chunks_exact(row.gradient.len());
            for ((dof, _), curved) in row.entries().zip(curvature) {
                let bent: f64 =
                    curved.iter().zip(row.entries()).map(|(c, (other, _))| c * self.increment[other]).sum();
                self.forces[dof] -= weight * bent;
            }
        }
        Ok(())
    }
}
