//! Studies: one case is run many times, in parallel, with some of its values replaced, and the runs
//! are compared.
//!
//! [`Plan::read`] reads a study file and checks every arm before anything is written. [`start`]
//! creates the directory, and [`resume`] runs the arms that have not finished, so that a study can
//! be killed and resumed at any time. Tables and claims are functions of the records alone:
//! [`carom_record::study`].

mod arms;
mod checks;
mod comparable;
mod compute;
mod distributed;
mod error;
mod expects;
mod explained;
mod file;
mod goals;
mod jobs;
mod matched;
mod memory;
mod names;
mod plan;
mod resolved;
mod run;
mod schema;
mod suite;
mod theory;
mod verify;

pub use distributed::{arm, collect, plan, plan_settled};
pub use error::StudyError;
pub use explained::{explained, similar_key};
pub use jobs::{Ended, Event};
pub use plan::{Plan, PlannedArm};
pub use run::{Outcome, resume, start};
pub use schema::schema;
pub use suite::{Item, Kind, Suite};
pub use verify::{Named, VerifyOptions};
