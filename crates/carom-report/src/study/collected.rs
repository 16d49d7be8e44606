//! Data for the page of a study from the records of its arms: columns, thinned, and the origin of
//! each record.

use std::ops::Range;

use carom_record::Run;
use carom_record::metrics::{Metric, Overlay, contact_force, probe_columns};
use carom_record::study::Study;
use carom_record::study::checks::fingerprint;
use carom_record::study::reference::FORCE;
use maud::{Markup, html};

use crate::digits::five;
use crate::labels::{is_stress, symbol, words};
use crate::measured::measured_label;
use crate::noise;
use crate::ordered::distinct;
use crate::plot::{Curve, Drawn};
use crate::text::Label;
use crate::trace::ends_and_extremes;

/// Columns shown besides those of the probes: name, label, caption.
const OTHERS: [(&str, &str, &str); 5] = [
    (FORCE, "|F|", "magnitude of the contact force"),
    ("contact_impulse_x", "P_{x}", "contact impulse in x direction"),
    ("contact_impulse_y", "P_{y}", "contact impulse in y direction"),
    ("contact_impulse_z", "P_{z}", "contact impulse in z direction"),
    ("dissipation", "dissipation", "energy dissipated by the time integrator"),
];

/// A column of all arms, thinned.
pub(super) struct Column {
    pub(super) name: String,
    pub(super) unit: String,
    pub(super) curves: Vec<(usize, Vec<f64>, Vec<f64>)>,
}

/// The origin of the record of an arm.
pub(super) struct Origin {
    /// Number of the arm.
    pub(super) arm: usize,
    /// Hash of its input.
    pub(super) input: String,
    /// Hash of its tables.
    pub(super) record: String,
    /// Rejected steps.
    pub(super) rejected: u64,
    /// Number of fallbacks and cycles of the solver.
    pub(super) fallbacks: usize,
}

impl Origin {
    /// From the record of an arm.
    pub(super) fn of(arm: usize, run: &Run) -> Self {
        let fallback = |kind: &str| ["fallback", "cycle", "no-stress"].contains(&kind);
        let fallbacks = run.log.iter().filter(|e| fallback(&e.kind)).count();
        let rejected = run.manifest.counters.get("rejected").copied().unwrap_or_default();
        let record = fingerprint(&run.directory).unwrap_or_default();
        Self { arm, input: run.manifest.input_hash.clone(), record, rejected, fallbacks }
    }
}

/// The measured data of a study and of the cases of its arms.
pub(super) struct Measured(pub(super) Vec<Overlay>);

impl Measured {
    /// Adds the data that are not known yet.
    pub(super) fn add(&mut self, found: Vec<Overlay>) {
        for overlay in found {
            if !self.0.contains(&overlay) {
                self.0.push(overlay);
            }
        }
    }

    fn of<'a>(&'a self, column: &'a str) -> impl Iterator<Item = &'a Overlay> {
        self.0.iter().filter(move |overlay| overlay.column == column)
    }

    /// The points of a column up to the end of the arms.
    pub(super) fn points(&self, column: &str, end: f64) -> Vec<Curve> {
        let points = |(k, overlay): (usize, &Overlay)| {
            let (x, y) = overlay.within(0.0, end);
            // Colours that are far from those of most arms, of which the first is black.
            let style = [4, 5, 6][k % 3];
            Curve { label: measured_label(overlay), style, x, y, drawn: Drawn::Dots, ..Curve::default() }
        };
        self.of(column).enumerate().map(points).filter(|curve| !curve.x.is_empty()).collect()
    }

    /// Words on measured data for the caption of a column.
    pub(super) fn words(&self, column: &str) -> String {
        let one = |overlay: &Overlay| {
            let source = overlay.source.as_ref().map_or_else(String::new, |source| format!(" ({source})"));
            format!("\u{201c}{}\u{201d}{source}", overlay.name)
        };
        let all: Vec<String> = self.of(column).map(one).collect();
        if all.is_empty() {
            return String::new();
        }
        format!(
            " Points: measured data {}; metrics `overlay_…` are the differences from them.",
            all.join(", ")
        )
    }
}

