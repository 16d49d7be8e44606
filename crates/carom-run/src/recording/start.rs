//! `run` and `resume`: a session from the start of a case, or from the checkpoint of a run.

use std::collections::BTreeMap;
use std::path::Path;
use std::sync::atomic::AtomicBool;

use carom_case::{Case, ContactSpec, Functions, PrimarySpec, history_columns};
use carom_mechanics::Simulation;
use carom_record::{Manifest, MemoryRecord, Run, RunWriter, Source, Status, Stop};

use super::columns::Since;
use super::fields::sides;
use super::outcome::{End, Outcome, Progress, RunError};
use super::session::Session;
use super::tally::{Tally, checkpoint, from_checkpoint};
use super::verdicts::judge;
use crate::build::axes_across;
use crate::setup::Setup;
use crate::thread_count::ThreadCount;
use crate::warnings::warnings;

/// Runs a case into a directory that must not exist yet.
///
/// # Errors
/// The case's problems (nothing is written), or an input/output error.
pub fn run(
    case: &Case,
    source: Source,
    directory: &Path,
    threads: impl Into<ThreadCount>,
    observe: &mut (dyn FnMut(&Progress) + Send),
    stop: &AtomicBool,
) -> Result<Outcome, RunError> {
    let (simulation, manifest) = started(case, source, threads)?;
    let mut writer = RunWriter::create(
        directory,
        &manifest,
        &checkpoint(simulation.state(), Since::default(), &Tally::at_start(&simulation))?,
    )?;
    from_start(Session::new(case, simulation, &mut writer, manifest), observe, stop)
}

/// Runs a case and records it in memory. Such a run cannot be resumed.
///
/// # Errors
/// The case's problems.
pub fn run_in_memory(
    case: &Case,
    source: Source,
    threads: impl Into<ThreadCount>,
    observe: &mut (dyn FnMut(&Progress) + Send),
    stop: &AtomicBool,
) -> Result<(Outcome, MemoryRecord), RunError> {
    let (simulation, manifest) = started(case, source, threads)?;
    let mut record = MemoryRecord::new(manifest.clone());
    let session = Session::new(case, simulation, &mut record, manifest);
    let outcome = from_start(session, observe, stop)?;
    Ok((outcome, record))
}

/// The simulation of a case at its start, and the manifest of its run.
fn started(
    case: &Case,
    source: Source,
    threads: impl Into<ThreadCount>,
) -> Result<(Simulation, Manifest), RunError> {
    let simulation = Setup::new(case).threads(threads).start().map_err(RunError::Case)?;
    let resolved = case.to_json().map_err(|e| RunError::Incompatible { what: e.to_string() })?;
    let version = env!("CARGO_PKG_VERSION");
    let threads = simulation.model().threads.count();
    let mut manifest = Manifest::new(version, case.facts(), resolved, source, history_columns(case), threads);
    // A case does not know its meshes.
    let across = manifest.facts.held.iter_mut().filter(|held| held.axis.is_none());
    for (held, axis) in across.zip(axes_across(case, simulation.model())) {
        held.axis = axis;
    }
    manifest.sides = sides(simulation.model());
    manifest.surfaces = surfaces(case);
    manifest.warnings = warnings(case, simulation.model());
    Ok((simulation, manifest))
}

/// Edges of a surface that pages draw.
const DRAWN: usize = 3000;

/// The edges of the triangulated surfaces of a case.
fn surfaces(case: &Case) -> BTreeMap<String, Vec<[[f64; 3]; 2]>> {
    let one = |contact: &ContactSpec| match &contact.primary {
        PrimarySpec::Surface(surface) => {
            Some((contact.name.clone(), surface.triangles().ok()?.outline(DRAWN)))
        }
        _ => None,
    };
    case.contacts.iter().filter_map(one).collect()
}

/// A run with its first row.
fn from_start(
    mut session: Session,
    observe: &mut (dyn FnMut(&Progress) + Send),
    stop: &AtomicBool,
) -> Result<Outcome, RunError> {
    session.write_start()?;
    session.go(observe, stop, Vec::new())
}

/// Resumes a run that was stopped or killed; a finished one is returned as it is.
///
/// # Errors
/// As [`run`], and if the record does not fit this version.
pub fn resume(
    directory: &Path,
    threads: impl Into<ThreadCount>,
    observe: &mut (dyn FnMut(&Progress) + Send),
    stop: &AtomicBool,
) -> Result<Outcome, RunError> {
    resume_with(directory, Functions::default(), threads, observe, stop)
}

/// As [`resume`], of a case with functions of a program, which must be the same.
///
/// # Errors
/// As [`resume`], and if a function is missing.
pub fn resume_with(
    directory: &Path,
    functions: Functions,
    threads: impl Into<ThreadCount>,
    observe: &mut (dyn FnMut(&Progress) + Send),
    stop: &AtomicBool,
) -> Result<Outcome, RunError> {
    let manifest = Manifest::read(directory)?;
    let mut case = Case::from_json(manifest.case.clone()).map_err(|error| RunError::Incompatible {
        what: format!(
            "the case in {} was resolved by Carom {} and does not fit this version: {error}",
            directory.join("manifest.json").display(),
            manifest.version
        ),
    })?;
    case.functions = functions;
    let case = &case;
    if manifest.status == Status::Finished {
        // The process may have been killed between the last row and the verdicts.
        if manifest.expectations.is_empty() && !case.expects.is_empty() {
            let mut run = Run::open(directory)?;
            if judge(&mut run, &case.expects) {
                run.manifest.write(directory)?;
            }
        }
        let steps = case.time.steps();
        return Ok(Outcome {
            directory: directory.to_path_buf(),
            end: End::Finished,
            reason: None,
            steps: steps as u64,
            time: case.time.end,
            wall: 0.0,
            remarks: vec!["the run was already finished; nothing was computed".into()],
            record: None,
        });
    }
    let reopened = RunWriter::reopen(directory)?;
    let (state, since, tally) =
        from_checkpoint(&reopened.payload).map_err(|error| RunError::Incompatible {
            what: format!(
                "the checkpoint of {} does not fit this version of Carom: {error}",
                directory.display()
            ),
        })?;
    let simulation = Setup::new(case).threads(threads).resume(state).map_err(RunError::Case)?;
    let mut manifest = reopened.manifest;
    manifest.status = Status::Running;
    // Those of a killed process are older in the manifest.
    (manifest.counters, manifest.timings) = (tally.counters.clone(), tally.timings.clone());
    manifest.reason = None;
    Stop::forget(directory, &mut manifest);
    // The tables will be longer.
    manifest.hashes.clear();
    manifest.started = carom_record::now();
    manifest.threads = simulation.model().threads.count();
    let remarks = reopened.fallback.iter().map(ToString::to_string).collect();
    let mut writer = reopened.writer;
    let mut session = Session::new(case, simulation, &mut writer, manifest);
    session.rotations.clone_from(&tally.rotations);
    session.frames.written = tally.frames;
    session.earlier = tally;
    session.writer.manifest(&session.manifest)?;
    if reopened.rows == 0 {
        session.write_start()?;
    } else {
        session.rows.since = since;
    }
    session.go(observe, stop, remarks)
}
