//! Arms in different systems of units, shown in the units of the first one. Without conversion,
//! equal motions would be drawn as different ones.

use std::collections::{BTreeMap, BTreeSet};

use carom_case::Units;
use carom_record::Run;
use carom_record::study::{Arm, Study, StudyManifest};
use carom_record::units;

/// Labels of length, time and mass of an arm.
fn system(arm: &Arm) -> [String; 3] {
    let units = arm.case.get("units").and_then(|units| serde_json::from_value::<Units>(units.clone()).ok());
    units.map(|Units { length, time, mass, .. }| [length, time, mass]).unwrap_or_default()
}

/// Systems of units of the arms, and the one that they are converted to.
#[derive(Default)]
pub(super) struct Systems {
    /// Whether each run is in the system of the first arm.
    own: Vec<bool>,
    first: [String; 3],
    /// Units without a known factor.
    unknown: BTreeSet<String>,
}

impl Systems {
    pub(super) fn of(manifest: &StudyManifest) -> Self {
        let first = manifest.arms.first().map(system).unwrap_or_default();
        let own = manifest.runs().map(|arm| system(arm) == first).collect();
        Self { own, first, unknown: BTreeSet::new() }
    }

    /// Whether a run is in the system of the first arm.
    pub(super) fn is_own(&self, run: usize) -> bool {
        self.own.get(run).is_none_or(|own| *own)
    }

    /// Whether all runs are.
    pub(super) fn is_one(&self) -> bool {
        self.own.iter().all(|own| *own)
    }

    /// Factor of the values of a run.
    pub(super) fn factor(&mut self, run: usize, from: &str, to: &str) -> Option<f64> {
        if self.is_own(run) {
            return Some(1.0);
        }
        let factor = units::factor(from, to);
        if factor.is_none() {
            self.unknown.insert(from.to_owned());
        }
        factor
    }

    /// Factor of the times of a run.
    pub(super) fn of_times(&mut self, arm: usize, run: &Run) -> Option<f64> {
        let to = self.first[1].clone();
        self.factor(arm, run.history.unit("time"), &to)
    }

    /// Converts the metrics of all runs; one in an unknown unit has no value.
    pub(super) fn convert(&mut self, study: &mut Study) {
        if self.is_one() {
            return;
        }
        let runs = || study.rows.iter().chain(&study.members).enumerate();
        let mut known: BTreeMap<String, String> = BTreeMap::new();
        // The first arm decides; where it has no such metric, the next one that has.
        for own in [true, false] {
            for (_, row) in runs().filter(|(run, _)| self.is_own(*run) == own) {
                for metric in &row.metrics {
                    known.entry(metric.name.to_string()).or_insert_with(|| metric.unit.clone());
                }
            }
        }
        for (run, row) in study.rows.iter_mut().chain(&mut study.members).enumerate() {
            for metric in &mut row.metrics {
                let Some(to) = known.get(metric.name.as_ref()) else { continue };
                let factor = self.factor(run, &metric.unit, to);
                metric.value = metric.value.zip(factor).map(|(value, factor)| value * factor);
                metric.unit.clone_from(to);
            }
        }
    }

    /// Words for the page; nothing where all arms have one system.
    pub(super) fn words(&self) -> Option<String> {
        if self.is_one() {
            return None;
        }
        let unknown: Vec<&str> = self.unknown.iter().map(String::as_str).collect();
        let left_out = match &unknown[..] {
            [] => String::new(),
            units => format!(" Values in units that are not known are left out: {}.", units.join(", ")),
        };
        Some(format!(
            "The arms have different systems of units. Figures and tables of this page are in the units of \
             the first arm, {}; the files `study.csv` and `study_tidy.csv` are in those of each arm.{left_out}",
            self.first.join(", ")
        ))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::study::trend::tests::study;
    use serde_json::json;

    /// 1 in = 25.4 mm and 1 lbf = 4.448 222 N (NIST SP 811): the metrics of all arms are those of
    /// the first one; what is not known is left out and named.
    #[test]
    fn metrics_are_converted_to_the_units_of_the_first_arm() {
        let metrics = || vec![("peak", 1.0), ("depth", 1.0), ("restitution", 0.5)];
        let mut study = study(&[("a=1", metrics()), ("a=2", metrics()), ("a=3", metrics())]);
        let units = [["N", "mm"], ["lbf", "in"], ["N", "cubit"]];
        for ((arm, row), units) in study.manifest.arms.iter_mut().zip(&mut study.rows).zip(units) {
            arm.case = json!({ "units": { "length": units[1], "time": "s", "mass": "kg" } });
            row.metrics.iter_mut().zip(units).for_each(|(metric, unit)| metric.unit = unit.into());
        }
        let mut systems = Systems::of(&study.manifest);
        assert!(systems.is_own(0) && !systems.is_own(1) && !systems.is_one());
        systems.convert(&mut study);
        let of = |arm: usize, metric: &str| study.rows[arm].value(metric);
        let near = |x: Option<f64>, published: f64| (x.unwrap() / published - 1.0).abs() < 1e-6;
        assert!(near(of(1, "peak"), 4.448_222) && near(of(1, "depth"), 25.4) && near(of(0, "depth"), 1.0));
        assert_eq!((of(1, "restitution"), of(2, "depth"), of(2, "peak")), (Some(0.5), None, Some(1.0)));
        assert!(study.rows.iter().all(|row| row.metrics[0].unit == "N" && row.metrics[1].unit == "mm"));
        assert!(systems.words().is_some_and(|words| words.ends_with("are left out: cubit.")));
    }
}
