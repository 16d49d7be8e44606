//! Factors through their interface: here the kernels of the library are not compiled again.

#![allow(clippy::unwrap_used)]

mod condensed;
mod cone;
mod forest;
mod independent;
mod mixing;
mod pattern;
mod principal;
mod projected;
mod saddle;
mod small;
mod sums;
mod symbolic;
mod threads;
