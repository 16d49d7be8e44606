//! `carom study`: many runs of one case, in parallel, and their comparison.

use std::num::NonZero;
use std::path::{Path, PathBuf};

use carom_record::study::{Row, StudyManifest};
use carom_study::{Outcome, StudyError};
use serde_json::json;

use crate::exit::{Exit, Failure};
use crate::live::stop_on_signal;
use crate::{directory, out, study_summary};

use super::progress::Runs;
use super::study_parts::StudyCommand;

/// Run a case many times with some of its values replaced, and compare the runs
#[derive(clap::Args)]
#[command(args_conflicts_with_subcommands = true, subcommand_negates_reqs = true)]
#[command(after_help = "\
Examples:
  carom study cases/paper/paper.toml
  carom study cases/paper/fair.toml --jobs 4 --out runs/fair
  carom study plan sweep.toml --out runs/sweep --slurm

An arm (variant) that fails is marked in the table; the exit code is then still 0.")]
pub(crate) struct Arguments {
    #[command(subcommand)]
    command: Option<StudyCommand>,
    /// The study file, or - for standard input
    #[arg(required = true)]
    study: Option<PathBuf>,
    /// Directory of the study; must not exist yet [default: runs/NAME, or runs/NAME-2, … if that
    /// exists; NAME is the name of the study file without its extension]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Number of concurrent arms (variants); results are bitwise identical for any number;
    /// at most 64, or four per core if that is more [default: one per core]
    #[arg(long, value_name = "N")]
    jobs: Option<NonZero<usize>>,
    /// Do not write the figures or the report page
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
    let mut runs = Runs::of_study(&plan.manifest);
    let stop = stop_on_signal()?;
    let title = &plan.manifest.title;
    out::event(&json!({ "event": "start", "title": title, "directory": &*directory, "arms": runs.names }))?;
    let done = carom_study::start(&plan, &directory, jobs, &mut |e| runs.event(e), &stop);
    conclude(done, runs, &directory, !arguments.no_report)
}

/// Resumes a study that was stopped; `page`: with figures and page at the end.
pub(crate) fn resume(
    directory: &Path,
    requested: Option<NonZero<usize>>,
    page: bool,
) -> Result<Exit, Failure> {
    let jobs = super::parallel("--jobs", requested)?;
    let manifest = StudyManifest::read(directory)?;
    let mut runs = Runs::of_study(&manifest);
    let stop = stop_on_signal()?;
    out::event(&json!({ "event": "resume", "directory": directory, "arms": runs.names }))?;
    let done = carom_study::resume(directory, jobs, &mut |e| runs.event(e), &stop);
    conclude(done, runs, directory, page)
}

fn conclude(
    done: Result<Outcome, StudyError>,
    runs: Runs,
    directory: &Path,
    page: bool,
) -> Result<Exit, Failure> {
    drop(runs);
    let outcome = done?;
    let interrupted = outcome.interrupted;
    let damaged = outcome.study.rows.iter().chain(&outcome.study.members).any(Row::is_damaged);
    study_summary::print(&outcome, directory, page)?;
    if interrupted {
        out::summary(&format!("interrupted; continue with: carom resume {}", directory.display()))?;
    }
    Ok(match (interrupted, damaged) {
        (true, _) => Exit::Interrupted,
        (false, true) => Exit::Missed,
        (false, false) => Exit::Done,
    })
}
