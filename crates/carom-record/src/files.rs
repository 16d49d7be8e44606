//! Atomic replacement of files: write a temporary file, rename it, and flush it to the disk where
//! it must survive a power failure.

use std::cell::Cell;
use std::fs::{self, File};
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use crate::RecordError;

/// Replaces `path` by the concatenated parts. After a crash the file is either the old or the new
/// one.
pub(crate) fn write_atomically(path: &Path, parts: &[&[u8]]) -> Result<(), RecordError> {
    rename_after(path, parts, flush)?;
    sync_directory(path.parent().unwrap_or(Path::new(".")))
}

/// Replaces `path` without flushing it to the disk. A killed process leaves the old or the new
/// file; until [`sync`] is called, a power failure may leave an empty one.
pub(crate) fn write_unsynced(path: &Path, parts: &[&[u8]]) -> Result<(), RecordError> {
    rename_after(path, parts, |_| Ok(()))
}

/// Flushes an open file to the disk. Every flush of this crate passes through here.
pub(crate) fn flush(file: &File) -> io::Result<()> {
    FLUSHES.with(|count| count.set(count.get() + 1));
    file.sync_all()
}

thread_local! {
    static FLUSHES: Cell<usize> = const { Cell::new(0) };
}

/// How often this thread has flushed a file to the disk.
pub fn flushes() -> usize {
    FLUSHES.get()
}

/// Flushes a file written earlier to the disk.
pub(crate) fn sync(path: &Path) -> Result<(), RecordError> {
    File::options()
        .write(true)
        .open(path)
        .and_then(|file| flush(&file))
        .map_err(RecordError::io("write", path))
}

/// Whether a new run may be written here: nothing is there, or an empty directory.
pub fn is_free(directory: &Path) -> bool {
    directory.symlink_metadata().is_err()
        || fs::read_dir(directory).is_ok_and(|mut entries| entries.next().is_none())
}

fn rename_after(
    path: &Path,
    parts: &[&[u8]],
    finish: impl FnOnce(&File) -> io::Result<()>,
) -> Result<(), RecordError> {
    let partial = partial(path);
    let mut file = File::create(&partial).map_err(RecordError::io("create", &partial))?;
    let written = parts.iter().try_for_each(|part| file.write_all(part)).and_then(|()| finish(&file));
    written.map_err(RecordError::io("write", path))?;
    drop(file);
    fs::rename(&partial, path).map_err(RecordError::io("replace", path))
}

/// Temporary file for writing `path`. Its name is fixed, so that the next write overwrites what a
/// killed process left behind.
pub(crate) fn partial(path: &Path) -> PathBuf {
    let mut name = std::ffi::OsString::from(".");
    name.push(path.file_name().unwrap_or_default());
    name.push(".partial");
    path.with_file_name(name)
}

/// Makes renames in a directory survive a power failure; needed, and possible, on Unix only.
pub(crate) fn sync_directory(directory: &Path) -> Result<(), RecordError> {
    // The parent of a bare name is the empty path.
    let directory = if directory.as_os_str().is_empty() { Path::new(".") } else { directory };
    if cfg!(unix) {
        File::open(directory).and_then(|d| flush(&d)).map_err(RecordError::io("write", directory))?;
    }
    Ok(())
}
