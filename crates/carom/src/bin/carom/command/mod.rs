//! One file per command.

pub(crate) mod check;
pub(crate) mod completions;
pub(crate) mod explain;
pub(crate) mod man;
pub(crate) mod mesh;
pub(crate) mod new;
pub(crate) mod report;
pub(crate) mod resume;
pub(crate) mod run;
pub(crate) mod schema;
pub(crate) mod study;
pub(crate) mod verify;

use std::io::IsTerminal;
use std::num::NonZero;
use std::path::Path;

use carom::case::{Case, Document, read};

use crate::console;
use crate::exit::Failure;

/// Stands for standard input where a case file is asked for.
pub(crate) const STDIN: &str = "-";

/// Reads a case with its overrides, from a file or from standard input; nothing is written.
fn case(path: &Path, sets: &[String]) -> Result<(Case, Document), Failure> {
    let document = if path == Path::new(STDIN) {
        let input = std::io::stdin();
        if input.is_terminal() {
            console::say("reading a case from standard input, up to its end (Ctrl-D)");
        }
        Document::read_from("<stdin>", input.lock(), sets)?
    } else {
        Document::open(path, sets)?
    };
    let case = read(&document).map_err(|problems| document.diagnose_all(&problems))?;
    Ok((case, document))
}

/// Threads as asked for, or one for each core.
fn threads(asked: Option<NonZero<usize>>) -> usize {
    asked.or_else(|| std::thread::available_parallelism().ok()).map_or(1, NonZero::get)
}
