//! Tests that run the command line: a single test program, so that it is linked once.

#![allow(clippy::unwrap_used)]

mod book;
mod commands;
mod common;
mod mesh;
mod misspelt;
mod new;
#[cfg(unix)]
mod resume;
mod schemes;
mod verify;
