//! `carom man`: the manual pages, one per command.

use std::path::PathBuf;

use clap::CommandFactory;

use crate::exit::{Exit, Failure};
use crate::out;

/// Print the manual page of carom, or write those of all commands into a directory
#[derive(clap::Args)]
#[command(after_help = "\
Examples:
  carom man --out ~/.local/share/man/man1
  carom man | man -l -")]
pub(crate) struct Arguments {
    /// Folder for carom.1, carom-run.1, …; without it, carom.1 is printed to standard
    /// output
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
}

pub(crate) fn run(arguments: &Arguments) -> Result<Exit, Failure> {
    let command = crate::Arguments::command();
    let Some(folder) = &arguments.out else {
        let mut page = Vec::new();
        clap_mangen::Man::new(command).render(&mut page)?;
        out::line(&String::from_utf8_lossy(&page))?;
        return Ok(Exit::Done);
    };
    let failed = |e| Failure::cannot("write to", folder, &e);
    std::fs::create_dir_all(folder)
        .and_then(|()| clap_mangen::generate_to(command, folder))
        .map_err(failed)?;
    Ok(Exit::Done)
}
