//! What is seen while a simulation runs: a line on a terminal's standard error, or events on
//! standard output. And Ctrl-C.

use std::io::{self, IsTerminal, Write};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

use serde::Serialize;

use crate::exit::{Exit, Failure};
use crate::out;
use crate::simulation::Progress;

/// At most ten updates a second.
const PAUSE: Duration = Duration::from_millis(100);

/// Shows progress. Dropping it erases the line.
pub(crate) struct Live {
    json: bool,
    terminal: bool,
    last: Option<Instant>,
    shown: bool,
}

#[derive(Serialize)]
struct Event<'a> {
    event: &'static str,
    #[serde(flatten)]
    progress: &'a Progress,
}

impl Live {
    pub(crate) fn new(json: bool) -> Self {
        Self { json, terminal: io::stderr().is_terminal(), last: None, shown: false }
    }

    /// Says what the case is warned of, before it runs.
    pub(crate) fn warn(&self, warnings: &[String]) {
        for message in warnings {
            if self.json {
                let _ = out::event(&serde_json::json!({ "event": "warning", "message": message }));
            } else {
                let _ = writeln!(io::stderr().lock(), "warning: {message}");
            }
        }
    }

    /// Shows a step, if the last one shown is long enough ago or this is the end.
    pub(crate) fn show(&mut self, progress: &Progress) {
        let last = progress.step == progress.steps;
        if !last && self.last.is_some_and(|then| then.elapsed() < PAUSE) {
            return;
        }
        self.last = Some(Instant::now());
        // A line nobody can see must not stop the run.
        if self.json {
            let _ = out::event(&Event { event: "progress", progress });
        }
        if self.terminal {
            self.shown = true;
            let _ = write!(io::stderr().lock(), "\r\x1b[K{}", line(progress));
        }
    }
}

impl Drop for Live {
    fn drop(&mut self) {
        if self.shown {
            let _ = write!(io::stderr().lock(), "\r\x1b[K");
        }
    }
}

/// `  45 %  t 0.3375  Δt 1.88e-3  Newton 4  contacts 7  energy -1.2e-6  left 3 s`
fn line(p: &Progress) -> String {
    let percent = 100.0 * p.step as f64 / p.steps.max(1) as f64;
    format!(
        "{percent:4.0} %  t {:.4e}  Δt {:.3e}  Newton {}  contacts {}  energy {:+.1e}  left {}",
        p.time,
        p.dt,
        p.newton,
        p.active,
        p.energy_drift,
        duration(p.eta)
    )
}

/// Seconds as people say them.
pub(crate) fn duration(seconds: f64) -> String {
    if !seconds.is_finite() {
        return "?".to_owned();
    }
    let whole = seconds.max(0.0).round() as u64;
    match whole {
        0..10 => format!("{seconds:.1} s"),
        10..120 => format!("{whole} s"),
        120..7200 => format!("{} min {} s", whole / 60, whole % 60),
        _ => format!("{} h {} min", whole / 3600, whole % 3600 / 60),
    }
}

/// A flag that the first Ctrl-C sets; the second one ends the process at once.
pub(crate) fn stop_on_signal() -> Result<Arc<AtomicBool>, Failure> {
    let stop = Arc::new(AtomicBool::new(false));
    let flag = Arc::clone(&stop);
    let set = ctrlc::set_handler(move || {
        if flag.swap(true, Ordering::Relaxed) {
            std::process::exit(Exit::Interrupted as i32);
        }
    });
    set.map_err(|e| Failure::Refused { what: format!("signals cannot be watched: {e}") })?;
    Ok(stop)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn line_says_it_all() {
        let p = Progress {
            step: 180,
            steps: 400,
            time: 0.3375,
            dt: 1.875e-3,
            newton: 4,
            active: 7,
            energy_drift: -1.2e-6,
            wall: 1.0,
            eta: 130.0,
        };
        let told = "  45 %  t 3.3750e-1  Δt 1.875e-3  Newton 4  contacts 7  energy -1.2e-6  left 2 min 10 s";
        assert_eq!(line(&p), told);
        assert_eq!([0.26, 61.0, 7300.0, f64::NAN].map(duration), ["0.3 s", "61 s", "2 h 1 min", "?"]);
    }
}
