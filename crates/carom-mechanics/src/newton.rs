//! One stage solved: Newton on positions and active multipliers with the primal–dual active set inside.
//!
//! Converged means, all at once: ‖Δy‖∞ ≤ tol·L before mixing; ‖r‖ ≤ tol·Σ‖f‖ (plus the round-off the system's diagonal stands for); |g| ≤ 1e-12·L on every active pair;
//! no pair penetrates, pulls, or has slid off its facet. Nothing less is accepted.

use carom_algebra::LinearError;

use crate::constraints::Constraints;
use crate::contact_update::{ActiveSets, Events, GAP_TOLERANCE, check_stuck, follow, hold_on, search, search_again};
use crate::equations::{Equations, Evaluation, Iterate, Measure};
use crate::kept::{Keeper, Kept};
use crate::kept_step::{begin, keeps, kept_step};
use crate::model::check_held;
use crate::rejected::Rejected;
use crate::sums::max_abs;
use crate::settings::{Settings, Tangent};
use crate::timings::timed;
use crate::workspace::Workspace;

/// Below this step, relative to L, facets are handed over before the iteration with a kept tangent has converged.
const CLOSE: f64 = 1e-5;
/// How often in a solve pairs are handed over as they slide, before corrections are as small as that.
const FOLLOWS: u32 = 12;
/// How much smaller than the tolerance the residual gets with a kept tangent.
const KEPT_DIGITS: f64 = 1e-3;
/// Halvings of a Newton step that inverts a cell or makes the residual much worse.
const HALVINGS: usize = 8;
/// Share of the predicted motion that its first correction may have: a prediction that needs more is none.
const TRUST: f64 = 0.5;

/// What a solve cost and what happened in it.
#[derive(Clone, Debug, Default)]
pub(crate) struct Effort {
    /// Newton iterations (linear solves).
    pub iterations: u32,
    /// Events of the pairs.
    pub events: Events,
    /// The kept factor's point.
    pub kept: Kept,
}

