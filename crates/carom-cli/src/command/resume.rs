//! `carom resume`: go on after a stop, bit for bit.

use std::num::NonZero;
use std::path::PathBuf;

use carom_record::study::StudyManifest;
use serde_json::json;

use crate::exit::{Exit, Failure};
use crate::live::{Live, stop_on_signal};
use crate::simulation::{self, Options};
use crate::{out, summary};

/// Go on with a run or a study that was stopped, bit for bit
#[derive(clap::Args)]
#[command(after_help = "\
Examples:
  carom resume runs/impact
  carom resume runs/fair --jobs 2")]
pub(crate) struct Arguments {
    /// The directory of the run or study
    directory: PathBuf,
    /// Threads of a run; the results are the same bits for any number [default: one for each core]
    #[arg(long, value_name = "N")]
    threads: Option<NonZero<usize>>,
    /// Arms of a study computed at the same time; the results are the same bits for any number
    /// [default: all cores]
    #[arg(long, value_name = "N")]
    jobs: Option<NonZero<usize>>,
    /// Make no figures and no page
    #[arg(long)]
    no_report: bool,
    /// Tell where the time of a run went
    #[arg(long)]
    profile: bool,
    /// One JSON object per event on standard output, and nothing else there
    #[arg(long)]
    json: bool,
}

pub(crate) fn run(arguments: &Arguments) -> Result<Exit, Failure> {
    if StudyManifest::is_in(&arguments.directory) {
        let of_a_run = [(arguments.threads.is_some(), "--threads"), (arguments.profile, "--profile")];
        if let Some((_, option)) = of_a_run.iter().find(|(given, _)| *given) {
            let what = format!("{option} is for a run, and {} is a study", arguments.directory.display());
            let help = "the arms of a study take one thread each: --jobs says how many at the same time; \
                        the time of an arm is in its manifest.json";
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
        let what = format!("--jobs is for a study, and {} is none", arguments.directory.display());
        return Err(Failure::Argument { what, help: "use --threads for a run".to_owned() });
    }
    super::report::run_directory(&arguments.directory)?;
    let options = Options {
        threads: super::threads(arguments.threads),
        report: !arguments.no_report,
        profile: arguments.profile,
    };
    let stop = stop_on_signal()?;
    if arguments.json {
        out::event(&json!({ "event": "resume", "directory": arguments.directory }))?;
    }
    let mut live = Live::new(arguments.json);
    let done = simulation::resume(&arguments.directory, options, &mut |p| live.show(p), &stop);
    drop(live);
    summary::tell(done, arguments.json)
}
