//! Progress of a study: a bar, or one JSON object per event.

use std::collections::BTreeSet;
use std::time::{Duration, Instant};

use carom_record::study::StudyManifest;
use carom_study::Event;
use indicatif::ProgressBar;
use serde_json::json;

use crate::live::duration;
use crate::{console, out};

/// Progress of a study.
pub(super) struct Seen {
    pub(super) names: Vec<String>,
    steps: Vec<u64>,
    /// Steps done, by arm.
    done: Vec<u64>,
    /// Wall seconds left, by arm that runs.
    left: Vec<Option<f64>>,
    ended: BTreeSet<usize>,
    pub(super) json: bool,
    bar: ProgressBar,
    last: Option<Instant>,
}

impl Seen {
    pub(super) fn new(manifest: &StudyManifest, json: bool) -> Self {
        Self {
            names: manifest.runs().map(|a| a.name.clone()).collect(),
            steps: manifest.runs().map(|a| a.steps).collect(),
            done: vec![0; manifest.runs().count()],
            left: vec![None; manifest.runs().count()],
            ended: BTreeSet::new(),
            json,
            bar: console::bar(manifest.runs().map(|a| a.steps).sum()),
            last: None,
        }
    }

    pub(super) fn event(&mut self, event: &Event) {
        let line = match event {
            Event::AlreadyDone(i) => {
                self.done[*i] = self.steps[*i];
                // Pilots and anchors have ended before.
                if !self.ended.insert(*i) {
                    return;
                }
                json!({ "event": "kept", "arm": self.names[*i] })
            }
            Event::Began(i) => json!({ "event": "began", "arm": self.names[*i] }),
            Event::Ended(i, ended) => {
                (self.done[*i], self.left[*i]) = (self.steps[*i], None);
                self.ended.insert(*i);
                json!({ "event": "ended", "arm": self.names[*i], "status": ended.status, "reason": ended.reason, "wall": ended.wall })
            }
            Event::Progress(i, p) => {
                (self.done[*i], self.left[*i]) = (p.step, Some(p.left));
                if self.last.is_some_and(|then| then.elapsed() < Duration::from_millis(200)) {
                    return;
                }
                self.last = Some(Instant::now());
                json!({ "event": "progress", "arm": self.names[*i], "step": p.step, "steps": p.steps, "time": p.time, "left": p.left })
            }
        };
        // A closed standard output must not stop the study.
        if self.json {
            let _ = out::event(&line);
        }
        self.bar.set_position(self.done.iter().sum());
        self.bar.set_message(self.line());
    }

    /// `2 of 4 arms  longest left 3 min 2 s`
    fn line(&self) -> String {
        let left = self.left.iter().flatten().copied().reduce(f64::max);
        let left = left.map_or_else(String::new, |left| format!("  longest left {}", duration(left)));
        format!("{} of {} runs{left}", self.ended.len(), self.names.len())
    }
}

impl Drop for Seen {
    fn drop(&mut self) {
        self.bar.finish_and_clear();
    }
}
