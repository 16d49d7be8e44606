//! Counters and timings of a run, over all processes that worked on it; a checkpoint contains them.

use std::collections::BTreeMap;

use carom_mechanics::{Simulation, State};
use cpu_time::{ProcessTime, ThreadTime};
use serde::{Deserialize, Serialize};

use super::columns::Since;
use super::frames::Written;
use super::outcome::RunError;

/// Counters and timings of a run up to a checkpoint.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub(super) struct Tally {
    pub(super) counters: BTreeMap<String, u64>,
    pub(super) timings: BTreeMap<String, f64>,
    /// Largest rotation and strain of each linear-elastic body in a row, with their times.
    pub(super) rotations: BTreeMap<usize, [[f64; 2]; 2]>,
    /// The frames that were written.
    pub(super) frames: Written,
}

impl Tally {
    /// The start may need a factorisation.
    pub(super) fn at_start(simulation: &Simulation) -> Self {
        let counters = [("factorisations".to_owned(), simulation.factorisations())].into();
        Self { counters, ..Self::default() }
    }
}

/// A checkpoint: the state, what the next row will count, and what the run has counted.
pub(super) fn checkpoint(state: &State, since: Since, tally: &Tally) -> Result<Vec<u8>, RunError> {
    postcard::to_stdvec(&(state, since, tally))
        .map_err(|e| RunError::Incompatible { what: format!("the state cannot be encoded: {e}") })
}

/// Reads the bytes of [`checkpoint`].
pub(super) fn from_checkpoint(bytes: &[u8]) -> Result<(State, Since, Tally), postcard::Error> {
    postcard::from_bytes(bytes)
}

/// Processor time: of this thread alone, since other runs may share the process; of the whole
/// process if steps use several threads.
pub(super) enum Busy {
    Thread(ThreadTime),
    Process(ProcessTime),
}

impl Busy {
    pub(super) fn now(threads: usize) -> Self {
        if threads == 1 { Self::Thread(ThreadTime::now()) } else { Self::Process(ProcessTime::now()) }
    }

    pub(super) fn seconds(&self) -> f64 {
        match self {
            Self::Thread(began) => began.elapsed().as_secs_f64(),
            Self::Process(began) => began.elapsed().as_secs_f64(),
        }
    }
}
