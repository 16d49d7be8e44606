//! Quantities shared by the metrics of a history, computed once: its episodes and the magnitude of
//! the contact force.

use std::ops::Range;

use super::episode::{Episode, default_bridge, episodes};
use crate::History;

/// Quantities shared by the metrics of a history.
pub struct Facts<'a> {
    pub(super) history: &'a History,
    pub(super) episodes: Vec<Episode>,
    /// Rows of the first episode, from the row before it to the row that ends it.
    pub(super) rows: Option<Range<usize>>,
    pub(super) force: Vec<f64>,
}

impl<'a> Facts<'a> {
    pub(super) fn of(history: &'a History) -> Self {
        let episodes = episodes(history, default_bridge(history));
        let rows = episodes.first().map(|e| e.span(history));
        Self { history, episodes, rows, force: contact_force(history) }
    }

    pub(super) fn first(&self) -> Option<Episode> {
        self.episodes.first().copied()
    }

    pub(super) fn time(&self, row: usize) -> f64 {
        self.history.times()[row]
    }

    pub(super) fn duration(&self) -> Option<f64> {
        let first = self.first()?;
        Some(self.time(first.end?) - self.time(first.start))
    }

    /// Change of the impulse along an axis over the first episode.
    pub(super) fn impulse(&self, axis: usize) -> Option<f64> {
        let p = *vector(self.history, "contact_impulse").get(axis)?;
        let rows = self.rows.clone()?;
        Some(p[rows.end - 1] - p[rows.start])
    }
}

/// Columns `NAME_x`, `NAME_y` and `NAME_z`, as many as there are dimensions.
pub(super) fn vector<'a>(history: &'a History, name: &str) -> Vec<&'a [f64]> {
    ["_x", "_y", "_z"].iter().filter_map(|axis| history.column(&format!("{name}{axis}"))).collect()
}

pub(super) fn norms(vector: &[&[f64]]) -> Vec<f64> {
    let rows = vector.first().map_or(0, |v| v.len());
    (0..rows).map(|i| vector.iter().fold(0.0, |sum, v| f64::hypot(sum, v[i]))).collect()
}

/// Magnitude of the contact force in every row.
pub fn contact_force(history: &History) -> Vec<f64> {
    norms(&vector(history, "contact_force"))
}
