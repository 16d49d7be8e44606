//! Arms in different systems of units, compared in the units of the first one: equal motions have
//! equal numbers.

use std::collections::{BTreeMap, BTreeSet};

use serde_json::Value;

use super::arm::Arm;
use super::manifest::StudyManifest;
use super::row::Row;
use crate::{History, Run, units};

/// Labels of length, time and mass of an arm.
fn system(arm: &Arm) -> [String; 3] {
    let units = arm.case.get("units");
    let label = |name: &str| units?.get(name).and_then(Value::as_str).map(str::to_owned);
    ["length", "time", "mass"].map(|name| label(name).unwrap_or_default())
}

/// Systems of units of the arms, and the one that they are converted to.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Systems {
    /// Whether each run is in the system of the first arm.
    own: Vec<bool>,
    first: [String; 3],
    /// Units of columns and metrics by name, of the first run that has them.
    known: BTreeMap<String, String>,
    /// Units without a known factor.
    unknown: BTreeSet<String>,
}

impl Systems {
    /// The systems of the runs of a study.
    pub fn of(manifest: &StudyManifest) -> Self {
        let first = manifest.arms.first().map(system).unwrap_or_default();
        let own = manifest.runs().map(|arm| system(arm) == first).collect();
        Self { own, first, ..Self::default() }
    }

    /// Whether a run is in the system of the first arm.
    pub fn is_own(&self, run: usize) -> bool {
        self.own.get(run).is_none_or(|own| *own)
    }

    /// Whether all runs are.
    pub fn is_one(&self) -> bool {
        self.own.iter().all(|own| *own)
    }

    /// Factor of the values of a quantity of a run; none if its unit is not known. What no run
    /// before has keeps its unit.
    fn factor(&mut self, run: usize, name: &str, unit: &mut String) -> Option<f64> {
        let to = self.known.entry(name.to_owned()).or_insert_with(|| unit.clone());
        if self.own.get(run).is_none_or(|own| *own) {
            return Some(1.0);
        }
        let factor = units::factor(unit, to);
        if factor.is_none() {
            self.unknown.insert(unit.clone());
        }
        unit.clone_from(to);
        factor
    }

    /// Converts the columns and metrics of a run; a metric in an unknown unit has no value, and a
    /// column in one is removed. Rows of contacts, whose columns have no units, are removed.
    pub(super) fn convert(&mut self, run: usize, record: &mut Run, row: &mut Row) {
        if self.is_one() {
            return;
        }
        for metric in &mut row.metrics {
            let factor = self.factor(run, &metric.name, &mut metric.unit);
            metric.value = metric.value.zip(factor).map(|(value, factor)| value * factor);
        }
        let columns = std::mem::take(&mut record.history.columns).into_iter();
        let kept =
            columns.zip(std::mem::take(&mut record.history.values)).filter_map(|(mut column, mut values)| {
                let factor = self.factor(run, &column.name, &mut column.unit)?;
                if factor != 1.0 {
                    values.iter_mut().for_each(|value| *value *= factor);
                }
                Some((column, values))
            });
        let (columns, values) = kept.unzip();
        record.history = History::new(columns, values);
        if !self.is_own(run) {
            record.contact.clear();
        }
    }

    /// Words for the page; nothing where all arms have one system.
    pub fn words(&self) -> Option<String> {
        if self.is_one() {
            return None;
        }
        let unknown: Vec<&str> = self.unknown.iter().map(String::as_str).collect();
        let left_out = match &unknown[..] {
            [] => String::new(),
            units => format!(" Values in units that are not known are left out: {}.", units.join(", ")),
        };
        Some(format!(
            "The arms have different systems of units. All values are in the units of the first arm, \
             {}.{left_out}",
            self.first.join(", ")
        ))
    }
}
