//! Pages and figures through the interface, in one binary, so that it is linked once.

#![allow(clippy::unwrap_used)]

mod common;
mod pages;
mod setup;
