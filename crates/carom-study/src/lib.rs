//! Studies: one case run many times with some of its values replaced, in parallel, and its runs
//! compared.
//!
//! [`Plan::read`] reads a study file and checks every arm before anything is written; [`start`]
//! makes the directory and [`resume`] runs what is not finished in it, so that a study killed at
//! any moment goes on where it was. Tables and claims are functions of the records alone:
//! [`carom_record::study`].

mod arms;
mod checks;
mod compute;
mod error;
mod expects;
mod file;
mod jobs;
mod matched;
mod plan;
mod run;
mod schema;
mod suite;
mod theory;
mod verify;

pub use error::StudyError;
pub use jobs::{Ended, Event};
pub use plan::{Plan, PlannedArm};
pub use run::{Outcome, resume, start};
pub use schema::schema;
pub use suite::{Item, Kind, Suite};
pub use verify::{Named, VerifyOptions};
