//! `carom export`: the history of a run as one file, with units.

#[cfg(feature = "parquet")]
use std::collections::HashMap;
use std::path::{Path, PathBuf};

use carom_record::Run;

use crate::exit::{Exit, Failure};
use crate::out;

/// Write the history of a run as CSV, JSON or Parquet with the units of its columns
#[derive(clap::Args)]
#[command(after_help = "\
Examples:
  carom export runs/impact --format json > impact.json
  carom export runs/impact --format parquet --out impact.parquet")]
pub(crate) struct Arguments {
    /// The run directory
    directory: PathBuf,
    /// Format of the output
    #[arg(long, value_enum)]
    format: Format,
    /// The file to write; must not exist yet [default: standard output; required for Parquet]
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
}

#[derive(Clone, Copy, clap::ValueEnum)]
enum Format {
    /// Names, units, then one line per row
    Csv,
    /// Columns with name, unit, description and values
    Json,
    /// Columns with unit and description as metadata; needs a build with `--features parquet`, or
    /// `python -m carom export`
    Parquet,
}

pub(crate) fn run(arguments: &Arguments) -> Result<Exit, Failure> {
    arguments.out.as_deref().map_or(Ok(()), free)?;
    let run = Run::open(&arguments.directory)?;
    let text = match arguments.format {
        Format::Json => run.to_json() + "\n",
        Format::Csv => run.to_csv()?,
        Format::Parquet => {
            write_parquet(&run, arguments.out.as_deref())?;
            return Ok(Exit::Done);
        }
    };
    match &arguments.out {
        Some(path) => std::fs::write(path, text).map_err(|e| Failure::cannot("write", path, &e))?,
        None => out::line(&text)?,
    }
    Ok(Exit::Done)
}

#[cfg(feature = "parquet")]
fn write_parquet(run: &Run, path: Option<&Path>) -> Result<(), Failure> {
    use std::sync::Arc;

    use arrow_array::{ArrayRef, Float64Array, RecordBatch};
    use arrow_schema::{DataType, Field, Schema};
    use parquet::arrow::ArrowWriter;

    let path = path.ok_or_else(|| Failure::argument("a Parquet file needs a name", "--out FILE"))?;
    let pair = |key: &str, text: &str| (key.to_owned(), text.to_owned());
    let columns = &run.history.columns;
    let fields = columns.iter().map(|c| {
        let data = [pair("unit", &c.unit), pair("description", &c.description)];
        let data: HashMap<_, _> = data.into_iter().filter(|(_, text)| !text.is_empty()).collect();
        Field::new(&c.name, DataType::Float64, false).with_metadata(data)
    });
    let schema = Arc::new(Schema::new(fields.collect::<Vec<_>>()));
    let values = run.history.values.iter().map(|v| Arc::new(Float64Array::from(v.clone())) as ArrayRef);
    let rows = RecordBatch::try_new(schema.clone(), values.collect())
        .map_err(|e| Failure::cannot("write", path, &e))?;
    let file = std::fs::File::create(path).map_err(|e| Failure::cannot("write", path, &e))?;
    ArrowWriter::try_new(file, schema, None)
        .and_then(|mut writer| {
            writer.write(&rows)?;
            writer.close()
        })
        .map_err(|e| Failure::cannot("write", path, &e))?;
    Ok(())
}

#[cfg(not(feature = "parquet"))]
fn write_parquet(_: &Run, _: Option<&Path>) -> Result<(), Failure> {
    Err(Failure::argument(
        "this program was built without Parquet",
        "cargo install --path crates/carom --features parquet, in a clone of Carom; or there \
               pip install \"./crates/carom-python[parquet]\", then python -m carom export DIR --format parquet \
               --out FILE",
    ))
}

/// A file that exists may be one of the record.
fn free(path: &Path) -> Result<(), Failure> {
    if !path.is_file() {
        return Ok(());
    }
    let what = format!("{} exists already, and Carom never overwrites a file", path.display());
    Err(Failure::argument(what, "name another file, or remove it first"))
}
