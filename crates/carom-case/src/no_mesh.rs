//! The error of a mesh.

use std::path::PathBuf;

use carom_solid::{Element, generate, gmsh};

/// Why the mesh of a body cannot be made.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum NoMesh {
    /// The built-in shape cannot be meshed.
    #[error(transparent)]
    Shape(#[from] generate::MeshError),
    /// The mesh file has no usable mesh.
    #[error("{}: {error}; {}", .file.display(), .error.why())]
    File {
        /// Path of the mesh file.
        file: PathBuf,
        /// Fault of the mesh file.
        #[source]
        error: Box<gmsh::MshError>,
    },
    /// The mesh file cannot be read, or has changed: a sentence that says why.
    #[error("{0}")]
    Unreadable(String),
    /// The shape needs a case of this dimension.
    #[error("this shape needs dimension = {0}")]
    Dimension(usize),
    /// A shape in space is extruded.
    #[error("this shape is not plane")]
    NotPlane,
    /// An extrusion cannot have cells of this element.
    #[error("an extrusion has no cells {0:?}")]
    Extrusion(Element),
}
