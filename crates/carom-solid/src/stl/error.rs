//! Why a file in STL gave no surface.

use crate::triangles::TrianglesError;

/// Why a file in STL gave no surface.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum StlError {
    /// It does not follow the format, with the place.
    #[error("{0}")]
    Format(String),
    /// It ends before its end.
    #[error("it ends early: {0}")]
    Cut(String),
    /// Its triangles are not a surface.
    #[error("{0}")]
    Surface(TrianglesError),
}
