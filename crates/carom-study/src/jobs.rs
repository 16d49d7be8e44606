//! Concurrent runs, as many as there are jobs, and their events.

use std::collections::VecDeque;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, PoisonError, mpsc};

use carom_record::Status;
use carom_run::ThreadCount;
use carom_run::recording::{self, End, Progress};

use crate::error::StudyError;

/// An event of an arm, given by its number.
#[derive(Clone, Debug)]
pub enum Event {
    /// The arm had finished or failed before.
    AlreadyDone(usize),
    /// The arm is started or resumed.
    Began(usize),
    /// The arm accepted a time step.
    Progress(usize, Progress),
    /// The arm ended.
    Ended(usize, Ended),
}

/// How an arm ended.
#[derive(Clone, Debug)]
pub struct Ended {
    /// Finished, failed or stopped.
    pub status: Status,
    /// Reason why the arm did not finish.
    pub reason: Option<String>,
    /// Wall seconds of this process.
    pub wall: f64,
}

impl Ended {
    pub(crate) fn of(outcome: recording::Outcome) -> Self {
        let (status, reason) = match outcome.end {
            End::Finished => (Status::Finished, None),
            End::Interrupted => (Status::Stopped, None),
            End::Stopped(_) => (Status::Failed, outcome.reason),
        };
        Self { status, reason, wall: outcome.wall }
    }
}

/// What is told of every accepted time step of a run.
pub(crate) type OnStep<'a> = &'a mut (dyn FnMut(&Progress) + Send);

/// Number of threads of each of `jobs` concurrent runs, which share those of the machine.
pub(crate) fn threads(jobs: usize) -> ThreadCount {
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    ThreadCount::UpTo((cores / jobs.max(1)).max(1))
}

/// Computes numbered runs, as many concurrently as there are jobs, started in the given order;
/// stops at the first error.
pub(crate) fn side_by_side(
    order: VecDeque<usize>,
    jobs: usize,
    one: &(dyn Fn(usize, OnStep) -> Result<Ended, StudyError> + Sync),
    observe: &mut dyn FnMut(&Event),
    stop: &AtomicBool,
) -> Result<(), StudyError> {
    let queue = Mutex::new(order);
    let failure = Mutex::new(None);
    let halted = AtomicBool::new(false);
    let work = |send: &mpsc::Sender<Event>| {
        while !stop.load(Ordering::Relaxed) && !halted.load(Ordering::Relaxed) {
            let Some(i) = locked(&queue).pop_front() else { return };
            // Runs continue without a receiver of events.
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
            let send = send.clone();
            let work = &work;
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
