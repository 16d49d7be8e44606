//! Two generations of a checkpoint, written in turn, so that a killed process leaves one of them
//! complete, and a link to the last one that was flushed to the disk, which a power failure leaves.
//!
//! ```text
//! "CAROMCKP" | version u32 | header length u32 | header (postcard) | payload | blake3 of all before (32 bytes)
//! ```
//!
//! The header describes the other files of the directory at the checkpoint: lengths and checksums
//! of the row files, and the list of field files with theirs, so that a record altered later is not
//! continued.

use std::fs;
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use crate::stream::{Extent, Hash};
use crate::{FieldEntry, RecordError, files};

const MAGIC: &[u8; 8] = b"CAROMCKP";
const VERSION: u32 = 19;
const HASH_LENGTH: usize = blake3::OUT_LEN;

/// The record at a checkpoint.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(crate) struct Header {
    /// Number of the checkpoint: of two, the one with the larger number is newer.
    pub(crate) sequence: u64,
    pub(crate) step: u64,
    /// Rows in `history.csv`, without the header.
    pub(crate) rows: u64,
    /// Length and checksum of `history.csv`, `contact.csv` and `log.jsonl`, in this order.
    pub(crate) streams: [Extent; 3],
    pub(crate) fields: Vec<FieldEntry>,
    /// Checksum of each entry's file.
    pub(crate) field_hashes: Vec<Hash>,
    pub(crate) payload: u64,
}

/// Generation of a checkpoint; a run writes A and B alternately.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Generation {
    A,
    B,
    /// The last checkpoint that was flushed to the disk, under a second name until the run ends.
    Flushed,
}

impl Generation {
    /// All generations.
    pub(crate) const ALL: [Self; 3] = [Self::A, Self::B, Self::Flushed];

    /// The generation to write after this one.
    pub(crate) fn next(self) -> Self {
        match self {
            Self::A => Self::B,
            Self::B | Self::Flushed => Self::A,
        }
    }
}

/// File of a generation.
pub(crate) fn path(directory: &Path, generation: Generation) -> PathBuf {
    directory.join("checkpoint").join(match generation {
        Generation::A => "a.bin",
        Generation::B => "b.bin",
        Generation::Flushed => "flushed.bin",
    })
}

/// Replaces one generation. If `flush`, it is flushed to the disk and named as flushed; what its
/// header describes must have been flushed before.
pub(crate) fn write(
    directory: &Path,
    generation: Generation,
    header: &Header,
    payload: &[u8],
    flush: bool,
) -> Result<(), RecordError> {
    let path = path(directory, generation);
    let header =
        postcard::to_stdvec(header).map_err(|e| RecordError::io("write", &path)(std::io::Error::other(e)))?;
    let mut head = MAGIC.to_vec();
    head.extend(VERSION.to_le_bytes());
    head.extend((header.len() as u32).to_le_bytes());
    head.extend(header);
    let hash = blake3::Hasher::new().update(&head).update(payload).finalize();
    let hash = hash.as_bytes();
    if !flush {
        return files::write_unsynced(&path, &[&head, payload, hash]);
    }
    files::write_atomically(&path, &[&head, payload, hash])?;
    name_flushed(directory, generation)
}

/// Flushes a generation that was written without.
pub(crate) fn sync(directory: &Path, generation: Generation) -> Result<(), RecordError> {
    files::sync(&path(directory, generation))?;
    files::sync_directory(&directory.join("checkpoint"))
}

/// Removes the second name of the last flushed generation: both generations stay as they are.
pub(crate) fn forget_flushed(directory: &Path) -> Result<(), RecordError> {
    let path = path(directory, Generation::Flushed);
    match fs::remove_file(&path) {
        Err(error) if error.kind() != std::io::ErrorKind::NotFound => {
            Err(RecordError::io("remove", &path)(error))
        }
        _ => Ok(()),
    }
}

/// Gives a flushed generation a second name, which the next checkpoints do not replace.
fn name_flushed(directory: &Path, generation: Generation) -> Result<(), RecordError> {
    let from = path(directory, generation);
    let to = path(directory, Generation::Flushed);
    let partial = files::partial(&to);
    // Left behind by a killed process, or by a rename to another name of the same file.
    let _ = fs::remove_file(&partial);
    // File systems without links are allowed.
    fs::hard_link(&from, &partial)
        .or_else(|_| fs::copy(&from, &partial).and_then(|_| files::flush(&fs::File::open(&partial)?)))
        .and_then(|()| fs::rename(&partial, &to))
        .map_err(RecordError::io("replace", &to))?;
    let _ = fs::remove_file(&partial);
    files::sync_directory(&directory.join("checkpoint"))
}

/// Reads and verifies one generation.
pub(crate) fn read(directory: &Path, generation: Generation) -> Result<(Header, Vec<u8>), RecordError> {
    let path = path(directory, generation);
    let mut bytes = std::fs::read(&path).map_err(RecordError::io("read", &path))?;
    let damaged = |what: &str| RecordError::corrupt(&path, None, what, "run the case again");
    if !bytes.starts_with(MAGIC) {
        return Err(damaged("it is not a checkpoint file"));
    }
    let body = bytes.len().checked_sub(HASH_LENGTH).ok_or_else(|| damaged("it is too short"))?;
    if blake3::hash(&bytes[..body]).as_bytes()[..] != bytes[body..] {
        return Err(damaged("its checksum is wrong"));
    }
    let word = |at: usize| bytes.get(at..at + 4).and_then(|b| b.try_into().ok()).map(u32::from_le_bytes);
    if word(8) != Some(VERSION) {
        let hint = "resume with the version of Carom that wrote it";
        return Err(RecordError::corrupt(&path, None, "its format has another version", hint));
    }
    let start = 16 + word(12).ok_or_else(|| damaged("it is too short"))? as usize;
    let header: Header = bytes
        .get(16..start)
        .and_then(|b| postcard::from_bytes(b).ok())
        .filter(|h: &Header| start as u64 + h.payload == body as u64)
        .ok_or_else(|| damaged("its header does not match its length"))?;
    bytes.truncate(body);
    bytes.drain(..start);
    Ok((header, bytes))
}
