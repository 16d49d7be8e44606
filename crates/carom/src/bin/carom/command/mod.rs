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

/// Name of standard input in place of a case file.
pub(crate) const STDIN: &str = "-";

/// Reads a case with its overrides, from a file or from standard input.
fn case(path: &Path, sets: &[String]) -> Result<(Case, Document), Failure> {
    let document = if path == Path::new(STDIN) {
        let input = std::io::stdin();
        if input.is_terminal() {
            console::say("reading a case from standard input; end it with Ctrl-D");
        }
        Document::read_from("<stdin>", input.lock(), sets)?
    } else {
        Document::open(path, sets)?
    };
    let case = read(&document).map_err(|problems| document.diagnose_all(&problems))?;
    Ok((case, document))
}

/// The requested number of threads, or one per core.
fn threads(requested: Option<NonZero<usize>>) -> usize {
    requested.or_else(|| std::thread::available_parallelism().ok()).map_or(1, NonZero::get)
}
