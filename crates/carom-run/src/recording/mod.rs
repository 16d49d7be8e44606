//! Records a simulation while it runs: the run directory of design.md §1.4. Recording never changes
//! the result.

mod columns;
mod fields;
mod log;
mod outcome;
mod rows;
mod session;
mod stopped;
mod units;
mod verdicts;

pub use columns::columns;
pub use fields::initial_fields;
pub use outcome::{End, Options, Outcome, Progress, RunError};
pub use rows::{ContactStates, Rows};
pub use session::{resume, resume_with, run, run_in_memory};
pub(crate) use stopped::explain;
