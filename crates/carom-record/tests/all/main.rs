//! Records are written, continued after a kill, and read back.

#![allow(clippy::unwrap_used)] // the helpers are tests too

mod available;
mod common;
mod decimal;
mod expectation;
mod expression;
mod manifest;
mod metrics;
mod metrics_by_hand;
mod order;
mod read_back;
mod resume;
mod sizes;
mod study;
mod units;
mod vtu;
mod writer;
