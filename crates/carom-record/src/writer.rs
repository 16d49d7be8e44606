//! Writing a run directory, so that a run can be killed at any time and resumed to the same bytes.
//!
//! A directory is created by one rename, with a first checkpoint in it. A checkpoint records the
//! lengths and checksums of the row files and of the field files. Reopening compares these with the
//! files, truncates the row files to these lengths and removes later fields.
//!
//! Data that a process has written survive its death. Only a power failure needs files that were
//! flushed to the disk, and a flush costs more than a step: a checkpoint flushes what it describes
//! if the last flush is [`FLUSH_INTERVAL`] ago, and the generations written since then do not
//! replace the flushed one (`checkpoint.rs`). The fields of a finished run, which is not resumed,
//! are left to the system.

use std::fs::{self, File};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use crate::checkpoint::{self, Generation, Header};
use crate::intact::{Intact, ROW_FILES, missing, newest_first, no_checkpoint, verified};
use crate::rows::{Table, Value};
use crate::stream::Stream;
use crate::{
    ContactColumns, ContactRow, Event, FieldEntry, FieldSet, Manifest, RecordError, Status, files, pvd,
};

/// The least time between two flushes. Only checkpoints flush: a power failure costs what was
/// computed since the last one that did.
pub const FLUSH_INTERVAL: Duration = Duration::from_secs(5);

/// A run directory being written. If it is dropped without `finish`, the run can be reopened.
pub struct RunWriter {
    directory: PathBuf,
    /// Whether each column of the history is an integer.
    integer: Vec<bool>,
    /// Axes of the positions and normals of contact rows.
    columns: ContactColumns,
    /// The three row files, in the order of [`ROW_FILES`].
    rows: [Table; 3],
    /// Header of the next checkpoint; its streams are those of the last one.
    header: Header,
    /// Generation of the last checkpoint.
    newest: Generation,
    /// Field files written since the last flush.
    unsynced: Vec<PathBuf>,
    /// The last flush; none since the run was reopened.
    flushed: Option<Instant>,
    flush_interval: Duration,
    /// Lock file of the run directory, locked as long as this writer exists.
    _lock: File,
}

/// A run directory reopened at a checkpoint.
pub struct Reopened {
    /// Appends after the checkpoint.
    pub writer: RunWriter,
    /// The current manifest.
    pub manifest: Manifest,
    /// The checkpoint's payload.
    pub payload: Vec<u8>,
    /// Step at which the checkpoint was taken.
    pub step: u64,
    /// Number of rows in the history; 0 if not even the initial state was recorded.
    pub rows: u64,
    /// The error of the newest checkpoint, if it or the record up to it is damaged and the previous
    /// one was used.
    pub fallback: Option<RecordError>,
}

impl RunWriter {
    /// Creates the directory with a first checkpoint, and its parents. It is an error if the
    /// directory exists and is not empty.
    pub fn create(
        directory: &Path,
        manifest: &Manifest,
        first_checkpoint: &[u8],
    ) -> Result<Self, RecordError> {
        if !files::is_free(directory) {
            return Err(RecordError::Exists { path: directory.to_path_buf() });
        }
        let parent = directory.parent().unwrap_or(Path::new("."));
        fs::create_dir_all(parent).map_err(RecordError::io("create", parent))?;
        let mut name = std::ffi::OsString::from(".");
        name.push(directory.file_name().unwrap_or_default());
        name.push(format!(".partial-{}", std::process::id()));
        let partial = directory.with_file_name(name);
        // Left behind by an earlier process that was killed before the rename.
        if partial.exists() {
            fs::remove_dir_all(&partial).map_err(RecordError::io("clear", &partial))?;
        }
        let built = Self::build(&partial, manifest, first_checkpoint).and_then(|()| {
            fs::rename(&partial, directory).map_err(|error| match error.kind() {
                std::io::ErrorKind::DirectoryNotEmpty | std::io::ErrorKind::AlreadyExists => {
                    RecordError::Exists { path: directory.to_path_buf() }
                }
                _ => RecordError::io("create", directory)(error),
            })
        });
        if let Err(error) = built {
            let _ = fs::remove_dir_all(&partial);
            return Err(error);
        }
        files::sync_directory(parent)?;
        let mut writer = Self::reopen(directory)?.writer;
        writer.flushed = Some(Instant::now());
        Ok(writer)
    }

