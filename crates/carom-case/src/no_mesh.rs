//! The error of a mesh.

use std::path::PathBuf;

use carom_solid::{Element, generate, gmsh};

/// Why the mesh of a body cannot be made.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum NoMesh {
    /// Its shape gives none.
    #[error(transparent)]
    Shape(#[from] generate::MeshError),
    /// Its file gives none.
    #[error("{}: {error}; {}", .file.display(), .error.why())]
    File {
        /// The file.
        file: PathBuf,
        /// Why.
        #[source]
        error: Box<gmsh::MshError>,
    },
    /// Its file cannot be used: a sentence with its name.
    #[error("{0}")]
    Unreadable(String),
    /// The shape is one of another dimension.
    #[error("this shape needs dimension = {0}")]
    Dimension(usize),
    /// A shape in space is extruded.
    #[error("this shape is not plane")]
    NotPlane,
    /// There are no such cells of an extrusion.
    #[error("an extrusion has no cells {0:?}")]
    Extrusion(Element),
}
