//! Time integration schemes as data, their analysis, and the stages of a step. Depends on no other
//! crate of Carom.

mod alpha;
mod analysis;
mod catalogue;
mod cubic;
mod error;
mod explain;
mod explained;
mod explicit;
mod integrator;
mod kind;
mod layout;
pub mod map;
mod name;
mod names;
mod nonsmooth;
mod nonsmooth_text;
mod oscillator;
mod parameter;
mod polynomial;
mod scheme;
pub mod schemes;
mod stage;
mod text;

pub use analysis::Principal;
pub use catalogue::scheme;
pub use cubic::Root;
pub use error::SchemeError;
pub use explain::{Accuracy, Constrained, Convention, Explanation, Overshoot, explain};
pub use explained::Explained;
pub use explicit::Explicit;
pub use integrator::Integrator;
pub use kind::{KindInfo, Member};
pub use name::Name;
pub use names::Elsewhere;
pub use nonsmooth::{Impulse, ImpulseShares, Nonsmooth};
pub use nonsmooth_text::NonsmoothExplanation;
pub use oscillator::{Motion, Oscillator};
pub use parameter::Parameter;
pub use scheme::{ForceRule, Scheme};
pub use schemes::KINDS;
pub use schemes::statics::STATIC;
pub use stage::{Affine, Internal, Kernel, Memory, PreviousStep, Stage, Weights};
pub use text::{Catalogue, CatalogueRow, explain_all};
