//! Pieces of an obstacle and nodes in contact that slide past their ends.

/// The next piece of a node in contact that slides past the end of its piece of an obstacle.
pub(in super::super) enum AtCorner {
    /// The node keeps its piece.
    Stays,
    /// The node moves to another piece, given by its number.
    Goes(usize),
    /// The node loses its contact.
    Leaves,
}
