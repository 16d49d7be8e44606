//! A model: bodies with their nodes numbered through, masses, loads, supports, contacts and probes.

mod contact;
mod formulas;
mod loads;
mod manufactured;
mod mass;
mod motion;
mod part;
mod probe;
mod redistribution;
mod rigid;
mod whole;

pub use contact::Contact;
pub use formulas::{NoValue, value};
pub use loads::{Amplitude, Load, Loads, LoadsAt};
pub use manufactured::Manufactured;
pub use mass::Mass;
pub use motion::{Motions, Prescribed};
pub use part::Part;
pub use probe::{Probe, Quantity, von_mises};
pub use redistribution::redistribute;
pub(crate) use rigid::check_held;
pub use rigid::{Mode, Unheld, free_motions};
pub use whole::{Model, Support};
