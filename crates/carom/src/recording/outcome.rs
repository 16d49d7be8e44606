//! What a run is asked for, what it tells after each step, and how it ends.

use std::path::PathBuf;

use carom_case::Problem;
use carom_mechanics::Stopped;
use carom_record::RecordError;

/// How to run.
#[derive(Clone, Copy, Debug)]
pub struct Options {
    /// Threads; results do not depend on them.
    pub threads: usize,
}

/// Where a simulation is, after an accepted step.
#[derive(Clone, Copy, Debug)]
pub struct Progress {
    /// Step just finished.
    pub step: u64,
    /// Steps in all.
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
    /// Pairs that came into contact in it.
    pub activations: u32,
    /// Pairs that left contact in it.
    pub releases: u32,
    /// Created energy over the largest kinetic + strain energy so far.
    pub energy_drift: f64,
    /// Wall seconds of this process.
    pub wall: f64,
    /// Wall seconds left, extrapolated.
    pub left: f64,
}

/// How a run ended.
#[derive(Clone, Debug, PartialEq)]
pub enum End {
    /// At its end time.
    Finished,
    /// By the user; resumable.
    Interrupted,
    /// The simulation could not go on; its last good state is kept.
    Stopped(Stopped),
}

/// A run that ended.
#[derive(Clone, Debug)]
pub struct Outcome {
    /// Where its record is.
    pub directory: PathBuf,
    /// How it ended.
    pub end: End,
    /// Steps done.
    pub steps: u64,
    /// Time reached.
    pub time: f64,
    /// Wall seconds of this process.
    pub wall: f64,
    /// Said once, e.g. that a damaged checkpoint was passed over.
    pub remarks: Vec<String>,
}

/// Why there is no (complete) run.
#[derive(Debug, thiserror::Error)]
pub enum RunError {
    /// The case is wrong in a way only its model shows. Nothing was written.
    #[error("{}", .0.iter().map(|p| p.what.as_str()).collect::<Vec<_>>().join("; "))]
    Case(Vec<Problem>),
    /// The run directory could not be written or read.
    #[error(transparent)]
    Record(#[from] RecordError),
    /// The run directory holds something this version cannot go on from.
    #[error("{what}")]
    Incompatible {
        /// What does not fit.
        what: String,
    },
}
