//! Surfaces in space, their parts and paths, one at a time.

mod candidate;
mod crosses;
mod folds;
mod passed;
mod patch;
