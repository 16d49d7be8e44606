//! Studies from outside: one program, so that it is linked once.

#![allow(clippy::unwrap_used)]

mod expectations;
mod study;
