//! Long computations without the interpreter's lock: progress is passed to a Python function, and
//! Ctrl-C stops them.

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::sync::{Mutex, PoisonError};
use std::time::Duration;

use pyo3::prelude::*;

/// Time between two looks at signals and progress.
const PAUSE: Duration = Duration::from_millis(100);

/// How far a computation is: steps done, all steps, time.
pub(crate) type Done = (u64, u64, f64);

/// Computes in a thread of its own. `report` is called with steps done, all steps and the time, at
/// most ten times a second. If a signal handler or `report` raises, the computation is asked to
/// stop; its result is returned with the exception.
pub(crate) fn watched<T: Send>(
    py: Python<'_>,
    report: Option<&Bound<'_, PyAny>>,
    work: impl FnOnce(&(dyn Fn(Done) + Sync), &AtomicBool) -> T + Send,
) -> PyResult<(T, Option<PyErr>)> {
    let stop = AtomicBool::new(false);
    let latest = Mutex::new(None);
    let (sender, ended) = channel::<()>();
    let ended = Mutex::new(ended);
    let lock = || latest.lock().unwrap_or_else(PoisonError::into_inner);
    std::thread::scope(|scope| {
        let stop = &stop;
        let latest = &latest;
        let thread = scope.spawn(move || {
            // Dropped at the end, also of a panic.
            let _sender = sender;
            let show = |done: Done| *latest.lock().unwrap_or_else(PoisonError::into_inner) = Some(done);
            // The interpreter learns of the thread once, and not at every call of a function.
            Python::attach(|py| py.detach(|| work(&show, stop)))
        });
        let mut raised = None;
        loop {
            let wait = || ended.lock().unwrap_or_else(PoisonError::into_inner).recv_timeout(PAUSE);
            let over = py.detach(wait) != Err(RecvTimeoutError::Timeout);
            let news = lock().take();
            if raised.is_none() {
                let shown = py.check_signals().and_then(|()| match (report, news) {
                    (Some(report), Some(done)) => report.call1(done).map(drop),
                    _ => Ok(()),
                });
                if let Err(error) = shown {
                    stop.store(true, Ordering::Relaxed);
                    raised = Some(error);
                }
            }
            if over {
                break;
            }
        }
        match py.detach(|| thread.join()) {
            Ok(result) => Ok((result, raised)),
            Err(panic) => std::panic::resume_unwind(panic),
        }
    })
}