    fn build(partial: &Path, manifest: &Manifest, payload: &[u8]) -> Result<(), RecordError> {
        let checkpoints = partial.join("checkpoint");
        fs::create_dir_all(&checkpoints).map_err(RecordError::io("create", &checkpoints))?;
        manifest.write(partial)?;
        let mut header = Header { payload: payload.len() as u64, ..Header::default() };
        let columns: Vec<&str> = manifest.columns.iter().map(|c| c.name.as_str()).collect();
        let of_contact = ContactRow::columns(manifest.facts.contact_columns());
        for (i, names) in [&columns[..], &of_contact, &[]].into_iter().enumerate() {
            let path = partial.join(ROW_FILES[i]);
            let stream = Stream::create(&path).map_err(RecordError::io("create", &path))?;
            let mut table = Table::new(path, stream);
            if !names.is_empty() {
                table.row(names.iter().map(|name| Value::Text(name)))?;
            }
            header.streams[i] = table.flush()?;
            table.sync()?;
        }
        checkpoint::write(partial, Generation::A, &header, payload, true)
    }

    /// Reopens the directory at the newest intact checkpoint.
    pub fn reopen(directory: &Path) -> Result<Reopened, RecordError> {
        let manifest = Manifest::read(directory)?;
        let lock = lock(directory)?;
        let mut fallback = None;
        for (generation, found) in newest_first(directory) {
            match found.and_then(|checkpoint| verified(directory, checkpoint)) {
                Ok(intact) => {
                    let reopened = Self::open(directory, manifest, lock, generation, intact)?;
                    return Ok(Reopened { fallback, ..reopened });
                }
                // A missing generation is normal: every run starts with one.
                Err(error) if fallback.is_none() && !missing(&error) => fallback = Some(error),
                Err(_) => {}
            }
        }
        Err(fallback.unwrap_or_else(|| no_checkpoint(directory)))
    }

    fn open(
        directory: &Path,
        manifest: Manifest,
        lock: File,
        generation: Generation,
        Intact { header, payload, hashers }: Intact,
    ) -> Result<Reopened, RecordError> {
        let mut rows = Vec::new();
        for (name, hasher) in ROW_FILES.iter().zip(hashers) {
            let path = directory.join(name);
            let stream = Stream::reopen(&path, hasher).map_err(RecordError::io("write", &path))?;
            rows.push(Table::new(path, stream));
        }
        drop_fields(directory, &header.fields)?;
        let writer = Self {
            directory: directory.to_path_buf(),
            integer: manifest.columns.iter().map(|c| c.integer).collect(),
            columns: manifest.facts.contact_columns(),
            rows: rows.try_into().unwrap_or_else(|_| unreachable!("three row files")),
            newest: generation,
            // The killed process may not have flushed what the checkpoint describes.
            unsynced: header.fields.iter().map(|e| directory.join(e.file())).collect(),
            header,
            flushed: None,
            flush_interval: FLUSH_INTERVAL,
            _lock: lock,
        };
        let step = writer.header.step;
        let rows = writer.header.rows;
        Ok(Reopened { writer, manifest, payload, step, rows, fallback: None })
    }

    /// Sets the least time between two flushes to the disk; the default is [`FLUSH_INTERVAL`].
    pub fn flush_interval(&mut self, interval: Duration) {
        self.flush_interval = interval;
    }

    /// The directory.
    pub fn directory(&self) -> &Path {
        &self.directory
    }

    /// Appends a row of `history.csv`, one value per column of the manifest.
    pub fn history(&mut self, row: &[f64]) -> Result<(), RecordError> {
        if row.len() != self.integer.len() {
            return Err(RecordError::Width { got: row.len(), expected: self.integer.len() });
        }
        let value = |(&value, &integer): (&f64, &bool)| {
            // A value that is not a count is written as it is, not rounded.
            if integer && value >= 0.0 && value.fract() == 0.0 {
                Value::Count(value as u64)
            } else {
                Value::Real(value)
            }
        };
        self.header.rows += 1;
        self.rows[0].row(row.iter().zip(&self.integer).map(value))
    }

    /// Appends rows of `contact.csv`; on a thread of a pool, all its threads format them.
    pub fn contact(&mut self, rows: &[ContactRow]) -> Result<(), RecordError> {
        self.rows[1].contact(rows, self.columns)
    }

    /// Appends a line of `log.jsonl`.
    pub fn log(&mut self, event: &Event) -> Result<(), RecordError> {
        let path = self.directory.join(ROW_FILES[2]);
        let line =
            serde_json::to_string(event).map_err(|error| RecordError::io("write", &path)(error.into()))?;
        self.rows[2].row([Value::Text(&line)])
    }

