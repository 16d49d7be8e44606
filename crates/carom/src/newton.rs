//! One stage solved: Newton on positions and active multipliers with the primal–dual active set inside.
//!
//! Converged means, all at once: ‖Δy‖∞ ≤ tol·L before mixing; ‖r‖ ≤ tol·Σ‖f‖ (plus the round-off the system's diagonal stands for); |g| ≤ 1e-12·L on every active pair;
//! no pair penetrates, pulls, or has slid off its facet. Nothing less is accepted.

use carom_algebra::LinearError;
use carom_contact::{ActiveSet, Linearised, Pair, PairEvent};

use crate::balance::contact_weights;
use crate::case::{NewtonSpec, TangentRule};
use crate::evaluation::{Measure, Trial, evaluate, follower_factor, mass_factor, round_off, stiffness_factor};
use crate::kept::{Keeper, Kept};
use crate::kept_step::{begin, keeps, kept_step};
use crate::model::Model;
use crate::rejected::Rejected;
use crate::rows::independent_rows;
use crate::state::State;
use crate::system::Row;
use crate::touching::{GAP_TOLERANCE, change_sets, detect, follow, look_again, stuck, touch};
use crate::workspace::{Workspace, timed};

/// Below this step, relative to L, the next iterate may well be the last: its tangent is not formed before it is needed.
pub(crate) const NEARLY_THERE: f64 = 1e-3;
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
    /// Events of the pairs, with the place of their contact.
    pub events: Vec<(usize, PairEvent)>,
    /// The kept factor's point.
    pub kept: Kept,
}

