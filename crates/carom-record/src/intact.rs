//! The checkpoints from which a run can be continued: their own checksum is right, and the record
//! beside them has not changed since.

use std::fs;
use std::path::Path;

use crate::checkpoint::{self, Generation, Header};
use crate::{RecordError, stream};

/// Files of rows, whose lengths and checksums a checkpoint records.
pub(crate) const ROW_FILES: [&str; 3] = ["history.csv", "contact.csv", "log.jsonl"];

/// Payload of the newest intact checkpoint; nothing is changed. The record beside it is not read.
///
/// # Errors
/// There is no intact checkpoint.
pub fn last_checkpoint(directory: &Path) -> Result<Vec<u8>, RecordError> {
    let mut damage = None;
    for (_, found) in newest_first(directory) {
        match found {
            Ok((_, payload)) => return Ok(payload),
            Err(error) if !missing(&error) => damage = Some(error),
            Err(_) => {}
        }
    }
    Err(damage.unwrap_or_else(|| no_checkpoint(directory)))
}

/// Steps and payloads of the intact checkpoints, the newest first; nothing is changed, and the
/// record beside them is not read.
///
/// # Errors
/// There is no intact checkpoint.
pub fn checkpoints(directory: &Path) -> Result<Vec<(u64, Vec<u8>)>, RecordError> {
    let mut found: Vec<_> = newest_first(directory).into_iter().filter_map(|(_, found)| found.ok()).collect();
    found.dedup_by_key(|(header, _)| header.sequence);
    let found: Vec<_> = found.into_iter().map(|(header, payload)| (header.step, payload)).collect();
    if found.is_empty() { Err(no_checkpoint(directory)) } else { Ok(found) }
}

pub(crate) type Checkpoint = (Header, Vec<u8>);

/// All generations, the newest first; a damaged or missing one, whose age is unknown, comes before
/// the others.
pub(crate) fn newest_first(directory: &Path) -> [(Generation, Result<Checkpoint, RecordError>); 3] {
    let mut found = Generation::ALL.map(|generation| (generation, checkpoint::read(directory, generation)));
    let age = |found: &Result<Checkpoint, RecordError>| found.as_ref().map_or(u64::MAX, |c| c.0.sequence);
    found.sort_by_key(|(_, checkpoint)| std::cmp::Reverse(age(checkpoint)));
    found
}

/// A checkpoint whose record is unchanged, with the running checksums of the row files.
pub(crate) struct Intact {
    pub(crate) header: Header,
    pub(crate) payload: Vec<u8>,
    pub(crate) hashers: Vec<blake3::Hasher>,
}

/// Compares the record with a checkpoint.
pub(crate) fn verified(directory: &Path, (header, payload): Checkpoint) -> Result<Intact, RecordError> {
    let mut hashers = Vec::new();
    for (name, extent) in ROW_FILES.iter().zip(&header.streams) {
        hashers.push(stream::verified(&directory.join(name), extent, header.step)?);
    }
    for (entry, hash) in header.fields.iter().zip(&header.field_hashes) {
        let path = directory.join(entry.file());
        let bytes = fs::read(&path).map_err(|error| stream::unreadable(&path, error))?;
        if blake3::hash(&bytes) != *hash {
            let what = format!("the fields of step {} have changed since they were written", entry.step);
            return Err(stream::altered(&path, what));
        }
    }
    Ok(Intact { header, payload, hashers })
}

pub(crate) fn no_checkpoint(directory: &Path) -> RecordError {
    stream::altered(&directory.join("checkpoint"), "it contains no checkpoint")
}

pub(crate) fn missing(error: &RecordError) -> bool {
    matches!(error, RecordError::Io { source, .. } if source.kind() == std::io::ErrorKind::NotFound)
}
