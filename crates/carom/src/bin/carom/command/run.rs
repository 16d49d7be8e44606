//! `carom run`: one simulation, recorded in a run directory with its report.

use std::path::{Path, PathBuf};

use carom::recording::{self, RunError};
use carom_record::Source;
use serde_json::json;

use super::flags::Flags;
use crate::exit::{Exit, Failure};
use crate::live::{Live, stop_on_signal};
use crate::{directory, out, simulation, summary};

/// Simulate a case and write a run directory with its report
#[derive(clap::Args)]
#[command(after_help = "\
Examples:
  carom run impact.toml
  sed s/0.25/0.5/ impact.toml | carom run - --out runs/dense
  carom run impact.toml --set time.step=1e-3 --set body.cylinder.element=T6
  carom run impact.toml --set 'time.scheme={ kind = \"hu\" }' --out runs/hu")]
pub(crate) struct Arguments {
    /// The case file, or - for standard input
    case: PathBuf,
    /// Directory of the run; must not exist yet [default: runs/NAME, or runs/NAME-2, … if that
    /// exists; NAME is the name of the case file without its extension]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Replace a value of the case; an entry of a list is addressed by its name:
    /// body.cylinder.element=T6
    #[arg(long = "set", value_name = "KEY=VALUE")]
    sets: Vec<String>,
    #[command(flatten)]
    pub(crate) flags: Flags,
}

pub(crate) fn run(arguments: &Arguments) -> Result<Exit, Failure> {
    let (case, document) = super::case(&arguments.case, &arguments.sets)?;
    let flags = &arguments.flags;
    let threads = flags.threads()?;
    let directory = directory::of_run(&arguments.case, arguments.out.as_deref())?;
    let stop = stop_on_signal()?;
    let steps = case.time.steps();
    out::event(&json!({ "event": "start", "title": case.title, "directory": &*directory, "steps": steps }))?;
    let folder = Path::new(document.name()).parent().unwrap_or(Path::new(""));
    let folder = std::path::absolute(Path::new(".").join(folder)).ok();
    let source = Source {
        text: document.text().to_owned(),
        sets: document.sets(),
        folder,
        no_report: flags.no_report,
    };
    let mut live = Live::new(&directory);
    let done = recording::run(&case, source, &directory, threads, &mut |p| live.show(p), &stop);
    let done = done.map_err(|error| match error {
        RunError::Case(problems) => Failure::Case(document.diagnose_all(&problems)),
        error => error.into(),
    });
    let done = simulation::conclude(done, flags.options(!flags.no_report));
    live.end(&done);
    summary::print(done, flags.strict)
}
