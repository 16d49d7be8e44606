//! The error of a mesh.

/// Why the mesh of a body cannot be made.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{0}")]
pub struct NoMesh(String);

impl<T: Into<String>> From<T> for NoMesh {
    fn from(why: T) -> Self {
        Self(why.into())
    }
}
