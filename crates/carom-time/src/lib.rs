//! Time integration schemes as data, their analysis, and the stages a step is made of. Depends on none of Carom's crates.

mod scheme;
mod stage;

pub use scheme::{ForceRule, Scheme};
pub use stage::{Affine, Kernel, Memory, Stage, Weights};
