//! Metrics one at a time, by hand.

mod averaged;
mod book;
mod column;
mod compare;
mod cost;
mod evaluated;
mod force;
mod group;
mod ledger;
mod oscillation;
mod overlay;
mod pressure;
mod samples;
mod signal;
