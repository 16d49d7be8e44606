//! The factor that Newton's method has at hand: found again, taken up for the rows of an iterate,
//! made anew.

use std::sync::Arc;

use crate::constraints::Constraints;
use crate::equations::{Equations, Evaluation};
use crate::rejected::Rejected;
use crate::renewal::{Point, Renewal};
use crate::tangent_factor::boundary;
use crate::timings::timed;
use crate::workspace::Workspace;

impl Workspace {
    /// Makes the factor that the state's point asks for: there already, but in a run that was
    /// resumed.
    ///
    /// # Errors
    /// A cell is inverted there.
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

    /// Has a factor ready for these rows, a new one where it is due.
    ///
    /// # Errors
    /// A cell is inverted, or the rows depend on each other.
    pub(crate) fn factor_for(
        &mut self,
        equations: &Equations,
        now: &Evaluation,
        rows: &Constraints,
        renewal: &mut Renewal,
    ) -> Result<(), Rejected> {
        for again in [true, false] {
            if renewal.due || !self.system.factor.spans(rows) {
                self.renew(equations, now, rows, renewal)?;
            }
            let Self { system, timings, .. } = self;
            let positive = timed(&mut timings.factor, || system.factor.prepare(equations.model, rows))?;
            if positive || !again {
                break;
            }
            renewal.due = true;
        }
        Ok(())
    }

    /// Makes a factor at the present positions, or else at the start of the step.
    fn renew(
        &mut self,
        equations: &Equations,
        now: &Evaluation,
        rows: &Constraints,
        renewal: &mut Renewal,
    ) -> Result<(), Rejected> {
        renewal.due = false;
        let boundary = boundary(equations.model, &now.place, rows, renewal.frozen.point.as_deref());
        // An iterate far from the solution may have no positive definite tangent; the state the
        // step began with nearly always has, with inertia.
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

    /// Makes the factor of a point, unless it is there already; whether it is positive definite.
    fn factor_at(
        &mut self,
        equations: &Equations,
        point: &Arc<Point>,
        double: bool,
    ) -> Result<bool, Rejected> {
        let Self { system, timings, .. } = self;
        timed(&mut timings.factor, || system.factor_at(equations.model, point, double))
    }
}
