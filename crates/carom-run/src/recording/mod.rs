//! Records a simulation while it runs, in its run directory. Recording never changes the result.

mod columns;
mod fields;
#[doc(hidden)]
pub mod frames;
mod log;
mod outcome;
mod rows;
mod session;
mod start;
mod stopped;
mod tally;
mod verdicts;

pub use fields::{block, initial_fields};
pub use outcome::{End, Outcome, Progress, RunError};
pub use rows::{ContactStates, Rows};
pub use start::{resume, resume_with, run, run_in_memory};
pub(crate) use stopped::explain;
