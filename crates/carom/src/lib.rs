//! Impact and contact of deformable solids by the positional finite element method.
//!
//! A case, text or file, is read and checked by [`Case`](case::Case), turned into a [`Simulation`]
//! by [`Setup`], and run step by step, or into a run directory by [`recording::run`]:
//!
//! ```
#![doc = include_str!("../examples/sweep.rs")]
//! ```
//!
//! [`Setup::material`] and [`Setup::kernel`] take a law and a time integrator of your own: any
//! [`solid::material::Material`] and any [`time::Kernel`]. The crates behind this one are
//! re-exported as modules.

#[cfg(feature = "diagnostics")]
pub mod diagnostics;

pub use carom_algebra as algebra;
pub use carom_contact as contact;
pub use carom_record as record;
pub use carom_report as report;
pub use carom_run::*;
pub use carom_solid as solid;
pub use carom_study as study;
pub use carom_time as time;
