//! Contact episodes: spans of rows with `active` > 0, including short interruptions.

use std::ops::Range;

use crate::{History, Reason};

/// Rows of an episode: the first one in contact, and the first one without contact after it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Episode {
    /// First row in contact.
    pub start: usize,
    /// First row without contact; none if contact lasts to the end of the record.
    pub end: Option<usize>,
}

/// Number of windows per episode over which peaks are averaged.
const WINDOWS: f64 = 16.0;

impl Episode {
    /// Time over which peaks are averaged, 1/16 of the episode; none if it has not ended.
    pub(super) fn window(self, times: &[f64]) -> Option<f64> {
        Some((times[self.end?] - times[self.start]) / WINDOWS)
    }

    /// Indices of the rows of the episode, from the row before its first one to the row that ends
    /// it.
    pub(super) fn span(self, history: &History) -> Range<usize> {
        self.start.saturating_sub(1)..self.end.map_or(history.times().len(), |end| end + 1)
    }
}

/// Contact episodes; interruptions shorter than `bridge` (in time) do not end them.
pub fn episodes(history: &History, bridge: f64) -> Vec<Episode> {
    let times = history.times();
    let active = history.column("active").unwrap_or_default();
    let mut found: Vec<Episode> = Vec::new();
    for (i, _) in active.iter().enumerate().filter(|(_, n)| **n > 0.0) {
        match found.last_mut() {
            Some(last) if last.end.is_none_or(|end| times[i] - times[end] < bridge) => last.end = None,
            _ => found.push(Episode { start: i, end: None }),
        }
        if active.get(i + 1) == Some(&0.0)
            && let Some(last) = found.last_mut()
        {
            last.end = Some(i + 1);
        }
    }
    found
}

/// Largest ratio of the lengths of intervals of contact that one window fits.
const UNEVEN: f64 = 4.0;

/// Time over which forces and stresses of a record are averaged: 1/16 of its longest closed
/// interval of contact, openings shorter than that bridged.
///
/// # Errors
/// Contact never ends, or its intervals are too different for one window.
pub fn window(history: &History) -> Result<f64, Reason> {
    let times = history.times();
    let closed = |bridge: f64| {
        let found = episodes(history, bridge).into_iter();
        found.filter_map(|episode| Some(times[episode.end?] - times[episode.start])).collect::<Vec<f64>>()
    };
    let longest = |lengths: &[f64]| lengths.iter().copied().fold(0.0, f64::max);
    let first = longest(&closed(default_bridge(history))) / WINDOWS;
    let lengths = closed(first);
    let window = longest(&lengths) / WINDOWS;
    if window <= 0.0 {
        return Err(
            "no contact of the reference begins and ends; give `window`, the time to average over".into()
        );
    }
    if lengths.iter().any(|length| *length > 0.0 && UNEVEN * length < WINDOWS * window) {
        return Err(
            "intervals of contact of the reference differ by 4 : 1; give `window`, the time to average over"
                .into(),
        );
    }
    Ok(window)
}

/// The value of `bridge` for the named metrics: 2 % of the recorded time.
pub fn default_bridge(history: &History) -> f64 {
    let times = history.times();
    0.02 * (times.last().unwrap_or(&0.0) - times.first().unwrap_or(&0.0))
}

/// The first episode, with the default value of `bridge`.
pub fn first_episode(history: &History) -> Option<Episode> {
    episodes(history, default_bridge(history)).first().copied()
}
