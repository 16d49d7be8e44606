//! Factors through their interface: here the kernels of the library are not compiled again.

#![allow(clippy::unwrap_used)]

mod condensed;
mod projected;
mod saddle;
