//! Metrics of a run, as functions of its history alone.
//!
//! An *episode* of contact is a span of rows with `active` > 0; gaps in it shorter than `bridge` (2 % of the recorded time by default)
//! do not end it. Its start is the first row with contact, its end the first row without: both are ends of steps, so a time is late by
//! at most one step. The *striker* is the body whose centre moves fastest in the row before the first episode, so that swapping
//! secondary and primary changes no metric. An impulse is a difference of the recorded `contact_impulse`, which the time
//! integrator accumulated; a mean force over a window w is [P(t + w) − P(t)]/w, not a mean of samples.

mod compare;
mod force;
mod ledger;
mod oscillation;
mod pressure;
mod table;
mod work;

use std::borrow::Cow;
use std::ops::Range;

use crate::History;
pub use compare::{deviation, phase_shift};
pub use force::high_frequency;
pub use ledger::energy_lost_at;
pub use pressure::hertz;
pub use table::{COLUMNS, Definition, FREE, HISTORY, PRESSURE, Unit, WORK, book_table, of_column};
pub use work::{column_roughness, of_run, probe_columns};

/// A metric of a run.
#[derive(Clone, Debug, PartialEq)]
pub struct Metric {
    /// Name, as expectations and studies call it.
    pub name: Cow<'static, str>,
    /// Value; none when the record has no such thing (no contact, or it has not ended).
    pub value: Option<f64>,
    /// Unit label.
    pub unit: String,
    /// What it means.
    pub definition: &'static str,
}

/// What the metrics of a history are made of.
pub struct Facts<'a> {
    history: &'a History,
    episodes: Vec<Episode>,
    /// Rows of the first episode, from the one before it to the one that ends it.
    rows: Option<Range<usize>>,
    force: Vec<f64>,
}

impl<'a> Facts<'a> {
    fn of(history: &'a History) -> Self {
        let episodes = episodes(history, default_bridge(history));
        let rows = episodes.first().map(|e| e.span(history));
        Self { history, episodes, rows, force: contact_force(history) }
    }

    fn first(&self) -> Option<Episode> {
        self.episodes.first().copied()
    }

    fn time(&self, row: usize) -> f64 {
        self.history.times()[row]
    }

    fn duration(&self) -> Option<f64> {
        let first = self.first()?;
        Some(self.time(first.end?) - self.time(first.start))
    }

    /// Change of the impulse along an axis over the first episode.
    fn impulse(&self, axis: usize) -> Option<f64> {
        let p = *vector(self.history, "contact_impulse").get(axis)?;
        let rows = self.rows.clone()?;
        Some(p[rows.end - 1] - p[rows.start])
    }
}

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
    fn span(self, history: &History) -> Range<usize> {
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

/// Value of a column at a time, linear between rows.
pub fn at(times: &[f64], values: &[f64], time: f64) -> Option<f64> {
    let i = times.partition_point(|&t| t < time);
    if times.get(i) == Some(&time) {
        return values.get(i).copied();
    }
    let (before, after) = (i.checked_sub(1)?, i);
    let s = (time - times[before]) / (times.get(after)? - times[before]);
    Some(values[before] + s * (values.get(after)? - values[before]))
}

/// Σ |xᵢ₊₁ − xᵢ|.
pub fn total_variation(values: &[f64]) -> f64 {
    values.windows(2).map(|w| (w[1] - w[0]).abs()).sum()
}

/// Total variation over the least a rise to the largest value and a fall needs, minus 1: 0 for a single hump. None for a constant.
pub fn roughness(values: &[f64]) -> Option<f64> {
    let top = extreme(values, f64::gt)?.1;
    let least = 2.0 * top - values.first()? - values.last()?;
    (least > 0.0).then(|| total_variation(values) / least - 1.0)
}

/// Largest mean over a window of time of the quantity whose integral is given: max |P(t + w) − P(t)|/w at recorded t, per component.
pub fn peak_mean(times: &[f64], integrals: &[&[f64]], window: f64) -> Option<f64> {
    let mean = |t: f64| {
        let change = |p: &&[f64]| Some((at(times, p, t + window)? - at(times, p, t)?) / window);
        integrals.iter().map(change).try_fold(0.0, |sum, f| Some(f64::hypot(sum, f?)))
    };
    let last = times.last()? - window;
    // The window that ends with the record starts between rows.
    times.iter().copied().filter(|&t| t <= last).chain([last]).filter_map(mean).reduce(f64::max)
}

/// Row and value that beats all others, the first of equals; NaN never wins.
pub(crate) fn extreme(values: &[f64], beats: fn(&f64, &f64) -> bool) -> Option<(usize, f64)> {
    let finite = values.iter().copied().enumerate().filter(|(_, x)| !x.is_nan());
    finite.reduce(|best, next| if beats(&next.1, &best.1) { next } else { best })
}

/// Columns `NAME_x` and `NAME_y`, as many as the dimension has.
fn vector<'a>(history: &'a History, name: &str) -> Vec<&'a [f64]> {
    ["_x", "_y"].iter().filter_map(|axis| history.column(&format!("{name}{axis}"))).collect()
}

