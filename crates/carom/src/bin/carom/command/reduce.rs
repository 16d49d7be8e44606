//! `carom reduce`: a smaller case that stops as a run did.

use std::path::PathBuf;

use carom::ReduceError;

use crate::exit::{Exit, Failure};
use crate::text::{several, short};
use crate::{directory, out};

/// From a run that stopped (exit code 3), make a smaller case that stops in the same way
#[derive(clap::Args)]
#[command(after_help = "\
The reduced case starts shortly before the stop. `carom reduce` also runs it, and exits with 0 if it
stops for the same reason at the same place, with 2 if it does not.

Examples:
  carom reduce runs/impact
  carom run runs/impact-reduced/case.toml")]
pub(crate) struct Arguments {
    /// The directory of a run that ended with exit code 3
    directory: PathBuf,
    /// Directory of the reduced case; must not exist yet [default: DIRECTORY-reduced, or
    /// DIRECTORY-reduced-2, … if that exists]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
}

pub(crate) fn run(arguments: &Arguments) -> Result<Exit, Failure> {
    super::report::run_directory(&arguments.directory)?;
    let to = directory::beside(&arguments.directory, "reduced", arguments.out.as_deref())?;
    let reduced = carom::reduce(&arguments.directory, &to)?;
    let mut lines = vec![format!(
        "{} to the stop, from t = {}",
        several(reduced.steps as usize, "step"),
        short(reduced.time)
    )];
    let removed = match &reduced.removed[..] {
        [] => format!("nothing: {}", carom::NEEDED),
        removed => removed.join(", "),
    };
    lines.push(format!("  removed    {removed}"));
    lines.push(format!("  remaining  {}", reduced.remaining.join(", ")));
    if let Some(reason) = &reduced.reason {
        lines.push(format!("  run again: {reason}"));
    }
    lines.push(reduced.case.display().to_string());
    out::summary(&lines.join("\n"))?;
    if reduced.reason.is_none() {
        let case = reduced.case.display();
        let what = format!(
            "the case that was written to {case} does not stop for the same reason at the same place"
        );
        let help = "use it as a start, or report this as a defect of Carom".to_owned();
        return Err(Failure::argument(what, help));
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
                Self::argument(what, help)
            }
            ReduceError::Unusable { what, help } => Self::argument(what, help),
        }
    }
}
