//! What the record of an arm came to: a row of the tables.

use crate::metrics::Metric;
use crate::{Expectation, Status};

/// An arm with its metrics.
#[derive(Clone, Debug, PartialEq)]
pub struct Row {
    /// The arm.
    pub name: String,
    /// How far it is; none when it has not begun.
    pub status: Option<Status>,
    /// Why it did not finish.
    pub reason: Option<String>,
    /// Metrics of a finished run; empty otherwise, since numbers of half a run mislead.
    pub metrics: Vec<Metric>,
    /// What was expected of its record.
    pub expectations: Vec<Expectation>,
    /// Whether a contact was ever active in it.
    pub contact: bool,
}

impl Row {
    /// Value of a metric.
    pub fn value(&self, metric: &str) -> Option<f64> {
        self.metrics.iter().find(|m| m.name == metric)?.value
    }
}
