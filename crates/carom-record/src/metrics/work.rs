//! What a study compares besides the metrics of the history: extremes and roughness of every probe's column, and the work done.
//!
//! Roughness of a column = TV/(2·range) − 1 over the first contact episode, from the row before it to the row that ends it: TV is
//! Σ|xᵢ₊₁ − xᵢ|, range is max − min. One hump that ends where it began has 0, a monotone column −1/2, one that goes up and down k
//! times through its whole range k − 1. It sees rows, not steps: a coarser `history_every` hides what lies between them.

use super::{
    COLUMNS, Definition, FREE, Metric, PRESSURE, Unit, WORK, all, default_bridge, energy_lost_at, episodes, extreme,
    first_episode, total_variation,
};
use crate::{History, Run};

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

/// Impacts whose energy a study tabulates one by one.
const IMPACTS: usize = 9;

/// Everything a study tabulates: [`all`], the energy lost at each of the first impacts where there are several, the pressure at the end of a static run,
/// then the columns of the probes, then the work.
pub fn of_run(run: &Run) -> Vec<Metric> {
    let history = &run.history;
    let mut metrics = all(history);
    let impacts = episodes(history, default_bridge(history)).len().min(IMPACTS);
    for n in 1..=if impacts > 1 { impacts } else { 0 } {
        let definition = "energy lost over the N-th episode of contact / largest kinetic + strain energy";
        let value = energy_lost_at(history, n);
        metrics.push(Metric { name: format!("energy_lost:{n}").into(), value, unit: String::new(), definition });
    }
    for (definition, value) in PRESSURE.iter().filter_map(|(d, value)| Some((d, value(run)?))) {
        let (name, unit) = (definition.name.into(), definition.unit.label(history));
        metrics.push(Metric { name, value: Some(value), unit, definition: definition.meaning });
    }
    for column in probe_columns(run) {
        for (Definition { name, unit, meaning, .. }, value) in &COLUMNS {
            let unit = if *unit == Unit::Column { history.unit(column).to_owned() } else { String::new() };
            let name = format!("{column}:{name}").into();
            metrics.push(Metric { name, value: value(history, column), unit, definition: meaning });
        }
        for (definition, value) in FREE.iter().filter_map(|(d, value)| Some((d, value(history, column)?))) {
            let (name, unit) = (format!("{column}:{}", definition.name).into(), definition.unit.label(history));
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
    use crate::Column;

    fn history(probe: Vec<f64>) -> History {
        let rows = probe.len();
        let active = (0..rows).map(|i| f64::from(i > 0 && i + 1 < rows)).collect();
        let column =
            |name: &str| Column { name: name.into(), unit: String::new(), description: String::new(), integer: false };
        let names = ["time", "active", "B.s"].map(column).to_vec();
        History::new(names, vec![(0..rows).map(|i| i as f64).collect(), active, probe])
    }

    /// Stress −32 in every row of contact, rows 1 to 32 of 34, but 32 in the middle one: windows of two rows. The mean over rows without it is −32; across it
    /// the trapezoids are 0.
    #[test]
    fn mean_peaks_by_hand() {
        let mut values = vec![-32.0; 34];
        values[17] = 32.0;
        let history = history(values);
        let (_, value) = crate::metrics::of_column(&history, "B.s", "peak_mean").unwrap();
        assert_eq!(value, Some(32.0));
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
