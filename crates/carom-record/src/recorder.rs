//! Where a run is recorded while it is computed: in its directory, or in memory.

use std::path::{Path, PathBuf};

use crate::{ContactRow, Event, FieldEntry, FieldSet, History, Manifest, RecordError, Run, RunWriter, Stop};

/// The record of a run being computed.
pub trait Recorder: Send {
    /// Appends a row of the history, one value per column of the manifest.
    ///
    /// # Errors
    /// A row of another width, or an input/output error; so are all errors of a recorder.
    fn history(&mut self, row: &[f64]) -> Result<(), RecordError>;
    /// Appends the states of active contact nodes.
    fn contact(&mut self, rows: &[ContactRow]) -> Result<(), RecordError>;
    /// Appends an event.
    fn log(&mut self, event: &Event) -> Result<(), RecordError>;
    /// Records the fields of a step.
    fn fields(&mut self, step: u64, time: f64, fields: FieldSet) -> Result<(), RecordError>;
    /// Whether a run can be resumed from its checkpoints.
    fn resumable(&self) -> bool;
    /// Replaces the older checkpoint.
    fn checkpoint(&mut self, step: u64, payload: &[u8]) -> Result<(), RecordError>;
    /// Replaces the manifest.
    fn manifest(&mut self, manifest: &Manifest) -> Result<(), RecordError>;
    /// Records why the run stopped; the manifest may take hashes of what is written.
    fn stop(&mut self, stop: &Stop, fields: &FieldSet, manifest: &mut Manifest) -> Result<(), RecordError>;
    /// The record so far.
    fn read(&self) -> Result<Run, RecordError>;
    /// Makes the record durable; last the manifest, which says how the run ended and may take
    /// hashes of what was written.
    fn finish(&mut self, manifest: &mut Manifest) -> Result<(), RecordError>;
    /// The directory; empty for a record in memory.
    fn directory(&self) -> &Path;
}

impl Recorder for RunWriter {
    fn history(&mut self, row: &[f64]) -> Result<(), RecordError> {
        self.history(row)
    }

    fn contact(&mut self, rows: &[ContactRow]) -> Result<(), RecordError> {
        self.contact(rows)
    }

    fn log(&mut self, event: &Event) -> Result<(), RecordError> {
        self.log(event)
    }

    fn fields(&mut self, step: u64, time: f64, fields: FieldSet) -> Result<(), RecordError> {
        self.fields(step, time, &fields)
    }

    fn resumable(&self) -> bool {
        true
    }

    fn checkpoint(&mut self, step: u64, payload: &[u8]) -> Result<(), RecordError> {
        self.checkpoint(step, payload)
    }

    fn manifest(&mut self, manifest: &Manifest) -> Result<(), RecordError> {
        self.manifest(manifest)
    }

    fn stop(&mut self, stop: &Stop, fields: &FieldSet, manifest: &mut Manifest) -> Result<(), RecordError> {
        stop.write(self.directory(), fields, manifest)
    }

    fn read(&self) -> Result<Run, RecordError> {
        Run::open(self.directory())
    }

    fn finish(&mut self, manifest: &mut Manifest) -> Result<(), RecordError> {
        self.finish(manifest)
    }

    fn directory(&self) -> &Path {
        self.directory()
    }
}

/// A record in memory. It has no checkpoints.
#[derive(Clone, Debug)]
pub struct MemoryRecord {
    /// The run, as [`Run::open`] would read it from a directory; its path is empty.
    pub run: Run,
    /// The fields of the instants `run.fields`, in their order.
    pub fields: Vec<FieldSet>,
}

impl MemoryRecord {
    /// An empty record.
    pub fn new(manifest: Manifest) -> Self {
        let columns = manifest.columns.clone();
        let values = vec![Vec::new(); columns.len()];
        let run = Run {
            directory: PathBuf::new(),
            history: History::new(columns, values),
            contact: Vec::new(),
            log: Vec::new(),
            stop: None,
            fields: Vec::new(),
            manifest,
        };
        Self { run, fields: Vec::new() }
    }
}

impl Recorder for MemoryRecord {
    fn history(&mut self, row: &[f64]) -> Result<(), RecordError> {
        let columns = &mut self.run.history.values;
        if row.len() != columns.len() {
            return Err(RecordError::Width { got: row.len(), expected: columns.len() });
        }
        columns.iter_mut().zip(row).for_each(|(column, value)| column.push(*value));
        Ok(())
    }

    fn contact(&mut self, rows: &[ContactRow]) -> Result<(), RecordError> {
        self.run.contact.extend(rows.iter().map(|row| {
            let [contact, friction] =
                [&row.contact, &row.friction].map(|text| text.clone().into_owned().into());
            ContactRow { contact, friction, ..row.clone() }
        }));
        Ok(())
    }

    fn log(&mut self, event: &Event) -> Result<(), RecordError> {
        self.run.log.push(event.clone());
        Ok(())
    }

    fn fields(&mut self, step: u64, time: f64, fields: FieldSet) -> Result<(), RecordError> {
        self.run.fields.push(FieldEntry { step, time });
        self.fields.push(fields);
        Ok(())
    }

    fn resumable(&self) -> bool {
        false
    }

    fn checkpoint(&mut self, _: u64, _: &[u8]) -> Result<(), RecordError> {
        Ok(())
    }

    fn manifest(&mut self, manifest: &Manifest) -> Result<(), RecordError> {
        self.run.manifest = manifest.clone();
        Ok(())
    }

    fn stop(&mut self, stop: &Stop, _: &FieldSet, _: &mut Manifest) -> Result<(), RecordError> {
        self.run.stop = Some(stop.clone());
        Ok(())
    }

    fn read(&self) -> Result<Run, RecordError> {
        Ok(self.run.clone())
    }

    fn finish(&mut self, manifest: &mut Manifest) -> Result<(), RecordError> {
        self.manifest(manifest)
    }

    fn directory(&self) -> &Path {
        &self.run.directory
    }
}
