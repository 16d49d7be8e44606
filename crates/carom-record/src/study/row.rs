//! Results of an arm: a row of the tables.

use std::path::Path;

use super::arm::Arm;
use crate::metrics::{self, MUCH_CREATED, Metric, Overlay};
use crate::{Expectation, RecordError, Run, Status, Warning, judge};

/// Results of an arm.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Row {
    /// Name of the arm.
    pub name: String,
    /// Status of the run; none if it has not started, or if its record is damaged.
    pub status: Option<Status>,
    /// Why the run did not finish, or how its record is damaged and what to do about it.
    pub reason: Option<String>,
    /// Metrics of a finished run; empty otherwise, because those of an unfinished run would be
    /// misleading.
    pub metrics: Vec<Metric>,
    /// Outcomes of the expectations of the arm.
    pub expectations: Vec<Expectation>,
    /// Whether the run had dynamic contact.
    pub contact: bool,
    /// Warnings of the run.
    pub warnings: Vec<Warning>,
}

impl Row {
    /// The results of an arm from its record.
    pub(super) fn of(arm: &Arm, run: &Run, measured: &[Overlay]) -> Self {
        let manifest = &run.manifest;
        let has_metrics = manifest.status == Status::Finished;
        Self {
            name: arm.name.clone(),
            status: Some(manifest.status),
            reason: manifest.reason.clone(),
            metrics: if has_metrics { metrics::of_run_beside(run, measured) } else { Vec::new() },
            expectations: judge(run, &arm.facts.expects),
            contact: run.had_dynamic_contact(),
            warnings: manifest.warnings.clone(),
        }
    }

    /// An arm whose record is damaged.
    pub(super) fn damaged(arm: &Arm, error: &RecordError, study: &Path) -> Self {
        let place = study.join(&arm.directory);
        let reason = format!("{}; remove {} and compute the arm again", error.what(), place.display());
        Self { name: arm.name.clone(), reason: Some(reason), ..Self::default() }
    }

    /// Whether the arm failed, or created so much energy that the default guard would have stopped
    /// it.
    pub fn is_unsound(&self) -> bool {
        self.status == Some(Status::Failed)
            || self.value("energy_created").is_some_and(|share| share > MUCH_CREATED)
    }

    /// Whether the record of the arm is damaged.
    pub fn is_damaged(&self) -> bool {
        self.status.is_none() && self.reason.is_some()
    }

    /// Whether the arm has finished or failed.
    pub fn has_ended(&self) -> bool {
        matches!(self.status, Some(Status::Finished | Status::Failed))
    }

    /// Whether all its results are those of another run, to the last bit; measured times differ
    /// from run to run.
    pub fn is_twin(&self, other: &Self) -> bool {
        let results = |row: &Self| -> Vec<(String, Option<u64>)> {
            let kept = row.metrics.iter().filter(|metric| !metric.is_measured());
            kept.map(|metric| (metric.name.to_string(), metric.value.map(f64::to_bits))).collect()
        };
        let own = results(self);
        own.iter().any(|(_, value)| value.is_some()) && own == results(other)
    }

    /// Value of a metric.
    pub fn value(&self, metric: &str) -> Option<f64> {
        self.metrics.iter().find(|m| m.name == metric)?.value
    }
}
