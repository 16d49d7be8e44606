//! Trials of changed cases past the place where a run stopped. Effort is counted in iterations ×
//! unknowns, not in seconds: the same run gives the same trials on any machine.

use std::sync::atomic::{AtomicBool, Ordering};

use carom_case::Case;
use carom_mechanics::{FrozenTangent, GridReport, HalfStepVelocity, Simulation, State};
use carom_record::Trial;

use super::change::{Change, Kind};
use crate::Setup;
use crate::initial::saved;

/// Steps of the run beyond the place after which a trial has got past it.
const BEYOND: f64 = 5.0;
/// Bisections of a step in a trial. What succeeds with few of them succeeds with more.
const BISECTIONS: u32 = 4;
/// Effort of one trial: at most this multiple of that of the run, and at most this many
/// iterations × unknowns (about a second). A short run may take the least, too.
const MULTIPLE: u64 = 8;
const MOST: u64 = 4_000_000;
const LEAST: u64 = 1_000_000;
/// Iterations that a step of the run counts.
pub(super) const TYPICAL: u64 = 4;
/// Iterations that a rejected attempt counts.
const REJECTED: u64 = 8;

/// Effort of a run: iterations, and unknowns.
#[derive(Clone, Copy, Debug)]
pub(super) struct Effort {
    pub iterations: u64,
    pub unknowns: u64,
}

impl Effort {
    fn spent(self) -> u64 {
        self.iterations * self.unknowns
    }

    /// Allowed for a trial.
    fn limit(self) -> u64 {
        (MULTIPLE * self.spent()).clamp(LEAST, MOST)
    }
}

/// How a trial went.
pub(super) enum Tried {
    Ended(Trial),
    /// The changed case cannot be started.
    Refused,
    /// From the start it would take too long, and there is no state of the run to begin from.
    NotAffordable,
    Interrupted,
}

/// The trials of a run that stopped.
pub(super) struct Trials<'a> {
    pub case: &'a Case,
    /// Time of the stop.
    pub stop: f64,
    /// Time of the last accepted state of the run.
    pub last: f64,
    /// A state of the run a few steps before.
    pub earlier: Option<&'a State>,
    pub effort: Effort,
    pub threads: usize,
}

impl Trials<'_> {
    /// How the trials are made.
    pub(super) fn words(&self) -> String {
        format!(
            "Each change was tried alone, up to {BEYOND} steps past the stop, with a step bisected at most \
             {BISECTIONS} times and a limited effort: {:.1e} iterations × unknowns (the run took {:.1e}).",
            self.effort.limit() as f64,
            self.effort.spent() as f64
        )
    }

    /// Runs a changed case past the stop: from its start if that is affordable, otherwise, or if it
    /// then ends before the run itself did, from an earlier state of the run.
    pub(super) fn trial(&self, change: &Change, interrupted: &AtomicBool) -> Tried {
        let factor = match change.kind {
            Kind::Shorter => 4,
            Kind::Bathe | Kind::Full => 2,
            _ => 1,
        };
        let setup = || Setup::new(&change.case).threads(self.threads);
        let later = |from: f64| {
            let state = self.earlier.filter(|state| state.time > from)?;
            Some(setup().resume(adapted(state, change)?).ok())
        };
        let mut first: Option<Trial> = None;
        if factor * self.effort.spent() <= self.effort.limit() {
            // The case may itself continue from a saved state.
            let started = match saved(self.case.initial.as_ref()) {
                Ok(Some(state)) => adapted(&state, change).and_then(|state| setup().resume(state).ok()),
                _ => setup().start().ok(),
            };
            let Some(simulation) = started else { return Tried::Refused };
            let Some(trial) = self.run(simulation, interrupted) else { return Tried::Interrupted };
            // One that ends before the run did says nothing about the place.
            if trial.passed || trial.reached > self.last - 1.001 * change.case.time.step {
                return Tried::Ended(trial);
            }
            first = Some(trial);
        }
        let began = first.as_ref().map_or(f64::NEG_INFINITY, |trial| trial.from);
        match (later(began), first) {
            (Some(Some(simulation)), _) => {
                self.run(simulation, interrupted).map_or(Tried::Interrupted, Tried::Ended)
            }
            (_, Some(trial)) => Tried::Ended(trial),
            (Some(None), None) => Tried::Refused,
            (None, None) => Tried::NotAffordable,
        }
    }

    /// None if it was interrupted.
    fn run(&self, mut simulation: Simulation, interrupted: &AtomicBool) -> Option<Trial> {
        simulation.limit_bisections(BISECTIONS);
        let target = (self.stop + BEYOND * self.case.time.step).min(self.case.time.end);
        let from = simulation.state().time;
        let mut spent = 0;
        let why = loop {
            let time = simulation.state().time;
            if simulation.finished() || time >= target * (1.0 - 1e-12) {
                break None;
            }
            if interrupted.load(Ordering::Relaxed) {
                return None;
            }
            if spent > self.effort.limit() {
                break Some("the effort for a trial was spent".to_owned());
            }
            let mut report = GridReport::default();
            if let Err(stopped) = simulation.advance(&mut report) {
                break Some(self.case.in_units(&stopped.to_string()));
            }
            let iterations = 1 + u64::from(report.newton) + REJECTED * u64::from(report.rejected);
            spent += iterations * self.effort.unknowns;
        };
        Some(Trial { from, reached: simulation.state().time, passed: why.is_none(), why })
    }
}

/// A state of the run as one of the changed case. What the scheme remembers of earlier steps is not
/// that of another scheme.
fn adapted(state: &State, change: &Change) -> Option<State> {
    let mut state = state.clone();
    match change.kind {
        Kind::Shorter if change.case.time.phase == 0.0 => state.step *= 4,
        Kind::Longer if state.step.is_multiple_of(2) => state.step /= 2,
        Kind::Shorter | Kind::Longer => return None,
        Kind::Bathe | Kind::Damped | Kind::Inertia => {
            (state.previous, state.half_step) = (None, HalfStepVelocity::default());
        }
        _ => {}
    }
    state.frozen = FrozenTangent::default();
    state.pairs.iter_mut().flatten().for_each(|pair| pair.start = None);
    Some(state)
}
