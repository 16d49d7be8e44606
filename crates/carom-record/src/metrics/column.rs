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
pub fn column_roughness(given: &Given) -> Option<f64> {
    let values = given.values()?.get(given.rows()?)?;
    let range = extreme(values, f64::gt)?.1 - extreme(values, f64::lt)?.1;
    (range > 0.0).then(|| total_variation(values) / (2.0 * range) - 1.0)
}

/// Largest absolute mean of a column over a window of 1/16 of the first episode, with the
/// trapezoidal rule between rows.
pub fn peak_of_means(given: &Given) -> Option<f64> {
    let times = given.history.times();
    peak_mean(times, &[&integral(times, given.values()?)], given.window()?)
}
