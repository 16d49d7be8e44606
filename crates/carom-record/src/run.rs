//! Reading a run directory: finished, stopped, or still being written (an incomplete last row or
//! line is ignored).

use std::collections::HashMap;
use std::path::{Path, PathBuf};

use crate::decimal::decimal;
use crate::rows::{ContactCell, ContactValue};
use crate::{
    Column, ContactColumns, ContactRow, Event, FieldEntry, FieldSet, Manifest, RecordError, Stop, pvd,
};

const HINT: &str = "resume from the last checkpoint with `carom resume`, or run the case again";

/// `history.csv` as columns.
#[derive(Clone, Debug, Default)]
pub struct History {
    /// Names and units, in order.
    pub columns: Vec<Column>,
    /// Values by column; all columns have the same length.
    pub values: Vec<Vec<f64>>,
    index: HashMap<String, usize>,
}

impl History {
    /// Creates a history from columns and their values.
    pub fn new(columns: Vec<Column>, values: Vec<Vec<f64>>) -> Self {
        let index = columns.iter().enumerate().map(|(i, c)| (c.name.clone(), i)).collect();
        Self { columns, values, index }
    }

    /// Values of a column.
    pub fn column(&self, name: &str) -> Option<&[f64]> {
        self.index.get(name).and_then(|&i| self.values.get(i)).map(Vec::as_slice)
    }

    /// Unit of a column; empty when it has none or does not exist.
    pub fn unit(&self, name: &str) -> &str {
        self.index.get(name).map_or("", |&i| &self.columns[i].unit)
    }

    /// Times of the rows.
    pub fn times(&self) -> &[f64] {
        self.column("time").unwrap_or_default()
    }
}

/// A run directory, read.
#[derive(Clone, Debug)]
pub struct Run {
    /// Path of the run directory.
    pub directory: PathBuf,
    /// The manifest of the run.
    pub manifest: Manifest,
    /// The history, with one row per recorded step.
    pub history: History,
    /// Contact rows: one per active contact node and recorded step.
    pub contact: Vec<ContactRow<'static>>,
    /// Events of the log.
    pub log: Vec<Event>,
    /// Why the run stopped, if it did.
    pub stop: Option<Stop>,
    /// Instants with recorded fields, in the order of time.
    pub fields: Vec<FieldEntry>,
}

impl Run {
    /// Reads everything but the field files.
    pub fn open(directory: &Path) -> Result<Self, RecordError> {
        let manifest = Manifest::read(directory)?;
        if directory.join("fields.vtkhdf").exists() {
            return Err(RecordError::OneFile { path: directory.join("fields.vtkhdf") });
        }
        let lines = |name: &str| Lines::read(directory, name, &manifest);
        let history = history(&lines("history.csv")?, &manifest.columns)?;
        let mut fields = pvd::read(directory)?;
        restore_times(&mut fields, &history);
        Ok(Self {
            directory: directory.to_path_buf(),
            history,
            contact: contact(&lines("contact.csv")?, manifest.facts.contact_columns())?,
            log: log(&lines("log.jsonl")?)?,
            stop: Stop::read(directory, &manifest)?,
            fields,
            manifest,
        })
    }

    /// Values of a history column.
    pub fn column(&self, name: &str) -> Option<&[f64]> {
        self.history.column(name)
    }

    /// Times of the history rows.
    pub fn times(&self) -> &[f64] {
        self.history.times()
    }

    /// Whether a contact was active in a dynamic run; false for static runs.
    pub fn had_dynamic_contact(&self) -> bool {
        !self.manifest.facts.is_static
            && self.column("active").is_some_and(|active| active.iter().any(|n| *n > 0.0))
    }

    /// Reads the fields of one instant.
    pub fn field(&self, entry: &FieldEntry) -> Result<FieldSet, RecordError> {
        let path = self.directory.join(entry.file());
        let bytes = std::fs::read(&path).map_err(RecordError::io("read", &path))?;
        FieldSet::from_vtu(&bytes).map_err(|what| RecordError::corrupt(&path, None, what, HINT))
    }
}

