//! Trials of changed cases past the place where a run stopped. Effort is counted in iterations ×
//! unknowns, not in seconds: the same run gives the same trials on any machine.

use carom_case::Case;
use carom_mechanics::{FrozenTangent, GridReport, HalfStepVelocity, Simulation, State};
use carom_record::Trial;

use super::change::{Change, Kind};
use crate::Setup;

/// Steps of the run beyond the place after which a trial has got past it.
const BEYOND: f64 = 5.0;
/// Bisections of a step in a trial. What succeeds with few of them succeeds with more.
const BISECTIONS: u32 = 4;
/// Effort of one trial: at most this multiple of that of the run, and at most this many iterations ×
/// unknowns (about a second). A short run may take the least, too.
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

/// How the trials are made, in words.
pub(super) fn words(effort: Effort) -> String {
    format!(
        "Each change was tried alone, up to {BEYOND} steps past the place, with at most {BISECTIONS} bisections \
         of a step and {:.1e} iterations × unknowns (the run took {:.1e}).",
        effort.limit() as f64,
        effort.spent() as f64
    )
}

/// Runs a changed case past a time, from its start if that is affordable, otherwise from an earlier
/// state of the run; none if the changed case cannot be started.
pub(super) fn trial(
    change: &Change,
    case: &Case,
    earlier: &State,
    stop: f64,
    effort: Effort,
    threads: usize,
) -> Option<Trial> {
    let factor = match change.kind {
        Kind::Shorter => 4,
        Kind::Bathe | Kind::Full => 2,
        _ => 1,
    };
    let setup = Setup::new(&change.case).threads(threads);
    let mut simulation = if factor * effort.spent() <= effort.limit() {
        setup.start().ok()?
    } else {
        setup.resume(adapted(earlier, change)?).ok()?
    };
    simulation.limit_bisections(BISECTIONS);
    let target = (stop + BEYOND * case.time.step).min(case.time.end);
    Some(run(&mut simulation, target, effort))
}

fn run(simulation: &mut Simulation, target: f64, effort: Effort) -> Trial {
    let from = simulation.state().time;
    let mut spent = 0;
    let why = loop {
        let time = simulation.state().time;
        if simulation.finished() || time >= target * (1.0 - 1e-12) {
            break None;
        }
        if spent > effort.limit() {
            break Some("the effort for a trial was spent".to_owned());
        }
        let mut report = GridReport::default();
        if let Err(stopped) = simulation.advance(&mut report) {
            break Some(stopped.to_string());
        }
        spent += (1 + u64::from(report.newton) + REJECTED * u64::from(report.rejected)) * effort.unknowns;
    };
    Trial { from, reached: simulation.state().time, passed: why.is_none(), why }
}

/// A state of the run as one of the changed case. What the scheme remembers of earlier steps is not
/// that of another scheme.
fn adapted(state: &State, change: &Change) -> Option<State> {
    let mut state = state.clone();
    match change.kind {
        Kind::Shorter if change.case.time.phase == 0.0 => state.step *= 4,
        Kind::Longer if state.step.is_multiple_of(2) => state.step /= 2,
        Kind::Shorter | Kind::Longer => return None,
        Kind::Bathe | Kind::Damped => {
            (state.previous, state.half_step) = (None, HalfStepVelocity::default());
        }
        _ => {}
    }
    state.frozen = FrozenTangent::default();
    state.pairs.iter_mut().flatten().for_each(|pair| pair.start = None);
    Some(state)
}
