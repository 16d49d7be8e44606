//! `carom resume`: resumes a run or a study; the result is bitwise identical.

use std::num::NonZero;
use std::path::PathBuf;

use carom_record::study::StudyManifest;
use serde_json::json;

use crate::exit::{Exit, Failure};
use crate::live::{Live, stop_on_signal};
use crate::simulation::{self, Options};
use crate::{out, summary};

/// Resume a run or a study that was stopped; the result is bitwise identical
#[derive(clap::Args)]
#[command(after_help = "\
Examples:
  carom resume runs/impact
  carom resume runs/fair --jobs 2")]
#[allow(clippy::struct_excessive_bools)] // flags of the command line
pub(crate) struct Arguments {
    /// The directory of the run or study
    directory: PathBuf,
    /// Number of threads of a run; results are bitwise identical for any number;
    /// at most four per core, or 64 [default: one per core]
    #[arg(long, value_name = "N")]
    threads: Option<NonZero<usize>>,
    /// Number of concurrent arms of a study; results are bitwise identical for any number;
    /// at most four per core, or 64 [default: all cores]
    #[arg(long, value_name = "N")]
    jobs: Option<NonZero<usize>>,
    /// Do not write figures and report page
    #[arg(long)]
    no_report: bool,
    /// Where a run stops, do not try what may get it past that place
    #[arg(long)]
    no_trials: bool,
    /// Print a timing profile of a run
    #[arg(long)]
    profile: bool,
    /// Exit with code 1 if an expectation of a run is missed
    #[arg(long)]
    strict: bool,
    /// Print one JSON object per event on standard output, and nothing else
    #[arg(long)]
    pub(crate) json: bool,
}

pub(crate) fn run(arguments: &Arguments) -> Result<Exit, Failure> {
    if StudyManifest::is_in(&arguments.directory) {
        let of_a_run = [
            (arguments.threads.is_some(), "--threads"),
            (arguments.profile, "--profile"),
            (arguments.strict, "--strict"),
        ];
        if let Some((_, option)) = of_a_run.iter().find(|(given, _)| *given) {
            let what =
                format!("{option} is an option for runs, but {} is a study", arguments.directory.display());
            let help = "each arm of a study uses one thread, and --jobs sets the number of concurrent arms; \
                        the timings of an arm are in its manifest.json";
            return Err(Failure::Argument { what, help: help.to_owned() });
        }
        return super::study::resume(
            &arguments.directory,
            arguments.jobs,
            !arguments.no_report,
            arguments.json,
        );
    }
    if arguments.jobs.is_some() {
        let what = format!("--jobs is an option for studies, but {} is a run", arguments.directory.display());
        return Err(Failure::Argument { what, help: "use --threads for a run".to_owned() });
    }
    super::report::run_directory(&arguments.directory)?;
    let options = Options {
        threads: super::parallel("--threads", arguments.threads)?,
        report: !arguments.no_report,
        profile: arguments.profile,
        trials: !arguments.no_trials,
    };
    let stop = stop_on_signal()?;
    if arguments.json {
        out::event(&json!({ "event": "resume", "directory": arguments.directory }))?;
    }
    let mut live = Live::new(arguments.json, &arguments.directory);
    let done = simulation::resume(&arguments.directory, options, &mut |p| live.show(p), &stop);
    live.end(&done);
    summary::print(done, arguments.json, arguments.strict)
}
