//! Time integration schemes as data, their analysis, and the stages a step is made of. Depends on none of Carom's crates.

mod alpha;
mod analysis;
mod backward_euler;
mod bathe;
mod bdf2;
mod cubic;
mod energy_momentum;
mod error;
mod explain;
mod family;
mod integrator;
pub mod map;
mod names;
mod oscillator;
mod polynomial;
mod scheme;
mod stage;
mod statics;
mod text;

pub use analysis::Principal;
pub use backward_euler::BackwardEuler;
pub use bathe::Bathe;
pub use bdf2::Bdf2;
pub use cubic::Root;
pub use energy_momentum::EnergyMomentum;
pub use error::SchemeError;
pub use explain::{Accuracy, Convention, Explanation, Held, explain};
pub use family::{KINDS, KindInfo, scheme};
pub use integrator::Integrator;
pub use names::{Elsewhere, Name};
pub use oscillator::{Motion, Oscillator};
pub use scheme::{ForceRule, Scheme};
pub use stage::{Affine, Before, Internal, Kernel, Memory, Stage, Weights};
pub use statics::{STATIC, Static};
pub use text::{Catalogue, CatalogueRow, explain_all};