fn norms(vector: &[&[f64]]) -> Vec<f64> {
    let rows = vector.first().map_or(0, |v| v.len());
    (0..rows).map(|i| vector.iter().fold(0.0, |sum, v| f64::hypot(sum, v[i]))).collect()
}

/// Contact force of every row: its absolute value.
pub fn contact_force(history: &History) -> Vec<f64> {
    norms(&vector(history, "contact_force"))
}

/// Name of the body whose centre is fastest in the row before the first contact (the first row, if there is none).
pub fn striker(history: &History) -> Option<&str> {
    let row = first_episode(history).map_or(0, |e| e.start.saturating_sub(1));
    let bodies = history.columns.iter().filter_map(|c| c.name.strip_suffix(".velocity_x"));
    let speeds = bodies.filter_map(|b| Some((b, *norms(&vector(history, &format!("{b}.velocity"))).get(row)?)));
    speeds.reduce(|best, next| if next.1 > best.1 { next } else { best }).map(|(body, _)| body)
}

/// −(v⁺·n)/(v⁻·n) of the striker's centre; n along the impulse of the first episode.
fn restitution(history: &History, episode: Episode) -> Option<f64> {
    let (before, after) = (episode.start.checked_sub(1)?, episode.end?);
    let impulse = vector(history, "contact_impulse");
    let velocity = vector(history, &format!("{}.velocity", striker(history)?));
    let along = |row: usize| velocity.iter().zip(&impulse).map(|(v, p)| v[row] * (p[after] - p[before])).sum::<f64>();
    let value = -along(after) / along(before);
    value.is_finite().then_some(value)
}

/// Time and rise of the apex: the vertex of the parabola through the highest row and its neighbours.
fn apex(history: &History, episode: Episode) -> Option<(f64, f64)> {
    let center = *vector(history, &format!("{}.center", striker(history)?)).last()?;
    let after = episode.end?;
    let (i, top) = extreme(&center[after..], f64::gt).map(|(i, x)| (i + after, x))?;
    let (t, y) = (history.times(), center);
    // Still rising when the record ends: the apex was not reached.
    if i + 1 == y.len() {
        return None;
    }
    if i == after {
        return Some((t[i], top - y[0]));
    }
    let slope = |a: usize, b: usize| (y[b] - y[a]) / (t[b] - t[a]);
    let (left, right) = (slope(i - 1, i), slope(i, i + 1));
    let curvature = (right - left) / (0.5 * (t[i + 1] - t[i - 1]));
    let there = left + 0.5 * curvature * (t[i] - t[i - 1]);
    if curvature == 0.0 {
        return Some((t[i], top - y[0]));
    }
    Some((t[i] - there / curvature, top - 0.5 * there * there / curvature - y[0]))
}

/// Time at which the velocity of the striker's centre along the impulse of the first episode changes its sign, linear between rows.
fn turning_time(facts: &Facts) -> Option<f64> {
    let (history, rows) = (facts.history, facts.rows.clone()?);
    let impulse = [facts.impulse(0), facts.impulse(1)];
    let velocity = vector(history, &format!("{}.velocity", striker(history)?));
    let along = |row: usize| velocity.iter().zip(impulse).map(|(v, p)| v[row] * p.unwrap_or_default()).sum::<f64>();
    let before = (rows.start..rows.end - 1).find(|&i| along(i) < 0.0 && along(i + 1) >= 0.0)?;
    let (a, b) = (along(before), along(before + 1));
    Some(facts.time(before) + (facts.time(before + 1) - facts.time(before)) * a / (a - b))
}

/// Every named metric, in the order of [`HISTORY`], and the energy lost at each impact.
pub fn all(history: &History) -> Vec<Metric> {
    let facts = Facts::of(history);
    let metric = |(definition, value): &(Definition, fn(&Facts) -> Option<f64>)| Metric {
        name: definition.name.into(),
        value: value(&facts),
        unit: definition.unit.label(history),
        definition: definition.meaning,
    };
    HISTORY.iter().map(metric).collect()
}

#[cfg(test)]
mod tests;
