//! Time integration schemes as data, their analysis, and the stages a step is made of. Depends on none of Carom's crates.

mod alpha;
mod error;
mod family;
mod oscillator;
mod scheme;
mod stage;

pub use error::SchemeError;
pub use family::{KINDS, KindInfo, scheme};
pub use oscillator::{Motion, Oscillator};
pub use scheme::{ForceRule, Scheme};
pub use stage::{Affine, Kernel, Memory, Stage, Weights};
