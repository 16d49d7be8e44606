//! Solution of one stage: inexact Newton on positions and multipliers (R. S. Dembo, S. C.
//! Eisenstat, T. Steihaug, SIAM J. Numer. Anal. 19 (1982) 400–408; forcing after S. C. Eisenstat,
//! H. F. Walker, SIAM J. Sci. Comput. 17 (1996) 16–32), with an inner primal–dual active set.
//!
//! Convergence requires all of: ‖Δy‖∞ ≤ tol·L; ‖r‖ ≤ tol·Σ‖f‖ (plus round-off according to the
//! system's diagonal and the springs of penalties), and with friction and inertia its resultants
//! vanish (`resultants.rs`); |g| ≤ 1e-12·L, and what positions are known to, on every active
//! constraint; no pair penetrates, pulls, or has slid off its facet. Nothing less is accepted, but
//! resultants where the last correction is below round-off of L: no further one changes them. With
//! an augmented Lagrangian this is a round, of which there are several (`rounds.rs`).

use carom_algebra::sums::max_abs;

use crate::contact::constraints::Constraints;
use crate::contact::update::{ContactUpdate, Events};
use crate::model::check_rigid_modes;
use crate::rejected::Rejected;
use crate::settings::{Settings, Tangent};
use crate::stage::equations::Equations;
use crate::stage::evaluation::{Evaluation, Iterate, Measure};
use crate::stage::linear_problem::{Correction, Goal};
use crate::stage::renewal::{FrozenTangent, Renewal};
use crate::stage::resultants::{are_balanced, round_off_of_springs};
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
/// Shortest share of a Newton step that inverts a cell or greatly increases the merit: the largest
/// of relative residual and relative gap.
const SHORTEST: f64 = 1.0 / 256.0;
/// Growth of the merit that is great, and a merit that is small enough in any case.
const WORSE: f64 = 2.0;
const NEGLIGIBLE: f64 = 1e-6;
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
    /// negative where its determinant is; none without friction.
    pub regularity: Option<f64>,
    /// Whether the equilibrium of a load step is unstable.
    pub unstable: bool,
    /// Contact and node of the closed gaps that had no multiplier in the last solve.
    pub dependent: Vec<(usize, usize)>,
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
    guess: Iterate,
    work: &mut Workspace,
) -> Result<(Evaluation, Effort), Rejected> {
    let (mut newton, mut now) = Newton::begin(equations, frozen, before, settings, guess, work)?;
    loop {
        let converged = newton.has_converged(&now);
        let changed = newton.change_contacts(&mut now, converged)?;
        if changed
            && newton.is_costly_guess()
            && let Some(start) = newton.unpredicted.take()
        {
            now = newton.restart(now, start)?;
            continue;
        }
        if converged && !changed {
            if newton.contact.next_round(&mut now)? {
                now = newton.next_round(now)?;
                continue;
            }
            newton.assess(&now);
            (newton.effort.events, newton.effort.frozen) = (newton.contact.events, newton.renewal.finish());
            return Ok((now, newton.effort));
        }
        if changed {
            now = newton.again(now)?;
        }
        newton.check_progress(&now, changed)?;
        let rows = Constraints::of(equations, &now);
        let correction = newton.correct(&now, &rows, changed)?;
        if let Some(start) = newton.unpredicted.take()
            && correction.first > newton.trust
        {
            newton.doubt_tangent();
            now = newton.restart(now, start)?;
            continue;
        }
        now = newton.advance(now, &correction, &rows, changed)?;
    }
}

/// A stage that is being solved.
struct Newton<'a> {
    equations: &'a Equations<'a>,
    settings: &'a Settings,
    work: &'a mut Workspace,
    contact: ContactUpdate<'a>,
    renewal: Renewal,
    /// A guess without predictor, until the predictor is known to help. Where contact begins,
    /// velocities and accelerations jump from node to node. Extrapolated over a step, that motion
    /// distorts or inverts cells, and Newton's method starts better without it.
    unpredicted: Option<Iterate>,
    /// The first correction, at most, of a useful predictor.
    trust: f64,
    iteration: usize,
    /// ‖Δy‖∞ of the last correction, and the reduction of the residual by it.
    step: f64,
    ratio: f64,
    /// Number of corrections that grew.
    grown: u32,
    /// Residual at convergence, and the part of it that is round-off.
    enough: f64,
    noise: f64,
    effort: Effort,
}

