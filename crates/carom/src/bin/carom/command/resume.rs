//! `carom resume`: resumes a run or a study; the result is bitwise identical.

use std::num::NonZero;
use std::path::PathBuf;

use carom_record::study::StudyManifest;
use carom_record::{Manifest, Status};
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
    let flags = &arguments.flags;
    if StudyManifest::is_in(&arguments.directory) {
        let of_a_run = [
            (flags.threads.is_some(), "--threads"),
            (flags.profile, "--profile"),
            (flags.strict, "--strict"),
            (flags.audit, "--audit"),
            (flags.no_trials, "--no-trials"),
        ];
        if let Some((_, option)) = of_a_run.iter().find(|(given, _)| *given) {
            let what =
                format!("{option} is an option for runs, but {} is a study", arguments.directory.display());
            let help = "the arms of a study share the cores, without audit and without trials where it stops; \
                --jobs sets the number of concurrent arms, and the timings of an arm are in its manifest.json";
            return Err(Failure::argument(what, help));
        }
        return super::study::resume(&arguments.directory, arguments.jobs, !flags.no_report, flags.json);
    }
    if arguments.jobs.is_some() {
        let what = format!("--jobs is an option for studies, but {} is a run", arguments.directory.display());
        return Err(Failure::argument(what, "use --threads for a run"));
    }
    super::report::run_directory(&arguments.directory)?;
    if flags.audit && Manifest::read(&arguments.directory)?.status == Status::Finished {
        let what = format!(
            "{} has finished, and --audit checks the steps that are computed",
            arguments.directory.display()
        );
        let help = "run its case again with --audit, into another directory".to_owned();
        return Err(Failure::argument(what, help));
    }
    let options = flags.options()?;
    let stop = stop_on_signal()?;
    if flags.json {
        out::event(&json!({ "event": "resume", "directory": arguments.directory }))?;
    }
    let mut live = Live::new(flags.json, &arguments.directory);
    let done = simulation::resume(&arguments.directory, options, &mut |p| live.show(p), &stop);
    live.end(&done);
    summary::print(done, flags.json, flags.strict)
}
