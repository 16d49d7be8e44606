//! The run directory of a Carom simulation, written and read, and metrics as pure functions of what
//! was read.
//!
//! ```text
//! runs/impact/manifest.json          what was run, with which result
//!             history.csv            one row per recorded step
//!             contact.csv            one row per active contact node of a recorded step
//!             log.jsonl              one event per line
//!             fields.pvd fields/     VTK files of the bodies, or all of them in fields.vtkhdf
//!             checkpoint/            two generations of what a run needs to go on
//! ```
//!
//! This crate knows no model and no solver. A run that produces the same numbers produces the same
//! bytes, and a run that is killed and reopened continues to the same bytes as one that was not.

mod checkpoint;
mod error;
mod expectation;
mod expression;
mod files;
mod manifest;
pub mod metrics;
pub mod order;
mod pvd;
pub mod question;
mod rows;
mod run;
pub mod study;
pub mod verification;
mod vtkhdf;
mod vtu;
mod writer;

pub use error::RecordError;
pub use expectation::{Bound, Deviation, Expect, Norm, OrderOf, judge};
pub use expression::{Expression, Sign};
pub use manifest::{Column, Expectation, Machine, Manifest, PHASES, Source, Status, now};
pub use pvd::{FieldEntry, FieldFormat};
pub use rows::{ContactRow, Event};
pub use run::{History, Run};
pub use vtu::{Block, Cell, FieldSet, PointArray};
pub use writer::{Reopened, RunWriter, last_checkpoint};
