//! Metrics of a record: of its history, of one of its columns, and all metrics that a study
//! tabulates for a run.

use std::borrow::Cow;

use super::definition::{Definition, Metric};
use super::given::Given;
use super::ledger::energy_lost_at;
use super::overlay::OVERLAY;
use super::run_table::{PRESSURE, REBOUND, WORK};
use super::table::{COLUMNS, FREE, HISTORY};
use crate::units::Unit;
use crate::{History, Overlay, Run};

/// Metrics that need neither a column nor measured data.
pub(crate) fn of_no_column() -> impl Iterator<Item = &'static Definition> {
    HISTORY.iter().chain(&REBOUND).chain(&PRESSURE).chain(&WORK)
}

/// Metrics of a column.
pub(crate) fn of_any_column() -> impl Iterator<Item = &'static Definition> {
    COLUMNS.iter().chain(&FREE)
}

impl Definition {
    /// The metric with its value: named `COLUMN:METRIC` of a column, `METRIC:NAME` of measured
    /// data.
    fn metric(&self, given: &Given) -> Metric {
        let Definition { name, unit, meaning, value, .. } = self;
        let name = match (given.measured, given.column) {
            (Some(measured), _) => Cow::from(format!("{name}:{}", measured.name)),
            (None, Some(column)) => Cow::from(format!("{column}:{name}")),
            (None, None) => Cow::from(*name),
        };
        let unit = match (unit, given.column) {
            (Unit::Column, Some(column)) => given.history.unit(column).to_owned(),
            (unit, _) => unit.label(given.history),
        };
        Metric { name, value: value(given), unit, definition: meaning }
    }
}

fn evaluated(table: &'static [Definition], given: &Given) -> impl Iterator<Item = Metric> {
    table.iter().map(|definition| definition.metric(given))
}

/// Every named metric of a history.
pub fn all(history: &History) -> Vec<Metric> {
    of_history(&Given::of(history)).collect()
}

/// Every named metric of a history, which may be that of a run.
pub(super) fn of_history(given: &Given) -> impl Iterator<Item = Metric> {
    evaluated(&HISTORY, given)
}

impl Metric {
    fn work(&self) -> Option<&'static Definition> {
        WORK.iter().find(|definition| definition.name == self.name)
    }

    /// Whether the metric measures computational work, which says nothing about the solution.
    pub fn is_work(&self) -> bool {
        self.work().is_some()
    }

    /// Whether the metric is a measured time, which differs from run to run.
    pub fn is_measured(&self) -> bool {
        self.work().is_some_and(|definition| definition.unit == Unit::Second)
    }
}

/// The metrics of a column, named `COLUMN:METRIC`.
pub(crate) fn of_columns(history: &History, column: &str) -> Vec<Metric> {
    evaluated(&COLUMNS, &Given::of(history).with_column(column)).collect()
}

/// The metrics of a column, with those of its free oscillation that are defined.
pub(crate) fn of_column(history: &History, column: &str) -> Vec<Metric> {
    of_given_column(&Given::of(history), column).collect()
}

fn of_given_column<'a>(given: &Given<'a>, column: &'a str) -> impl Iterator<Item = Metric> {
    let of_column = given.with_column(column);
    let free: Vec<Metric> = evaluated(&FREE, &of_column).filter(|metric| metric.value.is_some()).collect();
    let all: Vec<Metric> = evaluated(&COLUMNS, &of_column).collect();
    all.into_iter().chain(free)
}

/// The metrics of measured data, named `METRIC:NAME`.
pub fn of_measured(history: &History, overlay: &Overlay) -> Vec<Metric> {
    evaluated(&OVERLAY, &Given::of(history).beside(overlay)).collect()
}

/// Names of the columns of the probes, in the order of the history.
pub fn probe_columns(run: &Run) -> Vec<&str> {
    let is_probe = |name: &str| run.manifest.facts.probes.iter().any(|probe| probe == name);
    let columns = run.history.columns.iter().map(|c| c.name.as_str());
    columns.filter(|c| c.rsplit_once('.').is_some_and(|(probe, _)| is_probe(probe))).collect()
}

/// Largest number of impacts whose energy loss a study tabulates one by one.
const IMPACTS: usize = 9;

/// The metrics of the bodies of the first episode.
pub fn of_rebound(run: &Run) -> Vec<Metric> {
    evaluated(&REBOUND, &Given::of_run(run)).collect()
}

/// All metrics that a study tabulates: [`all`], [`of_rebound`], the energy lost in each of the
/// first impacts if there are several, the pressure at the end of a static run, differences from
/// measured data, the columns of the probes, and the work.
pub fn of_run(run: &Run) -> Vec<Metric> {
    of_run_beside(run, &[])
}

/// [`of_run`] with differences from these measured data too, of columns that the run has.
pub fn of_run_beside(run: &Run, measured: &[Overlay]) -> Vec<Metric> {
    let given = Given::of_run(run);
    let is_defined = |metric: &Metric| metric.value.is_some();
    let mut metrics: Vec<Metric> = of_history(&given).chain(evaluated(&REBOUND, &given)).collect();
    let impacts = given.episodes.len().min(IMPACTS);
    if impacts > 1 && !run.manifest.facts.is_static {
        metrics.extend((1..=impacts).map(|n| Metric {
            name: format!("energy_lost:{n}").into(),
            value: energy_lost_at(&run.history, n),
            unit: String::new(),
            definition: "energy lost over the N-th contact episode, divided by the largest kinetic + strain energy",
        }));
    }
    metrics.extend(evaluated(&PRESSURE, &given).filter(is_defined));
    let measured = measured.iter().filter(|overlay| run.column(&overlay.column).is_some());
    for overlay in run.manifest.facts.overlays.iter().chain(measured) {
        metrics.extend(evaluated(&OVERLAY, &given.beside(overlay)));
    }
    for column in probe_columns(run) {
        metrics.extend(of_given_column(&given, column));
    }
    metrics.extend(evaluated(&WORK, &given));
    metrics
}
