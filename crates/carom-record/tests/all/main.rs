//! Records are written, continued after a kill, and read back.

#![allow(clippy::unwrap_used)] // the helpers are tests too

mod common;
mod read_back;
mod resume;
