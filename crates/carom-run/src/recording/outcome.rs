//! Progress of a run after each step, and its outcome.

use std::path::PathBuf;

use carom_case::Problems;
use carom_mechanics::Stopped;
use carom_record::{RecordError, Run};

/// Progress of a simulation after an accepted step, and every second while a step is bisected.
#[derive(Clone, Copy, Debug, serde::Serialize)]
pub struct Progress {
    /// Step just finished.
    pub step: u64,
    /// Total number of steps.
    pub steps: u64,
    /// Time.
    pub time: f64,
    /// Grid step.
    pub dt: f64,
    /// Newton iterations of the step.
    pub newton: u32,
    /// Active pairs.
    pub active: usize,
    /// Attempts at it that were rejected and repeated with a smaller step.
    pub rejected: u32,
    /// Whether the step is still being bisected; time and Δt are then those of the last attempt.
    pub bisecting: bool,
    /// Pairs that came into contact in it.
    pub activations: u32,
    /// Pairs that left contact in it.
    pub releases: u32,
    /// Energy created so far over the energy scale so far.
    pub created: f64,
    /// Wall seconds of this process.
    pub wall: f64,
    /// Estimated wall seconds remaining.
    #[serde(rename = "eta")]
    pub left: f64,
}

/// How a run ended.
#[derive(Clone, Debug, PartialEq)]
pub enum End {
    /// At its end time.
    Finished,
    /// By the user; resumable.
    Interrupted,
    /// The simulation cannot continue; its last accepted state is saved.
    Stopped(Stopped),
}

/// A run that ended.
#[derive(Clone, Debug)]
pub struct Outcome {
    /// Directory of its record.
    pub directory: PathBuf,
    /// How it ended.
    pub end: End,
    /// Why it did not finish, with the units of the case.
    pub reason: Option<String>,
    /// Steps done.
    pub steps: u64,
    /// Time reached.
    pub time: f64,
    /// Wall seconds of this process.
    pub wall: f64,
    /// Remarks, e.g. that a damaged checkpoint was skipped.
    pub remarks: Vec<String>,
    /// The record, if this process has computed the run to its end.
    pub record: Option<Run>,
}

/// Why there is no (complete) run.
#[derive(Debug, thiserror::Error)]
pub enum RunError {
    /// A problem of the case that only its model reveals. Nothing was written.
    #[error(transparent)]
    Case(Problems),
    /// The run directory could not be written or read.
    #[error(transparent)]
    Record(#[from] RecordError),
    /// The run directory contains data from which this version cannot resume.
    #[error("{what}")]
    Incompatible {
        /// The incompatibility.
        what: String,
    },
}
