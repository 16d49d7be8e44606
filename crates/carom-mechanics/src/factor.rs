//! The factor used by Newton's method: restored, prepared for the rows of an iterate, or
//! recomputed.

use std::sync::Arc;

use crate::constraints::Constraints;
use crate::equations::Equations;
use crate::evaluation::Evaluation;
use crate::rejected::Rejected;
use crate::renewal::{Point, Renewal};
use crate::timings::timed;
use crate::workspace::Workspace;

impl Workspace {
    /// Recomputes the factor of the state's point, which only a resumed run lacks.
    ///
    /// # Errors
    /// If a cell is inverted there.
    pub(crate) fn restore_factor(
        &mut self,
        equations: &Equations,
        renewal: &Renewal,
    ) -> Result<(), Rejected> {
        match renewal.frozen.point.clone() {
            Some(point) if !renewal.due => self.factor_at(equations, &point, renewal.double).map(|_| ()),
            _ => Ok(()),
        }
    }

    /// Prepares a factor for these rows, a new one if due.
    ///
    /// # Errors
    /// If a cell is inverted, or the rows are linearly dependent.
    pub(crate) fn factor_for(
        &mut self,
        equations: &Equations,
        now: &Evaluation,
        rows: &Constraints,
        renewal: &mut Renewal,
    ) -> Result<(), Rejected> {
        for again in [true, false] {
            if renewal.due || !self.system.preconditioner.spans(rows) {
                self.renew(equations, now, rows, renewal)?;
            }
            let Self { system, timings, .. } = self;
            let positive =
                timed(&mut timings.factor, || system.preconditioner.prepare(equations.model, rows))?;
            if positive || !again {
                break;
            }
            renewal.due = true;
        }
        Ok(())
    }

    /// Factors at the current positions, or else at those of the step's start.
    fn renew(
        &mut self,
        equations: &Equations,
        now: &Evaluation,
        rows: &Constraints,
        renewal: &mut Renewal,
    ) -> Result<(), Rejected> {
        renewal.due = false;
        let last = renewal.frozen.point.as_deref();
        let boundary = self.system.preconditioner.boundary(equations.model, &now.place, rows, last);
        // Far from the solution the tangent may be indefinite; with inertia, that at the step's
        // start is almost always positive definite.
        let (present, start) =
            [&now.place, &equations.state.y].map(|at| equations.point(at, &boundary)).into();
        let mut chosen = &present;
        if !self.factor_at(equations, &present, renewal.double)? && !equations.stage.is_static() {
            chosen = &start;
            if !self.factor_at(equations, &start, renewal.double)? {
                chosen = &present;
                self.factor_at(equations, &present, renewal.double)?;
            }
        }
        if renewal.frozen.point.as_ref() != Some(chosen) {
            renewal.renewed(chosen.clone());
        }
        Ok(())
    }

    /// Computes the factor of a point unless it exists; returns whether it is positive definite.
    fn factor_at(
        &mut self,
        equations: &Equations,
        point: &Arc<Point>,
        double: bool,
    ) -> Result<bool, Rejected> {
        let Self { system, timings, .. } = self;
        timed(&mut timings.factor, || system.tangent_at(equations.model, point, double))
    }
}
