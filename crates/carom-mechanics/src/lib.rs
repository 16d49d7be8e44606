//! The mechanics of Carom: a numeric model of bodies, loads and contacts, the balance of forces,
//! and the steppers that advance its state in time. Independent of case files; the crate `carom`
//! builds models from cases.

mod active_rows;
mod audit;
mod balance;
mod carried;
mod cells;
mod cone;
mod constraints;
mod contact_forces;
mod contact_update;
mod created;
mod direct;
mod equations;
mod evaluation;
mod factor;
pub mod frequencies;
mod friction;
mod grid;
mod grid_report;
mod iterative;
mod ledger;
mod linear_problem;
mod mixing;
pub mod model;
mod newton;
mod overlap;
mod penetration;
mod persistency;
mod place;
mod preconditioner;
mod rejected;
mod renewal;
mod restitution;
mod restricted;
mod resultants;
mod settings;
mod simulation;
mod skins;
pub mod stability;
mod start;
mod state;
mod stepper;
mod substeps;
mod sums;
mod system;
mod tangent_factor;
#[cfg(test)]
mod tangent_tests;
#[cfg(test)]
mod testing;
mod timings;
mod trace;
mod undeclared;
mod valid_cells;
mod watched;
mod workspace;

pub use audit::{Doubt, audit, unaudited};
pub use friction::each_slip;
pub use grid::Grid;
pub use grid_report::{Attempt, GridReport, LogEvent};
pub use ledger::secondary_force;
pub use overlap::depths;
pub use penetration::{Depths, inside, penetration};
pub use place::Place;
pub use rejected::Rejected;
pub use renewal::{FrozenTangent, Point};
pub use settings::{Linear, Settings, Tangent};
pub use simulation::{Simulation, Stopped};
pub use start::Before;
pub use state::{Bisection, Carried, Created, HalfStepVelocity, Ledger, Means, OtherModel, Previous, State};
pub use stepper::{Accepted, Explicit, Implicit, Impulsive, StepReport, Stepper};
pub use sums::dot;
pub use timings::Timings;
pub use trace::{Iteration, Trace};
pub use workspace::Workspace;
