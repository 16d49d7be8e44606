//! What a study compares besides the metrics of the history: extremes and roughness of every probe's column, and the work done.
//!
//! Roughness of a column = TV/(2·range) − 1 over the first contact episode, from the row before it to the row that ends it: TV is
//! Σ|xᵢ₊₁ − xᵢ|, range is max − min. One hump that ends where it began has 0, a monotone column −1/2, one that goes up and down k
//! times through its whole range k − 1. It sees rows, not steps: a coarser `history_every` hides what lies between them.

use super::{Metric, all, extreme, first_episode, of_pressure, total_variation};
use crate::{History, Run};

/// Metrics of the work, with definitions.
pub const WORK_DEFINITIONS: [(&str, &str); 4] = [
    ("steps", "time steps of the grid done"),
    ("newton_iterations", "Newton iterations of all steps"),
    ("rejected_steps", "steps that were rejected and bisected"),
    ("wall_time", "wall seconds of all processes that computed the run, output included"),
];

/// Metrics of a probe's column `C`, called `C:min` and so on.
pub const COLUMN_DEFINITIONS: [(&str, &str); 3] = [
    ("min", "smallest recorded value of the column"),
    ("max", "largest recorded value of the column"),
    ("roughness", "total variation over twice the range, minus 1, in the first contact episode: 0 for one hump"),
];

/// Roughness of a column in the first contact episode; none without one, or for a constant.
pub fn column_roughness(history: &History, column: &str) -> Option<f64> {
    let episode = first_episode(history)?;
    let values = history.column(column)?;
    let values = values.get(episode.start.saturating_sub(1)..episode.end.map_or(values.len(), |end| end + 1))?;
    let range = extreme(values, f64::gt)?.1 - extreme(values, f64::lt)?.1;
    (range > 0.0).then(|| total_variation(values) / (2.0 * range) - 1.0)
}

/// Names of the columns of the probes, in the order of the history.
pub fn probe_columns(run: &Run) -> Vec<&str> {
    let probes = run.manifest.case.get("probes").and_then(|p| p.as_array());
    let names: Vec<&str> = probes.into_iter().flatten().filter_map(|p| p.get("name")?.as_str()).collect();
    let columns = run.history.columns.iter().map(|c| c.name.as_str());
    columns.filter(|c| c.rsplit_once('.').is_some_and(|(probe, _)| names.contains(&probe))).collect()
}

/// Everything a study tabulates: [`all`], the pressure at the end of a static run, then the columns of the probes, then the work.
pub fn of_run(run: &Run) -> Vec<Metric> {
    let history = &run.history;
    let mut metrics = all(history);
    metrics.extend(of_pressure(run));
    for column in probe_columns(run) {
        for (what, definition) in COLUMN_DEFINITIONS {
            let values = history.column(column).unwrap_or_default();
            let (value, unit) = match what {
                "min" => (extreme(values, f64::lt).map(|x| x.1), history.unit(column)),
                "max" => (extreme(values, f64::gt).map(|x| x.1), history.unit(column)),
                _ => (column_roughness(history, column), ""),
            };
            metrics.push(Metric { name: format!("{column}:{what}").into(), value, unit: unit.into(), definition });
        }
    }
    let count = |name: &str| run.manifest.counters.get(name).map(|&n| n as f64);
    for (name, definition) in WORK_DEFINITIONS {
        let (value, unit) = match name {
            "steps" => (count("steps"), ""),
            "newton_iterations" => (count("newton"), ""),
            "rejected_steps" => (count("rejected"), ""),
            _ => (run.manifest.timings.get("total").copied(), "s"),
        };
        metrics.push(Metric { name: name.into(), value, unit: unit.into(), definition });
    }
    metrics
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Column;

    fn history(probe: Vec<f64>) -> History {
        let rows = probe.len();
        let active = (0..rows).map(|i| f64::from(i > 0 && i + 1 < rows)).collect();
        let column =
            |name: &str| Column { name: name.into(), unit: String::new(), description: String::new(), integer: false };
        let names = ["time", "active", "B.s"].map(column).to_vec();
        History::new(names, vec![(0..rows).map(|i| i as f64).collect(), active, probe])
    }

    /// By hand: one hump, a ramp, and three humps through the whole range.
    #[test]
    fn roughness_counts_humps() {
        let of = |values: &[f64]| column_roughness(&history(values.to_vec()), "B.s");
        assert_eq!(of(&[0.0, -1.0, -4.0, -2.0, 0.0]), Some(0.0));
        assert_eq!(of(&[0.0, 1.0, 2.0, 5.0]), Some(-0.5));
        assert_eq!(of(&[0.0, 1.0, 0.0, 1.0, 0.0, 1.0, 0.0]), Some(2.0));
        assert_eq!(of(&[1.0; 5]), None);
        assert_eq!(column_roughness(&history(vec![0.0; 5]), "C"), None);
    }
}