/// Gives instants with fields the time of the row of their step, which their files have as a
/// decimal.
fn restore_times(fields: &mut [FieldEntry], history: &History) {
    let steps = history.column("step").unwrap_or_default();
    for entry in fields {
        let row = steps.partition_point(|step| *step < entry.step as f64);
        if let Some(time) = history.times().get(row).filter(|time| decimal(**time) == entry.time) {
            entry.time = *time;
        }
    }
}

/// The complete lines of a file.
struct Lines {
    path: PathBuf,
    bytes: Vec<u8>,
}

impl Lines {
    fn read(directory: &Path, name: &str, manifest: &Manifest) -> Result<Self, RecordError> {
        let mut bytes = manifest.file(directory, name)?;
        let complete = bytes.iter().rposition(|&b| b == b'\n').map_or(0, |i| i + 1);
        bytes.truncate(complete);
        Ok(Self { path: directory.join(name), bytes })
    }
}

/// Reads a CSV file whose header must be `names`, and calls `each` for every row.
fn rows(
    Lines { path, bytes }: &Lines,
    names: &[&str],
    mut each: impl FnMut(&csv::StringRecord) -> Result<(), String>,
) -> Result<(), RecordError> {
    let mut reader = csv::Reader::from_reader(bytes.as_slice());
    let damaged = |line, what| Err(RecordError::corrupt(path, line, what, HINT));
    match reader.headers() {
        Ok(header) if header == names => {}
        Ok(_) => return damaged(Some(1), "the header differs from that of this version".to_string()),
        Err(error) => return damaged(Some(1), error.to_string()),
    }
    let mut record = csv::StringRecord::new();
    loop {
        match reader.read_record(&mut record) {
            Ok(false) => return Ok(()),
            Ok(true) => {
                if let Err(what) = each(&record) {
                    return damaged(record.position().map(csv::Position::line), what);
                }
            }
            Err(error) => return damaged(error.position().map(csv::Position::line), error.to_string()),
        }
    }
}

fn number<T: std::str::FromStr>(record: &csv::StringRecord, i: usize, name: &str) -> Result<T, String> {
    let text = record.get(i).unwrap_or_default();
    text.parse().map_err(|_| format!("`{text}` in column {name} is not a number"))
}

fn history(lines: &Lines, columns: &[Column]) -> Result<History, RecordError> {
    let names: Vec<&str> = columns.iter().map(|c| c.name.as_str()).collect();
    let mut values = vec![Vec::new(); columns.len()];
    rows(lines, &names, |record| {
        for (i, column) in values.iter_mut().enumerate() {
            column.push(number(record, i, names[i])?);
        }
        Ok(())
    })?;
    Ok(History::new(columns.to_vec(), values))
}

fn contact(lines: &Lines, columns: ContactColumns) -> Result<Vec<ContactRow<'static>>, RecordError> {
    let mut list = Vec::new();
    rows(lines, &ContactRow::columns(columns), |record| {
        let mut row = ContactRow::default();
        for (i, ContactCell { name, value, .. }) in row.cells(columns).into_iter().enumerate() {
            match value {
                ContactValue::Count(count) => *count = number(record, i, name)?,
                ContactValue::Real(real) => *real = number(record, i, name)?,
                ContactValue::Text(text) => *text = record[i].to_owned().into(),
            }
        }
        list.push(row);
        Ok(())
    })?;
    Ok(list)
}

fn log(Lines { path, bytes }: &Lines) -> Result<Vec<Event>, RecordError> {
    let event = |(i, line)| {
        serde_json::from_slice(line)
            .map_err(|error| RecordError::corrupt(path, Some(i as u64 + 1), error.to_string(), HINT))
    };
    bytes.split(|&b| b == b'\n').filter(|line| !line.is_empty()).enumerate().map(event).collect()
}
