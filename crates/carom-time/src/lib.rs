//! Time integration schemes as data, their analysis, and the stages a step is made of. Depends on none of Carom's crates.

mod alpha;
mod analysis;
mod cubic;
mod error;
mod explain;
mod family;
mod names;
mod nonsmooth;
mod nonsmooth_text;
mod oscillator;
mod scheme;
mod stage;
mod text;

pub use analysis::Principal;
pub use cubic::Root;
pub use error::SchemeError;
pub use explain::{Accuracy, Convention, Explanation, Held, explain};
pub use family::{KINDS, KindInfo, scheme};
pub use names::{Elsewhere, Name};
pub use nonsmooth::{Impulse, ImpulseShares, NONSMOOTH_KINDS, Nonsmooth, NonsmoothInfo, nonsmooth};
pub use nonsmooth_text::{NonsmoothExplanation, explain_all_nonsmooth, explain_nonsmooth};
pub use oscillator::{Motion, Oscillator};
pub use scheme::{ForceRule, Scheme};
pub use stage::{Affine, Kernel, Memory, Stage, Weights};
pub use text::{Catalogue, CatalogueRow, explain_all};