/// Adds the columns of an arm, measured ones included.
pub(super) fn collect(columns: &mut Vec<Column>, measured: &Measured, arm: usize, run: &Run) {
    let mut put = |name: &str, values: &[f64], unit: &str| {
        let (x, y) = thinned(run.times(), values);
        let curve = (arm, x, y);
        if let Some(column) = columns.iter_mut().find(|column| column.name == name) {
            column.curves.push(curve);
            return;
        }
        columns.push(Column { name: name.to_owned(), unit: unit.to_owned(), curves: vec![curve] });
    };
    let force = contact_force(run);
    if force.iter().any(|f| *f > 0.0) {
        put(FORCE, &force, run.history.unit("contact_force_x"));
    }
    let nonzero = |name: &&str| run.column(name).is_some_and(|c| c.iter().any(|x| *x != 0.0));
    let others = OTHERS[1..].iter().map(|other| other.0).filter(nonzero);
    let probes = probe_columns(run).into_iter().filter(|name| {
        let stress = name.rsplit_once('.').is_some_and(|(_, quantity)| is_stress(quantity));
        !(stress && noise::is_noise(run, name))
    });
    let of_data = measured.0.iter().map(|overlay| overlay.column.as_str());
    for name in distinct(probes.chain(others).chain(of_data)) {
        let Some(values) = run.column(name) else { continue };
        put(name, values, run.history.unit(name));
    }
}

/// A curve thinned to the first, lowest, highest and last point of each of 1600 intervals, more
/// than a figure has pixels.
fn thinned(times: &[f64], values: &[f64]) -> (Vec<f64>, Vec<f64>) {
    const INTERVALS: usize = 1600;
    if times.len() <= 4 * INTERVALS {
        return (times.to_vec(), values.to_vec());
    }
    let kept = intervals(times.len(), INTERVALS).flat_map(|rows| ends_and_extremes(rows, |i| values[i]));
    kept.map(|i| (times[i], values[i])).unzip()
}

/// At most `most` intervals of equal row count.
pub(super) fn intervals(rows: usize, most: usize) -> impl Iterator<Item = Range<usize>> {
    let count = rows.min(most);
    (0..count).map(move |k| k * rows / count..(k + 1) * rows / count)
}

/// The unit of times, from the metrics of the arms; empty before any has finished.
pub(super) fn time_unit(study: &Study) -> &str {
    let times = ["contact_start", "contact_duration", "apex_time"];
    let mut metrics = study.rows.iter().flat_map(|row| &row.metrics);
    metrics.find(|metric| times.contains(&&*metric.name)).map_or("", |metric| &metric.unit)
}

/// The unit of time of all arms; empty if they have several.
pub(super) fn common_time(study: &Study) -> &str {
    if study.systems.is_one() { time_unit(study) } else { "" }
}

/// A time with its unit.
pub(super) fn in_time(study: &Study, value: f64) -> String {
    format!("{} {}", five(value), time_unit(study)).trim_end().to_owned()
}

/// The cells of a metric's name and unit.
pub(super) fn cells_of(metric: &Metric) -> Markup {
    html! { td title=(metric.definition) { code { (metric.name) } } td.unit { (Label(&metric.unit)) } }
}

/// Symbol and description of a column.
pub(super) fn named(column: &str) -> (String, String) {
    match (OTHERS.iter().find(|o| o.0 == column), column.rsplit_once('.')) {
        (Some((_, label, caption)), _) => ((*label).to_string(), (*caption).to_string()),
        (None, Some((probe, quantity))) => {
            (symbol(quantity), format!("{} {} at {probe}", words(quantity), symbol(quantity)))
        }
        _ => (column.to_owned(), column.to_owned()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn thinning_keeps_extremes() {
        let times: Vec<f64> = (0..100_000).map(f64::from).collect();
        let mut values = vec![0.0; times.len()];
        (values[31_234], values[67_890]) = (9.0, -5.0);
        let (x, y) = thinned(&times, &values);
        assert!(x.len() <= 6400 && x.is_sorted() && x[0] == 0.0 && x.last() == Some(&99_999.0));
        assert!(y.contains(&9.0) && y.contains(&-5.0));
    }

    #[test]
    fn intervals_follow_each_other_and_leave_no_row_out() {
        for (rows, most) in [(0, 5), (3, 5), (5, 5), (17, 5), (6401, 3200)] {
            let found: Vec<usize> = intervals(rows, most).flatten().collect();
            assert_eq!(found, (0..rows).collect::<Vec<_>>());
            assert_eq!(intervals(rows, most).count(), rows.min(most));
            assert!(intervals(rows, most).all(|interval| !interval.is_empty()));
        }
    }
}
