//! `carom schema`: JSON Schema for editors.

use crate::exit::{Exit, Failure};
use crate::out;

/// Print the JSON Schema of case files, for editors
#[derive(clap::Args)]
#[command(after_help = "\
Example:
  carom schema > carom.schema.json
  and `#:schema ./carom.schema.json` as first line of a case")]
pub(crate) struct Arguments {}

pub(crate) fn run(_: &Arguments) -> Result<Exit, Failure> {
    let schema = serde_json::to_string_pretty(&carom::case::schema()).map_err(std::io::Error::from)?;
    out::line(&schema)?;
    Ok(Exit::Done)
}
