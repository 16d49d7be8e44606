//! The names of metrics that a question may use, and the message about all others.

use super::form::form_names;
use crate::Reason;
use crate::metrics::{of_any_column, of_no_column};

/// Names of the metrics of a column.
pub fn column_metric_names() -> Vec<&'static str> {
    of_any_column().map(|d| d.name).collect()
}

/// Names of metrics that need no column.
pub fn metric_names() -> Vec<&'static str> {
    of_no_column().map(|d| d.name).chain(["stopped"]).collect()
}

/// The message about words that are no quantity.
pub(super) fn unknown(what: &str) -> Reason {
    format!(
        "`{what}` is not a valid quantity: give {} and a column, or one of the metrics {}",
        form_names(),
        metric_names().join(", ")
    )
    .into()
}
