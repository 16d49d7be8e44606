//! `carom report`: figures and page, made from the records alone.

use std::path::{Path, PathBuf};

use carom_record::study::StudyManifest;

use crate::exit::{Exit, Failure};
use crate::{out, simulation};

/// Rebuild the figures and the page of a run or a study from its records alone
#[derive(clap::Args)]
#[command(after_help = "Example:\n  carom report runs/impact")]
pub(crate) struct Arguments {
    /// The directory of the run or study
    directory: PathBuf,
}

pub(crate) fn run(arguments: &Arguments) -> Result<Exit, Failure> {
    let page = if StudyManifest::is_in(&arguments.directory) {
        crate::study_summary::report(&arguments.directory)?
    } else {
        run_directory(&arguments.directory)?;
        simulation::report(&arguments.directory)?
    };
    out::line(&page.display().to_string())?;
    Ok(Exit::Done)
}

/// Checks that a directory is that of a run.
pub(super) fn run_directory(directory: &Path) -> Result<(), Failure> {
    if directory.join("manifest.json").is_file() {
        return Ok(());
    }
    let path = directory.display();
    let what = if directory.exists() {
        format!("{path} is not the directory of a run or a study: it has no manifest.json")
    } else {
        format!("there is no directory {path}")
    };
    Err(Failure::Argument {
        what,
        help: "give a directory that `carom run` or `carom study` created, for example runs/impact"
            .to_owned(),
    })
}
