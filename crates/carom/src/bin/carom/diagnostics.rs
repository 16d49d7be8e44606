//! Failures on standard error, with the line of the case file, in colour on a terminal.

use carom::case::{CaseError, Diagnostic};
use carom::diagnostics::{plain, text};
use serde_json::json;

use crate::exit::{Exit, Failure};
use crate::{console, out};

/// Prints a failure, also as an event on standard output; returns its exit code.
pub(crate) fn print(failure: &Failure) -> Exit {
    let coloured = console::in_colour();
    let text = match failure {
        Failure::Case(error) => text(error, coloured),
        Failure::Argument { help, .. } => plain(&failure.to_string(), &[("try", help)], coloured),
        Failure::Stopped { help, directory, page, .. } => {
            let place = directory.display();
            let note = if *page {
                format!(
                    "why and where: {place}/report.html; a smaller case that stops too: carom reduce {place}"
                )
            } else {
                format!("the last valid state is saved in {place}")
            };
            plain(&failure.to_string(), &[("note", &note), ("try", help)], coloured)
        }
        Failure::System { .. } => plain(&failure.to_string(), &[], coloured),
    };
    console::say(text);
    // The event of a run that stopped has been printed already.
    if !matches!(failure, Failure::Stopped { .. }) {
        let _ = out::event(&event(failure));
    }
    failure.exit()
}

/// `{ "event": "error", "exit": 2, "errors": [{ "what": …, "why": …, "try": …, "file": …, … }] }`;
/// lines and columns from 1, a line of 0 for a file as a whole.
fn event(failure: &Failure) -> serde_json::Value {
    let errors = match failure {
        Failure::Case(CaseError::Wrong(found)) => found.iter().map(placed).collect(),
        Failure::Argument { what, help } => vec![json!({ "what": what, "try": help })],
        other => vec![json!({ "what": other.to_string() })],
    };
    json!({ "event": "error", "exit": failure.exit() as u8, "errors": errors })
}

fn placed(found: &Diagnostic) -> serde_json::Value {
    json!({
        "what": found.what, "why": found.why, "try": found.help,
        "file": found.file, "line": found.line, "column": found.column, "length": found.length,
    })
}
