//! What becomes of a node in contact that slides past the end of its piece.

/// Cosine of the largest turn at a sharp corner across which a node keeps its contact: as for
/// facets.
pub(super) const CORNER_COSINE: f64 = 0.87;

/// What becomes of such a node.
pub(in super::super) enum AtCorner {
    /// It keeps its piece.
    Stays,
    /// It moves to another one.
    Goes(usize),
    /// It loses its contact.
    Leaves,
}
