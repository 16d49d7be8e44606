//! The linear problem of a Newton iteration: a matrix-free tangent, preconditioned by the reused
//! factor.
//!
//! ```text
//! [ K  Fᵀ ] [Δy]   [−r]       K = w.mass a' M + w.internal K_int − w.external K_ext + Σ w.contact λ∇F   at the iterate
//! [ G  −C ] [Δλ] = [−c]       G = ∇g,   F: direction of the forces, G itself, a discrete gradient of g, or ∇g − μ Σ d_α H_α of a slip
//! ```
//!
//! Each correction is the factor's solution for the current residual. Mixed
//! (`carom_algebra::Mixing`) they are the iterates of left-preconditioned GMRES. The first is the
//! correction of an iteration with the reused factor alone: where it suffices, the tangent is never
//! applied. While factor and rows are unchanged and full steps are taken, the mixing history
//! carries over to the next iteration. K need not be symmetric (follower pressures, discrete
//! gradients), nor positive definite.

use carom_algebra::sums::max_abs;
use carom_algebra::{LinearError, Mixing};

use crate::contact::constraints::Constraints;
use crate::linear::preconditioner::Preconditioner;
use crate::linear::wholes::Wholes;
use crate::model::Model;
use crate::rejected::Rejected;
use crate::stage::equations::Equations;
use crate::stage::evaluation::Evaluation;
use crate::stage::renewal::Renewal;
use crate::timings::{Timings, timed};

/// Maximum number of solves of one linear problem; then the current solution is used.
const MOST_SOLVES: u32 = 30;

/// Correction, as a fraction of L, from which on the bodies' balance is closed.
const LATE: f64 = 1e-6;

/// The step of a Newton iteration.
#[derive(Debug, Default)]
pub(crate) struct Correction {
    /// Δy.
    pub increment: Vec<f64>,
    /// Δλ, one per row; unused for springs, whose multiplier follows from their gap.
    pub multipliers: Vec<f64>,
    /// ‖·‖∞ of the first correction and of the last.
    pub first: f64,
    pub last: f64,
    /// Number of solves.
    pub solves: u32,
}

/// Stopping criteria of a linear problem.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Goal {
    /// Remainder relative to the first correction.
    pub forcing: f64,
    /// Correction at which the stage converges.
    pub step: f64,
    /// The factor was made at this iterate: refactoring would not change it.
    pub fresh: bool,
    /// A first correction larger than this is useless: it is returned as it is.
    pub trust: f64,
    /// Number of earlier corrections that are mixed with each.
    pub mixing: usize,
}

/// Right-hand sides, buffers and the history of corrections.
#[derive(Debug, Default)]
pub struct LinearProblem {
    forces: Vec<f64>,
    gaps: Vec<f64>,
    increment: Vec<f64>,
    multipliers: Vec<f64>,
    product: Vec<f64>,
    wholes: Wholes,
    mixing: Mixing,
    /// Size of the last correction, if comparable with the next.
    comparable: Option<f64>,
    /// Contact and pair of each row, and whether it is one of friction.
    rows: Vec<((usize, usize), bool)>,
}

impl LinearProblem {
    /// Buffers for a model.
    pub(crate) fn new(model: &Model) -> Self {
        Self { wholes: Wholes::new(model), mixing: Mixing::on(&model.threads), ..Self::default() }
    }

    /// Clears the history: with another factor, other rows, or after a shortened step it is
    /// meaningless.
    pub(crate) fn restart(&mut self) {
        self.comparable = None;
        self.mixing.restart();
    }

