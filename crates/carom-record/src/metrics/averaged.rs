//! Metrics after the contact force and the columns of probes have been averaged over a short time:
//! twice the window over which a study averages, by default 1/8 of the first contact episode, or of
//! the record without an episode that ends. Extremes and roughness of a smooth signal hardly change
//! by that. Behind a jump, such as a wave front, a computed signal overshoots by a fraction of the
//! jump on every mesh (Gibbs), so that these metrics converge under refinement, but to wrong
//! values; averaging removes most of the overshoot. What it changes is therefore a part of their
//! uncertainty, and of that of largest means over the window itself.

use super::definition::Metric;
use super::episode::{WINDOWS, first_episode};
use super::evaluated::{of_columns, of_history, probe_columns};
use super::given::{Given, is_of_itself};
use super::samples::{at, integral};
use crate::{History, Run};

/// Metrics of the contact force that depend on few rows.
pub const OF_FORCE: [&str; 4] = ["peak_force", "peak_mean_force", "force_roughness", "force_high_frequency"];
/// Metrics of a column that depend on few rows.
pub const OF_COLUMN: [&str; 5] = ["min", "max", "roughness", "peak_mean", "high_frequency"];

/// The metrics that depend on few rows, of the averaged record; `window`: that of the study, if it
/// is given.
pub fn of_averages(run: &Run, window: Option<f64>) -> Vec<Metric> {
    let history = &run.history;
    let times = history.times();
    let of_contact = || first_episode(history).and_then(|episode| episode.window(times));
    let of_record =
        || (times.last().copied().unwrap_or(0.0) - times.first().copied().unwrap_or(0.0)) / WINDOWS;
    let window = 2.0 * window.or_else(of_contact).unwrap_or_else(of_record);
    let probes = probe_columns(run);
    let contacts = &run.manifest.facts.contacts;
    let is_force = |name: &str| {
        let of_contact = name.rsplit_once(".force_").map(|(contact, _)| contact);
        // Means of the force come from its impulse.
        let is_of_all = ["contact_force_", "contact_impulse_"].iter().any(|of| name.starts_with(of));
        is_of_all || contacts.iter().any(|of| of_contact == Some(&of.name))
    };
    let averaged = averaged(history, window, |name| is_force(name) || probes.contains(&name));
    let mut metrics: Vec<Metric> = of_history(&Given::of_changed(run, &averaged)).collect();
    // The normal forces of a side with itself are in no column.
    let is_averaged = !contacts.iter().any(is_of_itself);
    metrics.retain(|metric| is_averaged && OF_FORCE.contains(&metric.name.as_ref()));
    for column in probes {
        let of_rows = |name: &str| OF_COLUMN.iter().any(|what| name.ends_with(&format!(":{what}")));
        metrics.extend(of_columns(&averaged, column).into_iter().filter(|metric| of_rows(&metric.name)));
    }
    metrics
}

/// A history with some columns replaced by their means from t − w/2 to t + w/2, or to the ends of
/// the record, with the trapezoidal rule between rows.
pub fn averaged(history: &History, window: f64, of: impl Fn(&str) -> bool) -> History {
    let times = history.times();
    let first = times.first().copied().unwrap_or(0.0);
    let last = times.last().copied().unwrap_or(0.0);
    let mean = |values: &[f64]| -> Vec<f64> {
        let integral = integral(times, values);
        let around = |(&time, &value): (&f64, &f64)| {
            let from = (time - window / 2.0).max(first);
            let to = (time + window / 2.0).min(last);
            let change = at(times, &integral, to).zip(at(times, &integral, from)).map(|(b, a)| b - a);
            change.filter(|_| to > from).map_or(value, |change| change / (to - from))
        };
        times.iter().zip(values).map(around).collect()
    };
    let columns = history.columns.iter().zip(&history.values);
    let values = columns.map(|(column, values)| if of(&column.name) { mean(values) } else { values.clone() });
    History::new(history.columns.clone(), values.collect())
}
