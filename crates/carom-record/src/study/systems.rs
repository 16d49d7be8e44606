//! Arms in different systems of units, compared in the units of the first one: equal motions have
//! equal numbers.

use std::collections::BTreeSet;

use serde_json::Value;

use super::arm::Arm;
use super::manifest::StudyManifest;
use super::row::Row;
use crate::units::{self, Labels};
use crate::{History, Run};

/// Labels of length, time and mass of an arm.
fn system(arm: &Arm) -> [String; 3] {
    let units = arm.case.get("units");
    let label = |name: &str| units?.get(name).and_then(Value::as_str).map(str::to_owned);
    ["length", "time", "mass"].map(|name| label(name).unwrap_or_default())
}

/// The labels of all units of a system, in an order.
fn labels([length, time, mass]: &[String; 3]) -> Vec<String> {
    let Labels {
        time,
        length,
        velocity,
        acceleration,
        force,
        moment,
        momentum,
        angular_momentum,
        energy,
        stress,
        none,
    } = Labels::of(length, time, mass);
    let rate = format!("1/{time}");
    let of_motion = [time, rate, length, velocity, acceleration];
    let of_force = [force, moment, momentum, angular_momentum, energy, stress, none];
    of_motion.into_iter().chain(of_force).collect()
}

/// Systems of units of the arms, and the one that they are converted to.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Systems {
    /// Labels of length, time and mass of each run, those of the first arm first.
    of_runs: Vec<[String; 3]>,
    /// Units without a known factor.
    unknown: BTreeSet<String>,
}

impl Systems {
    /// The systems of the runs of a study.
    pub fn of(manifest: &StudyManifest) -> Self {
        Self { of_runs: manifest.runs().map(system).collect(), unknown: BTreeSet::new() }
    }

    /// Whether a run is in the system of the first arm.
    pub fn is_own(&self, run: usize) -> bool {
        self.of_runs.get(run).is_none_or(|system| *system == self.of_runs[0])
    }

    /// Whether all runs are.
    pub fn is_one(&self) -> bool {
        (0..self.of_runs.len()).all(|run| self.is_own(run))
    }

    /// Converts the columns and metrics of a run; a metric in an unknown unit has no value, and a
    /// column in one is removed. Rows of contacts, whose columns have no units, are removed.
    pub(super) fn convert(&mut self, run: usize, record: &mut Run, row: &mut Row) {
        if self.is_own(run) {
            return;
        }
        let [from, to] = [run, 0].map(|run| labels(&self.of_runs[run]));
        let mut factor = |unit: &mut String| {
            // A label that is no unit of the case, as of seconds of computation, stays as it is.
            let known = from.iter().position(|label| label == unit).filter(|_| !unit.is_empty());
            let Some(known) = known else { return Some(1.0) };
            let factor = units::factor(unit, &to[known]);
            if factor.is_none() {
                self.unknown.insert(unit.clone());
            }
            unit.clone_from(&to[known]);
            factor
        };
        for metric in row.metrics.iter_mut().filter(|metric| !metric.is_measured()) {
            let factor = factor(&mut metric.unit);
            metric.value = metric.value.zip(factor).map(|(value, factor)| value * factor);
        }
        let columns = std::mem::take(&mut record.history.columns).into_iter();
        let values = std::mem::take(&mut record.history.values);
        let kept = columns.zip(values).filter_map(|(mut column, mut values)| {
            let factor = factor(&mut column.unit)?;
            values.iter_mut().for_each(|value| *value *= factor);
            Some((column, values))
        });
        let (columns, values) = kept.unzip();
        record.history = History::new(columns, values);
        record.contact.clear();
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
            "The arms have different systems of units. Figures and tables are in the units of the first \
             arm, {}; claims and expectations refer to the numbers of each record.{left_out}",
            self.of_runs[0].join(", ")
        ))
    }
}
