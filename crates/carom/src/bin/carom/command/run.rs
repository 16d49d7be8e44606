//! `carom run`: one simulation, recorded in a run directory with its report.

use std::num::NonZero;
use std::path::PathBuf;

use serde_json::json;

use crate::exit::{Exit, Failure};
use crate::live::{Live, stop_on_signal};
use crate::simulation::{self, Options};
use crate::{directory, out, summary};

/// Simulate a case and write a run directory with its report
#[derive(clap::Args)]
#[command(after_help = "\
Examples:
  carom run impact.toml
  sed s/0.25/0.5/ impact.toml | carom run - --out runs/dense
  carom run impact.toml --set time.step=1e-3 --set body.cylinder.element=T6
  carom run impact.toml --set 'time.scheme={ kind = \"hu\" }' --out runs/hu")]
#[allow(clippy::struct_excessive_bools)] // flags of the command line
pub(crate) struct Arguments {
    /// The case file, or - for standard input
    case: PathBuf,
    /// Directory of the run; must not exist yet [default: runs/NAME, runs/NAME-2, …]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Replace a value of the case; an entry of a list is addressed by its name:
    /// body.cylinder.element=T6
    #[arg(long = "set", value_name = "KEY=VALUE")]
    sets: Vec<String>,
    /// Number of threads; results are bitwise identical for any number;
    /// at most four per core, or 64 [default: one per core]
    #[arg(long, value_name = "N")]
    threads: Option<NonZero<usize>>,
    /// Do not write figures and report page
    #[arg(long)]
    no_report: bool,
    /// Where a run stops, do not try what may get it past that place
    #[arg(long)]
    no_trials: bool,
    /// Print a timing profile
    #[arg(long)]
    profile: bool,
    /// Exit with code 1 if an expectation is missed
    #[arg(long)]
    strict: bool,
    /// Print one JSON object per event on standard output, and nothing else
    #[arg(long)]
    pub(crate) json: bool,
}

pub(crate) fn run(arguments: &Arguments) -> Result<Exit, Failure> {
    let (case, document) = super::case(&arguments.case, &arguments.sets)?;
    let options = Options {
        threads: super::parallel("--threads", arguments.threads)?,
        report: !arguments.no_report,
        profile: arguments.profile,
        trials: !arguments.no_trials,
    };
    let directory = directory::of_run(&arguments.case, arguments.out.as_deref())?;
    let stop = stop_on_signal()?;
    if arguments.json {
        let steps = case.time.steps();
        out::event(
            &json!({ "event": "start", "title": case.title, "directory": &*directory, "steps": steps }),
        )?;
    }
    let mut live = Live::new(arguments.json, &directory);
    let done = simulation::run(&case, &document, &directory, options, &mut |p| live.show(p), &stop);
    live.end(&done);
    summary::print(done, arguments.json, arguments.strict)
}
