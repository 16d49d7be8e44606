//! Schemes through their interface, in one binary, so that it is linked once.

#![allow(clippy::unwrap_used)]

mod analysis;
mod common;
mod energy;
mod free_fall;
mod kernels;
