//! Rows of `history.csv` and `contact.csv` and lines of `log.jsonl`.
//!
//! Numbers are written as the shortest decimals that read back to the same bits, with an exponent
//! if very small or large.

use std::borrow::Cow;
use std::fmt::Write as _;
use std::io::{self, BufWriter, Write as _};
use std::path::PathBuf;

use rayon::prelude::*;
use serde::{Deserialize, Serialize};

use crate::RecordError;
use crate::stream::{Extent, Stream};
use crate::units::Unit;

/// State of one active contact node at the end of a step.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ContactRow<'a> {
    /// Step number.
    pub step: u64,
    /// Time at the end of the step.
    pub time: f64,
    /// Name of the contact.
    pub contact: Cow<'a, str>,
    /// Node of the secondary side, or one of the primary side that is paired with a facet of the
    /// secondary one.
    pub node: u64,
    /// Current position of the node.
    pub point: [f64; 3],
    /// Facet of the other side that the node is paired with.
    pub facet: u64,
    /// Coordinate of the closest point on that facet, −1 … 1; on a triangle 0 … 1.
    pub xi: f64,
    /// Second coordinate of the closest point on the facet, in space.
    pub eta: f64,
    /// Gap, negative for penetration.
    pub gap: f64,
    /// Normal force, negative for compression.
    pub multiplier: f64,
    /// Force per area of the deformed surface at the node.
    pub pressure: f64,
    /// Outward unit normal of the primary: the force on the secondary side is −multiplier · normal.
    pub normal: [f64; 3],
    /// `stick` or `slip`; `none` without friction.
    pub friction: Cow<'a, str>,
    /// Tangential traction: the force on the secondary side is −traction · J normal, with J a
    /// quarter turn counter-clockwise. In space the length of `rubbing`.
    pub traction: f64,
    /// Slip since the node came into contact, in the direction of the traction; in space its
    /// length.
    pub slip: f64,
    /// Force of friction on the secondary side, in space.
    pub rubbing: [f64; 3],
    /// Force per area of the reference surface at the node, of a mortar contact.
    pub nominal: f64,
    /// Point at which the resultant of the pressure acts for which the row stands, of a mortar
    /// contact.
    pub center: [f64; 2],
}

/// Which columns `contact.csv` has.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactColumns {
    /// Number of axes of positions: 3 in dimension 3, otherwise 2.
    pub axes: usize,
    /// Whether a contact is a mortar: the columns of a pressure field follow.
    pub has_field: bool,
}

