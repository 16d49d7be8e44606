//! The tangent where it is formed: for the kept factor, where one is due; in full, where there is none to keep.

use std::sync::Arc;

use carom_algebra::LinearError;

use crate::constraints::Constraints;
use crate::equations::{Equations, Evaluation};
use crate::kept_factor::boundary;
use crate::linear_problem::Correction;
use crate::model::check_held;
use crate::rejected::Rejected;
use crate::renewal::{Point, Renewal};
use crate::sums::max_abs;
use crate::timings::timed;
use crate::workspace::Workspace;

impl Workspace {
    /// Makes the factor that the state's point asks for: there already, but in a run that was resumed. Where there is none, a new one is due.
    ///
    /// # Errors
    /// A cell is inverted there.
    pub(crate) fn restore_factor(
        &mut self,
        equations: &Equations,
        renewal: &mut Renewal,
        double: bool,
    ) -> Result<(), Rejected> {
        if !renewal.due {
            renewal.due = match renewal.kept.point.clone() {
                Some(point) => !self.hold(equations, &point, double)?,
                None => true,
            };
        }
        Ok(())
    }

    /// Has a factor ready for these rows, a new one where it is due; whether there is one.
    ///
    /// # Errors
    /// A cell is inverted.
    pub(crate) fn factor_for(
        &mut self,
        equations: &Equations,
        now: &Evaluation,
        rows: &Constraints,
        renewal: &mut Renewal,
        double: bool,
    ) -> Result<bool, Rejected> {
        for _ in 0..2 {
            if (renewal.due || !self.system.kept.covers(rows))
                && !self.renew(equations, now, rows, renewal, double)?
                && !self.system.kept.covers(rows)
            {
                return Ok(false);
            }
            let Self { system, timings, .. } = self;
            if timed(&mut timings.factor, || system.kept.prepare(equations.model, rows)).is_ok() {
                return Ok(true);
            }
            renewal.due = true;
        }
        Ok(false)
    }

    /// Makes a factor at the present positions, or else at the start of the step; whether there is another now.
    fn renew(
        &mut self,
        equations: &Equations,
        now: &Evaluation,
        rows: &Constraints,
        renewal: &mut Renewal,
        double: bool,
    ) -> Result<bool, Rejected> {
        renewal.due = false;
        let boundary = boundary(equations.model, &now.place, rows, renewal.kept.point.as_deref());
        let (mass, stiffness) = (equations.mass_factor(), equations.factor_stiffness());
        // An iterate far from the solution may have no positive definite tangent; the state the step began with nearly always has.
        for at in [&now.place, &equations.state.y] {
            let point = Arc::new(Point { at: at.clone(), mass, stiffness, boundary: boundary.clone() });
            if self.system.kept.is_of(&point) {
                // The same factor again is of no help.
                return Ok(false);
            }
            if self.hold(equations, &point, double)? {
                renewal.renewed(point);
                return Ok(true);
            }
        }
        Ok(false)
    }

    /// Makes the factor of a point, unless it is there already; whether there is one.
    fn hold(&mut self, equations: &Equations, point: &Arc<Point>, double: bool) -> Result<bool, Rejected> {
        let Self { system, right, timings, .. } = self;
        timed(&mut timings.factor, || system.hold(equations.model, point, double, right))
            .map_err(|(body, inverted)| Rejected::Inverted { body, inverted })
    }

    /// The correction with the tangent of the iterate, formed and factored.
    ///
    /// # Errors
    /// A cell is inverted, nothing holds a body, or the system is singular.
    pub(crate) fn full_correction(
        &mut self,
        equations: &Equations,
        now: &Evaluation,
        rows: &Constraints,
    ) -> Result<Correction, Rejected> {
        let (model, stage) = (equations.model, &equations.stage);
        if stage.is_static() {
            check_held(&model.parts, &model.unheld, &now.place, rows.rows.iter())?;
        }
        let Self { system, right, pull, timings, .. } = self;
        // What moved supports still have to go pulls at their neighbours.
        let mut increment = vec![0.0; model.dofs()];
        equations.remaining(&now.at).for_each(|(dof, left)| increment[dof] = left);
        let (before, at) =
            if equations.between() { (Some(&equations.state.y[..]), &now.y) } else { (None, &now.place) };
        timed(&mut timings.assembly, || system.internal_tangent(model, before, at, right, Some((&increment, pull))))
            .map_err(|(body, inverted)| Rejected::Inverted { body, inverted })?;
        if model.loads.follow() {
            system.loads_tangent(model, &equations.loads);
        }
        let (mass, stiffness) = (equations.mass_factor(), equations.stiffness_factor());
        let inertia =
            timed(&mut timings.factor, || system.factor(model, mass, stiffness, equations.follower_factor(), rows))?;
        if inertia.negative < rows.len() {
            let size = model.free.len() + rows.len();
            return Err(LinearError::Singular { size, pivot: inertia.negative, value: 0.0 }.into());
        }
        let open = rows.open.iter().zip(rows.rows.iter()).map(|(open, row)| open + row.along(&increment));
        let gaps: Vec<f64> = rows.weights.iter().zip(open).map(|(weight, open)| -weight * open).collect();
        for ((right, r), pull) in right.iter_mut().zip(&now.residual).zip(pull) {
            *right = -(r + stiffness * *pull);
        }
        let mut multipliers = Vec::new();
        timed(&mut timings.solve, || system.solve(model, right, &gaps, &mut increment, &mut multipliers))?;
        equations.remaining(&now.at).for_each(|(dof, left)| increment[dof] = left);
        let size = max_abs(&increment);
        Ok(Correction { increment, multipliers, first: size, last: size, solves: 1 })
    }
}
