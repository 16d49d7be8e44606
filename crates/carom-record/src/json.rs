//! The content of JSON files.

use std::path::Path;

use serde::Serialize;
use serde::de::DeserializeOwned;

use crate::RecordError;

/// The value in a file; `hint` tells what to do if it is damaged.
pub(crate) fn value<T: DeserializeOwned>(
    path: &Path,
    text: &[u8],
    hint: &'static str,
) -> Result<T, RecordError> {
    serde_json::from_slice(text)
        .map_err(|error| RecordError::corrupt(path, Some(error.line() as u64), error.to_string(), hint))
}

/// What is written into a file for a value.
pub(crate) fn text(path: &Path, value: &impl Serialize) -> Result<Vec<u8>, RecordError> {
    serde_json::to_vec_pretty(value).map_err(|error| RecordError::io("write", path)(error.into()))
}
