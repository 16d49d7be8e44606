//! Solution of one stage: inexact Newton on positions and multipliers (R. S. Dembo, S. C.
//! Eisenstat, T. Steihaug, SIAM J. Numer. Anal. 19 (1982) 400–408; forcing after S. C. Eisenstat,
//! H. F. Walker, SIAM J. Sci. Comput. 17 (1996) 16–32), with an inner primal–dual active set.
//!
//! Convergence requires all of: ‖Δy‖∞ ≤ tol·L; ‖r‖ ≤ tol·Σ‖f‖ (plus round-off according to the
//! system's diagonal), and with friction and inertia its resultants vanish
//! (`resultants.rs`); |g| ≤ 1e-12·L on every active constraint; no pair penetrates, pulls, or has
//! slid off its facet. Nothing less is accepted. With an augmented Lagrangian this is a round, of
//! which there are several (`rounds.rs`).

use carom_contact::inner;

use crate::augmented;
use crate::constraints::Constraints;
use crate::contact_update::{ContactUpdate, Events, activate_initial, check_satisfiable, search};
use crate::equations::Equations;
use crate::evaluation::{Evaluation, Iterate, Measure};
use crate::linear_problem::{Correction, Goal};
use crate::model::check_rigid_modes;
use crate::rejected::Rejected;
use crate::renewal::{FrozenTangent, Renewal};
use crate::resultants::are_balanced;
use crate::rounds::Rounds;
use crate::settings::{Settings, Tangent};
use crate::sums::max_abs;
use crate::timings::timed;
use crate::trace::Iteration;
use crate::workspace::Workspace;

/// Factor below the tolerance to which the residual is reduced if linear problems are solved
/// inexactly.
const DIGITS: f64 = 1e-3;
/// Largest forcing term of a linear problem, and its ratio to the reduction of the residual in the
/// previous iteration.
const FORCING: f64 = 0.1;
const FORCING_RATIO: f64 = 0.9;
/// Number of corrections with a reused factor that may grow without a change of contacts.
const PATIENCE: u32 = 2;
/// Bisections of a Newton step that inverts a cell or greatly increases the residual.
const BISECTIONS: usize = 8;
/// Fraction of the predicted motion that its first correction may have; otherwise the predictor is
/// discarded.
const TRUST: f64 = 0.5;

/// Cost and events of a solve.
#[derive(Clone, Debug, Default)]
pub(crate) struct Effort {
    /// Linear solves.
    pub iterations: u32,
    /// Events of the pairs.
    pub events: Events,
    /// The smallest relative singular value of the interface with friction at the solution,
    /// negative where its determinant is; infinite without friction.
    pub regularity: f64,
    /// The point of the reused factor.
    pub frozen: FrozenTangent,
}

