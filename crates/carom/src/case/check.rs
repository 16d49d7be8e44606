//! What concerns several tables: names, references, sides, dimensions, steps.

use super::document::Document;
use super::problem::Problem;
use super::read::Draft;

/// Adds what is wrong between tables.
pub(super) fn problems(_document: &Document, _draft: &Draft, _problems: &mut Vec<Problem>) {}
