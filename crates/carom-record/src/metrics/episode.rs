//! Episodes of contact: spans of rows with `active` > 0, short gaps closed.

use std::ops::Range;

use crate::History;

/// Row numbers of an episode: the first with contact, and the first after it without, if it ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Episode {
    /// First row with contact.
    pub start: usize,
    /// First row without; none when contact lasts to the end of the record.
    pub end: Option<usize>,
}

impl Episode {
    /// Its rows, from the one before it to the one that ends it.
    pub(super) fn span(self, history: &History) -> Range<usize> {
        self.start.saturating_sub(1)..self.end.map_or(history.times().len(), |end| end + 1)
    }
}

/// Episodes of contact; gaps shorter than `bridge` (in time) belong to them.
pub fn episodes(history: &History, bridge: f64) -> Vec<Episode> {
    let (times, active) = (history.times(), history.column("active").unwrap_or_default());
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

/// The bridge the named metrics use: 2 % of the recorded time.
pub fn default_bridge(history: &History) -> f64 {
    let times = history.times();
    0.02 * (times.last().unwrap_or(&0.0) - times.first().unwrap_or(&0.0))
}

/// First episode with the default bridge.
pub fn first_episode(history: &History) -> Option<Episode> {
    episodes(history, default_bridge(history)).first().copied()
}