/// Solves the stage in `work.stage` from the guess in `trial`. `kept`: the factor of the stage before; `before`: positions at its end, for trajectories.
pub(crate) fn solve_stage<const D: usize>(
    model: &Model<D>,
    state: &State,
    kept: &Kept,
    before: &[f64],
    settings: &NewtonSpec,
    trial: &mut Trial,
    work: &mut Workspace<D>,
) -> Result<Effort, Rejected> {
    let mut effort = Effort::default();
    let mut sets: Vec<ActiveSet> =
        model.contacts.iter().map(|c| ActiveSet::new(GAP_TOLERANCE * model.scale, c.within)).collect();
    let (mass, stiffness) = (mass_factor(&work.stage), stiffness_factor(&work.stage));
    let keep = settings.tangent != TangentRule::Full && keeps(model, work);
    let rule = if keep { settings.tangent } else { TangentRule::Full };
    let mut keeper = Keeper::new(kept, rule, mass, stiffness);
    if state.halved.is_on() {
        keeper.hurry();
    }
    let mut predicted = Some((max_abs(&trial.increment), trial.pairs.clone())).filter(|_| !work.stage.is_static());
    if keep
        && keeper.distrusts()
        && let Some((_, pairs)) = predicted.take()
    {
        rest(state, before, pairs, trial);
    }
    timed(&mut work.timings.contact, || detect(model, before, trial, &mut effort.events))?;
    let mut begun = begin(model, state, trial, work, &mut keeper);
    if matches!(begun, Err(Rejected::Inverted { .. }))
        && let Some((_, pairs)) = predicted.take()
    {
        rest(state, before, pairs, trial);
        timed(&mut work.timings.contact, || detect(model, before, trial, &mut effort.events))?;
        begun = begin(model, state, trial, work, &mut keeper);
    }
    let mut measure = begun?;
    if work.stage.is_static() && touch(model, trial, work) {
        measure = evaluate(model, state, trial, work, false)?;
    }
    let mut has_tangent = keeper.full;
    work.mixing.restart();
    let mut mixed = Vec::new();
    let (mut step, mut shrinking, mut follows) = (f64::INFINITY, 1.0_f64, 0);
    loop {
        // What a kept tangent leaves over shrinks with the residual, not with its square: the balance is taken three digits further.
        let (next, digits) = if keeper.full { (step, 1.0) } else { (step * shrinking.min(1.0), KEPT_DIGITS) };
        let settled = next <= settings.tolerance * model.scale
            && measure.residual <= digits * settings.tolerance * measure.forces + round_off(model, work)
            && measure.gap <= GAP_TOLERANCE * model.scale;
        let mut changed = change_sets(model, &mut sets, trial, work, settled)?;
        if keep && !settled && follows < FOLLOWS && follow(model, trial, &mut effort.events) {
            follows += 1;
            sets.iter_mut().for_each(ActiveSet::restart);
            changed = true;
        }
        if !keeper.full && !settled && !changed && step <= CLOSE * model.scale {
            // Where a node will slide to is known long before the last digits are.
            changed = timed(&mut work.timings.contact, || look_again(model, before, trial, &mut effort.events))?;
            if changed {
                sets.iter_mut().for_each(ActiveSet::restart);
            }
        }
        if settled && !changed {
            if !timed(&mut work.timings.contact, || look_again(model, before, trial, &mut effort.events))? {
                effort.kept = keeper.finish();
                return Ok(effort);
            }
            sets.iter_mut().for_each(ActiveSet::restart);
            changed = true;
        }
        if keeper.exhausted(settings.max_iterations) {
            if changed {
                // The gaps at hand belong to the pairs before.
                evaluate(model, state, trial, work, false)?;
            }
            stuck(model, trial, work)?;
            return Err(Rejected::NoConvergence {
                iterations: effort.iterations,
                step: step / model.scale,
                residual: measure.residual / measure.forces.max(f64::MIN_POSITIVE),
            });
        }
        if changed {
            measure = evaluate(model, state, trial, work, keeper.full && !has_tangent)?;
            has_tangent = keeper.full;
        }
        let rows = independent_rows(model, &trial.pairs, work);
        let made = keeper.made();
        if keeper.full || !kept_step(model, state, work, &rows, &mut keeper)? {
            if !has_tangent {
                measure = evaluate(model, state, trial, work, true)?;
            }
            linear_step(model, work, &rows)?;
        }
        step = max_abs(&work.correction);
        effort.iterations += 1;
        if let Some((size, pairs)) = predicted.take()
            && keeper.predicted(step <= TRUST * size || size == 0.0)
        {
            rest(state, before, pairs, trial);
            sets.iter_mut().for_each(ActiveSet::restart);
            timed(&mut work.timings.contact, || detect(model, before, trial, &mut effort.events))?;
            measure = evaluate(model, state, trial, work, keeper.full)?;
            (step, has_tangent) = (f64::INFINITY, keeper.full);
            continue;
        }
        keeper.observe(step, settings.tolerance * model.scale, !rows.is_empty(), changed);
        if changed || keeper.made() != made || rows != mixed {
            work.mixing.restart();
        }
        if !keeper.full {
            work.mixing.improve([&mut work.correction, &mut work.multipliers], settings.mixing);
        }
        let residual = measure.residual;
        let tangent = keeper.full && step > NEARLY_THERE * model.scale;
        let length;
        (measure, length) = advance(model, state, trial, work, &rows, tangent, (!changed).then_some(measure))?;
        if length != 1.0 {
            work.mixing.restart();
        }
        mixed = rows;
        shrinking = measure.residual / residual.max(f64::MIN_POSITIVE);
        has_tangent = tangent;
    }
}

/// Puts the trial where the stage began. Where contact begins, velocities and accelerations jump from node to node: that motion, gone on with for a
/// step, tears cells that the balance holds together or turns them over, and Newton begins better from where none is.
fn rest(state: &State, before: &[f64], pairs: Vec<Vec<Pair>>, trial: &mut Trial) {
    for ((increment, y), (start, old)) in trial.increment.iter_mut().zip(&mut trial.y).zip(before.iter().zip(&state.y))
    {
        (*increment, *y) = (start - old, *start);
    }
    trial.pairs = pairs;
}

