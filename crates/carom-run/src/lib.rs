//! Simulations built from cases, run step by step in memory or into a run directory. Users import
//! the crate `carom`, which re-exports this one.

#[doc(hidden)]
pub mod build;
mod initial;
mod initial_obstacles;
mod initial_pairs;
mod overlap;
#[doc(hidden)]
pub mod quantity;
pub mod recording;
#[doc(hidden)]
pub mod reduce;
mod saved_state;
mod setup;
mod thread_count;
mod warnings;
mod waves;

pub use carom_case as case;
pub use carom_mechanics::{
    Accepted, Attempt, Bisection, Depths, Explicit, FrozenTangent, Grid, GridReport, HalfStepVelocity,
    Implicit, Impulsive, InitialState, Ledger, LogEvent, Means, OtherModel, Point, Previous, Rejected,
    Settings, Simulation, State, StepReport, Stepper, Stopped, Tangent, Timings, Workspace, frequencies,
    model, stability,
};
pub use overlap::{OverlapNode, overlapping};
pub use reduce::{NEEDED, ReduceError, Reduced, reduce};
pub use setup::Setup;
pub use thread_count::ThreadCount;
pub use warnings::{Entry, Found, Rule, WARNINGS, warnings};
pub use waves::crossing;
