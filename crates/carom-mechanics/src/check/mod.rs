//! Checks of positions that no equation asks for: depths, overlaps, valid cells.

pub mod inside;
pub(crate) mod overlap;
pub(crate) mod overlapping;
pub mod penetration;
pub(crate) mod skins;
pub(crate) mod tips;
pub(crate) mod undeclared;
pub mod valid_cells;
pub(crate) mod watched;
