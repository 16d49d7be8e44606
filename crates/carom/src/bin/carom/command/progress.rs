//! Progress of many runs: a bar, and one JSON object per event.

use std::collections::BTreeSet;
use std::time::{Duration, Instant};

use carom_record::Status;
use carom_record::study::StudyManifest;
use carom_study::Event;
use indicatif::ProgressBar;
use serde_json::json;

use crate::text::duration;
use crate::{console, out};

/// Least time between two events of progress.
const PAUSE: Duration = Duration::from_millis(200);

/// The runs of a study or of a verification. Dropping it erases the bar.
pub(super) struct Runs {
    /// Name of a run in events: `arm` or `run`.
    noun: &'static str,
    pub(super) names: Vec<String>,
    steps: Vec<u64>,
    done: Vec<u64>,
    /// Wall seconds left, by run in progress.
    left: Vec<Option<f64>>,
    ended: BTreeSet<usize>,
    bar: ProgressBar,
    last: Option<Instant>,
}

impl Runs {
    pub(super) fn new(noun: &'static str) -> Self {
        Self {
            noun,
            names: Vec::new(),
            steps: Vec::new(),
            done: Vec::new(),
            left: Vec::new(),
            ended: BTreeSet::new(),
            bar: console::bar(1),
            last: None,
        }
    }

    /// The arms of a study.
    pub(super) fn of_study(manifest: &StudyManifest) -> Self {
        let mut runs = Self::new("arm");
        manifest.runs().for_each(|arm| runs.add(&arm.name, arm.steps));
        runs
    }

    /// Adds a run with its number of steps.
    pub(super) fn add(&mut self, name: &str, steps: u64) {
        self.names.push(name.to_owned());
        self.steps.push(steps);
        self.done.push(0);
        self.left.push(None);
        self.bar.set_length(self.steps.iter().sum::<u64>().max(1));
    }

    pub(super) fn event(&mut self, event: &Event) {
        let line = match event {
            Event::AlreadyDone(i) => {
                self.done[*i] = self.steps[*i];
                // Pilots and anchors have ended before.
                if !self.ended.insert(*i) {
                    return;
                }
                json!({ "event": "kept", (self.noun): self.names[*i] })
            }
            Event::Began(i) => json!({ "event": "began", (self.noun): self.names[*i] }),
            Event::Ended(i, ended) => {
                let line = json!({
                    "event": "ended", (self.noun): self.names[*i], "status": ended.status, "reason": ended.reason,
                    "wall": ended.wall
                });
                self.done[*i] = self.steps[*i];
                self.left[*i] = None;
                self.ended.insert(*i);
                self.say_ended(*i, ended.status == Status::Finished, ended.wall);
                line
            }
            Event::Progress(i, p) => {
                let line = json!({
                    "event": "progress", (self.noun): self.names[*i], "step": p.step, "steps": p.steps, "time": p.time,
                    "left": p.left
                });
                self.done[*i] = p.step;
                self.left[*i] = Some(p.left);
                if self.last.is_some_and(|then| then.elapsed() < PAUSE) {
                    return;
                }
                self.last = Some(Instant::now());
                line
            }
        };
        // A closed standard output must not stop the runs.
        let _ = out::event(&line);
        self.bar.set_position(self.done.iter().sum());
        self.bar.set_message(self.line());
    }

    /// Says that a run has ended, with `--verbose`.
    fn say_ended(&self, run: usize, finished: bool, wall: f64) {
        if console::is_verbose() {
            let how = if finished { "done" } else { "stopped" };
            let count = format!("{}/{}", self.ended.len(), self.names.len());
            let line = format!("{count:>9}  {how} in {}  {}", duration(wall), self.names[run]);
            self.bar.suspend(|| console::say(line));
        }
    }

    /// `2 of 4 runs  longest left 3 min 2 s`
    fn line(&self) -> String {
        let left = self.left.iter().flatten().copied().reduce(f64::max);
        let left = left.map_or_else(String::new, |left| format!("  longest left {}", duration(left)));
        format!("{} of {} runs{left}", self.ended.len(), self.names.len())
    }
}

impl Drop for Runs {
    fn drop(&mut self) {
        self.bar.finish_and_clear();
    }
}
