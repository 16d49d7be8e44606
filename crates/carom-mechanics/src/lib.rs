//! The mechanics of Carom: a numeric model of bodies, loads and contacts, the balance of forces,
//! and the steppers that advance its state in time. Independent of case files; the crate
//! `carom-run` builds models from cases.

mod carried;
mod cells;
pub mod check;
pub mod contact;
mod created;
pub mod frequencies;
mod friction_state;
mod grid;
mod grid_report;
mod ledger;
pub mod linear;
mod materials;
pub mod model;
mod place;
mod pressure;
mod rejected;
mod restricted;
mod settings;
mod simulation;
pub mod stability;
pub mod stage;
pub mod start;
mod state;
mod stepper;
mod stopped;
pub mod substeps;
mod timings;
mod trace;
pub mod velocity;
mod works;
mod workspace;

pub use check::inside::{DeepPlace, inside};
pub use check::overlap::depths;
pub use check::overlapping::Overlap;
pub use check::penetration::{Depths, Penetration, penetration};
pub use check::undeclared::Undeclared;
pub use friction_state::each_slip;
pub use grid::Grid;
pub use grid_report::{Attempt, GridReport, LogEvent};
pub use ledger::secondary_force;
pub use materials::Materials;
pub use place::Place;
pub use pressure::{Pressures, Surfaces};
pub use rejected::Rejected;
pub use settings::{Linear, Settings, Tangent};
pub use simulation::Simulation;
pub use stage::renewal::{FrozenTangent, Point};
pub use start::InitialState;
pub use state::{Bisection, Carried, Created, HalfStepVelocity, Ledger, Means, OtherModel, Previous, State};
pub use stepper::{Accepted, Explicit, Implicit, Impulsive, StepReport, Stepper};
pub use stopped::Stopped;
pub use timings::Timings;
pub use trace::{Iteration, Trace};
pub use workspace::Workspace;