/// Solves for `work.correction` and `work.multipliers`.
fn linear_step<const D: usize>(
    model: &Model<D>,
    work: &mut Workspace<D>,
    rows: &[(usize, usize)],
) -> Result<(), Rejected> {
    let stage = &work.stage;
    let weight = |k: usize| contact_weights(stage, model.contacts[k].force).0;
    let soft = |k: usize| model.contacts[k].penalty.is_some();
    let compliance = |k: usize, p: usize| if soft(k) { work.stiffnesses[k][p].recip() } else { 0.0 };
    let gaps: Vec<Row<D>> = rows
        .iter()
        .map(|&(k, p)| Row { gap: &work.gaps[k][p], weight: weight(k), compliance: compliance(k, p) })
        .collect();
    if stage.is_static() {
        model.check_held(&work.at, gaps.iter().map(|row| row.gap))?;
    }
    let (mass, stiffness, follower) = (mass_factor(stage), stiffness_factor(stage), follower_factor(stage));
    let inertia = timed(&mut work.timings.factor, || work.system.factor(model, mass, stiffness, follower, &gaps))?;
    if inertia.negative < rows.len() {
        let size = model.free.len() + rows.len();
        return Err(LinearError::Singular { size, pivot: inertia.negative, value: 0.0 }.into());
    }
    let remaining = &work.remaining;
    let approach = |gap: &Linearised<D>| {
        let moved = |p: usize| (0..D).map(|i| gap.gradient[p][i] * remaining[gap.nodes[p] * D + i]).sum::<f64>();
        (0..gap.count).map(moved).sum::<f64>()
    };
    // The multiplier of a spring is that of its gap already; only what moved supports still bring is missing.
    let open = |k: usize, p: usize| if soft(k) { 0.0 } else { work.gaps[k][p].gap };
    let right: Vec<f64> = rows.iter().map(|&(k, p)| -weight(k) * (open(k, p) + approach(&work.gaps[k][p]))).collect();
    for (r, pull) in work.residual.iter_mut().zip(&work.pull) {
        *r = -(*r + stiffness * pull);
    }
    let (system, forces) = (&mut work.system, &work.residual);
    timed(&mut work.timings.solve, || {
        system.solve(model, forces, &right, &mut work.correction, &mut work.multipliers)
    })?;
    for moved in &work.motions {
        work.correction[moved.dof] = work.remaining[moved.dof];
    }
    Ok(())
}

/// Takes the Newton step, shortened where it inverts a cell or, with an unchanged active set, makes the residual much worse; the share of it that was taken.
fn advance<const D: usize>(
    model: &Model<D>,
    state: &State,
    trial: &mut Trial,
    work: &mut Workspace<D>,
    rows: &[(usize, usize)],
    tangent: bool,
    before: Option<Measure>,
) -> Result<(Measure, f64), Rejected> {
    work.saved.increment.clone_from(&trial.increment);
    work.saved.pairs.clone_from(&trial.pairs);
    let merit = |m: &Measure| (m.residual / m.forces.max(f64::MIN_POSITIVE)).max(m.gap / model.scale);
    let mut length = 1.0;
    let mut outcome = take(model, state, trial, work, rows, length, tangent);
    for _ in 0..HALVINGS {
        let worse = match (&outcome, &before) {
            (Err(_), _) => true,
            (Ok(now), Some(then)) => merit(now) > 2.0 * merit(then) && merit(now) > 1e-6,
            (Ok(_), None) => false,
        };
        if !worse {
            return outcome.map(|measure| (measure, length));
        }
        length *= 0.5;
        let shorter = take(model, state, trial, work, rows, length, tangent);
        // Where shortening does not help, the full step is as good as any: contact forces come and go.
        outcome = shorter;
    }
    if outcome.is_ok() {
        length = 1.0;
        outcome = take(model, state, trial, work, rows, length, tangent).or(outcome);
    }
    outcome.map(|measure| (measure, length))
}

fn take<const D: usize>(
    model: &Model<D>,
    state: &State,
    trial: &mut Trial,
    work: &mut Workspace<D>,
    rows: &[(usize, usize)],
    length: f64,
    tangent: bool,
) -> Result<Measure, Rejected> {
    for i in 0..trial.increment.len() {
        trial.increment[i] = work.saved.increment[i] + length * work.correction[i];
    }
    if length == 1.0 {
        // To the last digit.
        for moved in &work.motions {
            trial.increment[moved.dof] = model.reference[moved.dof] + moved.motion[0] - state.y[moved.dof];
        }
    }
    trial.pairs.clone_from(&work.saved.pairs);
    for (&(k, p), multiplier) in rows.iter().zip(&work.multipliers) {
        trial.pairs[k][p].lambda += length * multiplier;
    }
    evaluate(model, state, trial, work, tangent)
}

pub(crate) fn max_abs(x: &[f64]) -> f64 {
    x.iter().fold(0.0, |m: f64, v| if v.is_finite() { m.max(v.abs()) } else { f64::INFINITY })
}

#[cfg(test)]
#[path = "newton_tests.rs"]
mod tests;
