//! Computes the arms of a study: as many concurrently as there are jobs, the longest first, each in
//! its own run directory. An arm that fails is a row of the tables; after Ctrl-C or a kill, every
//! arm can be resumed.

use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};

use carom_record::study::{Row, Study, StudyManifest};
use carom_record::{RecordError, Status};

use crate::compute::{case_of, compute};
use crate::error::StudyError;
use crate::jobs::{Event, OnStep, side_by_side, threads};
use crate::plan::Plan;
use crate::{checks, matched, theory};

/// A study that ended.
#[derive(Debug)]
pub struct Outcome {
    /// Whether it was stopped before all arms had ended; `resume` continues it. An arm whose record
    /// is damaged is not waited for.
    pub interrupted: bool,
    /// The study, read from its records.
    pub study: Study,
}

/// Creates the directory of a study, which must not exist, and runs the study.
///
/// # Errors
/// Input/output or system error. A failed arm is not an error.
pub fn start(
    plan: &Plan,
    directory: &Path,
    jobs: usize,
    observe: &mut dyn FnMut(&Event),
    stop: &AtomicBool,
) -> Result<Outcome, StudyError> {
    plan.fits_memory(jobs)?;
    create(plan, directory)?;
    resume(directory, jobs, observe, stop)
}

/// Creates the directory of a study, which must not exist.
pub(crate) fn create(plan: &Plan, directory: &Path) -> Result<(), StudyError> {
    if !carom_record::is_free(directory) {
        return Err(StudyError::Exists { path: directory.to_owned() });
    }
    let arms = directory.join("arms");
    std::fs::create_dir_all(&arms).map_err(RecordError::io("create", &arms))?;
    plan.manifest.write(directory)?;
    if plan.manifest.goal.is_some() {
        theory::write(plan, directory)?;
    }
    Ok(())
}

/// Runs the arms that have not ended, `jobs` of them concurrently, and writes the tables.
///
/// # Errors
/// Input/output or system error, or a study that is not compatible with this version. A failed arm
/// is not an error.
pub fn resume(
    directory: &Path,
    jobs: usize,
    observe: &mut dyn FnMut(&Event),
    stop: &AtomicBool,
) -> Result<Outcome, StudyError> {
    let mut manifest = StudyManifest::read(directory)?;
    manifest.status = Status::Running;
    manifest.write(directory)?;
    let settled = matched::settle(&mut manifest, directory, jobs, observe, stop)?;
    let mut waiting = Vec::new();
    for (i, arm) in manifest.runs().enumerate() {
        let status = manifest.status_of(directory, arm);
        match status.map_err(|error| StudyError::of_record(arm, directory, error))? {
            Some(Status::Finished | Status::Failed) => observe(&Event::AlreadyDone(i)),
            // A case that cannot be read is an error when its turn comes.
            _ if settled => waiting.push((i, case_of(arm).map_or(0.0, |case| case.work()))),
            // If the steps of matched cost are not settled, no other arm is run.
            _ => {}
        }
    }
    waiting.sort_by(|a, b| b.1.total_cmp(&a.1));
    let order = waiting.into_iter().map(|(i, _)| i).collect();
    let one = |i: usize, progress: OnStep| compute(&manifest, directory, i, threads(jobs), progress, stop);
    side_by_side(order, jobs, &one, observe, stop)?;
    conclude(manifest, directory, stop)
}

/// The checks and tables of a study whose arms have been computed, as far as they have.
pub(crate) fn conclude(
    mut manifest: StudyManifest,
    directory: &Path,
    stop: &AtomicBool,
) -> Result<Outcome, StudyError> {
    // Which arm is checked must not depend on which of them have ended first.
    if manifest.goal.is_some()
        && !stop.load(Ordering::Relaxed)
        && manifest.runs().all(|arm| manifest.has_ended(directory, arm))
    {
        checks::make(&manifest, directory, stop);
    }
    let study = Study::open(directory, &mut |_, _| ())?;
    let rows = || study.rows.iter().chain(&study.members);
    let interrupted = rows().any(|row| !row.has_ended() && !row.is_damaged());
    manifest.status = if rows().all(Row::has_ended) { Status::Finished } else { Status::Stopped };
    manifest.write(directory)?;
    study.write_tables()?;
    Ok(Outcome { interrupted, study: Study { manifest, ..study } })
}
