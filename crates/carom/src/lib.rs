//! Impact and contact of deformable solids by the positional finite element method.

mod balance;
pub mod case;
mod cells;
mod evaluation;
pub mod frequencies;
mod held;
mod initial;
mod kept;
mod kept_step;
mod ledger;
mod mixing;
pub mod model;
mod newton;
mod penalty;
mod persistency;
pub mod recording;
mod rejected;
mod rows;
mod scheme;
mod simulation;
pub mod stability;
mod start;
mod state;
mod stepper;
mod system;
mod touching;
mod workspace;

pub use kept::{Kept, Point};
pub use rejected::Rejected;
pub use simulation::{GridReport, LogEvent, Simulation, Stopped};
pub use state::{Ahead, Halved, Ledger, Means, Previous, State};
pub use stepper::{Accepted, Explicit, Implicit, Impulsive, StepReport, Stepper};
pub use workspace::{Timings, Workspace};
