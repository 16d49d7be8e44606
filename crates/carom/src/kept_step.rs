//! Newton's step with the kept factor: had from the point in the state, made anew where that is due, given up where there is none.
//!
//! When it is due is the policy of `kept.rs`; what the factor is, that of `held.rs`.

use std::sync::Arc;

use carom_algebra::LinearError;
use carom_time::Internal;

use crate::balance::contact_weights;
use crate::case::TangentRule;
use crate::evaluation::{Measure, Trial, evaluate, mass_factor, stiffness_factor};
use crate::held::boundary;
use crate::kept::{Keeper, Point};
use crate::model::Model;
use crate::rejected::Rejected;
use crate::rows::independent_rows;
use crate::state::State;
use crate::system::{HoldError, Row};
use crate::workspace::{Workspace, timed};

/// Whether a tangent of another time serves: not where the iteration itself moves supports, loads turn with the body, nothing but the tangent holds a
/// body, forces are a discrete gradient or springs, or a predictor is projected between the steps.
pub(crate) fn keeps<const D: usize>(model: &Model<D>, work: &Workspace<D>) -> bool {
    work.motions.is_empty()
        && !model.loads.follow()
        && !work.stage.is_static()
        && work.stage.internal == Internal::Gradient
        && model.contacts.iter().all(|contact| contact.penalty.is_none() && !contact.predictor)
}

/// The first evaluation, and the kept factor where there is one to keep.
pub(crate) fn begin<const D: usize>(
    model: &Model<D>,
    state: &State,
    trial: &mut Trial,
    work: &mut Workspace<D>,
    keeper: &mut Keeper,
) -> Result<Measure, Rejected> {
    if !keeper.full {
        let measure = evaluate(model, state, trial, work, false)?;
        let held = if let Some(point) = keeper.kept.point.clone().filter(|_| !keeper.due) {
            hold(model, work, &point, keeper.rule)?
        } else {
            let rows = independent_rows(model, &trial.pairs, work);
            renew(model, state, work, &rows, keeper)?
        };
        if held {
            return Ok(measure);
        }
        keeper.refused();
    }
    work.system.release();
    evaluate(model, state, trial, work, true)
}

/// Makes the factor of a point; whether there is one.
fn hold<const D: usize>(
    model: &Model<D>,
    work: &mut Workspace<D>,
    point: &Arc<Point>,
    rule: TangentRule,
) -> Result<bool, Rejected> {
    let (system, scratch) = (&mut work.system, &mut work.correction);
    match timed(&mut work.timings.factor, || system.hold(model, point, rule == TangentRule::KeptDouble, scratch)) {
        Ok(()) => Ok(true),
        Err(HoldError::Indefinite) => Ok(false),
        Err(HoldError::Inverted((body, inverted))) => Err(Rejected::Inverted { body, inverted }),
    }
}

/// Makes a factor at the present positions, or else at the start of the step; whether there is one.
fn renew<const D: usize>(
    model: &Model<D>,
    state: &State,
    work: &mut Workspace<D>,
    rows: &[(usize, usize)],
    keeper: &mut Keeper,
) -> Result<bool, Rejected> {
    let boundary = {
        let rows = linearised(model, work, rows);
        boundary(model, work.at.as_chunks::<D>().0, &rows, keeper.kept.point.as_deref())
    };
    let (mass, stiffness) = (mass_factor(&work.stage), stiffness_factor(&work.stage));
    // An iterate far from the solution may have no positive definite tangent; the state the step began with nearly always has.
    for at in [work.at.clone(), state.y.clone()] {
        let point = Arc::new(Point { at, mass, stiffness, boundary: boundary.clone() });
        if work.system.holds(&point) {
            // The same factor again is of no help.
            return Ok(false);
        }
        if hold(model, work, &point, keeper.rule)? {
            keeper.renewed(point);
            return Ok(true);
        }
    }
    Ok(false)
}

/// Solves with the kept factor, made anew where that is due; false where there is none.
pub(crate) fn kept_step<const D: usize>(
    model: &Model<D>,
    state: &State,
    work: &mut Workspace<D>,
    rows: &[(usize, usize)],
    keeper: &mut Keeper,
) -> Result<bool, Rejected> {
    let mut fresh = false;
    while !keeper.helpless() {
        if !fresh && (keeper.due || !work.system.covers(&linearised(model, work, rows))) {
            if !renew(model, state, work, rows, keeper)? {
                break;
            }
            fresh = true;
        }
        if try_kept(model, work, rows).is_ok() {
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

fn linearised<'a, const D: usize>(
    model: &Model<D>,
    work: &'a Workspace<D>,
    rows: &[(usize, usize)],
) -> Vec<Row<'a, D>> {
    let weight = |k: usize| contact_weights(&work.stage, model.contacts[k].force).0;
    rows.iter().map(|&(k, p)| Row { gap: &work.gaps[k][p], weight: weight(k), compliance: 0.0 }).collect()
}

/// Solves for `work.correction` and `work.multipliers` with the kept factor.
fn try_kept<const D: usize>(
    model: &Model<D>,
    work: &mut Workspace<D>,
    rows: &[(usize, usize)],
) -> Result<(), LinearError> {
    let weight = |k: usize| contact_weights(&work.stage, model.contacts[k].force).0;
    let gaps: Vec<Row<D>> =
        rows.iter().map(|&(k, p)| Row { gap: &work.gaps[k][p], weight: weight(k), compliance: 0.0 }).collect();
    let right: Vec<f64> = gaps.iter().map(|row| -row.weight * row.gap.gap).collect();
    timed(&mut work.timings.factor, || work.system.constrain(model, &gaps))?;
    work.right.clear();
    work.right.extend(work.residual.iter().map(|r| -r));
    let (system, forces) = (&mut work.system, &work.right);
    timed(&mut work.timings.solve, || system.solve(model, forces, &right, &mut work.correction, &mut work.multipliers))
}
