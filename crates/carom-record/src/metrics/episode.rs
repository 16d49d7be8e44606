//! Contact episodes: spans of rows in contact, including short interruptions. A row is in contact
//! if pairs are active, or became active and opened again since the row before it.

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

/// Difference of times, relative to the last one, that is round-off.
const ROUND_OFF: f64 = 1e-12;
/// Number of windows per episode over which peaks are averaged.
pub(super) const WINDOWS: f64 = 16.0;

impl Episode {
    /// Whether a row at a time is in contact.
    pub(super) fn contains(self, times: &[f64], time: f64) -> bool {
        times[self.start] <= time && self.end.is_none_or(|end| time < times[end])
    }

    /// Time over which peaks are averaged, 1/16 of the episode; none if it has not ended.
    pub(super) fn window(self, times: &[f64]) -> Option<f64> {
        Some((times[self.end?] - times[self.start]) / WINDOWS)
    }

    /// Whether no row of the episode has active pairs: contact begins and ends between two rows.
    pub fn is_within_a_step(self, history: &History) -> bool {
        let active = history.column("active").unwrap_or_default();
        active[self.start..self.end.unwrap_or(active.len())].iter().all(|count| *count == 0.0)
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
    let [active, begins] = ["active", "activations"].map(|name| history.column(name).unwrap_or_default());
    let is_in_contact = |row: usize| {
        let counts = [active.get(row), begins.get(row)];
        counts.into_iter().flatten().any(|count| *count > 0.0)
    };
    // An interruption of exactly this length is one, whatever the last digits of its times.
    let last = times.last().map_or(0.0, |time| time.abs());
    let bridge = bridge - ROUND_OFF * last;
    let mut found: Vec<Episode> = Vec::new();
    for i in (0..active.len()).filter(|row| is_in_contact(*row)) {
        match found.last_mut() {
            Some(last) if last.end.is_none_or(|end| times[i] - times[end] < bridge) => last.end = None,
            _ => found.push(Episode { start: i, end: None }),
        }
        if i + 1 < active.len()
            && !is_in_contact(i + 1)
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
/// Contact never ends, the last interval is longer than those before it and does not end, or the
/// intervals are too different for one window.
pub fn window(history: &History) -> Result<f64, Reason> {
    let times = history.times();
    let last = times.len().saturating_sub(1);
    let length = |episode: &Episode| times[episode.end.unwrap_or(last)] - times[episode.start];
    let longest = |lengths: &[f64]| lengths.iter().copied().fold(0.0, f64::max);
    let closed = |found: &[Episode]| -> Vec<f64> {
        found.iter().filter(|episode| episode.end.is_some()).map(length).collect()
    };
    let bridge = longest(&closed(&episodes(history, default_bridge(history)))) / WINDOWS;
    let found = episodes(history, bridge);
    let lengths = closed(&found);
    let window = longest(&lengths) / WINDOWS;
    let why = if window <= 0.0 {
        "no contact of the reference begins and ends"
    } else if found.iter().any(|episode| episode.end.is_none() && length(episode) > longest(&lengths)) {
        "the longest contact of the reference lasts to its end"
    } else if lengths.iter().any(|length| *length > 0.0 && UNEVEN * length < WINDOWS * window) {
        "intervals of contact of the reference differ by 4 : 1"
    } else {
        return Ok(window);
    };
    Err(format!("{why}; give `window`, the time to average over").into())
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
