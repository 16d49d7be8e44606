//! Time integration schemes as data, their analysis, and the stages a step is made of. Depends on none of Carom's crates.

mod alpha;
mod analysis;
mod cubic;
mod error;
mod explain;
mod family;
mod names;
mod oscillator;
mod scheme;
mod stage;
mod statics;
mod text;

pub use analysis::Principal;
pub use cubic::Root;
pub use error::SchemeError;
pub use explain::{Accuracy, Convention, Explanation, Held, explain};
pub use family::{KINDS, KindInfo, scheme};
pub use names::{Elsewhere, Name};
pub use oscillator::{Motion, Oscillator};
pub use scheme::{ForceRule, Scheme};
pub use stage::{Affine, Kernel, Memory, Stage, Weights};
pub use statics::{STATIC, Static};
pub use text::{Catalogue, CatalogueRow, explain_all};
