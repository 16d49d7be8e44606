//! `carom schema`: JSON Schema for editors.

use crate::exit::{Exit, Failure};
use crate::out;

/// Print the JSON Schema of case files or study files, for editors
#[derive(clap::Args)]
#[command(after_help = "\
Examples:
  carom schema > carom.schema.json
  carom schema --study > study.schema.json

Editors with a language server for TOML (Taplo) use the schema if the first line of a case is:
  #:schema ./carom.schema.json")]
pub(crate) struct Arguments {
    /// Print the schema of study files
    #[arg(long)]
    study: bool,
}

pub(crate) fn run(arguments: &Arguments) -> Result<Exit, Failure> {
    let schema = if arguments.study { carom_study::schema() } else { carom::case::schema() };
    let schema = serde_json::to_string_pretty(&schema).map_err(std::io::Error::from)?;
    out::line(&schema)?;
    Ok(Exit::Done)
}
