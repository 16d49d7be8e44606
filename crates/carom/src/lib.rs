//! Impact and contact of deformable solids by the positional finite element method.
//!
//! A case, text or file, is read and checked by [`Case`](case::Case), turned into a [`Simulation`]
//! by [`Setup`], and run step by step, or into a run directory by [`recording::run`]:
//!
//! ```
#![doc = include_str!("../examples/sweep.rs")]
//! ```

mod build;
mod initial;
pub mod recording;
mod setup;

pub use build::overlaps;
pub use carom_case as case;
pub use carom_mechanics::{
    Accepted, Before, Bisection, Explicit, FrozenTangent, Grid, GridReport, HalfStepVelocity, Implicit,
    Impulsive, Ledger, LogEvent, Means, OtherModel, Point, Previous, Rejected, Settings, Simulation, State,
    StepReport, Stepper, Stopped, Tangent, Timings, Workspace, frequencies, model, stability,
};
pub use setup::{Setup, too_long};
