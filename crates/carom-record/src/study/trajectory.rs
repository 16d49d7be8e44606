//! The part of a run that is compared with a reference.

use std::collections::BTreeMap;

use crate::Run;
use crate::metrics::{self, Metric};

/// The part of a run that is used for comparisons.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Trajectory {
    /// Times of the rows.
    pub times: Vec<f64>,
    /// Columns of probes and of the striker's centre, and [`FORCE`], the magnitude of the contact
    /// force.
    pub columns: BTreeMap<String, Vec<f64>>,
    /// Metrics of the run.
    pub metrics: Vec<Metric>,
}

/// Column name of the magnitude of the contact force.
pub const FORCE: &str = "contact force";

impl Trajectory {
    /// Extracts the trajectory from a record.
    pub fn of(run: &Run, metrics: &[Metric]) -> Self {
        let history = &run.history;
        let mut names: Vec<String> = metrics::probe_columns(run).into_iter().map(str::to_owned).collect();
        if let Some(striker) = metrics::striker(history) {
            names.extend(["x", "y"].map(|axis| format!("{striker}.center_{axis}")));
        }
        let columns = names.into_iter().filter_map(|name| {
            let values = history.column(&name)?.to_vec();
            Some((name, values))
        });
        let mut columns: BTreeMap<_, _> = columns.collect();
        columns.insert(FORCE.to_owned(), metrics::contact_force(history));
        Self { times: history.times().to_vec(), columns, metrics: metrics.to_vec() }
    }

    pub(super) fn value(&self, metric: &str) -> Option<f64> {
        self.metrics.iter().find(|m| m.name == metric)?.value
    }
}
