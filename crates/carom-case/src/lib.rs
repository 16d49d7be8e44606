//! Reads, checks and resolves case files: text to numbers, with every default filled in, names
//! still as names, and the place of every error. The resolved case is what `manifest.json` records
//! and `resume` reads back. No mechanics here.

extern crate self as carom_case;

mod between;
mod check;
mod columns;
mod conform;
mod document;
#[doc(hidden)]
pub mod draft;
#[doc(hidden)]
pub mod example;
mod excerpt;
mod expect;
mod explained;
mod explained_columns;
mod facts;
pub mod keys;
#[doc(hidden)]
pub mod load_table;
mod make;
mod memory;
mod mesh_file;
mod no_mesh;
mod overlay;
mod overrides;
mod place;
mod problem;
mod read;
mod read_scheme;
#[doc(hidden)]
pub mod refine;
#[doc(hidden)]
pub mod schema;
mod scheme;
#[doc(hidden)]
pub mod spec;
mod stored;
mod suggest;
mod surface_file;
mod tree;
#[doc(hidden)]
pub mod unit;

pub use carom_formula::{Function, Functions};
pub use carom_record::{Bound, Expect as ExpectSpec};
pub use columns::history_columns;
pub use document::Document;
pub use excerpt::{Excerpt, merged};
pub use expect::{Asked, EXPECT, expects};
pub use explained::{Described, ExplainedKey, explained, similar_key};
pub use explained_columns::{ExplainedColumn, every_column, explained_columns};
pub use load_table::TableSpec;
pub use memory::{Memory, gibibytes};
pub use mesh_file::FileMesh;
pub use no_mesh::NoMesh;
pub use overlay::{OVERLAY, overlays};
pub use place::PlaceSpec;
pub use problem::{CaseError, Diagnostic, Problem, Problems};
pub use read::{read, read_table};
pub use read_scheme::read_scheme;
pub use schema::{schema, schema_of};
pub use spec::{
    ActiveSetRule, BodySpec, Case, ContactLaw, ContactPoint, ContactSpec, Detection, Enforcement, Fallback,
    ForceTime, FormulaSpec, FrictionSpec, InitialSpec, InvariantsSpec, Law, LinearRule, LoadKind, LoadSpec,
    MassKind, MaterialSpec, MeshSpec, Method, NewtonSpec, ObstacleMotion, OutputSpec, Overhang, Overlap,
    OverlaySpec, Persistency, Plane, PlasticSpec, Preset, PrimarySpec, ProbeSpec, Quadrature, Quantity,
    RefineSpec, SKIN, SchemeSpec, SupportSpec, TangentRule, TieMethod, TieSpec, TimeSpec, Units, Velocities,
    Volumetric, load_variables,
};
pub use surface_file::SurfaceSpec;
