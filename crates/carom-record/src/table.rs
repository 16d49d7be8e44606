//! Tables as CSV files. A missing value is an empty cell; numbers read back to the same bits.

use std::path::Path;

use serde::Serialize;

use crate::{RecordError, files};

/// Replaces a file by a table; the cells of a row are those of nested tuples and lists.
///
/// # Errors
/// Input/output or system error.
pub fn write(
    path: &Path,
    header: &[&str],
    rows: impl Iterator<Item = impl Serialize>,
) -> Result<(), RecordError> {
    let failed = |error: csv::Error| RecordError::io("write", path)(error.into());
    let mut writer = csv::WriterBuilder::new().has_headers(false).from_writer(Vec::new());
    writer.write_record(header).map_err(failed)?;
    for row in rows {
        writer.serialize(row).map_err(failed)?;
    }
    let bytes = writer.into_inner().map_err(|error| RecordError::io("write", path)(error.into_error()))?;
    files::write_atomically(path, &[&bytes])
}
