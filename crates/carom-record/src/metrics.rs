//! Metrics of a run, as functions of its record: most of its history alone.
//!
//! A contact *episode* is a span of rows in contact (`episode.rs`); interruptions shorter than
//! `bridge` (by default 2 % of the recorded time) do not end it. It starts with the first row in
//! contact and ends with the first row without contact. Both are ends of steps, so a time is late
//! by at most one step. The *striker* is the body whose centre moves fastest in the row before the
//! first episode; with this definition, swapping secondary and primary changes no metric but the
//! signs of impulses, if contacts count as one (`given.rs`). An impulse is a difference of the
//! recorded `contact_impulse`, which the time integrator accumulates; a mean force over a window w
//! is [P(t + w) − P(t)]/w, not a mean of samples.

#[doc(hidden)]
pub mod averaged;
mod book;
#[doc(hidden)]
pub mod column;
mod compare;
mod cost;
mod definition;
mod episode;
mod evaluated;
mod file;
#[doc(hidden)]
pub mod force;
#[doc(hidden)]
pub mod given;
#[doc(hidden)]
pub mod group;
mod ledger;
#[doc(hidden)]
pub mod oscillation;
#[doc(hidden)]
pub mod overlay;
mod parties;
#[doc(hidden)]
pub mod pressure;
mod rebound;
#[doc(hidden)]
pub mod run_table;
#[doc(hidden)]
pub mod samples;
mod signal;
mod striker;
#[doc(hidden)]
pub mod table;

pub use crate::facts::Overlay;
pub use crate::units::Unit;
pub use averaged::of_averages;
pub use book::{Explanation, book_table, explained};
pub use compare::{deviation, phase_shift};
pub use cost::{KERNELS, Kernel, cost};
pub use definition::Metric;
pub use episode::{Episode, default_bridge, episodes, first_episode, window};
pub use evaluated::{all, of_measured, of_rebound, of_run, of_run_beside, probe_columns};
pub(crate) use evaluated::{of_any_column, of_column, of_no_column};
pub use file::write;
pub(crate) use given::Given;
pub use given::contact_force;
pub(crate) use given::{count_as_one, total_force};
pub use group::{TITLES, group};
pub use ledger::{MUCH_CREATED, energy_lost_at};
pub use overlay::{OVERLAY, overlays};
pub use rebound::{Impact, no_rebound};
pub(crate) use run_table::{PRESSURE, WORK};
pub(crate) use samples::{at, extreme, integral};
pub use signal::{Distance, Signal};
pub use striker::striker;
