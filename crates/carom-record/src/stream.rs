//! A file that is only appended to, with the checksum of its bytes.
//!
//! The checksum is updated with what is written, so that the cost of a checkpoint does not grow
//! with the record; only reopening reads the file again.

use std::fs::{File, OpenOptions};
use std::io::{self, BufRead, BufReader, Read, Seek, SeekFrom, Write};
use std::path::Path;

use serde::{Deserialize, Serialize};

use crate::{RecordError, files};

/// BLAKE3 hash.
pub(crate) type Hash = [u8; blake3::OUT_LEN];

/// Length of a stream at a checkpoint, and the checksum of these bytes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(crate) struct Extent {
    pub(crate) length: u64,
    pub(crate) hash: Hash,
}

/// A stream being written.
pub(crate) struct Stream {
    file: File,
    hasher: blake3::Hasher,
}

impl Stream {
    pub(crate) fn create(path: &Path) -> io::Result<Self> {
        Ok(Self { file: File::create(path)?, hasher: blake3::Hasher::new() })
    }

    /// Opens a stream that [`verified`] has read, to append after the bytes read.
    pub(crate) fn reopen(path: &Path, hasher: blake3::Hasher) -> io::Result<Self> {
        let mut file = OpenOptions::new().write(true).open(path)?;
        file.set_len(hasher.count())?;
        file.seek(SeekFrom::End(0))?;
        Ok(Self { file, hasher })
    }

    /// Flushes the file to the disk.
    pub(crate) fn sync(&self) -> io::Result<()> {
        files::flush(&self.file)
    }

    /// Length and checksum of the bytes written so far.
    pub(crate) fn extent(&self) -> Extent {
        Extent { length: self.hasher.count(), hash: self.hasher.finalize().into() }
    }
}

impl Write for Stream {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let written = self.file.write(bytes)?;
        self.hasher.update(&bytes[..written]);
        Ok(written)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.file.flush()
    }
}

/// The running checksum of the first bytes of a file, if they are those of the checkpoint of a
/// step. What was written after it may be incomplete and is not read.
pub(crate) fn verified(path: &Path, extent: &Extent, step: u64) -> Result<blake3::Hasher, RecordError> {
    let file = File::open(path).map_err(|error| unreadable(path, error))?;
    let mut reader = BufReader::with_capacity(1 << 16, file.take(extent.length));
    let mut hasher = blake3::Hasher::new();
    loop {
        let bytes = reader.fill_buf().map_err(RecordError::io("read", path))?;
        if bytes.is_empty() {
            break;
        }
        hasher.update(bytes);
        let read = bytes.len();
        reader.consume(read);
    }
    if hasher.count() < extent.length {
        let got = hasher.count();
        let had = extent.length;
        return Err(altered(path, format!("it has {got} bytes, but had {had} bytes at step {step}")));
    }
    if hasher.finalize() != extent.hash {
        let what = format!("its first {} bytes have changed since step {step}", extent.length);
        return Err(altered(path, what));
    }
    Ok(hasher)
}

/// The error of a file that the checkpoints describe differently.
pub(crate) fn altered(path: &Path, what: impl Into<String>) -> RecordError {
    RecordError::corrupt(path, None, what, "restore it from a copy, or run the case again")
}

/// The error of a file that must be there.
pub(crate) fn unreadable(path: &Path, error: io::Error) -> RecordError {
    match error.kind() {
        io::ErrorKind::NotFound => altered(path, "it is missing"),
        _ => RecordError::io("read", path)(error),
    }
}
