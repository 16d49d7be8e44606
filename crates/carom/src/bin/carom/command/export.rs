//! `carom export`: the history of a run as one file, with units.

use std::path::PathBuf;

use carom_record::Run;
use serde_json::json;

use crate::exit::{Exit, Failure};
use crate::out;

/// Write the history of a run as CSV or JSON with the units of its columns
#[derive(clap::Args)]
#[command(after_help = "\
Examples:
  carom export runs/impact --format json > impact.json
  python -m carom export runs/impact --format parquet      (Python package)")]
pub(crate) struct Arguments {
    /// The run directory
    directory: PathBuf,
    /// Format; Parquet is written by the Python package
    #[arg(long, value_enum)]
    format: Format,
    /// The file to write [default: standard output]
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
}

#[derive(Clone, Copy, clap::ValueEnum)]
enum Format {
    /// Names, units, then one line per row
    Csv,
    /// Columns with name, unit, description and values
    Json,
    /// See `python -m carom export`
    Parquet,
}

pub(crate) fn run(arguments: &Arguments) -> Result<Exit, Failure> {
    let run = match arguments.format {
        Format::Parquet => {
            let help = "python -m carom export DIR --format parquet (pip install carom[parquet])";
            let what = "the command does not write Parquet; the Python package does".to_owned();
            return Err(Failure::Argument { what, help: help.to_owned() });
        }
        Format::Csv | Format::Json => Run::open(&arguments.directory)?,
    };
    let text = match arguments.format {
        Format::Json => json_text(&run),
        _ => csv_text(&run),
    };
    match &arguments.out {
        Some(path) => std::fs::write(path, text + "\n")
            .map_err(|e| Failure::System { what: format!("cannot write {}: {e}", path.display()) })?,
        None => out::line(&text)?,
    }
    Ok(Exit::Done)
}

fn json_text(run: &Run) -> String {
    let history = &run.history;
    let columns = history.columns.iter().zip(&history.values);
    let columns: Vec<_> = columns
        .map(|(c, values)| {
            json!({ "name": c.name, "unit": c.unit, "description": c.description, "values": values })
        })
        .collect();
    json!({ "title": run.manifest.case["title"], "version": run.manifest.version, "columns": columns })
        .to_string()
}

/// Names, units, and rows of shortest decimals that read back to the same bits.
fn csv_text(run: &Run) -> String {
    let history = &run.history;
    let of = |text: fn(&carom_record::Column) -> &str| history.columns.iter().map(text).collect::<Vec<_>>();
    let mut lines = vec![of(|c| &c.name).join(","), of(|c| &c.unit).join(",")];
    let cell = |k: usize, row: usize| {
        let value = history.values[k][row];
        if history.columns[k].integer && value.fract() == 0.0 {
            format!("{value}")
        } else {
            format!("{value:?}")
        }
    };
    let row = |i| (0..history.values.len()).map(|k| cell(k, i)).collect::<Vec<_>>().join(",");
    lines.extend((0..history.times().len()).map(row));
    lines.join("\n")
}
