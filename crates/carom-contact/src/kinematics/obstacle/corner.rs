//! Pieces of an obstacle and nodes in contact that slide past their ends.

/// Cosine of the largest turn at a sharp corner of an obstacle across which a node keeps its
/// contact; the same as for facets.
pub(in super::super) const CORNER_COSINE: f64 = 0.87;

/// The next piece of a node in contact that slides past the end of its piece of an obstacle.
pub(in super::super) enum AtCorner {
    /// The node keeps its piece.
    Stays,
    /// The node moves to another piece, given by its number.
    Goes(usize),
    /// The node loses its contact.
    Leaves,
}
