//! A case as data: one type per table. Reading them is done elsewhere.

mod body;
mod case;
mod contact;
mod formula;
mod load;
mod mesh;
mod obstacle;
mod output;
mod polygon;
mod time;

pub use body::{BodySpec, Law, MassKind, MaterialSpec, PlaceSpec, Plane, Volumetric};
pub use case::{Case, InitialSpec, Preset, Units, Velocities};
pub use contact::{
    ActiveSetRule, ContactLaw, ContactPoint, ContactSpec, Detection, Enforcement, ForceTime, FrictionSpec,
    Overlap, Persistency, PrimarySpec,
};
pub use formula::FormulaSpec;
pub use load::{LoadKind, LoadSpec, SupportSpec, TableSpec};
pub(crate) use mesh::PLANES;
pub use mesh::{MeshSpec, RefineSpec, SKIN};
pub use obstacle::{ObstacleMotion, SurfaceSpec};
pub use output::{OutputSpec, OverlaySpec, ProbeSpec, Quantity};
pub use time::{Fallback, LinearRule, NewtonSpec, SchemeSpec, TangentRule, TimeSpec};
