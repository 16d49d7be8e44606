//! The parts of a step on small models, in one binary, so that the library is compiled once.

#![allow(clippy::unwrap_used)]

mod grid;
mod models;
mod motion;
mod penetration;
mod points;
mod precision;
mod rejected;
mod renewal;
mod restitution;
mod stopped;
mod substeps;
mod tangent;
mod trace;
mod valid_cells;
