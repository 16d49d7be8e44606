//! Checks of a study with a goal after its arms have ended: the arm with the fewest steps and
//! iterations is computed again with two threads, and once more, stopped at the first step with
//! contact (without contact, at the last step but one) and resumed from its files. The tables of
//! all three must be bitwise identical.
//!
//! The result is written to `checks.json` and shown on the page. The repetitions are kept, in
//! `checks/`, only if they differ.

use std::fs;
use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};

use carom_record::study::checks::{Checks, fingerprint};
use carom_record::study::{Arm, StudyManifest};
use carom_record::{RecordError, Status};
use carom_run::recording::{self, End, Progress};

use crate::compute::case_of;
use crate::error::StudyError;

/// Number of threads of the first repetition; arms have one.
const THREADS: usize = 2;

/// Makes the checks, unless they exist or no arm has finished. If they cannot be made, because of a
/// full disk or Ctrl-C, the study is still valid: there is no `checks.json`, and the page says so.
pub(crate) fn make(manifest: &StudyManifest, directory: &Path, stop: &AtomicBool) {
    if directory.join("checks.json").is_file() {
        return;
    }
    let folder = directory.join("checks");
    let written =
        repeated(manifest, directory, &folder, stop).ok().flatten().filter(|c| c.write(directory).is_ok());
    if !written.is_some_and(|c| c.fingerprint != c.threads.1 || c.fingerprint != c.resumed.1) {
        // A folder that cannot be removed only prevents the next attempt.
        let _ = fs::remove_dir_all(&folder);
    }
}

/// Computes both repetitions in `folder`; none if no arm has finished, or when stopped.
fn repeated(
    manifest: &StudyManifest,
    directory: &Path,
    folder: &Path,
    stop: &AtomicBool,
) -> Result<Option<Checks>, StudyError> {
    let work = |arm: &Arm| {
        let run = manifest.record(directory, arm).ok()??.manifest;
        let count = |name: &str| run.counters.get(name).copied().unwrap_or_default();
        (run.status == Status::Finished).then(|| count("newton") + count("steps"))
    };
    let arms = manifest.arms.iter().filter_map(|arm| Some((work(arm)?, arm)));
    let Some((_, arm)) = arms.min_by_key(|(work, _)| *work) else { return Ok(None) };
    let case = case_of(arm)?;
    let failed = |source| StudyError::Arm { arm: arm.name.clone(), source };
    if folder.exists() {
        fs::remove_dir_all(folder).map_err(RecordError::io("remove", folder))?;
    }
    fs::create_dir_all(folder).map_err(RecordError::io("create", folder))?;
    let threads = folder.join("threads");
    let resumed = folder.join("resumed");
    let source = || manifest.source_of(arm);
    let done = recording::run(&case, source(), &threads, THREADS, &mut |_| (), stop);
    if done.map_err(failed)?.end == End::Interrupted {
        return Ok(None);
    }
    let halt = AtomicBool::new(false);
    let mut at = 0;
    let mut active_pairs = 0;
    let mut watch = |p: &Progress| {
        let reached = p.active > 0 || p.step + 1 >= p.steps;
        if !halt.load(Ordering::Relaxed) && (reached || stop.load(Ordering::Relaxed)) {
            halt.store(true, Ordering::Relaxed);
            (at, active_pairs) = (p.step, p.active);
        }
    };
    recording::run(&case, source(), &resumed, 1, &mut watch, &halt).map_err(failed)?;
    let done = recording::resume(&resumed, 1, &mut |_| (), stop).map_err(failed)?;
    if done.end == End::Interrupted {
        return Ok(None);
    }
    Ok(Some(Checks {
        arm: arm.name.clone(),
        fingerprint: fingerprint(&directory.join(&arm.directory))?,
        threads: (THREADS, fingerprint(&threads)?),
        resumed: (at, fingerprint(&resumed)?),
        active_pairs,
    }))
}
