//! Metrics of a record: of its history, of one of its columns, and all metrics that a study
//! tabulates for a run.

use super::definition::{Definition, Metric, Unit};
use super::episode::{default_bridge, episodes};
use super::facts::Facts;
use super::ledger::energy_lost_at;
use super::overlay::{OVERLAY, Overlay, overlays};
use super::run_table::{PRESSURE, REBOUND, WORK};
use super::table::{COLUMNS, FREE, HISTORY};
use crate::{History, Run};

/// Every named metric of a history, in the order of [`HISTORY`].
pub fn all(history: &History) -> Vec<Metric> {
    let facts = Facts::of(history);
    let metric = |(definition, value): &(Definition, fn(&Facts) -> Option<f64>)| Metric {
        name: definition.name.into(),
        value: value(&facts),
        unit: definition.unit.label(history),
        definition: definition.meaning,
    };
    HISTORY.iter().map(metric).collect()
}

impl Metric {
    /// Whether it is one of the computational work, which says nothing about the solution.
    pub fn is_work(&self) -> bool {
        WORK.iter().any(|(definition, _)| definition.name == self.name)
    }

    /// Whether it is a measured time, which differs from run to run.
    pub fn is_measured(&self) -> bool {
        WORK.iter().any(|(definition, _)| definition.name == self.name && definition.unit == Unit::Second)
    }
}

/// Definition and value of a metric of a column; none if there is no such metric.
pub fn of_column(history: &History, column: &str, what: &str) -> Option<(&'static Definition, Option<f64>)> {
    let (definition, value) = COLUMNS.iter().chain(&FREE).find(|(d, _)| d.name == what)?;
    Some((definition, value(history, column)))
}

/// The metrics of [`COLUMNS`] of a column, named `COLUMN:METRIC`.
pub(crate) fn of_columns(history: &History, column: &str) -> Vec<Metric> {
    let metric = |(definition, value): &(Definition, fn(&History, &str) -> Option<f64>)| Metric {
        name: format!("{column}:{}", definition.name).into(),
        value: value(history, column),
        unit: match definition.unit {
            Unit::Column => history.unit(column).to_owned(),
            _ => String::new(),
        },
        definition: definition.meaning,
    };
    COLUMNS.iter().map(metric).collect()
}

/// The metrics of measured data, named `METRIC:NAME`.
pub fn of_measured(history: &History, overlay: &Overlay) -> Vec<Metric> {
    let metric = |(definition, value): &(Definition, fn(&History, &Overlay) -> Option<f64>)| Metric {
        name: format!("{}:{}", definition.name, overlay.name).into(),
        value: value(history, overlay),
        unit: match definition.unit {
            Unit::Column => history.unit(&overlay.column).to_owned(),
            other => other.label(history),
        },
        definition: definition.meaning,
    };
    OVERLAY.iter().map(metric).collect()
}

/// Names of the columns of the probes, in the order of the history.
pub fn probe_columns(run: &Run) -> Vec<&str> {
    let probes = run.manifest.case.get("probes").and_then(|p| p.as_array());
    let names: Vec<&str> = probes.into_iter().flatten().filter_map(|p| p.get("name")?.as_str()).collect();
    let columns = run.history.columns.iter().map(|c| c.name.as_str());
    columns.filter(|c| c.rsplit_once('.').is_some_and(|(probe, _)| names.contains(&probe))).collect()
}

/// Largest number of impacts whose energy loss a study tabulates one by one.
const IMPACTS: usize = 9;

/// The metrics of [`REBOUND`].
pub fn of_rebound(run: &Run) -> Vec<Metric> {
    let metric = |(definition, value): &(Definition, fn(&Run) -> Option<f64>)| Metric {
        name: definition.name.into(),
        value: value(run),
        unit: definition.unit.label(&run.history),
        definition: definition.meaning,
    };
    REBOUND.iter().map(metric).collect()
}

/// All metrics that a study tabulates: [`all`], [`of_rebound`], the energy lost in each of the
/// first impacts if there are several, the pressure at the end of a static run, differences from
/// measured data, the columns of the probes, and the work.
pub fn of_run(run: &Run) -> Vec<Metric> {
    of_run_beside(run, &[])
}

/// [`of_run`] with differences from these measured data too, of columns that the run has.
pub fn of_run_beside(run: &Run, measured: &[Overlay]) -> Vec<Metric> {
    let history = &run.history;
    let mut metrics = all(history);
    metrics.extend(of_rebound(run));
    let impacts = episodes(history, default_bridge(history)).len().min(IMPACTS);
    for n in 1..=if impacts > 1 { impacts } else { 0 } {
        let definition =
            "energy lost over the N-th contact episode, divided by the largest kinetic + strain energy";
        let value = energy_lost_at(history, n);
        metrics.push(Metric {
            name: format!("energy_lost:{n}").into(),
            value,
            unit: String::new(),
            definition,
        });
    }
    for (definition, value) in PRESSURE.iter().filter_map(|(d, value)| Some((d, value(run)?))) {
        let (name, unit) = (definition.name.into(), definition.unit.label(history));
        metrics.push(Metric { name, value: Some(value), unit, definition: definition.meaning });
    }
    let measured = measured.iter().filter(|overlay| history.column(&overlay.column).is_some());
    metrics.extend(overlays(run).iter().chain(measured).flat_map(|overlay| of_measured(history, overlay)));
    for column in probe_columns(run) {
        metrics.extend(of_columns(history, column));
        for (definition, value) in FREE.iter().filter_map(|(d, value)| Some((d, value(history, column)?))) {
            let (name, unit) =
                (format!("{column}:{}", definition.name).into(), definition.unit.label(history));
            metrics.push(Metric { name, value: Some(value), unit, definition: definition.meaning });
        }
    }
    for (definition, value) in &WORK {
        let (unit, value) = (definition.unit.label(history), value(run));
        metrics.push(Metric { name: definition.name.into(), value, unit, definition: definition.meaning });
    }
    metrics
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_and_counts_are_work() {
        let is_work = |name: &'static str| {
            Metric { name: name.into(), value: None, unit: String::new(), definition: "" }.is_work()
        };
        let work =
            ["steps", "newton_iterations", "rejected_steps", "factorisations", "cpu_time", "wall_time"];
        assert!(work.into_iter().all(is_work));
        assert!(!is_work("chatter") && !is_work("energy_lost:1") && !is_work("A.ux:max"));
    }
}
