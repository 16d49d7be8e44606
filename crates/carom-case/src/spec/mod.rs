//! The tables of a case: one type each, with its keys.

mod body;
mod case;
mod contact;
mod formula;
mod load;
mod mesh;
mod mesh_size;
mod obstacle;
mod output;
pub mod polygon;
mod tie;
mod time;

pub use body::{BodySpec, InvariantsSpec, Law, MassKind, MaterialSpec, Plane, PlasticSpec, Volumetric};
pub(crate) use body::{MaterialKeys, materials};
pub use case::{Case, InitialSpec, Preset, Units, Velocities};
pub use contact::{
    ActiveSetRule, ContactLaw, ContactPoint, ContactSpec, Detection, Enforcement, ForceTime, FrictionSpec,
    Method, Overlap, Persistency, Quadrature,
};
pub use formula::FormulaSpec;
pub(crate) use load::{LoadKeys, SupportKeys, loads, supports};
pub use load::{LoadKind, LoadSpec, SupportSpec, load_variables};
pub use mesh::{MeshSpec, RefineSpec, SKIN};
pub(crate) use mesh_size::PLANES;
pub use obstacle::{ObstacleMotion, PrimarySpec};
pub use output::{OutputSpec, OverlaySpec, ProbeSpec, Quantity};
pub use tie::{Overhang, TieMethod, TieSpec};
pub(crate) use time::scheme;
pub use time::{Fallback, LinearRule, NewtonSpec, SchemeSpec, TangentRule, TimeSpec};
