//! Time integration schemes as data, their analysis, and the stages a step is made of. Depends on none of Carom's crates.

mod alpha;
mod analysis;
mod cubic;
mod error;
mod explain;
mod integrator;
mod kind;
pub mod map;
mod names;
mod nonsmooth;
mod nonsmooth_text;
mod oscillator;
mod polynomial;
mod scheme;
pub mod schemes;
mod stage;
mod text;

pub use analysis::Principal;
pub use cubic::Root;
pub use error::SchemeError;
pub use explain::{Accuracy, Convention, Explanation, Held, explain};
pub use integrator::{Explained, Integrator};
pub use kind::{KindInfo, Member, Parameter, scheme};
pub use names::{Elsewhere, Name};
pub use nonsmooth::{Explicit, Impulse, ImpulseShares, Nonsmooth};
pub use nonsmooth_text::NonsmoothExplanation;
pub use oscillator::{Motion, Oscillator};
pub use scheme::{ForceRule, Scheme};
pub use schemes::KINDS;
pub use schemes::statics::STATIC;
pub use stage::{Affine, Before, Internal, Kernel, Memory, Stage, Weights};
pub use text::{Catalogue, CatalogueRow, explain_all};
