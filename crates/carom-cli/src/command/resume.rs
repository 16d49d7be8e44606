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
#[command(after_help = "Example:\n  carom resume runs/impact")]
pub(crate) struct Arguments {
    /// The directory of the run or study
    directory: PathBuf,
    /// Threads; the results are the same bits for any number [default: 1]
    #[arg(long, value_name = "N")]
    threads: Option<NonZero<usize>>,
    /// Make no figures and no page
    #[arg(long)]
    no_report: bool,
    /// Tell where the time went
    #[arg(long)]
    profile: bool,
    /// One JSON object per event on standard output, and nothing else there
    #[arg(long)]
    json: bool,
}

pub(crate) fn run(arguments: &Arguments) -> Result<Exit, Failure> {
    if StudyManifest::is_in(&arguments.directory) {
        return super::study::resume(&arguments.directory, arguments.json);
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