/// Solves a stage from a guess. `kept`: the factor of the stage before; `before`: positions at its end, for trajectories.
pub(crate) fn solve_stage(
    equations: &Equations,
    kept: &Kept,
    before: &[f64],
    settings: &Settings,
    mut guess: Iterate,
    work: &mut Workspace,
) -> Result<(Evaluation, Effort), Rejected> {
    let (model, state) = (equations.model, equations.state);
    let mut effort = Effort::default();
    let mut sets = ActiveSets::new(model);
    let keep = settings.tangent != Tangent::Full && keeps(equations);
    let rule = if keep { settings.tangent } else { Tangent::Full };
    let mut keeper = Keeper::new(kept, rule, equations.mass_factor(), equations.stiffness_factor());
    if state.halved.is_on() {
        keeper.hurry();
    }
    let mut predicted =
        Some((max_abs(&guess.increment), guess.pairings.clone())).filter(|_| !equations.stage.is_static());
    let rest = |pairings: Vec<_>| Iterate {
        increment: before.iter().zip(&state.y).map(|(start, old)| start - old).collect(),
        pairings,
    };
    if keep
        && keeper.distrusts()
        && let Some((_, pairings)) = predicted.take()
    {
        guess = rest(pairings);
    }
    detect(equations, before, &mut guess, &mut effort.events, work);
    let mut begun = begin(equations, guess, work, &mut keeper);
    if matches!(begun, Err(Rejected::Inverted { .. }))
        && let Some((_, pairings)) = predicted.take()
    {
        guess = rest(pairings);
        detect(equations, before, &mut guess, &mut effort.events, work);
        begun = begin(equations, guess, work, &mut keeper);
    }
    let mut now = begun?;
    if equations.stage.is_static() && hold_on(model, &mut now) {
        now = again(equations, now, work)?;
    }
    work.mixing.restart();
    let mut mixed = Vec::new();
    let (mut step, mut shrinking, mut follows) = (f64::INFINITY, 1.0_f64, 0);
    loop {
        // What a kept tangent leaves over shrinks with the residual, not with its square: the balance is taken three digits further.
        let (next, digits) = if keeper.full { (step, 1.0) } else { (step * shrinking.min(1.0), KEPT_DIGITS) };
        let settled = next <= settings.tolerance * model.scale
            && now.measure.residual
                <= digits * settings.tolerance * now.measure.forces + work.system.round_off(equations)
            && now.measure.gap <= GAP_TOLERANCE * model.scale;
        let mut changed = sets.change(equations, &mut now, &work.system, settled)?;
        if keep && !settled && follows < FOLLOWS && follow(model, &mut now, &mut effort.events) {
            follows += 1;
            sets.restart();
            changed = true;
        }
        if !keeper.full && !settled && !changed && step <= CLOSE * model.scale {
            // Where a node will slide to is known long before the last digits are.
            changed = timed(&mut work.timings.contact, || search_again(model, before, &mut now, &mut effort.events));
            if changed {
                sets.restart();
            }
        }
        if settled && !changed {
            if !timed(&mut work.timings.contact, || search_again(model, before, &mut now, &mut effort.events)) {
                effort.kept = keeper.finish();
                return Ok((now, effort));
            }
            sets.restart();
            changed = true;
        }
        if keeper.exhausted(settings.max_iterations) {
            if changed {
                // The gaps at hand belong to the pairs before.
                now = again(equations, now, work)?;
            }
            check_stuck(equations, &now)?;
            return Err(Rejected::NoConvergence {
                iterations: effort.iterations,
                step: step / model.scale,
                residual: now.measure.residual / now.measure.forces.max(f64::MIN_POSITIVE),
            });
        }
        if changed {
            now = again(equations, now, work)?;
        }
        let rows = Constraints::of(equations, &now);
        let made = keeper.made();
        if keeper.full || !kept_step(equations, &now, work, &rows, &mut keeper)? {
            full_step(equations, &now, work, &rows)?;
        }
        step = max_abs(&work.correction);
        effort.iterations += 1;
        if let Some((size, pairings)) = predicted.take()
            && keeper.predicted(step <= TRUST * size || size == 0.0)
        {
            let mut guess = rest(pairings);
            sets.restart();
            detect(equations, before, &mut guess, &mut effort.events, work);
            work.spare.put(now);
            now = equations.evaluate(guess, &mut work.spare, &mut work.timings)?;
            step = f64::INFINITY;
            continue;
        }
        keeper.observe(step, settings.tolerance * model.scale, !rows.is_empty(), changed);
        if changed || keeper.made() != made || rows.places != mixed {
            work.mixing.restart();
        }
        if !keeper.full {
            work.mixing.improve([&mut work.correction, &mut work.multipliers], settings.mixing);
        }
        let residual = now.measure.residual;
        let length;
        (now, length) = advance(equations, now, work, &rows, !changed)?;
        if length != 1.0 {
            work.mixing.restart();
        }
        mixed = rows.places;
        shrinking = now.measure.residual / residual.max(f64::MIN_POSITIVE);
    }
}

/// Finds the pairs of a guess.
fn detect(equations: &Equations, before: &[f64], guess: &mut Iterate, events: &mut Events, work: &mut Workspace) {
    let positions = equations.state.y.iter().zip(&guess.increment).map(|(y, d)| y + d);
    work.right.clear();
    work.right.extend(positions);
    let now = &work.right;
    timed(&mut work.timings.contact, || search(equations.model, before, now, &mut guess.pairings, events));
}

/// Evaluates an iterate again: its pairs have changed.
fn again(equations: &Equations, mut evaluation: Evaluation, work: &mut Workspace) -> Result<Evaluation, Rejected> {
    let at = std::mem::take(&mut evaluation.at);
    work.spare.put(evaluation);
    equations.evaluate(at, &mut work.spare, &mut work.timings)
}

