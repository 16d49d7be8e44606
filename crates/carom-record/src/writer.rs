//! Writing a run directory, so that a run can be killed at any time and resumed to the same bytes.
//!
//! A directory is created by one rename, with a first checkpoint in it. A checkpoint flushes the
//! row files, and the field files written since the previous one, to the disk and then records
//! their lengths. Reopening truncates the row files to these lengths and removes later fields.
//! Between checkpoints nothing is flushed, because a resumed run does not need it.

use std::fs::{self, File, OpenOptions};
use std::io::{BufWriter, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

use crate::checkpoint::{self, Header};
use crate::rows::{Table, contact_axes, contact_columns};
use crate::{
    ContactRow, Event, FieldEntry, FieldFormat, FieldSet, Manifest, RecordError, files, pvd, vtkhdf,
};

const ROW_FILES: [&str; 3] = ["history.csv", "contact.csv", "log.jsonl"];

/// A run directory being written. If it is dropped without `finish`, the run can be reopened.
pub struct RunWriter {
    directory: PathBuf,
    /// Which history columns are integers.
    integer: Vec<bool>,
    /// Axes of the positions and normals of contact rows.
    axes: usize,
    history: Table,
    contact: Table,
    log: BufWriter<File>,
    /// Header of the next checkpoint; its lengths are those of the last one.
    header: Header,
    /// Generation that the next checkpoint replaces.
    generation: usize,
    /// Format of the fields.
    field_format: FieldFormat,
    /// Field files written since the last checkpoint.
    unsynced: Vec<PathBuf>,
    /// Locked as long as this writer exists.
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
    /// Its step.
    pub step: u64,
    /// Number of rows in the history; 0 if not even the initial state was recorded.
    pub rows: u64,
    /// The error of the newest checkpoint, if it is damaged and the previous one was used.
    pub fallback: Option<RecordError>,
}

impl RunWriter {
    /// Creates the directory with a first checkpoint, and its parents. It is an error if the
    /// directory exists.
    pub fn create(
        directory: &Path,
        manifest: &Manifest,
        first_checkpoint: &[u8],
    ) -> Result<Self, RecordError> {
        if directory.symlink_metadata().is_ok() {
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
        Ok(Self::reopen(directory)?.writer)
    }

    fn build(partial: &Path, manifest: &Manifest, payload: &[u8]) -> Result<(), RecordError> {
        let checkpoints = partial.join("checkpoint");
        fs::create_dir_all(&checkpoints).map_err(RecordError::io("create", &checkpoints))?;
        manifest.write(partial)?;
        let mut header = Header { payload: payload.len() as u64, ..Header::default() };
        let columns: Vec<&str> = manifest.columns.iter().map(|c| c.name.as_str()).collect();
        let of_contact = contact_columns(contact_axes(&manifest.case));
        for (i, names) in [&columns[..], &of_contact, &[]].into_iter().enumerate() {
            let path = partial.join(ROW_FILES[i]);
            let failed = |e| RecordError::io("create", &path)(e);
            let mut table = Table::new(File::create(&path).map_err(failed)?);
            for name in names {
                table.text(name).map_err(failed)?;
            }
            if !names.is_empty() {
                table.end_row().map_err(failed)?;
            }
            table.flush().and_then(|()| table.file().sync_all()).map_err(failed)?;
            header.lengths[i] = table.file().metadata().map_err(failed)?.len();
        }
        checkpoint::write(partial, 0, &header, payload)
    }

    /// Reopens the directory at the newest intact checkpoint.
    pub fn reopen(directory: &Path) -> Result<Reopened, RecordError> {
        let manifest = Manifest::read(directory)?;
        let lock = lock(directory)?;
        let (generation, (header, payload), fallback) = newest(directory)?;
        // A missing generation is normal: every run starts with one.
        let fallback = fallback.filter(|error| !missing(error));
        Ok(Reopened { fallback, ..Self::open(directory, manifest, lock, generation, header, payload)? })
    }

    /// Reopens the directory at the checkpoint of one generation, 0 or 1.
    pub fn reopen_at(directory: &Path, generation: usize) -> Result<Reopened, RecordError> {
        let manifest = Manifest::read(directory)?;
        let lock = lock(directory)?;
        let (header, payload) = verified(directory, generation)?;
        Self::open(directory, manifest, lock, generation, header, payload)
    }

    fn open(
        directory: &Path,
        manifest: Manifest,
        lock: File,
        generation: usize,
        header: Header,
        payload: Vec<u8>,
    ) -> Result<Reopened, RecordError> {
        let mut rows = Vec::new();
        for (name, length) in ROW_FILES.iter().zip(header.lengths) {
            let path = directory.join(name);
            let failed = |e| RecordError::io("write", &path)(e);
            let mut file = OpenOptions::new().read(true).write(true).open(&path).map_err(failed)?;
            file.set_len(length).and_then(|()| file.seek(SeekFrom::End(0))).map_err(failed)?;
            rows.push(file);
        }
        let [history, contact, log] = rows.try_into().unwrap_or_else(|_| unreachable!("three row files"));
        drop_fields(directory, &header.fields)?;
        vtkhdf::keep(directory, &header.fields)?;
        let writer = Self {
            directory: directory.to_path_buf(),
            integer: manifest.columns.iter().map(|c| c.integer).collect(),
            axes: contact_axes(&manifest.case),
            history: Table::new(history),
            contact: Table::new(contact),
            log: BufWriter::new(log),
            generation: 1 - generation % 2,
            header,
            field_format: FieldFormat::default(),
            unsynced: Vec::new(),
            _lock: lock,
        };
        let (step, rows) = (writer.header.step, writer.header.rows);
        Ok(Reopened { writer, manifest, payload, step, rows, fallback: None })
    }

    /// Sets the format of the fields; the default is VTU. A run has one format.
    pub fn field_format(&mut self, format: FieldFormat) {
        self.field_format = format;
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
        let table = &mut self.history;
        let written = row
            .iter()
            .zip(&self.integer)
            .try_for_each(|(&value, &integer)| {
                // A value that is not a count is written as it is, not rounded.
                if integer && value >= 0.0 && value.fract() == 0.0 {
                    table.integer(value as u64)
                } else {
                    table.number(value)
                }
            })
            .and_then(|()| table.end_row());
        self.header.rows += 1;
        written.map_err(RecordError::io("write", &self.directory.join(ROW_FILES[0])))
    }

    /// Appends a row of `contact.csv`.
    pub fn contact(&mut self, row: &ContactRow) -> Result<(), RecordError> {
        self.contact
            .contact(row, self.axes)
            .map_err(|e| RecordError::io("write", &self.directory.join(ROW_FILES[1]))(e))
    }

    /// Appends a line of `log.jsonl`.
    pub fn log(&mut self, event: &Event) -> Result<(), RecordError> {
        serde_json::to_writer(&mut self.log, event)
            .map_err(Into::into)
            .and_then(|()| self.log.write_all(b"\n"))
            .map_err(|e| RecordError::io("write", &self.directory.join(ROW_FILES[2]))(e))
    }

    /// Writes fields as VTU, or into the run's VTKHDF file.
    pub fn fields(&mut self, step: u64, time: f64, fields: &FieldSet) -> Result<(), RecordError> {
        let entry = FieldEntry { step, time };
        let entries = &mut self.header.fields;
        entries.retain(|e| e.step != step);
        entries.push(entry.clone());
        if self.field_format == FieldFormat::VtkHdf {
            self.unsynced = vec![vtkhdf::path(&self.directory)];
            return vtkhdf::put(&self.directory, entries.len() - 1, &entry, fields);
        }
        let folder = self.directory.join("fields");
        fs::create_dir_all(&folder).map_err(RecordError::io("create", &folder))?;
        let path = self.directory.join(entry.file());
        files::write_unsynced(&path, &fields.to_vtu(time)?)?;
        self.unsynced.push(path);
        pvd::write(&self.directory, entries)
    }

    /// Flushes everything to the disk, then replaces the older generation.
    pub fn checkpoint(&mut self, step: u64, payload: &[u8]) -> Result<(), RecordError> {
        self.sync()?;
        self.header.step = step;
        self.header.sequence += 1;
        self.header.payload = payload.len() as u64;
        checkpoint::write(&self.directory, self.generation, &self.header, payload)?;
        self.generation = 1 - self.generation;
        Ok(())
    }

    /// Replaces `manifest.json`.
    pub fn manifest(&mut self, manifest: &Manifest) -> Result<(), RecordError> {
        manifest.write(&self.directory)
    }

    /// Flushes everything to the disk; last the manifest, which says how the run ended.
    pub fn finish(mut self, manifest: &Manifest) -> Result<(), RecordError> {
        self.sync()?;
        vtkhdf::finish(&self.directory)?;
        manifest.write(&self.directory)
    }

    fn sync(&mut self) -> Result<(), RecordError> {
        if !self.unsynced.is_empty() {
            self.unsynced.drain(..).try_for_each(|path| files::sync(&path))?;
            if self.field_format == FieldFormat::Vtu {
                files::sync_directory(&self.directory.join("fields"))?;
                files::sync(&self.directory.join(pvd::FILE))?;
            }
            files::sync_directory(&self.directory)?;
        }
        let flushed = [self.history.flush(), self.contact.flush(), self.log.flush()];
        let files = [self.history.file(), self.contact.file(), self.log.get_ref()];
        for (i, (flushed, file)) in flushed.into_iter().zip(files).enumerate() {
            self.header.lengths[i] = flushed
                .and_then(|()| file.sync_all())
                .and_then(|()| file.metadata())
                .map_err(|e| RecordError::io("write", &self.directory.join(ROW_FILES[i]))(e))?
                .len();
        }
        Ok(())
    }
}

/// Payload of the newest intact checkpoint; nothing is changed.
///
/// # Errors
/// There is no intact checkpoint.
pub fn last_checkpoint(directory: &Path) -> Result<Vec<u8>, RecordError> {
    newest(directory).map(|(_, (_, payload), _)| payload)
}

/// The newest intact checkpoint: its generation, its contents, and the error of the other one.
fn newest(directory: &Path) -> Result<(usize, (Header, Vec<u8>), Option<RecordError>), RecordError> {
    let [a, b] = [0, 1].map(|generation| verified(directory, generation));
    Ok(match (a, b) {
        (Ok(a), Ok(b)) if a.0.sequence > b.0.sequence => (0, a, None),
        (Ok(_), Ok(b)) => (1, b, None),
        (Ok(a), Err(error)) => (0, a, Some(error)),
        (Err(error), Ok(b)) => (1, b, Some(error)),
        (Err(error), Err(other)) => return Err(if missing(&error) { other } else { error }),
    })
}

/// A checkpoint, if it is intact and the row files are at least as long as it records.
fn verified(directory: &Path, generation: usize) -> Result<(Header, Vec<u8>), RecordError> {
    let (header, payload) = checkpoint::read(directory, generation)?;
    for (name, length) in ROW_FILES.iter().zip(header.lengths) {
        let path = directory.join(name);
        let got = fs::metadata(&path).map_err(RecordError::io("read", &path))?.len();
        if got < length {
            let what = format!("it has {got} bytes, but had {length} bytes at the checkpoint");
            return Err(RecordError::corrupt(&path, None, what, "run the case again"));
        }
    }
    Ok((header, payload))
}

fn missing(error: &RecordError) -> bool {
    matches!(error, RecordError::Io { source, .. } if source.kind() == std::io::ErrorKind::NotFound)
}

/// Prevents two processes from writing the same record. The system releases the lock when the
/// process ends, even if it is killed.
fn lock(directory: &Path) -> Result<File, RecordError> {
    let path = directory.join("checkpoint").join("lock");
    let file = File::create(&path).map_err(RecordError::io("open", &path))?;
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