impl<'a> Newton<'a> {
    /// Evaluates the guess; one that inverts a cell, without predictor.
    fn begin(
        equations: &'a Equations<'a>,
        frozen: &FrozenTangent,
        before: &'a [f64],
        settings: &'a Settings,
        mut guess: Iterate,
        work: &'a mut Workspace,
    ) -> Result<(Self, Evaluation), Rejected> {
        let model = equations.model;
        let state = equations.state;
        let is_static = equations.stage.is_static();
        let contact = ContactUpdate::new(equations, before);
        contact.start(&mut guess);
        let predicted = max_abs(&guess.increment);
        let start = || Iterate {
            increment: before.iter().zip(&state.y).map(|(start, old)| start - old).collect(),
            pairings: guess.pairings.clone(),
            stiffer: 0,
        };
        let factors = [equations.mass_factor(), equations.factor_stiffness()];
        let double = settings.tangent != Tangent::Frozen;
        let cost = work.system.preconditioner.cost();
        work.trace.start();
        let mut newton = Self {
            equations,
            settings,
            work,
            contact,
            renewal: Renewal::new(frozen, factors, double, cost),
            unpredicted: (!is_static || predicted > 0.0).then(start),
            trust: if predicted > 0.0 { TRUST * predicted } else { f64::INFINITY },
            iteration: 0,
            step: f64::INFINITY,
            ratio: 1.0,
            grown: 0,
            enough: 0.0,
            noise: 0.0,
            effort: Effort::default(),
        };
        newton.work.linear.restart();
        let mut now = match newton.evaluate(guess) {
            Err(Rejected::Inverted { .. }) if let Some(start) = newton.unpredicted.take() => {
                newton.evaluate(start)?
            }
            evaluated => evaluated?,
        };
        if newton.contact.activate_initial(&mut now) {
            now = newton.again(now)?;
        }
        let Workspace { system, timings, .. } = &mut *newton.work;
        timed(&mut timings.factor, || system.start(model, &newton.renewal))?;
        Ok((newton, now))
    }

    /// Finds the pairs of a guess and evaluates it.
    fn evaluate(&mut self, mut guess: Iterate) -> Result<Evaluation, Rejected> {
        let Workspace { spare, timings, .. } = &mut *self.work;
        let y: Vec<f64> = self.equations.state.y.iter().zip(&guess.increment).map(|(y, d)| y + d).collect();
        timed(&mut timings.contact, || self.contact.search(&y, &mut guess.pairings));
        self.equations.evaluate(guess, spare, timings)
    }

    /// Evaluates an iterate whose pairs have changed again. The existing rows belong to the
    /// previous pairs.
    fn again(&mut self, mut now: Evaluation) -> Result<Evaluation, Rejected> {
        self.work.linear.restart();
        self.equations.change_contacts(&mut now, &mut self.work.timings)?;
        Ok(now)
    }

    /// Notes whether the equilibrium of a load step is stable. That is not known with friction and
    /// pressures that follow the body, whose tangents are not symmetric, without a factor, and
    /// where the tangent has none.
    fn assess(&mut self, now: &Evaluation) {
        let equations = self.equations;
        let model = equations.model;
        let is_known = equations.stage.is_static()
            && !model.has_friction()
            && !model.loads.follow_sides()
            && !self.work.system.preconditioner.is_iterative();
        if is_known {
            let last = self.renewal.frozen.point.as_deref();
            let Workspace { system, timings, .. } = &mut *self.work;
            let is_stable = timed(&mut timings.factor, || system.is_stable(equations, now, last));
            self.effort.unstable = matches!(is_stable, Ok(Some(false)));
        }
    }

    /// Starts from another guess.
    fn restart(&mut self, now: Evaluation, guess: Iterate) -> Result<Evaluation, Rejected> {
        self.work.spare.put(now);
        self.contact.restart();
        self.work.linear.restart();
        self.evaluate(guess)
    }

    /// Starts the next round, a solve of its own, from the solution of the last one.
    fn next_round(&mut self, now: Evaluation) -> Result<Evaluation, Rejected> {
        (self.iteration, self.step, self.ratio, self.grown) = (0, f64::INFINITY, 1.0, 0);
        self.again(now)
    }