    /// Writes fields as VTU, and lists them in `fields.pvd`.
    pub fn fields(&mut self, step: u64, time: f64, fields: &FieldSet) -> Result<(), RecordError> {
        let entry = FieldEntry { step, time };
        let Header { fields: entries, field_hashes: hashes, .. } = &mut self.header;
        if let Some(same) = entries.iter().position(|e| e.step == step) {
            entries.remove(same);
            hashes.remove(same);
        }
        let folder = self.directory.join("fields");
        fs::create_dir_all(&folder).map_err(RecordError::io("create", &folder))?;
        let path = self.directory.join(entry.file());
        let bytes = fields.to_vtu(time)?;
        files::write_unsynced(&path, &[&bytes])?;
        self.unsynced.push(path);
        hashes.push(blake3::hash(&bytes).into());
        entries.push(entry);
        pvd::write(&self.directory, entries)
    }

    /// Replaces the older generation; flushes it, and before it all that it describes, to the disk
    /// if the last flush is long ago.
    pub fn checkpoint(&mut self, step: u64, payload: &[u8]) -> Result<(), RecordError> {
        let flush = self.flushed.is_none_or(|at| at.elapsed() >= self.flush_interval);
        self.write_rows()?;
        if flush {
            self.sync_fields()?;
            self.rows.iter().try_for_each(Table::sync)?;
            self.flushed = Some(Instant::now());
        }
        self.header.step = step;
        self.header.sequence += 1;
        self.header.payload = payload.len() as u64;
        self.newest = self.newest.next();
        checkpoint::write(&self.directory, self.newest, &self.header, payload, flush)?;
        Ok(())
    }

    /// Replaces `manifest.json`.
    pub fn manifest(&mut self, manifest: &Manifest) -> Result<(), RecordError> {
        manifest.write(&self.directory)
    }

    /// Flushes to the disk tables, log, the last checkpoint and, if the run may be resumed, its
    /// fields; last the manifest, which says how the run ended, and takes the hashes of the tables
    /// and the log.
    pub fn finish(&mut self, manifest: &mut Manifest) -> Result<(), RecordError> {
        self.write_rows()?;
        if manifest.status != Status::Finished {
            self.sync_fields()?;
        }
        self.rows.iter().try_for_each(Table::sync)?;
        checkpoint::sync(&self.directory, self.newest)?;
        if self.newest != Generation::Flushed {
            checkpoint::forget_flushed(&self.directory)?;
        }
        for (name, extent) in ROW_FILES.into_iter().zip(&self.header.streams) {
            manifest.hashes.insert(name.into(), blake3::Hash::from(extent.hash).to_hex().to_string());
        }
        manifest.write(&self.directory)
    }

    /// Hands all rows to the system, and notes their lengths and checksums.
    fn write_rows(&mut self) -> Result<(), RecordError> {
        for (table, extent) in self.rows.iter_mut().zip(&mut self.header.streams) {
            *extent = table.flush()?;
        }
        Ok(())
    }

    fn sync_fields(&mut self) -> Result<(), RecordError> {
        if !self.unsynced.is_empty() {
            self.unsynced.drain(..).try_for_each(|path| files::sync(&path))?;
            files::sync_directory(&self.directory.join("fields"))?;
            files::sync(&self.directory.join(pvd::FILE))?;
            files::sync_directory(&self.directory)?;
        }
        Ok(())
    }
}

/// Prevents two processes from writing the same record. The system releases the lock when the
/// process ends, even if it is killed.
fn lock(directory: &Path) -> Result<File, RecordError> {
    let path = directory.join("checkpoint").join("lock");
    let file = File::create(&path).map_err(|error| match error.kind() {
        std::io::ErrorKind::NotFound => no_checkpoint(directory),
        _ => RecordError::io("open", &path)(error),
    })?;
    match file.try_lock() {
        Err(fs::TryLockError::WouldBlock) => Err(RecordError::Busy { path: directory.to_path_buf() }),
        // File systems without locks are allowed.
        Ok(()) | Err(fs::TryLockError::Error(_)) => Ok(file),
    }
}

/// Removes field files that are not in the list, and writes the list to `fields.pvd`.
fn drop_fields(directory: &Path, keep: &[FieldEntry]) -> Result<(), RecordError> {
    let folder = directory.join("fields");
    let Ok(entries) = fs::read_dir(&folder) else { return Ok(()) };
    let keep_names: Vec<PathBuf> = keep.iter().map(|e| directory.join(e.file())).collect();
    for entry in entries {
        let path = entry.map_err(RecordError::io("read", &folder))?.path();
        if !keep_names.contains(&path) {
            fs::remove_file(&path).map_err(RecordError::io("remove", &path))?;
        }
    }
    pvd::write(directory, keep)?;
    files::sync(&directory.join(pvd::FILE))
}
