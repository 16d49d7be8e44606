//! Standard output: text or JSON lines. A reader that closes the pipe (`| head`) is not an error.

use std::io::{self, Write};

use serde::Serialize;

/// Writes a text and a line end.
pub(crate) fn line(text: &str) -> io::Result<()> {
    let mut out = io::stdout().lock();
    quiet(writeln!(out, "{}", text.trim_end()).and_then(|()| out.flush()))
}

/// Writes one event as one line of JSON.
pub(crate) fn event<T: Serialize>(event: &T) -> io::Result<()> {
    line(&serde_json::to_string(event).map_err(io::Error::from)?)
}

fn quiet(result: io::Result<()>) -> io::Result<()> {
    match result {
        Err(error) if error.kind() == io::ErrorKind::BrokenPipe => Ok(()),
        other => other,
    }
}
