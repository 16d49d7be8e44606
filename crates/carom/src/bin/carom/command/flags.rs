//! Options that `carom run` and `carom resume` have in common.

use std::num::NonZero;

use carom::ThreadCount;

use crate::exit::Failure;
use crate::simulation::Options;

// How a run is computed and reported. (A doc comment would replace the help of the commands.)
#[derive(clap::Args)]
#[allow(clippy::struct_excessive_bools)] // flags of the command line
pub(crate) struct Flags {
    /// Number of threads of a run; results are bitwise identical for any number;
    /// at most 64, or four per core if that is more [default: one per core, and one for a model
    /// too small for more to pay]
    #[arg(long, value_name = "N")]
    pub(crate) threads: Option<NonZero<usize>>,
    /// Do not write the figures or the report page
    #[arg(long)]
    pub(crate) no_report: bool,
    /// Print a timing profile of a run
    #[arg(long)]
    pub(crate) profile: bool,
    /// Exit with code 1 if a run misses an expectation (`[[expect]]` in the case)
    #[arg(long)]
    pub(crate) strict: bool,
    /// Print one JSON object per event on standard output, and nothing else
    #[arg(long)]
    pub(crate) json: bool,
}

impl Flags {
    pub(crate) fn threads(&self) -> Result<ThreadCount, Failure> {
        let count = super::parallel("--threads", self.threads)?;
        Ok(if self.threads.is_some() { ThreadCount::Exactly(count) } else { ThreadCount::UpTo(count) })
    }

    pub(crate) fn options(&self, report: bool) -> Options {
        Options { report, profile: self.profile }
    }
}