/// A value of a row, to be read or written.
#[derive(Debug)]
#[allow(missing_docs)]
pub enum ContactValue<'r, 'a> {
    Count(&'r mut u64),
    Real(&'r mut f64),
    Text(&'r mut Cow<'a, str>),
}

/// A column of `contact.csv`, and its value in a row.
#[derive(Debug)]
pub struct ContactCell<'r, 'a> {
    /// Header in the file.
    pub name: &'static str,
    /// Unit.
    pub unit: Unit,
    /// Meaning.
    pub meaning: &'static str,
    /// The value.
    pub value: ContactValue<'r, 'a>,
}

/// Cells of the components of a vector.
fn vector<'r, 'a: 'r>(
    names: [&'static str; 3],
    unit: Unit,
    meaning: &'static str,
    values: &'r mut [f64],
) -> impl Iterator<Item = ContactCell<'r, 'a>> {
    let values = names.into_iter().zip(values);
    values.map(move |(name, value)| ContactCell { name, unit, meaning, value: ContactValue::Real(value) })
}

impl<'a> ContactRow<'a> {
    /// The cells of the row in the order of the file.
    pub fn cells(&mut self, columns: ContactColumns) -> Vec<ContactCell<'_, 'a>> {
        use ContactValue::{Count, Real, Text};
        let ContactColumns { axes, has_field } = columns;
        let cell = |name, unit, meaning, value| ContactCell { name, unit, meaning, value };
        let mut cells = vec![
            cell("step", Unit::None, "step of the row in history.csv", Count(&mut self.step)),
            cell("time", Unit::Time, "time of the row in history.csv", Real(&mut self.time)),
            cell("contact", Unit::None, "name of the contact", Text(&mut self.contact)),
            cell("node", Unit::None, "number of the node in the field files", Count(&mut self.node)),
        ];
        let meaning = "current position of the node";
        cells.extend(vector(["x", "y", "z"], Unit::Length, meaning, &mut self.point).take(axes));
        let meaning = "facet of the other side with which the node is paired";
        cells.push(cell("facet", Unit::None, meaning, Count(&mut self.facet)));
        let meaning = "coordinate of the closest point on the facet, −1 to 1; on a triangle 0 to 1";
        cells.push(cell("xi", Unit::None, meaning, Real(&mut self.xi)));
        if axes == 3 {
            let meaning = "second coordinate of the closest point on the facet";
            cells.push(cell("eta", Unit::None, meaning, Real(&mut self.eta)));
        }
        cells.push(cell("gap", Unit::Length, "gap, negative if penetrating", Real(&mut self.gap)));
        let meaning = "normal force λ ≤ 0";
        cells.push(cell("multiplier", Unit::Force, meaning, Real(&mut self.multiplier)));
        let meaning = "contact pressure at the node, per deformed area; in plane stress the thickness is the undeformed one";
        cells.push(cell("pressure", Unit::Stress, meaning, Real(&mut self.pressure)));
        let meaning =
            "unit normal out of the primary; the force on the secondary side is −multiplier × normal";
        let names = ["normal_x", "normal_y", "normal_z"];
        cells.extend(vector(names, Unit::None, meaning, &mut self.normal).take(axes));
        let meaning = "stick or slip; none without friction";
        cells.push(cell("friction", Unit::None, meaning, Text(&mut self.friction)));
        let meaning = "force of friction on the secondary side, against the normal turned left by 90°; in space its length";
        cells.push(cell("traction", Unit::Force, meaning, Real(&mut self.traction)));
        let meaning = "slip since the node came into contact; in space its length";
        cells.push(cell("slip", Unit::Length, meaning, Real(&mut self.slip)));
        if axes == 3 {
            let meaning = "force of friction on the secondary side";
            let names = ["friction_x", "friction_y", "friction_z"];
            cells.extend(vector(names, Unit::Force, meaning, &mut self.rubbing));
        }
        if has_field {
            let meaning = "pressure of a mortar contact at the node, per reference area";
            cells.push(cell("nominal_pressure", Unit::Stress, meaning, Real(&mut self.nominal)));
            let meaning = "point at which the force of the row acts, of a mortar contact";
            let names = ["center_x", "center_y", ""];
            cells.extend(vector(names, Unit::Length, meaning, &mut self.center));
        }
        cells
    }

    /// Header of `contact.csv`.
    pub fn columns(columns: ContactColumns) -> Vec<&'static str> {
        ContactRow::default().cells(columns).iter().map(|cell| cell.name).collect()
    }
}

/// An event of a run.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Event {
    /// Step being computed.
    pub step: u64,
    /// Time at the start of that step.
    pub time: f64,
    /// Kind: `rejected`, `active-set`, `cycle`, `fallback`, …
    pub kind: String,
    /// Description of the event, in one sentence.
    pub message: String,
    /// Names and numbers for programs.
    #[serde(flatten)]
    pub data: serde_json::Map<String, serde_json::Value>,
}

impl Event {
    /// An event without data.
    pub fn new(step: u64, time: f64, kind: &str, message: impl Into<String>) -> Self {
        Self { step, time, kind: kind.into(), message: message.into(), data: serde_json::Map::new() }
    }

    /// Adds a named datum; a number that is not finite becomes null.
    #[must_use]
    pub fn with(mut self, key: &str, value: impl Into<serde_json::Value>) -> Self {
        self.data.insert(key.into(), value.into());
        self
    }
}

/// A value of a cell.
pub(crate) enum Value<'a> {
    Count(u64),
    Real(f64),
    Text(&'a str),
}