/// Solves a stage from a guess. `frozen`: the factor of the previous stage; `before`: positions at
/// its end, for trajectories.
pub(crate) fn solve_stage(
    equations: &Equations,
    frozen: &FrozenTangent,
    before: &[f64],
    settings: &Settings,
    mut guess: Iterate,
    work: &mut Workspace,
) -> Result<(Evaluation, Effort), Rejected> {
    let (model, state, tolerance) = (equations.model, equations.state, settings.tolerance);
    let mut effort = Effort { regularity: f64::INFINITY, ..Effort::default() };
    let (mass, stiffness) = (equations.mass_factor(), equations.factor_stiffness());
    let cost = work.system.preconditioner.cost();
    let mut renewal = Renewal::new(frozen, [mass, stiffness], settings.tangent != Tangent::Frozen, cost);
    // Without inertia corrections may grow before they shrink, and the residual tolerance is mostly
    // round-off of positions: a remaining residual would appear in reactions.
    let (full, is_static) = (settings.tangent == Tangent::Full, equations.stage.is_static());
    work.linear.restart();
    work.trace.start();
    augmented::start(model, &mut guess);
    // Where contact begins, velocities and accelerations jump from node to node. Extrapolated over
    // a step, that motion distorts or inverts cells, and Newton's method starts better without a
    // predictor.
    let predicted = max_abs(&guess.increment);
    let mut fallback = Some(Iterate {
        increment: before.iter().zip(&state.y).map(|(start, old)| start - old).collect(),
        pairings: guess.pairings.clone(),
        stiffer: 0,
    })
    .filter(|_| !is_static);
    let mut now = match begin(equations, before, guess, &mut effort.events, work) {
        Err(Rejected::Inverted { .. }) if let Some(fallback) = fallback.take() => {
            begin(equations, before, fallback, &mut effort.events, work)?
        }
        begun => begun?,
    };
    if is_static && activate_initial(model, &mut now) {
        now = again(equations, now, work)?;
    }
    work.restore_factor(equations, &renewal)?;
    let digits = if is_static { DIGITS } else { 1.0 };
    let iterates = work.system.preconditioner.iterations().is_some();
    let (mut contact, mut rounds) = (ContactUpdate::new(model), Rounds::new());
    let (mut step, mut ratio, mut grown, mut iteration) = (f64::INFINITY, 1.0_f64, 0, 0);
    loop {
        // The error of an inexact linear solve shrinks with the residual, so the residual is
        // reduced further if linear problems are solved inexactly.
        let noise = work.system.round_off(equations);
        let enough = DIGITS * tolerance * now.measure.forces + noise;
        let settled = step * if is_static { 1.0 } else { ratio.min(1.0) } <= tolerance * model.scale
            && now.measure.residual <= enough
            && (now.measure.gap <= model.gap_tolerance
                || now.measure.has_slip && Constraints::gap(equations, &now) <= model.gap_tolerance)
            && (is_static || are_balanced(equations, &now, noise));
        let changed = contact.update(equations, before, &mut now, &mut effort.events, settled, step, work)?;
        work.trace.push(iterate(equations, &now, iteration, step, changed), &now.y);
        if changed
            && iteration == 0
            && iterates
            && let Some(fallback) = fallback.take()
        {
            // The predictor would be tried at the cost of an iteration.
            work.spare.put(now);
            contact.restart();
            work.linear.restart();
            now = begin(equations, before, fallback, &mut effort.events, work)?;
            continue;
        }
        if settled && !changed {
            if rounds.next(equations, &mut now)? {
                // A solve of its own, from the solution of the last one.
                now = again(equations, now, work)?;
                contact.restart();
                work.linear.restart();
                (step, ratio, grown, iteration) = (f64::INFINITY, 1.0, 0, 0);
                continue;
            }
            effort.frozen = renewal.finish();
            return Ok((now, effort));
        }
        if changed {
            // The existing rows belong to the previous pairs.
            now = again(equations, now, work)?;
            work.linear.restart();
        }
        if iteration >= settings.max_iterations || (!is_static && grown > PATIENCE) {
            work.trace.blame(&now.residual, &model.free);
            check_satisfiable(equations, &now)?;
            return Err(Rejected::NoConvergence {
                iterations: iteration as u32,
                step: [step / model.scale, tolerance],
                residual: [now.measure.residual, enough]
                    .map(|r| r / now.measure.forces.max(f64::MIN_POSITIVE)),
                gap: Some([now.measure.gap, model.gap_tolerance].map(|gap| gap / model.scale)),
                unbalanced: !is_static && !are_balanced(equations, &now, noise),
                changing: changed,
            });
        }
        let rows = Constraints::of(equations, &now);
        if is_static {
            let (rows, slips) = (rows.rows.iter(), now.slipping());
            check_rigid_modes(&model.parts, &model.unconstrained, &now.place, rows, slips)?;
        }
        let made = renewal.made;
        renewal.due |= full;
        work.factor_for(equations, &now, &rows, &mut renewal)?;
        let regularity = work.system.preconditioner.regularity().filter(|_| rows.is_skew);
        effort.regularity = regularity.unwrap_or(f64::INFINITY);
        contact.regularity = contact.regularity.min(effort.regularity);
        let trust = if fallback.is_some() && predicted > 0.0 { TRUST * predicted } else { f64::INFINITY };
        // Limited by the progress of the outer iteration, and by its convergence criterion.
        let pace = if changed { 1.0 } else { ratio };
        let forcing = digits * FORCING.min(FORCING_RATIO * pace).max(enough / now.measure.residual);
        let goal = Goal { forcing, step: tolerance * model.scale, fresh: renewal.made != made, trust };
        let Workspace { linear, system, timings, .. } = work;
        let correction = linear.solve(
            equations,
            &now,
            &rows,
            &mut *system.preconditioner,
            &mut renewal,
            goal,
            settings.mixing,
            timings,
        )?;
        (iteration, effort.iterations) = (iteration + 1, effort.iterations + correction.solves);
        if let Some(fallback) = fallback.take()
            && correction.first > trust
        {
            work.spare.put(now);
            contact.restart();
            work.linear.restart();
            now = begin(equations, before, fallback, &mut effort.events, work)?;
            // A tangent of the discarded motion misleads where it is all that is known; a factor is
            // corrected by products, and dearer.
            renewal.due |= renewal.made > 0 && iterates;
            step = f64::INFINITY;
            continue;
        }
        let size = max_abs(&correction.increment);
        grown += u32::from(!changed && size > step && size > tolerance * model.scale);
        step = size;
        let residual = now.measure.residual;
        now = advance(equations, now, &correction, &rows, !changed, work)?;
        ratio = now.measure.residual / residual.max(f64::MIN_POSITIVE);
    }
}

