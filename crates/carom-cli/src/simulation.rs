//! The boundary to the library: what a command asks of a simulation, and what it gets back.

use std::path::{Path, PathBuf};
use std::sync::atomic::AtomicBool;

use carom::case::{Case, Document};
use serde::Serialize;

use crate::exit::Failure;

/// How to run.
#[derive(Clone, Copy, Debug)]
#[allow(dead_code)]
pub(crate) struct Options {
    /// Threads; results do not depend on them.
    pub(crate) threads: usize,
    /// Whether figures and page are made at the end.
    pub(crate) report: bool,
    /// Whether wall time is measured by phase.
    pub(crate) profile: bool,
}

/// Where a simulation is, after an accepted step.
#[derive(Clone, Copy, Debug, Serialize)]
pub(crate) struct Progress {
    pub(crate) step: usize,
    pub(crate) steps: usize,
    pub(crate) time: f64,
    pub(crate) dt: f64,
    /// Newton iterations of the step.
    pub(crate) newton: usize,
    /// Active contact nodes.
    pub(crate) active: usize,
    /// (total − total₀ − external work) / largest energy so far.
    pub(crate) energy_drift: f64,
    /// Wall seconds so far and left.
    pub(crate) wall: f64,
    pub(crate) eta: f64,
}

/// A finished or interrupted run.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct Outcome {
    pub(crate) directory: PathBuf,
    /// Stopped by Ctrl-C before the end.
    pub(crate) interrupted: bool,
    pub(crate) steps: usize,
    pub(crate) time: f64,
    pub(crate) wall: f64,
    pub(crate) extremes: Vec<Extreme>,
    pub(crate) expectations: Vec<Expectation>,
    /// Wall seconds by phase, with `--profile`.
    pub(crate) profile: Vec<(String, f64)>,
    /// The page, if it was made.
    pub(crate) report: Option<PathBuf>,
}

/// Smallest and largest value of a probe's column.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct Extreme {
    pub(crate) column: String,
    pub(crate) unit: String,
    pub(crate) min: f64,
    pub(crate) min_time: f64,
    pub(crate) max: f64,
    pub(crate) max_time: f64,
}

/// An `[[expect]]` with what came out.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct Expectation {
    pub(crate) what: String,
    /// `-0.7827 ± 0.004`.
    pub(crate) wanted: String,
    pub(crate) got: Option<f64>,
    pub(crate) met: bool,
}

/// What the model of a case has, for `carom check`.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct Facts {
    pub(crate) bodies: Vec<BodyFacts>,
    /// Steps a pressure wave takes through the smallest body.
    pub(crate) transit_steps: f64,
}

/// A body's mesh.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct BodyFacts {
    pub(crate) name: String,
    pub(crate) nodes: usize,
    pub(crate) cells: usize,
    /// Sides with their numbers of nodes.
    pub(crate) sides: Vec<(String, usize)>,
    /// Free degrees of freedom.
    pub(crate) dofs: usize,
}

fn absent() -> Failure {
    Failure::Refused { what: "this build of Carom reads cases but does not simulate them".to_owned() }
}

/// Runs a case into a directory that does not exist yet.
pub(crate) fn run(
    _case: &Case,
    _document: &Document,
    _out: &Path,
    _options: Options,
    _progress: &mut dyn FnMut(&Progress),
    _stop: &AtomicBool,
) -> Result<Outcome, Failure> {
    Err(absent())
}

/// Goes on with a run that was stopped; a finished one is returned as it is.
pub(crate) fn resume(
    _directory: &Path,
    _options: Options,
    _progress: &mut dyn FnMut(&Progress),
    _stop: &AtomicBool,
) -> Result<Outcome, Failure> {
    Err(absent())
}

/// Builds the model of a case, so that what only the model knows is checked too.
#[allow(clippy::unnecessary_wraps)]
pub(crate) fn facts(_case: &Case, _document: &Document) -> Result<Option<Facts>, Failure> {
    Ok(None)
}

/// Makes figures and page of a run directory from its records.
pub(crate) fn report(_directory: &Path) -> Result<PathBuf, Failure> {
    Err(absent())
}
