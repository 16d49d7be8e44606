//! Numbers of threads and of concurrent runs.

use carom::ThreadCount;
use carom::record::Machine;
use pyo3::prelude::*;

/// The largest number of threads, or of concurrent runs, that is accepted.
#[pyfunction]
pub(crate) fn most_concurrent() -> usize {
    Machine::current().most_concurrent()
}

/// The number of threads of a run: that which is asked for, or as many as pay.
pub(crate) fn thread_count(requested: Option<usize>) -> ThreadCount {
    let most = || ThreadCount::UpTo(Machine::current().cpus);
    requested.map_or_else(most, ThreadCount::Exactly)
}
