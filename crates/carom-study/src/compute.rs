//! Computes one arm of a study in its directory, from the start or from its last checkpoint.

use std::path::Path;
use std::sync::atomic::AtomicBool;

use carom_record::study::StudyManifest;
use carom_run::case::Case;
use carom_run::recording::{self, Options, Progress};

use crate::error::StudyError;
use crate::jobs::Ended;

/// Computes a run to its end; `begun`: resumes it.
pub(crate) fn compute(
    manifest: &StudyManifest,
    directory: &Path,
    i: usize,
    begun: bool,
    observe: &mut dyn FnMut(&Progress),
    stop: &AtomicBool,
) -> Result<Ended, StudyError> {
    let arm = manifest.run(i);
    let path = directory.join(&arm.directory);
    let options = Options { threads: 1 };
    let done = if begun {
        recording::resume(&path, options, observe, stop)
    } else {
        let case: Case = serde_json::from_value(arm.case.clone())
            .map_err(|e| StudyError::Incompatible { arm: arm.name.clone(), what: e.to_string() })?;
        let source = manifest.source_of(arm);
        recording::run(&case, source, &path, options, observe, stop)
    };
    done.map(Ended::of).map_err(|source| StudyError::Arm { arm: arm.name.clone(), source })
}
