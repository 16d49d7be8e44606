//! `fields.pvd`: the list of the field files of a run with their times, for ParaView.

use std::fmt::Write as _;
use std::path::Path;

use quick_xml::events::Event;
use serde::{Deserialize, Serialize};

use crate::decimal::decimal;
use crate::{RecordError, files};

/// An instant with recorded fields.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct FieldEntry {
    /// Number of the step.
    pub step: u64,
    /// Time of that step.
    pub time: f64,
}

impl FieldEntry {
    /// Path of its VTU file relative to the run directory, with `/`.
    pub fn file(&self) -> String {
        format!("fields/{:08}.vtu", self.step)
    }
}

/// Name of the list.
pub(crate) const FILE: &str = "fields.pvd";

/// Replaces `fields.pvd`, without flushing it to the disk.
pub(crate) fn write(directory: &Path, entries: &[FieldEntry]) -> Result<(), RecordError> {
    let mut text = String::from(
        "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\" byte_order=\"LittleEndian\">\n <Collection>\n",
    );
    for entry in entries {
        let time = decimal(entry.time);
        let _ = writeln!(text, "  <DataSet timestep=\"{time:?}\" part=\"0\" file=\"{}\"/>", entry.file());
    }
    text.push_str(" </Collection>\n</VTKFile>\n");
    files::write_unsynced(&directory.join(FILE), &[text.as_bytes()])
}

/// Reads `fields.pvd`; a run without field files has none.
pub(crate) fn read(directory: &Path) -> Result<Vec<FieldEntry>, RecordError> {
    let path = directory.join(FILE);
    let text = match std::fs::read_to_string(&path) {
        Ok(text) => text,
        Err(error) if error.kind() == std::io::ErrorKind::NotFound => return Ok(Vec::new()),
        Err(error) => return Err(RecordError::io("read", &path)(error)),
    };
    let mut reader = quick_xml::Reader::from_str(&text);
    let mut entries = Vec::new();
    loop {
        let at = reader.buffer_position() as usize;
        let damaged = |what: String| {
            let line = 1 + text[..at].matches('\n').count() as u64;
            RecordError::corrupt(&path, Some(line), what, "run `carom resume` or run the case again")
        };
        match reader.read_event().map_err(|e| damaged(e.to_string()))? {
            Event::Eof => return Ok(entries),
            Event::Empty(tag) if tag.name().as_ref() == "DataSet" => {
                let attribute = |name| Some(tag.try_get_attribute(name).ok()??.value);
                let time = attribute("timestep").and_then(|t| t.parse().ok());
                let step = attribute("file")
                    .and_then(|f| f.strip_prefix("fields/")?.strip_suffix(".vtu")?.parse().ok());
                let (Some(time), Some(step)) = (time, step) else {
                    return Err(damaged("a DataSet has no valid time or file name".into()));
                };
                entries.push(FieldEntry { step, time });
            }
            _ => {}
        }
    }
}
