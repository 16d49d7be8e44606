//! JSON files of a record.

use std::io::ErrorKind;
use std::path::Path;

use serde::Serialize;
use serde::de::DeserializeOwned;

use crate::{RecordError, files};

/// Parses the text of a file as JSON; `hint` is the remedy if it is damaged.
pub(crate) fn value<T: DeserializeOwned>(
    path: &Path,
    text: &[u8],
    hint: &'static str,
) -> Result<T, RecordError> {
    serde_json::from_slice(text)
        .map_err(|error| RecordError::corrupt(path, Some(error.line() as u64), error.to_string(), hint))
}

/// The value in a file, none if there is no such file; `hint` tells what to do if it is damaged.
///
/// # Errors
/// Input/output or system error, or a damaged file.
pub fn read<T: DeserializeOwned>(path: &Path, hint: &'static str) -> Result<Option<T>, RecordError> {
    match std::fs::read(path) {
        Err(error) if matches!(error.kind(), ErrorKind::NotFound | ErrorKind::NotADirectory) => Ok(None),
        text => value(path, &text.map_err(RecordError::io("read", path))?, hint).map(Some),
    }
}

/// Serialises a value as indented JSON that ends in a newline; `path` is named in errors.
pub(crate) fn text(path: &Path, value: &impl Serialize) -> Result<Vec<u8>, RecordError> {
    let text =
        serde_json::to_vec_pretty(value).map_err(|error| RecordError::io("write", path)(error.into()))?;
    Ok([&text[..], b"\n"].concat())
}

/// Replaces a file by one that contains this value as JSON.
///
/// # Errors
/// Input/output or system error.
pub fn write(path: &Path, value: &impl Serialize) -> Result<(), RecordError> {
    files::write_atomically(path, &[&text(path, value)?])
}
