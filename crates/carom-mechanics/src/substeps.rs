//! Substeps of a grid step. A rejected step is bisected, unless a formula has no value that is
//! allowed. So is a step that creates more than a tenth of the energy that the guard still allows;
//! it is stored, and taken after all if the shortest step is rejected, or a shorter one creates
//! more than four times as much: energy that the error of a smooth motion creates falls with the
//! cube of the step, that of an impact or a change of facet does not.

use crate::grid_report::GridReport;
use crate::rejected::Rejected;
use crate::state::State;
use crate::stepper::Accepted;

/// Bisections of Δt before the run stops.
pub(crate) const MOST: u32 = 12;
/// Share of the energy that the guard still allows that one step may create.
const STEP: f64 = 0.1;
/// Created energy over the energy scale that is round-off.
const ROUND_OFF: f64 = 1e-12;
/// Created energy of a shorter step relative to that of the longer one, above which it makes it
/// worse.
const WORSE: f64 = 4.0;

/// Progress through a grid step in units of Δt/2^level.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Progress {
    /// Number of bisections.
    pub level: u32,
    /// Units that are done.
    pub done: u64,
}

impl Progress {
    /// Part of the grid step that is done.
    pub fn done(self) -> f64 {
        self.done as f64 / (1_u64 << self.level) as f64
    }

    /// Part of the grid step at the end of the next substep.
    pub fn next(self) -> f64 {
        Self { done: self.done + 1, ..self }.done()
    }

    /// Halves the next substep.
    pub fn bisect(&mut self) {
        *self = Self { level: self.level + 1, done: 2 * self.done };
    }

    /// Completes a substep, and returns to the longest step that begins there.
    pub fn advance(&mut self) {
        self.done += 1;
        while self.level > 0 && self.done.is_multiple_of(2) {
            *self = Self { level: self.level - 1, done: self.done / 2 };
        }
    }
}

/// A step that created energy, with the report before it, while shorter ones are tried.
pub(crate) struct StoredStep {
    step: Accepted,
    created: f64,
    /// Whether the guard allows it.
    is_within: bool,
    at: Progress,
    report: GridReport,
}

/// What follows from a step.
pub(crate) enum Next {
    /// It is the next one.
    Take(Accepted),
    /// Shorter ones are tried.
    Bisect(Rejected),
    /// Shorter ones do not help, for this reason: the one that was stored is the next one.
    Return(Rejected, Accepted),
    /// Not even the shortest one is accepted.
    Stop(Rejected),
}

/// Limits of a grid step.
#[derive(Clone, Copy)]
pub(crate) struct Limits {
    /// Share of the energy scale that the run may create.
    pub guard: Option<f64>,
    /// Energy that may always be created.
    pub floor: f64,
    /// Bisections before the run stops.
    pub bisections: u32,
    /// Time at the end of the grid step.
    pub end: f64,
}

/// Decides about a step from `from`.
pub(crate) fn decide(
    stepped: Result<Accepted, Rejected>,
    from: &State,
    limits: Limits,
    stored: &mut Option<StoredStep>,
    progress: &mut Progress,
    report: &mut GridReport,
) -> Next {
    if stored.as_ref().is_some_and(|stored| progress.done() >= stored.at.next()) {
        *stored = None;
    }
    let is_final = |rejected: &Rejected| rejected.is_final(limits.end);
    let last = progress.level >= limits.bisections || stepped.as_ref().is_err_and(is_final);
    let (rejected, returns) = match stepped {
        Ok(mut step) => {
            step.observe();
            let Some((created, allowed)) =
                limits.guard.and_then(|share| beyond(&step, from, share, limits.floor))
            else {
                return Next::Take(step);
            };
            let worse = |stored: &StoredStep| stored.is_within && (last || created > WORSE * stored.created);
            let returns = stored.as_ref().is_some_and(worse);
            if last && !returns {
                return Next::Take(step);
            }
            if stored.is_none() {
                let is_within = created <= allowed / STEP;
                let report = report.clone();
                *stored = Some(StoredStep { step, created, is_within, at: *progress, report });
            }
            (Rejected::Energy { created, allowed }, returns)
        }
        Err(rejected) => (rejected, last && stored.as_ref().is_some_and(|stored| stored.is_within)),
    };
    match stored.take_if(|_| returns) {
        Some(stored) => {
            *progress = stored.at;
            report.return_to(stored.report);
            Next::Return(rejected, stored.step)
        }
        None if last => Next::Stop(rejected),
        None => Next::Bisect(rejected),
    }
}

/// The energy that a step created and what it may create, if it is less.
fn beyond(step: &Accepted, from: &State, share: f64, floor: f64) -> Option<(f64, f64)> {
    let before = &from.ledger;
    let now = &step.state().ledger;
    let so_far = before.surely_created().max(0.0);
    let created = now.surely_created() - so_far;
    let allowed = STEP * (share * now.scale() + floor - so_far).max(0.0);
    (created > allowed.max(ROUND_OFF * now.scale())).then_some((created, allowed))
}
