//! Standard output: text or JSON lines. A reader that closes the pipe (`| head`) is not an error.

use std::io::{self, Write};

use serde::Serialize;

use crate::console;

/// Writes what a command was asked for.
pub(crate) fn line(text: &str) -> io::Result<()> {
    let mut out = io::stdout().lock();
    match writeln!(out, "{}", text.trim_end()).and_then(|()| out.flush()) {
        Err(error) if error.kind() == io::ErrorKind::BrokenPipe => Ok(()),
        other => other,
    }
}

/// Writes a summary for people: nothing with `--quiet` or `--json`.
pub(crate) fn summary(text: &str) -> io::Result<()> {
    if console::is_silent() { Ok(()) } else { line(text) }
}

/// Writes an event as one line of JSON: nothing without `--json`.
pub(crate) fn event<T: Serialize>(event: &T) -> io::Result<()> {
    if !console::is_json() {
        return Ok(());
    }
    line(&serde_json::to_string(event).map_err(io::Error::from)?)
}
