//! One file per command.

pub(crate) mod check;
pub(crate) mod explain;
pub(crate) mod mesh;
pub(crate) mod new;
pub(crate) mod report;
pub(crate) mod resume;
pub(crate) mod run;
pub(crate) mod schema;
pub(crate) mod study;
pub(crate) mod verify;

use std::num::NonZero;
use std::path::Path;

use carom::case::{Case, Document, read};

use crate::exit::Failure;

/// Reads a case with its overrides; nothing is written.
fn case(path: &Path, sets: &[String]) -> Result<(Case, Document), Failure> {
    let document = Document::open(path, sets)?;
    let case = read(&document).map_err(|problems| document.diagnose_all(&problems))?;
    Ok((case, document))
}

/// Threads as asked for, or one for each core.
fn threads(asked: Option<NonZero<usize>>) -> usize {
    asked.or_else(|| std::thread::available_parallelism().ok()).map_or(1, NonZero::get)
}
