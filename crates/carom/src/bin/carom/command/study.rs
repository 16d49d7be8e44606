//! `carom study`: many runs of one case, in parallel, and their comparison.

use std::collections::BTreeSet;
use std::num::NonZero;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use indicatif::ProgressBar;

use carom_record::study::{Row, StudyManifest};
use carom_study::{Event, Outcome, StudyError};
use serde_json::json;

use crate::exit::{Exit, Failure};
use crate::live::{duration, stop_on_signal};
use crate::{console, directory, out, study_summary};

use super::study_parts::StudyCommand;

/// Run a case many times with some of its values replaced, and compare the runs
#[derive(clap::Args)]
#[command(args_conflicts_with_subcommands = true, subcommand_negates_reqs = true)]
#[command(after_help = "\
Examples:
  carom study cases/paper/paper.toml
  carom study cases/paper/fair.toml --jobs 4 --out runs/fair
  carom study plan sweep.toml --out runs/sweep --slurm

A failed arm is a row of the table; the exit code is still 0.")]
pub(crate) struct Arguments {
    #[command(subcommand)]
    command: Option<StudyCommand>,
    /// The study file, or - for standard input
    #[arg(required = true)]
    study: Option<PathBuf>,
    /// Directory of the study; must not exist yet [default: runs/NAME, runs/NAME-2, …]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Number of concurrent arms (variants); results are bitwise identical for any number;
    /// at most 64, or four per core if that is more [default: all cores]
    #[arg(long, value_name = "N")]
    jobs: Option<NonZero<usize>>,
    /// Do not write figures and report page
    #[arg(long)]
    no_report: bool,
    /// Print one JSON object per event on standard output, and nothing else
    #[arg(long)]
    pub(crate) json: bool,
}

pub(crate) fn run(arguments: &Arguments) -> Result<Exit, Failure> {
    if let Some(command) = &arguments.command {
        return command.run();
    }
    let path = arguments.study.as_deref().unwrap_or(Path::new(super::STDIN));
    let jobs = super::parallel("--jobs", arguments.jobs)?;
    let plan = super::plan(&super::document(path, &[])?, path)?;
    let directory = directory::of_run(path, arguments.out.as_deref())?;
    let mut seen = Seen::new(&plan.manifest, arguments.json);
    let stop = stop_on_signal()?;
    if arguments.json {
        out::event(
            &json!({ "event": "start", "title": plan.manifest.title, "directory": &*directory, "arms": seen.names }),
        )?;
    }
    let done = carom_study::start(&plan, &directory, jobs, &mut |e| seen.event(e), &stop);
    conclude(done, seen, &directory, !arguments.no_report)
}

/// Resumes a study that was stopped; `page`: with figures and page at the end.
pub(crate) fn resume(
    directory: &Path,
    requested: Option<NonZero<usize>>,
    page: bool,
    json: bool,
) -> Result<Exit, Failure> {
    let jobs = super::parallel("--jobs", requested)?;
    let manifest = StudyManifest::read(directory)?;
    let mut seen = Seen::new(&manifest, json);
    let stop = stop_on_signal()?;
    if json {
        out::event(&json!({ "event": "resume", "directory": directory, "arms": seen.names }))?;
    }
    let done = carom_study::resume(directory, jobs, &mut |e| seen.event(e), &stop);
    conclude(done, seen, directory, page)
}

fn conclude(
    done: Result<Outcome, StudyError>,
    seen: Seen,
    directory: &Path,
    page: bool,
) -> Result<Exit, Failure> {
    let json = seen.json;
    drop(seen);
    let outcome = done?;
    let interrupted = outcome.interrupted;
    let damaged = outcome.study.rows.iter().chain(&outcome.study.members).any(Row::is_damaged);
    study_summary::print(&outcome, directory, page, json)?;
    if interrupted && !json && !console::is_quiet() {
        out::line(&format!("stopped by Ctrl-C; continue with: carom resume {}", directory.display()))?;
    }
    Ok(match (interrupted, damaged) {
        (true, _) => Exit::Interrupted,
        (false, true) => Exit::Missed,
        (false, false) => Exit::Done,
    })
}

/// Progress of a study.
pub(super) struct Seen {
    names: Vec<String>,
    steps: Vec<u64>,
    /// Steps done, by arm.
    done: Vec<u64>,
    /// Wall seconds left, by arm that runs.
    left: Vec<Option<f64>>,
    ended: BTreeSet<usize>,
    json: bool,
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
