//! The metrics of a run as a file of its directory.

use serde::Serialize;

use super::evaluated::of_run;
use crate::{RecordError, Run, files, json};

/// Name of the file.
const FILE: &str = "metrics.json";

#[derive(Serialize)]
struct File<'a> {
    metrics: Vec<Entry<'a>>,
}

#[derive(Serialize)]
struct Entry<'a> {
    name: &'a str,
    value: f64,
    unit: &'a str,
    meaning: &'a str,
}

/// Writes `metrics.json`: every metric that is defined for the run, with value, unit and meaning.
/// The computational work is left out, so that equal records give equal bytes; the manifest has it.
/// A record in memory has no such file.
///
/// # Errors
/// If the file cannot be written.
pub fn write(run: &Run) -> Result<(), RecordError> {
    if run.directory.as_os_str().is_empty() {
        return Ok(());
    }
    let metrics = of_run(run);
    let defined = metrics.iter().filter(|metric| !metric.is_work()).filter_map(|metric| {
        let value = metric.value.filter(|value| value.is_finite())?;
        Some(Entry { name: &metric.name, value, unit: &metric.unit, meaning: metric.definition })
    });
    let path = run.directory.join(FILE);
    files::write_atomically(&path, &[&json::text(&path, &File { metrics: defined.collect() })?, b"\n"])
}
