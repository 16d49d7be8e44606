//! Metrics after the contact force and the columns of probes have been averaged over a short time:
//! twice the window over which a study averages, by default 1/8 of the first contact episode. In a
//! record without an episode that ends it is 1/8 of the period of a column, or of the record if
//! that is shorter. Extremes and roughness of a smooth signal hardly change by that. Behind a jump,
//! such as a wave front, a computed signal overshoots by a fraction of the jump on every mesh
//! (Gibbs), so that these metrics converge under refinement, but to wrong values; averaging removes
//! most of the overshoot. What it changes is therefore a part of their uncertainty. Largest means
//! over a window keep a part of the overshoot, and are averaged, too.

use super::definition::Metric;
use super::episode::{WINDOWS, first_episode};
use super::evaluated::{of_columns, of_history, probe_columns};
use super::given::{Given, is_of_itself};
use super::samples::{at, integral};
use crate::{Column, History, Run};

/// Metrics of the contact force that depend on few rows.
pub const OF_FORCE: [&str; 4] = ["peak_force", "peak_mean_force", "force_roughness", "force_high_frequency"];
/// Metrics of a column that depend on few rows.
pub const OF_COLUMN: [&str; 5] = ["min", "max", "roughness", "peak_mean", "high_frequency"];

/// The metrics that depend on few rows, of the averaged record; `window`: that of the study, if it
/// is given.
pub fn of_averages(run: &Run, window: Option<f64>) -> Vec<Metric> {
    let history = &run.history;
    let times = history.times();
    let window = window.or_else(|| first_episode(history)?.window(times));
    let probes = probe_columns(run);
    let contacts = &run.manifest.facts.contacts;
    let is_force = |name: &str| {
        let of_contact = name.rsplit_once(".force_").map(|(contact, _)| contact);
        // Means of the force come from its impulse.
        let is_of_all = ["contact_force_", "contact_impulse_"].iter().any(|of| name.starts_with(of));
        is_of_all || contacts.iter().any(|of| of_contact == Some(&of.name))
    };
    let averaged = averaged(history, |name, values| {
        let counts = is_force(name) || probes.contains(&name);
        counts.then(|| 2.0 * window.unwrap_or_else(|| period(times, values) / WINDOWS))
    });
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

/// Twice the time between two passages of the mean value of a column on average; at most the time
/// of the record.
pub fn period(times: &[f64], values: &[f64]) -> f64 {
    let duration = times.last().copied().unwrap_or(0.0) - times.first().copied().unwrap_or(0.0);
    let mean = integral(times, values).last().copied().unwrap_or(0.0) / duration;
    let passages = values.windows(2).filter(|pair| (pair[0] < mean) != (pair[1] < mean)).count();
    2.0 * duration / passages.max(2) as f64
}

/// A history with some columns replaced by their means from t − w/2 to t + w/2, with a shorter
/// window about the same instant beside the ends of the record, and with the trapezoidal rule
/// between rows. `window`: w of a column and its values, if it is replaced.
pub fn averaged(history: &History, window: impl Fn(&str, &[f64]) -> Option<f64>) -> History {
    let times = history.times();
    let first = times.first().copied().unwrap_or(0.0);
    let last = times.last().copied().unwrap_or(0.0);
    let mean = |values: &[f64], window: f64| -> Vec<f64> {
        let integral = integral(times, values);
        let around = |(&time, &value): (&f64, &f64)| {
            let half = (window / 2.0).min(time - first).min(last - time);
            let change = at(times, &integral, time + half).zip(at(times, &integral, time - half));
            let change = change.map(|(after, before)| after - before);
            change.filter(|_| half > 0.0).map_or(value, |change| change / (2.0 * half))
        };
        times.iter().zip(values).map(around).collect()
    };
    let columns = history.columns.iter().zip(&history.values);
    let of_column = |(column, values): (&Column, &Vec<f64>)| match window(&column.name, values) {
        Some(window) => mean(values, window),
        None => values.clone(),
    };
    History::new(history.columns.clone(), columns.map(of_column).collect())
}
