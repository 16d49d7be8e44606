//! `carom reduce`: a smaller case that stops as a run did.

use std::path::PathBuf;

use carom::ReduceError;

use crate::exit::{Exit, Failure};
use crate::{console, directory, out, summary};

/// Make a smaller case that starts just before the stop of a run and stops in the same way
#[derive(clap::Args)]
#[command(after_help = "\
`carom reduce` runs the reduced case: its exit code is 0 if the case stops for the same reason at
the same place.

Example:
  carom reduce runs/impact
  carom run runs/impact-reduced/case.toml")]
pub(crate) struct Arguments {
    /// The directory of a run that ended with exit code 3
    directory: PathBuf,
    /// Directory of the reduced case; must not exist yet [default: RUN-reduced, RUN-reduced-2, …]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
}

pub(crate) fn run(arguments: &Arguments) -> Result<Exit, Failure> {
    super::report::run_directory(&arguments.directory)?;
    let to = directory::beside(&arguments.directory, "reduced", arguments.out.as_deref())?;
    let reduced = carom::reduce(&arguments.directory, &to)?;
    let mut lines = vec![format!(
        "{} step{} to the stop, from t = {}",
        reduced.steps,
        if reduced.steps == 1 { "" } else { "s" },
        summary::short(reduced.time)
    )];
    let list = |names: &[String]| if names.is_empty() { "nothing".to_owned() } else { names.join(", ") };
    lines.push(format!("  removed    {}", list(&reduced.removed)));
    lines.push(format!("  remaining  {}", list(&reduced.remaining)));
    if let Some(reason) = &reduced.reason {
        lines.push(format!("  run again: {reason}"));
    }
    lines.push(reduced.case.display().to_string());
    if !console::is_quiet() {
        out::line(&lines.join("\n"))?;
    }
    if reduced.reason.is_none() {
        let case = reduced.case.display();
        let what = format!(
            "the case that was written to {case} does not stop for the same reason at the same place"
        );
        let help = "use it as a start, or report this as a defect of Carom".to_owned();
        return Err(Failure::Argument { what, help });
    }
    Ok(Exit::Done)
}

impl From<ReduceError> for Failure {
    fn from(error: ReduceError) -> Self {
        match error {
            ReduceError::Record(error) => error.into(),
            ReduceError::Case(problems) => {
                let what = ReduceError::Case(problems).to_string();
                let help = "restore the files that the case names as they were when the run was made";
                Self::Argument { what, help: help.to_owned() }
            }
            ReduceError::Unusable { what, help } => Self::Argument { what, help: help.to_owned() },
        }
    }
}
