//! Metrics of a column in the first contact episode.
//!
//! The roughness of a column is TV/(2·range) − 1 over the first contact episode, from the row
//! before it to the row that ends it: TV is Σ|xᵢ₊₁ − xᵢ|, range is max − min. It is 0 for a single
//! hump that returns to its initial value, −1/2 for a monotonic column, and k − 1 for a column that
//! passes k times up and down through its whole range. It is computed from rows, so variation
//! between the rows of a coarse `history_every` is not included.

use super::given::Given;
use super::samples::{extreme, integral, peak_mean, total_variation};

/// Roughness of a column in the first contact episode; none without an episode or for a constant.
pub(super) fn column_roughness(given: &Given) -> Option<f64> {
    let values = given.values()?.get(given.rows()?)?;
    let range = extreme(values, f64::gt)?.1 - extreme(values, f64::lt)?.1;
    (range > 0.0).then(|| total_variation(values) / (2.0 * range) - 1.0)
}

/// Largest absolute mean of a column over a window of 1/16 of the first episode, with the
/// trapezoidal rule between rows.
pub(super) fn peak_of_means(given: &Given) -> Option<f64> {
    let times = given.history.times();
    peak_mean(times, &[&integral(times, given.values()?)], given.window()?)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Column, History};

    fn history(probe: Vec<f64>) -> History {
        let rows = probe.len();
        let active = (0..rows).map(|i| f64::from(i > 0 && i + 1 < rows)).collect();
        let column = |name: &str| Column {
            name: name.into(),
            unit: String::new(),
            description: String::new(),
            integer: false,
        };
        let names = ["time", "active", "B.s"].map(column).to_vec();
        History::new(names, vec![(0..rows).map(|i| i as f64).collect(), active, probe])
    }

    /// Stress −32 in every row in contact, rows 1 to 32 of 34, except 32 in the middle row; windows
    /// of two rows. The mean is −32 without the middle row, and 0 across it.
    #[test]
    fn mean_peaks_by_hand() {
        let mut values = vec![-32.0; 34];
        values[17] = 32.0;
        let history = history(values);
        assert_eq!(peak_of_means(&Given::of(&history).with_column("B.s")), Some(32.0));
    }

    /// By hand: one hump, a ramp, and three humps through the whole range.
    #[test]
    fn roughness_counts_humps() {
        let of = |values: &[f64]| column_roughness(&Given::of(&history(values.to_vec())).with_column("B.s"));
        assert_eq!(of(&[0.0, -1.0, -4.0, -2.0, 0.0]), Some(0.0));
        assert_eq!(of(&[0.0, 1.0, 2.0, 5.0]), Some(-0.5));
        assert_eq!(of(&[0.0, 1.0, 0.0, 1.0, 0.0, 1.0, 0.0]), Some(2.0));
        assert_eq!(of(&[1.0; 5]), None);
        assert_eq!(column_roughness(&Given::of(&history(vec![0.0; 5])).with_column("C")), None);
    }
}