    /// Whether it would cost an iteration to try the contacts that the predictor leads to.
    fn is_costly_guess(&self) -> bool {
        self.iteration == 0 && self.work.system.preconditioner.is_iterative()
    }

    /// A tangent formed at a predicted position that is given up is formed again if solves iterate
    /// with it: they find no better direction than it gives. With a factor, a solve is corrected by
    /// products with the exact tangent, and another factor would cost more.
    fn doubt_tangent(&mut self) {
        self.renewal.due |= self.renewal.made > 0 && self.work.system.preconditioner.is_iterative();
        self.step = f64::INFINITY;
    }

    /// Whether all criteria are met that the contacts do not decide. The error of an inexact linear
    /// solve shrinks with the residual, so the residual is reduced further if linear problems are
    /// solved inexactly. Without inertia corrections may grow before they shrink.
    fn has_converged(&mut self, now: &Evaluation) -> bool {
        let equations = self.equations;
        let model = self.equations.model;
        let measure = &now.measure;
        let is_static = equations.stage.is_static();
        let tolerance = self.settings.tolerance;
        self.noise = self.work.system.round_off(equations) + round_off_of_springs(equations, now);
        self.enough = DIGITS * tolerance * measure.forces + self.noise;
        self.step * if is_static { 1.0 } else { self.ratio.min(1.0) } <= tolerance * model.scale
            && measure.residual <= self.enough
            && (measure.gap <= model.gap_tolerance
                || measure.may_depend && Constraints::gap(equations, now) <= model.gap_tolerance)
            && (is_static || self.is_at_rest() || are_balanced(equations, now, self.noise))
    }

    /// Whether the last correction is below the round-off of positions of the size of the model, so
    /// that further ones change nothing. Resultants then remain of the size of the round-off of the
    /// forces of cells, of which nodal forces are differences: much more than the forces that move
    /// a light and stiff body.
    fn is_at_rest(&self) -> bool {
        self.step <= 0.5 * f64::EPSILON * self.equations.model.scale
    }

    /// Updates the contacts of an iterate; returns whether one changed.
    fn change_contacts(&mut self, now: &mut Evaluation, converged: bool) -> Result<bool, Rejected> {
        let changed = self.contact.update(now, converged, self.step, self.work)?;
        let scale = self.equations.model.scale;
        let iterate = Iteration {
            number: self.iteration as u32,
            residual: now.measure.residual / now.measure.forces.max(f64::MIN_POSITIVE),
            gap: now.measure.gap / scale,
            correction: self.step / scale,
            length: 1.0,
            active: now.pressing().count() as u32,
            changed,
        };
        self.work.trace.push(iterate, &now.y);
        Ok(changed)
    }

    /// # Errors
    /// After too many iterations, or corrections that grow.
    fn check_progress(&mut self, now: &Evaluation, changed: bool) -> Result<(), Rejected> {
        let equations = self.equations;
        let model = self.equations.model;
        let measure = &now.measure;
        let is_static = equations.stage.is_static();
        if self.iteration < self.settings.max_iterations && (is_static || self.grown <= PATIENCE) {
            return Ok(());
        }
        self.work.trace.blame(&now.residual, &model.free);
        self.contact.check_satisfiable(now)?;
        Err(Rejected::NoConvergence {
            iterations: self.iteration as u32,
            step: [self.step / model.scale, self.settings.tolerance],
            residual: [measure.residual, self.enough].map(|r| r / measure.forces.max(f64::MIN_POSITIVE)),
            gap: Some([measure.gap, model.gap_tolerance].map(|gap| gap / model.scale)),
            unbalanced: !is_static && !self.is_at_rest() && !are_balanced(equations, now, self.noise),
            changing: changed,
        })
    }

