//! A model: bodies with consecutive node numbers, masses, loads, supports, contacts and probes.

mod body_instance;
mod contact;
mod formulas;
mod friction;
mod loads;
mod manufactured;
mod mass;
mod momenta;
mod motion;
mod pieces;
mod points;
mod probe;
mod redistribution;
mod rigid;
mod whole;

pub use body_instance::{BodyInstance, bounds};
pub use contact::{AllowedDepths, Augmentation, Contact, OfRows, Springs};
pub use formulas::{NoValue, value};
pub use friction::Friction;
pub use loads::{Amplitude, InBody, Load, Loads, LoadsAt, Weight};
pub use manufactured::Manufactured;
pub use mass::Mass;
pub use momenta::Momenta;
pub use motion::{Motion, Motions, Prescribed, Turn};
pub(crate) use pieces::{Piece, tied_pieces};
pub use points::{Circular, Point, Points};
pub use probe::{Probe, Quantity, past_of, von_mises};
pub use redistribution::redistribute;
pub(crate) use rigid::check_rigid_modes;
pub use rigid::{Mode, RigidMotion, Unconstrained, free_motions};
pub use whole::{Model, Pivot, Support, Tie, gap_tolerance};
