//! Writing and reading of run directories, and metrics as pure functions of the record.
//!
//! ```text
//! runs/impact/manifest.json          what was run, and its result
//!             history.csv            one row per recorded step
//!             contact.csv            one row per active contact node of a recorded step
//!             log.jsonl              one event per line
//!             fields.pvd fields/     VTK files of the bodies
//!             checkpoint/            two generations of the state needed to resume
//! ```
//!
//! This crate knows no model and no solver. Equal numbers give equal bytes, and a run that is
//! killed and resumed writes the same bytes as an uninterrupted one.

#[doc(hidden)]
pub mod available;
mod checkpoint;
#[doc(hidden)]
pub mod decimal;
mod error;
mod expect;
mod expectation;
mod export;
#[doc(hidden)]
pub mod expression;
mod facts;
mod files;
mod intact;
pub mod json;
#[doc(hidden)]
pub mod manifest;
pub mod metrics;
pub mod order;
mod pvd;
pub mod question;
mod reason;
mod recorder;
mod rows;
mod run;
mod sizes;
mod stop;
mod stream;
pub mod study;
pub mod table;
pub mod units;
pub mod verification;
mod vtu;
mod warning;
mod writer;

pub use available::available_memory;
pub use error::RecordError;
pub use expect::{Bound, Deviation, Expect, Norm, OrderOf};
pub use expectation::judge;
pub use expression::{Expression, Sign};
pub use facts::{ContactFacts, Facts, Held, Overlay, Stepping, Turns, body_of};
pub use files::{flushes, is_free};
pub use intact::{checkpoints, last_checkpoint};
pub use manifest::{Column, Expectation, Machine, Manifest, PHASES, Source, Status, now};
pub use pvd::FieldEntry;
pub use reason::Reason;
pub use recorder::{MemoryRecord, Recorder};
pub use rows::{ContactCell, ContactColumns, ContactRow, ContactValue, Event};
pub use run::{History, Run};
pub use sizes::{Sizes, modulus};
pub use stop::{Advice, Stop, StopIteration, StopNode, StopPlace};
pub use vtu::{Block, Cell, CellArray, CellMaterials, FieldSet, LARGEST_VON_MISES, PointArray};
pub use warning::Warning;
pub use writer::{FLUSH_INTERVAL, Reopened, RunWriter};
