//! The command line, run: one program, so that it is linked once.

#![allow(clippy::unwrap_used)]

mod book;
mod commands;
mod common;
mod export;
#[cfg(unix)]
mod input;
#[cfg(target_os = "linux")]
mod memory;
mod mesh;
mod misspelt;
mod mutants;
mod new;
mod refused;
#[cfg(unix)]
mod report;
mod resume;
mod schemes;
mod stopped;
mod study;
mod verify;
