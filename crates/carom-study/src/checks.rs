//! What a study with a goal tries on itself once its arms have ended: the arm with the fewest steps
//! and iterations is computed with two threads, and once more, stopped at the first step at which
//! something touches (the last but one where nothing does) and resumed from its files. The tables
//! of all three must have the same bits.
//!
//! What was found stands in `checks.json` and on the page. The repetitions are kept, in `checks/`,
//! only where they differ.

use std::fs;
use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};

use carom_record::study::checks::{Checks, fingerprint};
use carom_record::study::{Arm, StudyManifest};
use carom_record::{Manifest, RecordError, Status};
use carom_run::case::Case;
use carom_run::recording::{self, End, Options, Progress};

use crate::error::StudyError;

/// Threads of the repetition: the arms have one.
const THREADS: usize = 2;

/// Tries it, unless it was tried before or no arm has finished. Whatever keeps it from being tried,
/// a full disk or a wish to stop, is no fault of the study: there is no `checks.json` then, and the
/// page says so.
pub(crate) fn make(manifest: &StudyManifest, directory: &Path, stop: &AtomicBool) {
    if directory.join("checks.json").is_file() {
        return;
    }
    let folder = directory.join("checks");
    let written =
        tried(manifest, directory, &folder, stop).ok().flatten().filter(|c| c.write(directory).is_ok());
    if !written.is_some_and(|c| c.fingerprint != c.threads.1 || c.fingerprint != c.resumed.1) {
        // Where it cannot be removed, it is only in the way of the next attempt.
        let _ = fs::remove_dir_all(&folder);
    }
}

/// Computes both repetitions in `folder`; none where no arm has finished, or when stopped.
fn tried(
    manifest: &StudyManifest,
    directory: &Path,
    folder: &Path,
    stop: &AtomicBool,
) -> Result<Option<Checks>, StudyError> {
    let work = |arm: &Arm| {
        let run = Manifest::read(&directory.join(&arm.directory)).ok()?;
        let count = |name: &str| run.counters.get(name).copied().unwrap_or_default();
        (run.status == Status::Finished).then(|| count("newton") + count("steps"))
    };
    let arms = manifest.arms.iter().filter_map(|arm| Some((work(arm)?, arm)));
    let Some((_, arm)) = arms.min_by_key(|(work, _)| *work) else { return Ok(None) };
    let case: Case = serde_json::from_value(arm.case.clone())
        .map_err(|e| StudyError::Incompatible { arm: arm.name.clone(), what: e.to_string() })?;
    let refused = |source| StudyError::Arm { arm: arm.name.clone(), source };
    let io = |action, source| RecordError::Io { action, path: folder.to_owned(), source };
    if folder.exists() {
        fs::remove_dir_all(folder).map_err(|e| io("remove", e))?;
    }
    fs::create_dir_all(folder).map_err(|e| io("create", e))?;
    let (threads, resumed) = (folder.join("threads"), folder.join("resumed"));
    let source = || manifest.source_of(arm);
    let done = recording::run(&case, source(), &threads, Options { threads: THREADS }, &mut |_| (), stop);
    if done.map_err(refused)?.end == End::Interrupted {
        return Ok(None);
    }
    let (halt, mut at, mut active_pairs) = (AtomicBool::new(false), 0, 0);
    let mut watch = |p: &Progress| {
        let here = p.active > 0 || p.step + 1 >= p.steps;
        if !halt.load(Ordering::Relaxed) && (here || stop.load(Ordering::Relaxed)) {
            halt.store(true, Ordering::Relaxed);
            (at, active_pairs) = (p.step, p.active);
        }
    };
    recording::run(&case, source(), &resumed, Options { threads: 1 }, &mut watch, &halt).map_err(refused)?;
    let done = recording::resume(&resumed, Options { threads: 1 }, &mut |_| (), stop).map_err(refused)?;
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