    /// Solves to the goal, or until a new factor is due.
    ///
    /// # Errors
    /// If a cell is inverted where the tangent is applied, or a solve failed.
    pub(crate) fn solve(
        &mut self,
        equations: &Equations,
        now: &Evaluation,
        rows: &Constraints,
        preconditioner: &mut dyn Preconditioner,
        renewal: &mut Renewal,
        goal: Goal,
        timings: &mut Timings,
    ) -> Result<Correction, Rejected> {
        let names = || rows.list.iter().map(|row| (row.place, row.slip.is_some()));
        if goal.fresh || !names().eq(self.rows.iter().copied()) {
            self.restart();
            self.rows.clear();
            self.rows.extend(names());
        }
        self.begin(equations, now, rows, timings)?;
        let mut total = Correction::default();
        (total.increment, total.multipliers) = (self.increment.clone(), vec![0.0; rows.len()]);
        loop {
            self.correct(equations, rows, preconditioner, goal.mixing, &mut total, timings)?;
            if total.last == 0.0 {
                // Without a residual no correction can be compared with another one.
                self.restart();
                return Ok(total);
            }
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
            self.subtract_product(equations, now, rows, timings)?;
        }
    }

    /// Right-hand sides, minus the contribution of the remaining displacements of prescribed dofs,
    /// which are in `increment`.
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
        self.gaps.extend(rows.list.iter().map(|row| -row.weight * row.open));
        self.increment.clear();
        self.increment.resize(now.residual.len(), 0.0);
        self.multipliers.clear();
        self.multipliers.resize(rows.len(), 0.0);
        let mut remaining = false;
        for (dof, distance) in equations.remaining(&now.at) {
            self.increment[dof] = distance;
            remaining |= distance != 0.0;
        }
        equations.model.points.carry(&mut self.increment);
        if remaining { self.subtract_product(equations, now, rows, timings) } else { Ok(()) }
    }

    /// One more correction with the factor, into `increment` and `multipliers`, added to `total`.
    fn correct(
        &mut self,
        equations: &Equations,
        rows: &Constraints,
        preconditioner: &mut dyn Preconditioner,
        depth: usize,
        total: &mut Correction,
        timings: &mut Timings,
    ) -> Result<(), LinearError> {
        timed(&mut timings.solve, || {
            preconditioner.solve(
                equations.model,
                [&self.forces, &self.gaps],
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
        self.complete(equations, rows);
        total.increment.iter_mut().zip(&self.increment).for_each(|(total, change)| *total += change);
        total.multipliers.iter_mut().zip(&self.multipliers).for_each(|(total, change)| *total += change);
        Ok(())
    }

    /// The matrix times increments and multipliers.
    ///
    /// # Errors
    /// If a cell is inverted where the tangent is applied.
    pub fn product(
        equations: &Equations,
        now: &Evaluation,
        rows: &Constraints,
        [increment, multipliers]: [Vec<f64>; 2],
    ) -> Result<[Vec<f64>; 2], Rejected> {
        let forces = vec![0.0; increment.len()];
        let gaps = vec![0.0; multipliers.len()];
        let mut problem = Self { forces, gaps, increment, multipliers, ..Self::default() };
        problem.subtract_product(equations, now, rows, &mut Timings::default())?;
        Ok([problem.forces, problem.gaps].map(|right| right.iter().map(|value| -value).collect()))
    }

    /// Subtracts the effect of the last correction from the right-hand sides.
    fn subtract_product(
        &mut self,
        equations: &Equations,
        now: &Evaluation,
        rows: &Constraints,
        timings: &mut Timings,
    ) -> Result<(), Rejected> {
        self.product.resize(self.forces.len(), 0.0);
        equations.product_into(now, &self.increment, &mut self.product, timings)?;
        self.forces.iter_mut().zip(&self.product).for_each(|(right, product)| *right -= product);
        rows.subtract_forces([&self.increment, &self.multipliers], &mut self.forces);
        rows.subtract_gaps([&self.increment, &self.multipliers], &mut self.gaps);
        Ok(())
    }

    /// Completes a correction by the translations of the bodies.
    fn complete(&mut self, equations: &Equations, rows: &Constraints) {
        let model = equations.model;
        // What earlier corrections leave, the next ones correct. Pressures that follow their sides
        // change their resultant with the shape.
        let is_late = max_abs(&self.increment) <= LATE * model.scale;
        if !is_late || equations.stage.is_static() || model.loads.follow_sides() {
            return;
        }
        self.product.clone_from(&self.forces);
        rows.subtract_forces([&self.increment, &self.multipliers], &mut self.product);
        self.wholes.complete(&self.product, equations.mass_factor(), rows, &mut self.increment);
    }
}
