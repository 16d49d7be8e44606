//! The arms of a study computed: as many at a time as there are jobs, the longest first, each in its own run directory. An arm that
//! fails is a row of the tables; Ctrl-C or a kill leaves every arm resumable.

use std::collections::{BTreeMap, VecDeque};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, PoisonError, mpsc};

use carom::case::Case;
use carom::recording::{self, End, Options, Progress, RunError};
use carom_record::study::{Study, StudyManifest};
use carom_record::{RecordError, Status};

use crate::{Plan, checks, matched, theory};

/// What happens to an arm, told by its number.
#[derive(Clone, Debug)]
pub enum Event {
    /// It was finished, or had failed, before.
    Kept(usize),
    /// It begins, or goes on.
    Began(usize),
    /// After an accepted step.
    Progress(usize, Progress),
    /// It ended.
    Ended(usize, Ended),
}

/// How an arm ended.
#[derive(Clone, Debug)]
pub struct Ended {
    /// Finished, failed or stopped.
    pub status: Status,
    /// Why it did not finish.
    pub reason: Option<String>,
    /// Wall seconds of this process.
    pub wall: f64,
}

/// A study that ended.
#[derive(Debug)]
pub struct Outcome {
    /// Stopped before all arms had ended; `go_on` goes on.
    pub interrupted: bool,
    /// What the records say.
    pub study: Study,
}

/// Why a study cannot go on.
#[derive(Debug, thiserror::Error)]
pub enum StudyError {
    /// A record cannot be written or read.
    #[error(transparent)]
    Record(#[from] RecordError),
    /// An arm cannot be computed for a reason that is not its numbers.
    #[error("arm \"{arm}\": {source}")]
    Arm {
        /// Its name.
        arm: String,
        /// Why.
        source: RunError,
    },
    /// `study.json` holds a case this version cannot read.
    #[error("the case of arm \"{arm}\" does not fit this version of Carom: {what}")]
    Incompatible {
        /// The arm.
        arm: String,
        /// What does not fit.
        what: String,
    },
    /// The directory exists.
    #[error("{} exists already, and a study never overwrites", path.display())]
    Exists {
        /// The directory.
        path: PathBuf,
    },
}

/// Makes the directory of a study, which must not exist, and runs it.
///
/// # Errors
/// What the machine refused. A failed arm is no error.
pub fn start(
    plan: &Plan,
    directory: &Path,
    jobs: usize,
    observe: &mut dyn FnMut(&Event),
    stop: &AtomicBool,
) -> Result<Outcome, StudyError> {
    if directory.exists() {
        return Err(StudyError::Exists { path: directory.to_owned() });
    }
    let make = |path: PathBuf| {
        let refused = |source| RecordError::Io { action: "create", path: path.clone(), source };
        std::fs::create_dir_all(&path).map_err(refused)
    };
    make(directory.join("arms"))?;
    plan.manifest.write(directory)?;
    if plan.manifest.goal.is_some() {
        theory::write(plan, directory)?;
    }
    go_on(directory, jobs, observe, stop)
}

/// Runs the arms that have not ended, `jobs` at a time, and writes the tables.
///
/// # Errors
/// What the machine refused, or what is no study of this version. A failed arm is no error.
pub fn go_on(
    directory: &Path,
    jobs: usize,
    observe: &mut dyn FnMut(&Event),
    stop: &AtomicBool,
) -> Result<Outcome, StudyError> {
    let mut manifest = StudyManifest::read(directory)?;
    manifest.status = Status::Running;
    manifest.write(directory)?;
    let whole = matched::settle(&mut manifest, directory, jobs, observe, stop)?;
    let mut waiting = Vec::new();
    for (i, arm) in manifest.arms.iter().enumerate() {
        match manifest.state(directory, arm)?.0 {
            Some(Status::Finished | Status::Failed) => observe(&Event::Kept(i)),
            // An arm whose step is not settled waits for the next time.
            _ if !whole => {}
            state => waiting.push((i, state.is_some())),
        }
    }
    waiting.sort_by_key(|(i, _)| std::cmp::Reverse(manifest.arms[*i].steps));
    let begun: BTreeMap<usize, bool> = waiting.iter().copied().collect();
    let order = waiting.into_iter().map(|(i, _)| i).collect();
    let one = |i: usize, progress: &mut dyn FnMut(&Progress)| {
        compute(&manifest, directory, i, begun.get(&i) == Some(&true), progress, stop)
    };
    side_by_side(order, jobs, &one, observe, stop)?;
    if manifest.goal.is_some() && !stop.load(Ordering::Relaxed) {
        checks::make(&manifest, directory, stop);
    }
    let study = Study::open(directory, &mut |_, _| ())?;
    let ended = |row: &carom_record::study::Row| matches!(row.status, Some(Status::Finished | Status::Failed));
    let interrupted = !study.rows.iter().all(ended);
    manifest.status = if interrupted { Status::Stopped } else { Status::Finished };
    manifest.write(directory)?;
    study.write_tables()?;
    Ok(Outcome { interrupted, study: Study { manifest, ..study } })
}

/// Computes numbered runs, as many at a time as there are jobs, begun in the order given; stops at the first error.
pub(crate) fn side_by_side<E: Send>(
    order: VecDeque<usize>,
    jobs: usize,
    one: &(dyn Fn(usize, &mut dyn FnMut(&Progress)) -> Result<Ended, E> + Sync),
    observe: &mut dyn FnMut(&Event),
    stop: &AtomicBool,
) -> Result<(), E> {
    let queue = Mutex::new(order);
    let failure = Mutex::new(None);
    let halted = AtomicBool::new(false);
    let work = |send: &mpsc::Sender<Event>| {
        while !stop.load(Ordering::Relaxed) && !halted.load(Ordering::Relaxed) {
            let Some(i) = locked(&queue).pop_front() else { return };
            // A listener that has gone must not stop the runs.
            let _ = send.send(Event::Began(i));
            match one(i, &mut |p| drop(send.send(Event::Progress(i, *p)))) {
                Ok(ended) => drop(send.send(Event::Ended(i, ended))),
                Err(error) => {
                    halted.store(true, Ordering::Relaxed);
                    locked(&failure).get_or_insert(error);
                }
            }
        }
    };
    std::thread::scope(|scope| {
        let (send, events) = mpsc::channel();
        for _ in 0..jobs.max(1) {
            let (send, work) = (send.clone(), &work);
            scope.spawn(move || work(&send));
        }
        drop(send);
        events.iter().for_each(|event| observe(&event));
    });
    failure.into_inner().unwrap_or_else(PoisonError::into_inner).map_or(Ok(()), Err)
}

fn locked<T>(mutex: &Mutex<T>) -> std::sync::MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

/// One arm from where it is to its end.
pub(crate) fn compute(
    manifest: &StudyManifest,
    directory: &Path,
    i: usize,
    begun: bool,
    observe: &mut dyn FnMut(&Progress),
    stop: &AtomicBool,
) -> Result<Ended, StudyError> {
    let arm = &manifest.arms[i];
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

impl Ended {
    pub(crate) fn of(outcome: recording::Outcome) -> Self {
        let (status, reason) = match outcome.end {
            End::Finished => (Status::Finished, None),
            End::Interrupted => (Status::Stopped, None),
            End::Stopped(stopped) => (Status::Failed, Some(stopped.to_string())),
        };
        Self { status, reason, wall: outcome.wall }
    }
}
