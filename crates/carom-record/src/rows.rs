//! Rows of `history.csv` and `contact.csv` and lines of `log.jsonl`.
//!
//! Numbers are written as the shortest decimals that read back to the same bits, with an exponent
//! if very small or large.

use std::borrow::Cow;
use std::fmt::Write as _;
use std::io;

use serde::{Deserialize, Serialize};

use crate::stream::Stream;

/// State of one active contact node at the end of a step.
#[derive(Clone, Debug, PartialEq)]
pub struct ContactRow<'a> {
    /// Step.
    pub step: u64,
    /// Time.
    pub time: f64,
    /// Name of the contact.
    pub contact: Cow<'a, str>,
    /// Node of the secondary side, or one of the primary side that is paired with a facet of the
    /// secondary one.
    pub node: u64,
    /// Its current position.
    pub point: [f64; 3],
    /// Facet of the other side that it is paired with.
    pub facet: u64,
    /// Coordinate of the closest point on that facet, −1 … 1; on a triangle 0 … 1.
    pub xi: f64,
    /// Its second coordinate, in space.
    pub eta: f64,
    /// Gap, negative for penetration.
    pub gap: f64,
    /// Multiplier, negative for compression.
    pub multiplier: f64,
    /// −multiplier / consistent weight of the node.
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
}

/// Header of `contact.csv` for this number of axes.
pub fn contact_columns(axes: usize) -> Vec<&'static str> {
    let (places, normals) = (&["x", "y", "z"][..axes], &["normal_x", "normal_y", "normal_z"][..axes]);
    let rubbing = &["friction_x", "friction_y", "friction_z"][..if axes == 3 { 3 } else { 0 }];
    [
        &["step", "time", "contact", "node"][..],
        places,
        &["facet", "xi"],
        &["eta"][..usize::from(axes == 3)],
        &["gap", "multiplier", "pressure"],
        normals,
        &["friction", "traction", "slip"],
        rubbing,
    ]
    .concat()
}

/// An event of a run.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Event {
    /// Step being computed.
    pub step: u64,
    /// Time at its start.
    pub time: f64,
    /// Kind: `rejected`, `active-set`, `cycle`, `fallback`, …
    pub kind: String,
    /// One sentence.
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

/// A CSV file being written, with one buffer for all numbers.
pub(crate) struct Table {
    writer: csv::Writer<Stream>,
    text: String,
}

impl Table {
    pub(crate) fn new(stream: Stream) -> Self {
        Self {
            writer: csv::WriterBuilder::new().terminator(csv::Terminator::Any(b'\n')).from_writer(stream),
            text: String::new(),
        }
    }

    pub(crate) fn text(&mut self, field: &str) -> io::Result<()> {
        Ok(self.writer.write_field(field)?)
    }

    pub(crate) fn integer(&mut self, value: u64) -> io::Result<()> {
        self.display(format_args!("{value}"))
    }

    pub(crate) fn number(&mut self, value: f64) -> io::Result<()> {
        self.display(format_args!("{value:?}"))
    }

    fn display(&mut self, arguments: std::fmt::Arguments) -> io::Result<()> {
        self.text.clear();
        self.text.write_fmt(arguments).map_err(io::Error::other)?;
        Ok(self.writer.write_field(&self.text)?)
    }

    pub(crate) fn end_row(&mut self) -> io::Result<()> {
        Ok(self.writer.write_record(None::<&[u8]>)?)
    }

    pub(crate) fn contact(&mut self, row: &ContactRow, axes: usize) -> io::Result<()> {
        self.integer(row.step)?;
        self.number(row.time)?;
        self.text(&row.contact)?;
        self.integer(row.node)?;
        row.point[..axes].iter().try_for_each(|x| self.number(*x))?;
        self.integer(row.facet)?;
        self.number(row.xi)?;
        if axes == 3 {
            self.number(row.eta)?;
        }
        [row.gap, row.multiplier, row.pressure].iter().try_for_each(|x| self.number(*x))?;
        row.normal[..axes].iter().try_for_each(|x| self.number(*x))?;
        self.text(&row.friction)?;
        self.number(row.traction)?;
        self.number(row.slip)?;
        if axes == 3 {
            row.rubbing.iter().try_for_each(|force| self.number(*force))?;
        }
        self.end_row()
    }

    /// Passes all buffered rows to the operating system.
    pub(crate) fn flush(&mut self) -> io::Result<()> {
        self.writer.flush()
    }

    /// The underlying stream, for syncing.
    pub(crate) fn stream(&self) -> &Stream {
        self.writer.get_ref()
    }
}
