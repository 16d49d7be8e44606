//! Progress of a simulation: a bar on standard error if it is a terminal, or events on standard
//! output. Also Ctrl-C.

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

use carom::recording::Progress;
use carom_record::Manifest;
use indicatif::ProgressBar;
use serde::Serialize;

use crate::exit::{Exit, Failure};
use crate::simulation::Outcome;
use crate::text::duration;
use crate::{console, out};

/// At most ten events per second.
const PAUSE: Duration = Duration::from_millis(100);

/// Time between lines about a step that is being bisected, if standard error is not a terminal.
const LOGGED: Duration = Duration::from_secs(10);

/// Shows progress. Dropping it erases the bar.
pub(crate) struct Live {
    bar: ProgressBar,
    last: Option<Instant>,
    /// The run, whose manifest has the warnings.
    directory: PathBuf,
    /// Number of warnings already shown; none before the first step.
    warned: Option<usize>,
    /// When a bisected step was last reported on other outputs than a terminal.
    heard: Option<Instant>,
}

#[derive(Serialize)]
struct Event<'a> {
    event: &'static str,
    #[serde(flatten)]
    progress: &'a Progress,
}

impl Live {
    pub(crate) fn new(directory: &Path) -> Self {
        Self { bar: console::bar(1), last: None, directory: directory.to_owned(), warned: None, heard: None }
    }

    /// Shows the warnings of the run that have not been shown yet.
    fn warn(&mut self) {
        // Without a manifest nothing was run.
        let warnings = Manifest::read(&self.directory).map_or_else(|_| Vec::new(), |m| m.warnings);
        for warning in warnings.iter().skip(self.warned.unwrap_or(0)) {
            let event =
                serde_json::json!({ "event": "warning", "message": warning.to_string(), "warning": warning });
            let _ = out::event(&event);
            if !console::is_silent() {
                self.bar.suspend(|| console::say(console::warning("warning: ", "", warning)));
            }
        }
        self.warned = Some(warnings.len());
    }

    /// Shows the warnings that a run left at its end, whether it finished or stopped, and erases
    /// the bar.
    pub(crate) fn end(mut self, done: &Result<Outcome, Failure>) {
        if matches!(done, Ok(_) | Err(Failure::Stopped { .. })) {
            self.warn();
        }
    }

    /// Shows a step. Not every step is an event, but the last one always is.
    pub(crate) fn show(&mut self, progress: &Progress) {
        if self.warned.is_none() {
            self.warn();
        }
        self.bar.set_length(progress.steps);
        self.bar.set_position(progress.step);
        if !self.bar.is_hidden() {
            self.bar.set_message(line(progress));
        }
        if progress.bisecting {
            return self.bisecting(progress);
        }
        if console::is_verbose()
            && let Some(changes) = changes(progress)
        {
            self.bar.suspend(|| console::say(changes));
        }
        let last = progress.step == progress.steps;
        if !last && self.last.is_some_and(|then| then.elapsed() < PAUSE) {
            return;
        }
        self.last = Some(Instant::now());
        // A closed standard output must not stop the run.
        let _ = out::event(&Event { event: "progress", progress });
    }
}

impl Live {
    /// Shows that a step is still being bisected: in a log once in a while, on a terminal in the
    /// bar.
    fn bisecting(&mut self, progress: &Progress) {
        let _ = out::event(&Event { event: "bisecting", progress });
        if self.bar.is_hidden() && !console::is_silent() {
            let since = self.heard.get_or_insert_with(Instant::now);
            if since.elapsed() >= LOGGED {
                *since = Instant::now();
                console::say(line(progress));
            }
        }
    }
}

impl Drop for Live {
    fn drop(&mut self) {
        self.bar.finish_and_clear();
    }
}

/// `t 0.3375  Δt 1.88e-3  Newton 4  contacts 7  energy created 1.2e-6  left 3 s`
fn line(p: &Progress) -> String {
    if p.bisecting {
        let step = p.step + 1;
        let rejected = p.rejected;
        return format!(
            "step {step} is being bisected: t {:.6e}  Δt {:.1e}  {rejected} rejected",
            p.time, p.dt
        );
    }
    format!(
        "t {:.4e}  Δt {:.3e}  Newton {}  contacts {}  energy created {:.1e}  left {}",
        p.time,
        p.dt,
        p.newton,
        p.active,
        p.created,
        duration(p.left)
    )
}

/// A line for `--verbose`, if attempts were rejected or contacts changed.
fn changes(p: &Progress) -> Option<String> {
    let counts = [(p.rejected, "rejected"), (p.activations, "activated"), (p.releases, "released")];
    let counts: Vec<_> =
        counts.iter().filter(|(n, _)| *n > 0).map(|(n, what)| format!("{n} {what}")).collect();
    let step = p.step;
    let time = p.time;
    let newton = p.newton;
    (!counts.is_empty()).then(|| format!("step {step}  t {time:.6e}  Newton {newton}  {}", counts.join(", ")))
}

/// A flag that is set by the first Ctrl-C; the second one ends the process immediately.
pub(crate) fn stop_on_signal() -> Result<Arc<AtomicBool>, Failure> {
    let stop = Arc::new(AtomicBool::new(false));
    let flag = Arc::clone(&stop);
    let set = ctrlc::set_handler(move || {
        if flag.swap(true, Ordering::Relaxed) {
            std::process::exit(Exit::Interrupted as i32);
        }
    });
    set.map_err(|e| Failure::System { what: format!("cannot install the handler of Ctrl-C: {e}") })?;
    Ok(stop)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn line_of_a_step() {
        let p = Progress {
            step: 180,
            steps: 400,
            time: 0.3375,
            dt: 1.875e-3,
            newton: 4,
            active: 7,
            rejected: 1,
            bisecting: false,
            activations: 0,
            releases: 2,
            created: 1.2e-6,
            wall: 1.0,
            left: 130.0,
        };
        let expected =
            "t 3.3750e-1  Δt 1.875e-3  Newton 4  contacts 7  energy created 1.2e-6  left 2 min 10 s";
        assert_eq!(line(&p), expected);
        let expected = "step 180  t 3.375000e-1  Newton 4  1 rejected, 2 released";
        assert_eq!(changes(&p).as_deref(), Some(expected));
        let expected = "step 181 is being bisected: t 3.375000e-1  Δt 1.9e-3  1 rejected";
        assert_eq!(line(&Progress { bisecting: true, ..p }), expected);
    }
}
