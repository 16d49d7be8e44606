//! A simulation written down as it goes: the run directory of design.md §1.4. Nothing here changes a bit of the result.

mod columns;
mod fields;
mod log;
mod session;
mod units;
mod verdicts;

pub use columns::columns;
pub use session::{End, Options, Outcome, Progress, RunError, resume, run};