/// A file of rows being written.
pub(crate) struct Table {
    path: PathBuf,
    quotes: csv::QuoteStyle,
    stream: BufWriter<Stream>,
}

/// Rows of `contact.csv` that are formatted at once.
const SHARE: usize = 64;

impl Table {
    pub(crate) fn new(path: PathBuf, stream: Stream) -> Self {
        // A line of the log is one cell as it is.
        let is_log = path.extension().is_some_and(|extension| extension == "jsonl");
        let quotes = if is_log { csv::QuoteStyle::Never } else { csv::QuoteStyle::Necessary };
        Self { path, quotes, stream: BufWriter::new(stream) }
    }

    pub(crate) fn row<'a>(&mut self, cells: impl IntoIterator<Item = Value<'a>>) -> Result<(), RecordError> {
        let mut lines = Lines::new(self.quotes);
        let line = lines.add(cells).and_then(|()| lines.text());
        self.append(line)
    }

    /// Appends rows of `contact.csv`; on a thread of a pool, all its threads format them.
    pub(crate) fn contact(
        &mut self,
        rows: &[ContactRow],
        columns: ContactColumns,
    ) -> Result<(), RecordError> {
        let quotes = self.quotes;
        let text = |rows: &[ContactRow]| {
            let mut lines = Lines::new(quotes);
            rows.iter().try_for_each(|row| lines.add_contact(row, columns))?;
            lines.text()
        };
        if rows.len() <= SHARE || rayon::current_thread_index().is_none() {
            return self.append(text(rows));
        }
        let texts: Vec<_> = rows.par_chunks(SHARE).map(text).collect();
        texts.into_iter().try_for_each(|text| self.append(text))
    }

    fn append(&mut self, text: io::Result<Vec<u8>>) -> Result<(), RecordError> {
        text.and_then(|text| self.stream.write_all(&text)).map_err(RecordError::io("write", &self.path))
    }

    /// Passes all rows to the operating system.
    pub(crate) fn flush(&mut self) -> Result<Extent, RecordError> {
        self.stream.flush().map_err(RecordError::io("write", &self.path))?;
        Ok(self.stream.get_ref().extent())
    }

    /// Flushes to the disk what was passed to the operating system.
    pub(crate) fn sync(&self) -> Result<(), RecordError> {
        self.stream.get_ref().sync().map_err(RecordError::io("write", &self.path))
    }
}

/// Lines of a file, with one buffer for all numbers.
struct Lines {
    writer: csv::Writer<Vec<u8>>,
    number: String,
}

impl Lines {
    fn new(quotes: csv::QuoteStyle) -> Self {
        let mut builder = csv::WriterBuilder::new();
        builder.quote_style(quotes).terminator(csv::Terminator::Any(b'\n'));
        Self { writer: builder.from_writer(Vec::new()), number: String::new() }
    }

    fn add<'a>(&mut self, cells: impl IntoIterator<Item = Value<'a>>) -> io::Result<()> {
        for cell in cells {
            self.number.clear();
            // Writing to a text cannot fail.
            let _ = match cell {
                Value::Count(count) => write!(self.number, "{count}"),
                Value::Real(real) => write!(self.number, "{real:?}"),
                Value::Text(text) => {
                    self.writer.write_field(text)?;
                    continue;
                }
            };
            self.writer.write_field(&self.number)?;
        }
        Ok(self.writer.write_record(None::<&[u8]>)?)
    }

    fn add_contact(&mut self, row: &ContactRow, columns: ContactColumns) -> io::Result<()> {
        let mut row = row.clone();
        self.add(row.cells(columns).into_iter().map(|cell| match cell.value {
            ContactValue::Count(count) => Value::Count(*count),
            ContactValue::Real(real) => Value::Real(*real),
            ContactValue::Text(text) => Value::Text(text),
        }))
    }

    fn text(self) -> io::Result<Vec<u8>> {
        self.writer.into_inner().map_err(csv::IntoInnerError::into_error)
    }
}
