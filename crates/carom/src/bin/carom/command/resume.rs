//! `carom resume`: resumes a run or a study; the result is bitwise identical.

use std::num::NonZero;
use std::path::PathBuf;

use carom::recording;
use carom_record::Manifest;
use carom_record::study::StudyManifest;
use serde_json::json;

use super::flags::Flags;
use crate::exit::{Exit, Failure};
use crate::live::{Live, stop_on_signal};
use crate::{out, simulation, summary};

/// Resume an interrupted run or study; the result is bitwise identical to an uninterrupted one
#[derive(clap::Args)]
#[command(after_help = "\
Examples:
  carom resume runs/impact
  carom resume runs/fair --jobs 2")]
pub(crate) struct Arguments {
    /// The directory of the run or study
    directory: PathBuf,
    /// Number of concurrent arms of a study; results are bitwise identical for any number;
    /// at most 64, or four per core if that is more [default: one per core]
    #[arg(long, value_name = "N")]
    jobs: Option<NonZero<usize>>,
    #[command(flatten)]
    pub(crate) flags: Flags,
}

pub(crate) fn run(arguments: &Arguments) -> Result<Exit, Failure> {
    let Arguments { directory, jobs, flags } = arguments;
    if StudyManifest::is_in(directory) {
        let of_a_run = [
            (flags.threads.is_some(), "--threads"),
            (flags.profile, "--profile"),
            (flags.strict, "--strict"),
        ];
        if let Some((_, option)) = of_a_run.iter().find(|(given, _)| *given) {
            let what = format!("{option} is an option for runs, but {} is a study", directory.display());
            let help = "the arms of a study share the cores; --jobs sets the number of concurrent arms, and the \
                timings of an arm are in its manifest.json";
            return Err(Failure::argument(what, help));
        }
        return super::study::resume(directory, *jobs, !flags.no_report);
    }
    if jobs.is_some() {
        let what = format!("--jobs is an option for studies, but {} is a run", directory.display());
        return Err(Failure::argument(what, "use --threads for a run"));
    }
    super::report::run_directory(directory)?;
    let report = !flags.no_report && !Manifest::read(directory)?.source.no_report;
    let threads = flags.threads()?;
    let stop = stop_on_signal()?;
    out::event(&json!({ "event": "resume", "directory": directory }))?;
    let mut live = Live::new(directory);
    let done = recording::resume(directory, threads, &mut |p| live.show(p), &stop);
    let done = simulation::conclude(done.map_err(Failure::from), flags.options(report));
    live.end(&done);
    summary::print(done, flags.strict)
}
