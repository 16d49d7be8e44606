//! Newton's step with the kept factor: had from the point in the state, made anew where that is due, given up where there is none.
//!
//! When it is due is the policy of `kept.rs`; what the factor is, that of `held.rs`.

use std::sync::Arc;

use carom_algebra::LinearError;
use carom_time::Internal;

use crate::constraints::Constraints;
use crate::equations::{Equations, Evaluation, Iterate};
use crate::held::boundary;
use crate::kept::{Keeper, Point};
use crate::rejected::Rejected;
use crate::settings::Tangent;
use crate::system::HoldError;
use crate::timings::timed;
use crate::workspace::Workspace;

/// Whether a tangent of another time serves: not where the iteration itself moves supports, loads turn with the body, nothing but the tangent holds a
/// body, forces are a discrete gradient or springs, or a predictor is projected between the steps.
pub(crate) fn keeps(equations: &Equations) -> bool {
    let model = equations.model;
    equations.motions.is_empty()
        && !model.loads.follow()
        && !equations.stage.is_static()
        && equations.stage.internal == Internal::Gradient
        && model.contacts.iter().all(|contact| contact.interface.is_constraint() && !contact.predictor)
}

/// The first evaluation, and the kept factor where there is one to keep.
pub(crate) fn begin(
    equations: &Equations,
    guess: Iterate,
    work: &mut Workspace,
    keeper: &mut Keeper,
) -> Result<Evaluation, Rejected> {
    let now = equations.evaluate(guess, &mut work.spare, &mut work.timings)?;
    if !keeper.full {
        let held = if let Some(point) = keeper.kept.point.clone().filter(|_| !keeper.due) {
            hold(equations, work, &point, keeper.rule)?
        } else {
            renew(equations, &now, work, &Constraints::of(equations, &now), keeper)?
        };
        if held {
            return Ok(now);
        }
        keeper.refused();
    }
    work.system.release();
    Ok(now)
}

/// Makes the factor of a point; whether there is one.
fn hold(equations: &Equations, work: &mut Workspace, point: &Arc<Point>, rule: Tangent) -> Result<bool, Rejected> {
    let (system, scratch) = (&mut work.system, &mut work.correction);
    let double = rule == Tangent::KeptDouble;
    match timed(&mut work.timings.factor, || system.hold(equations.model, point, double, scratch)) {
        Ok(()) => Ok(true),
        Err(HoldError::Indefinite) => Ok(false),
        Err(HoldError::Inverted((body, inverted))) => Err(Rejected::Inverted { body, inverted }),
    }
}

/// Makes a factor at the present positions, or else at the start of the step; whether there is one.
fn renew(
    equations: &Equations,
    now: &Evaluation,
    work: &mut Workspace,
    rows: &Constraints,
    keeper: &mut Keeper,
) -> Result<bool, Rejected> {
    let boundary = boundary(equations.model, &now.place, rows, keeper.kept.point.as_deref());
    let (mass, stiffness) = (equations.mass_factor(), equations.stiffness_factor());
    // An iterate far from the solution may have no positive definite tangent; the state the step began with nearly always has.
    for at in [&now.place, &equations.state.y] {
        let point = Arc::new(Point { at: at.clone(), mass, stiffness, boundary: boundary.clone() });
        if work.system.holds(&point) {
            // The same factor again is of no help.
            return Ok(false);
        }
        if hold(equations, work, &point, keeper.rule)? {
            keeper.renewed(point);
            return Ok(true);
        }
    }
    Ok(false)
}

/// Solves with the kept factor, made anew where that is due; false where there is none.
pub(crate) fn kept_step(
    equations: &Equations,
    now: &Evaluation,
    work: &mut Workspace,
    rows: &Constraints,
    keeper: &mut Keeper,
) -> Result<bool, Rejected> {
    let mut fresh = false;
    while !keeper.helpless() {
        if !fresh && (keeper.due || !work.system.covers(rows)) {
            if !renew(equations, now, work, rows, keeper)? {
                break;
            }
            fresh = true;
        }
        if try_kept(equations, now, work, rows).is_ok() {
            return Ok(true);
        }
        if fresh {
            break;
        }
        keeper.due = true;
    }
    keeper.refused();
    work.system.release();
    Ok(false)
}

/// Solves for `work.correction` and `work.multipliers` with the kept factor.
fn try_kept(
    equations: &Equations,
    now: &Evaluation,
    work: &mut Workspace,
    rows: &Constraints,
) -> Result<(), LinearError> {
    let Workspace { system, timings, right, correction, multipliers, .. } = work;
    let gaps: Vec<f64> = rows.weights.iter().zip(&rows.open).map(|(w, open)| -w * open).collect();
    timed(&mut timings.factor, || system.constrain(equations.model, rows))?;
    right.clear();
    right.extend(now.residual.iter().map(|r| -r));
    timed(&mut timings.solve, || system.solve(equations.model, right, &gaps, correction, multipliers))
}
