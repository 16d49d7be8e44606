//! Meshes from and to Gmsh: .msh files of version 4.1 and 2.2, text and binary, of order 1 to 3.
//!
//! A body is a *named* physical surface (dimension 1: curve, dimension 3: volume); its sides are
//! the named physical curves (points, surfaces) on its boundary. Defects that can be repaired
//! without changing the geometry are, and [`Mesh::repairs`](crate::Mesh::repairs) lists them;
//! others are errors with line or byte.
//!
//! ```no_run
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let file = carom_solid::gmsh::read(&std::fs::read("impact.msh")?)?;
//! let cylinder = file.body("cylinder")?;
//! assert!(cylinder.sides.contains_key("arc"));
//! # Ok(())
//! # }
//! ```

mod bar;
mod body;
mod cell_type;
mod checks;
mod error;
mod file;
mod group;
mod joint;
mod order;
mod raw;
mod read;
mod source;
mod triangles;
mod version_2;
mod version_4;
mod volume;
mod write;

pub use error::{Fault, MshError, Place};
pub use file::MshFile;
pub use joint::Joint;
pub use read::read;
pub use triangles::SurfaceError;
pub use write::write_msh41;
