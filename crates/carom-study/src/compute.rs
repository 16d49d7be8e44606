//! Computes one arm of a study in its directory, from the start or from its last checkpoint.

use std::path::Path;
use std::sync::atomic::AtomicBool;

use carom_record::study::{Arm, StudyManifest};
use carom_run::ThreadCount;
use carom_run::case::Case;
use carom_run::recording::{self, RunError};

use crate::error::StudyError;
use crate::jobs::{Ended, OnStep};

/// Computes run number `i` to its end; one that has begun is resumed.
pub(crate) fn compute(
    manifest: &StudyManifest,
    directory: &Path,
    i: usize,
    threads: ThreadCount,
    observe: OnStep,
    stop: &AtomicBool,
) -> Result<Ended, StudyError> {
    let arm = manifest.run(i);
    let path = directory.join(&arm.directory);
    let done = if path.join("manifest.json").is_file() {
        recording::resume(&path, threads, observe, stop)
    } else {
        let case = case_of(arm)?;
        let source = manifest.source_of(arm);
        recording::run(&case, source, &path, threads, observe, stop)
    };
    done.map(Ended::of).map_err(|error| match error {
        RunError::Record(error) => StudyError::of_record(arm, directory, error),
        source => StudyError::Arm { arm: arm.name.clone(), source },
    })
}

/// The case of a run.
pub(crate) fn case_of(run: &Arm) -> Result<Case, StudyError> {
    serde_json::from_value(run.case.clone())
        .map_err(|e| StudyError::Incompatible { arm: run.name.clone(), what: e.to_string() })
}
