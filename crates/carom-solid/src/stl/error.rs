//! Why a file in STL gave no surface.

use crate::triangles::TrianglesError;

/// Why a file in STL gave no surface.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum StlError {
    /// The file does not follow the format, with the place.
    #[error("{0}")]
    Format(String),
    /// The file is cut short.
    #[error("it ends early: {0}")]
    Cut(String),
    /// Its triangles are not a surface.
    #[error("{0}")]
    Surface(TrianglesError),
}