    /// Solves the linear problem of an iterate with these rows, as accurately as the progress of
    /// the outer iteration and its convergence criterion require. In load steps a remaining
    /// residual would appear in reactions: its tolerance is mostly round-off of positions.
    fn correct(
        &mut self,
        now: &Evaluation,
        rows: &Constraints,
        changed: bool,
    ) -> Result<Correction, Rejected> {
        let equations = self.equations;
        let model = self.equations.model;
        let settings = self.settings;
        let is_static = equations.stage.is_static();
        if is_static {
            let gaps = rows.rows.iter();
            let slips = now.slipping();
            check_rigid_modes(&model.parts, &model.unconstrained, &now.place, gaps, slips)?;
        }
        let made = self.renewal.made;
        // Where metal yields, the tangent is a thousand times softer than where it is elastic, and
        // without inertia nothing else keeps the factor of one near that of the other.
        self.renewal.due |= settings.tangent == Tangent::Full || is_static && model.remembers();
        let Workspace { linear, system, timings, .. } = &mut *self.work;
        timed(&mut timings.factor, || system.prepare(equations, now, rows, &mut self.renewal))?;
        let regularity = system.preconditioner.regularity().filter(|_| rows.is_skew);
        self.contact.regularity = self.contact.regularity.min(regularity.unwrap_or(f64::INFINITY));
        self.effort.regularity = regularity;
        let node = |&(k, p): &(usize, usize)| (k, model.contacts[k].node(&now.at.pairings[k].pairs[p]));
        self.effort.dependent = rows.dependent.iter().map(node).collect();
        let pace = if changed { 1.0 } else { self.ratio };
        let digits = if is_static { DIGITS } else { 1.0 };
        let goal = Goal {
            forcing: digits * FORCING.min(FORCING_RATIO * pace).max(self.enough / now.measure.residual),
            step: settings.tolerance * model.scale,
            fresh: self.renewal.made != made,
            trust: if self.unpredicted.is_some() { self.trust } else { f64::INFINITY },
            mixing: settings.mixing,
        };
        let preconditioner = &mut *system.preconditioner;
        let correction =
            linear.solve(equations, now, rows, preconditioner, &mut self.renewal, goal, timings)?;
        self.iteration += 1;
        self.effort.iterations += correction.solves;
        Ok(correction)
    }

    /// Takes the Newton step, shortened if it inverts a cell or, with unchanged contacts, greatly
    /// increases the residual; and observes the progress.
    fn advance(
        &mut self,
        now: Evaluation,
        correction: &Correction,
        rows: &Constraints,
        changed: bool,
    ) -> Result<Evaluation, Rejected> {
        let equations = self.equations;
        let scale = self.equations.model.scale;
        let size = max_abs(&correction.increment);
        self.grown += u32::from(!changed && size > self.step && size > self.settings.tolerance * scale);
        self.step = size;
        let merit = |m: &Measure| (m.residual / m.forces.max(f64::MIN_POSITIVE)).max(m.gap / scale);
        // Until moving supports have reached their positions, the balance is not comparable.
        let compares = !changed && equations.remaining(&now.at).all(|(_, distance)| distance == 0.0);
        let is_worse = |next: &Evaluation| {
            let [before, after] = [&now.measure, &next.measure].map(merit);
            compares && after > WORSE * before && after > NEGLIGIBLE
        };
        let mut length = 1.0;
        let mut outcome = self.take(&now, correction, rows, 1.0);
        while length > SHORTEST && outcome.as_ref().map_or(true, is_worse) {
            length *= 0.5;
            self.work.linear.restart();
            self.work.trace.shorten(length);
            outcome = self.take(&now, correction, rows, length);
        }
        if length == SHORTEST && outcome.is_ok() {
            // If shortening does not help, the full step is as good as any: contact forces appear
            // and vanish.
            self.work.trace.shorten(1.0);
            outcome = self.take(&now, correction, rows, 1.0).or(outcome);
        }
        let next = outcome?;
        self.ratio = next.measure.residual / now.measure.residual.max(f64::MIN_POSITIVE);
        self.work.spare.put(now);
        Ok(next)
    }

    /// Evaluates the end of a share of a correction.
    fn take(
        &mut self,
        now: &Evaluation,
        correction: &Correction,
        rows: &Constraints,
        length: f64,
    ) -> Result<Evaluation, Rejected> {
        let mut at = self.work.spare.copy(&now.at);
        at.increment.iter_mut().zip(&correction.increment).for_each(|(d, change)| *d += length * change);
        if length == 1.0 {
            self.equations.arrive(&mut at.increment);
        }
        rows.add_to(&mut at.pairings, length, &correction.multipliers);
        self.equations.evaluate(at, &mut self.work.spare, &mut self.work.timings)
    }
}
