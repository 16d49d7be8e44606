//! Reads, checks and resolves case files: text to numbers, with every default filled in, names
//! still as names, and the place of every error. The resolved case is what `manifest.json` records
//! and `resume` reads back. No mechanics here.

mod between;
mod check;
mod columns;
mod conform;
mod document;
mod draft;
mod example;
mod excerpt;
mod expect;
mod facts;
pub mod keys;
mod load;
mod load_table;
mod make;
mod memory;
mod mesh;
mod mesh_cells;
mod mesh_file;
mod no_mesh;
mod obstacle;
mod overlay;
mod overrides;
mod place;
mod problem;
mod read;
mod read_scheme;
mod refine;
mod schema;
mod scheme;
mod solids;
mod spec;
mod stored;
mod suggest;
mod surface_file;
mod tables;
mod tree;
mod unit;
mod view;

pub use carom_formula::{Function, Functions};
pub use carom_record::{Bound, Expect as ExpectSpec};
pub use columns::history_columns;
pub use document::Document;
pub use excerpt::{Excerpt, merged};
pub use expect::{Asked, read_expects};
pub use load::load_variables;
pub use memory::{Memory, gibibytes};
pub use no_mesh::NoMesh;
pub use overlay::read_overlays;
pub use problem::{CaseError, Diagnostic, Problem, Problems};
pub use read::read;
pub use read_scheme::read_scheme;
pub use schema::{changes, expectation, measured, schema};
pub use spec::{
    ActiveSetRule, BodySpec, Case, ContactLaw, ContactPoint, ContactSpec, Detection, Enforcement, Fallback,
    ForceTime, FormulaSpec, FrictionSpec, InitialSpec, Law, LinearRule, LoadKind, LoadSpec, MassKind,
    MaterialSpec, MeshSpec, NewtonSpec, ObstacleMotion, OutputSpec, Overlap, OverlaySpec, Persistency,
    PlaceSpec, Plane, Preset, PrimarySpec, ProbeSpec, Quantity, RefineSpec, SKIN, SchemeSpec, SupportSpec,
    SurfaceSpec, TableSpec, TangentRule, TimeSpec, Units, Velocities, Volumetric,
};
