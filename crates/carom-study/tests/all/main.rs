//! Studies from outside: one program, so that it is linked once.

#![allow(clippy::unwrap_used)]

mod alike;
mod common;
mod corpus;
mod coverage;
mod distributed;
mod expectations;
mod study;
mod truth;
