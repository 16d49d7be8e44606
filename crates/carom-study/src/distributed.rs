//! A study in separate processes, on one machine or many: it is planned, each of its runs is
//! computed by a process of its own, and the tables are made from the records. The run directory is
//! all that the processes share: a run is created by one rename, locked while it is written, and
//! resumed from its last checkpoint, so that a process can be killed, and its run started again, at
//! any time.

use std::path::Path;
use std::sync::atomic::AtomicBool;

use carom_record::study::{Arm, StudyManifest};
use carom_record::{Manifest, RecordError, Status};
use carom_run::recording::{Progress, RunError};

use crate::compute::compute;
use crate::error::StudyError;
use crate::jobs::{Ended, Event};
use crate::matched;
use crate::plan::Plan;
use crate::run::{Outcome, conclude, create};

/// Creates the directory of a study, which must not exist, and computes nothing.
///
/// # Errors
/// Input/output or system error, and a study with steps of matched cost: [`plan_settled`].
pub fn plan(plan: &Plan, directory: &Path) -> Result<(), StudyError> {
    let manifest = &plan.manifest;
    if let Some(arm) = manifest.arms.iter().find(|arm| manifest.by_cost(arm)) {
        return Err(StudyError::Unsettled { arm: arm.name.clone() });
    }
    create(plan, directory)
}

/// As [`plan`], but finds the steps of matched cost by trial runs, one after the other. The other
/// runs can then be computed by processes on any machine. Returns whether all steps were found,
/// which a stop prevents.
///
/// # Errors
/// Input/output or system error.
pub fn plan_settled(
    plan: &Plan,
    directory: &Path,
    observe: &mut dyn FnMut(&Event),
    stop: &AtomicBool,
) -> Result<bool, StudyError> {
    create(plan, directory)?;
    matched::settle(&mut plan.manifest.clone(), directory, 1, observe, stop)
}

/// Computes run number `number`, from 1, of a planned study: from the start, or from its last
/// checkpoint. One that has ended is returned as it is.
///
/// # Errors
/// Input/output or system error, no such run, a damaged record, a run that another process is
/// computing, and steps of matched cost that were not found yet.
pub fn arm(
    directory: &Path,
    number: usize,
    observe: &mut (dyn FnMut(&Progress) + Send),
    stop: &AtomicBool,
) -> Result<Ended, StudyError> {
    let manifest = StudyManifest::read(directory)?;
    let count = manifest.runs().count();
    if number == 0 || number > count {
        return Err(StudyError::NoRun { directory: directory.to_owned(), number, count });
    }
    let i = number - 1;
    let arm = manifest.run(i);
    let damaged = |error| StudyError::of_record(arm, directory, error);
    let record = manifest.record(directory, arm).map_err(damaged)?;
    if let Some(ended) = record.as_ref().and_then(|run| ended(&run.manifest)) {
        return Ok(ended);
    }
    settled(&manifest, directory)?;
    match compute(&manifest, directory, i, 1.into(), observe, stop) {
        // Another process created it since.
        Err(StudyError::Arm { source: RunError::Record(RecordError::Exists { path }), .. }) => {
            match ended(&Manifest::read(&path).map_err(damaged)?) {
                Some(ended) => Ok(ended),
                None => compute(&manifest, directory, i, 1.into(), observe, stop),
            }
        }
        other => other,
    }
}

/// Checks that all steps of matched cost have been found.
fn settled(manifest: &StudyManifest, directory: &Path) -> Result<(), StudyError> {
    let begun = |arm: &&Arm| matches!(manifest.status_of(directory, arm), Ok(Some(_)));
    match manifest.arms.iter().filter(|arm| manifest.by_cost(arm)).find(|arm| !begun(arm)) {
        Some(arm) => Err(StudyError::Unsettled { arm: arm.name.clone() }),
        None => Ok(()),
    }
}

/// How a run ended, if it has.
fn ended(run: &Manifest) -> Option<Ended> {
    let has_ended = matches!(run.status, Status::Finished | Status::Failed);
    has_ended.then(|| Ended { status: run.status, reason: run.reason.clone(), wall: 0.0 })
}

/// Writes the tables of a study from what has been computed. An arm that is missing or damaged is a
/// row without values.
///
/// # Errors
/// Input/output or system error.
pub fn collect(directory: &Path, stop: &AtomicBool) -> Result<Outcome, StudyError> {
    conclude(StudyManifest::read(directory)?, directory, stop)
}