/// Solves for `work.correction` and `work.multipliers` with the tangent of the iterate.
pub(crate) fn full_step(
    equations: &Equations,
    now: &Evaluation,
    work: &mut Workspace,
    rows: &Constraints,
) -> Result<(), Rejected> {
    let Equations { model, state, stage, .. } = equations;
    if stage.is_static() {
        check_held(&model.parts, &model.unheld, &now.place, rows.rows.iter())?;
    }
    // What moved supports still have to go pulls at their neighbours.
    let Workspace { system, timings, right, pull, correction, multipliers, .. } = work;
    correction.fill(0.0);
    equations.remaining(&now.at).for_each(|(dof, left)| correction[dof] = left);
    let (before, at) = if equations.between() { (Some(&state.y[..]), &now.y) } else { (None, &now.place) };
    timed(&mut timings.assembly, || system.internal_tangent(model, before, at, right, Some((correction, pull))))
        .map_err(|(body, inverted)| Rejected::Inverted { body, inverted })?;
    if model.loads.follow() {
        system.loads_tangent(model, &equations.loads);
    }
    let (mass, stiffness, follower) =
        (equations.mass_factor(), equations.stiffness_factor(), equations.follower_factor());
    let inertia = timed(&mut timings.factor, || system.factor(model, mass, stiffness, follower, rows))?;
    if inertia.negative < rows.len() {
        let size = model.free.len() + rows.len();
        return Err(LinearError::Singular { size, pivot: inertia.negative, value: 0.0 }.into());
    }
    let approach = rows.rows.iter().map(|row| row.along(correction));
    let gaps: Vec<f64> =
        rows.weights.iter().zip(&rows.open).zip(approach).map(|((w, open), moved)| -w * (open + moved)).collect();
    for ((right, r), pull) in right.iter_mut().zip(&now.residual).zip(pull) {
        *right = -(r + stiffness * *pull);
    }
    timed(&mut timings.solve, || system.solve(model, right, &gaps, correction, multipliers))?;
    equations.remaining(&now.at).for_each(|(dof, left)| correction[dof] = left);
    Ok(())
}

/// Takes the Newton step, shortened where it inverts a cell or, with an unchanged active set, makes the residual much worse; the share of it that was taken.
fn advance(
    equations: &Equations,
    now: Evaluation,
    work: &mut Workspace,
    rows: &Constraints,
    compare: bool,
) -> Result<(Evaluation, f64), Rejected> {
    let merit = |m: &Measure| (m.residual / m.forces.max(f64::MIN_POSITIVE)).max(m.gap / equations.model.scale);
    let mut length = 1.0;
    let mut outcome = take(equations, &now.at, work, rows, length);
    for _ in 0..HALVINGS {
        let worse = match &outcome {
            Err(_) => true,
            Ok(next) => compare && merit(&next.measure) > 2.0 * merit(&now.measure) && merit(&next.measure) > 1e-6,
        };
        if !worse {
            work.spare.put(now);
            return outcome.map(|next| (next, length));
        }
        length *= 0.5;
        if let Ok(worse) = outcome {
            work.spare.put(worse);
        }
        outcome = take(equations, &now.at, work, rows, length);
    }
    // Where shortening does not help, the full step is as good as any: contact forces come and go.
    if outcome.is_ok() {
        length = 1.0;
        outcome = take(equations, &now.at, work, rows, length).or(outcome);
    }
    work.spare.put(now);
    outcome.map(|next| (next, length))
}

fn take(
    equations: &Equations,
    from: &Iterate,
    work: &mut Workspace,
    rows: &Constraints,
    length: f64,
) -> Result<Evaluation, Rejected> {
    let mut at = work.spare.copy(from);
    for (increment, correction) in at.increment.iter_mut().zip(&work.correction) {
        *increment += length * correction;
    }
    if length == 1.0 {
        equations.arrive(&mut at.increment);
    }
    for (&(k, p), multiplier) in rows.places.iter().zip(&work.multipliers) {
        at.pairings[k].pairs[p].lambda += length * multiplier;
    }
    equations.evaluate(at, &mut work.spare, &mut work.timings)
}
