//! What is wrong with a formula, and where.

use std::ops::Range;

/// What is wrong with a formula, and where.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FormulaError {
    /// What is wrong, and what to try.
    pub message: String,
    /// Bytes of the text that are wrong; empty where something is missing.
    pub at: Range<usize>,
}

impl std::fmt::Display for FormulaError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{} (at character {})", self.message, self.at.start + 1)
    }
}

impl std::error::Error for FormulaError {}