/// An iterate for the trace.
fn iterate(
    equations: &Equations,
    now: &Evaluation,
    number: usize,
    correction: f64,
    changed: bool,
) -> Iteration {
    let Measure { residual, forces, gap, .. } = now.measure;
    Iteration {
        number: number as u32,
        residual: residual / forces.max(f64::MIN_POSITIVE),
        gap: gap / equations.model.scale,
        correction: correction / equations.model.scale,
        length: 1.0,
        active: now.pressing().count() as u32,
        changed,
    }
}

/// Finds the pairs of a guess and evaluates it.
fn begin(
    equations: &Equations,
    before: &[f64],
    mut guess: Iterate,
    events: &mut Events,
    work: &mut Workspace,
) -> Result<Evaluation, Rejected> {
    let y: Vec<f64> = equations.state.y.iter().zip(&guess.increment).map(|(y, d)| y + d).collect();
    timed(&mut work.timings.contact, || search(equations.model, before, &y, &mut guess.pairings, events));
    equations.evaluate(guess, &mut work.spare, &mut work.timings)
}

/// Re-evaluates an iterate whose pairs have changed.
fn again(
    equations: &Equations,
    mut evaluation: Evaluation,
    work: &mut Workspace,
) -> Result<Evaluation, Rejected> {
    match equations.change_contacts(&mut evaluation, &mut work.timings) {
        Ok(()) => Ok(evaluation),
        Err(rejected) => {
            work.spare.put(evaluation);
            Err(rejected)
        }
    }
}

/// Takes the Newton step, shortened if it inverts a cell or, with unchanged contacts, greatly
/// increases the residual.
fn advance(
    equations: &Equations,
    now: Evaluation,
    correction: &Correction,
    rows: &Constraints,
    compare: bool,
    work: &mut Workspace,
) -> Result<Evaluation, Rejected> {
    let merit =
        |m: &Measure| (m.residual / m.forces.max(f64::MIN_POSITIVE)).max(m.gap / equations.model.scale);
    // Until moving supports have reached their positions, the balance is not comparable.
    let compare = compare && equations.remaining(&now.at).all(|(_, distance)| distance == 0.0);
    let worse = |next: &Measure| compare && merit(next) > 2.0 * merit(&now.measure) && merit(next) > 1e-6;
    let take = |length: f64, work: &mut Workspace| {
        let mut at = work.spare.copy(&now.at);
        at.increment.iter_mut().zip(&correction.increment).for_each(|(d, change)| *d += length * change);
        if length == 1.0 {
            equations.arrive(&mut at.increment);
        }
        for ((&(k, p), along), change) in rows.places.iter().zip(&rows.slips).zip(&correction.multipliers) {
            let pair = &mut at.pairings[k].pairs[p];
            match along {
                None => pair.lambda += length * change,
                Some(along) => pair.tangential.pull(*along, length * change),
            }
        }
        for &((k, p), along) in &rows.dropped {
            // Other rows constrain it.
            let tangential = &mut at.pairings[k].pairs[p].tangential;
            tangential.pull(along, -inner(along, tangential.traction));
        }
        equations.evaluate(at, &mut work.spare, &mut work.timings)
    };
    let (mut length, mut outcome) = (1.0, take(1.0, work));
    for _ in 0..BISECTIONS {
        if outcome.as_ref().is_ok_and(|next| !worse(&next.measure)) {
            work.spare.put(now);
            return outcome;
        }
        work.linear.restart();
        length *= 0.5;
        work.trace.shorten(length);
        if let Ok(rejected) = outcome {
            work.spare.put(rejected);
        }
        outcome = take(length, work);
    }
    if outcome.is_ok() {
        // If shortening does not help, the full step is as good as any: contact forces appear and
        // vanish.
        work.trace.shorten(1.0);
        outcome = take(1.0, work).or(outcome);
    }
    work.spare.put(now);
    outcome
}
