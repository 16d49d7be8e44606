//! Impact and contact of deformable solids by the positional finite element method.

mod balance;
pub mod case;
mod cells;
mod held;
mod initial;
mod kept;
mod ledger;
pub mod model;
mod newton;
mod persistency;
pub mod recording;
mod rejected;
mod rows;
mod scheme;
mod simulation;
mod start;
mod state;
mod stepper;
mod system;

pub use kept::{Kept, Point};
pub use newton::{Timings, Workspace};
pub use rejected::Rejected;
pub use simulation::{GridReport, LogEvent, Simulation, Stopped};
pub use state::{Ledger, State};
pub use stepper::{Accepted, Implicit, StepReport, Stepper};
