//! The striker, which is the body of the first contact whose centre moves fastest before it, and
//! its apex after it.
//!
//! ```text
//! apex   vertex of the parabola through the highest row of its centre and the adjacent rows
//! ```

use super::episode::{default_bridge, first_episode};
use super::given::{Given, norms, vector};
use super::parties::{in_contacts, own_episode, taking_part};
use super::samples::extreme;
use crate::{History, Run};

/// Excess of a speed over another one, relative to it, that is round-off.
const ROUND_OFF: f64 = 1e-9;

/// Name of the body, of those that take part in the first contact, whose centre moves fastest in
/// the row before it (without contact, in the first row); the first one of those that are equally
/// fast. An obstacle whose motion is prescribed has reactions, and is none.
pub fn striker(run: &Run) -> Option<&str> {
    let mut part = first_episode(&run.history).map_or(Vec::new(), |episode| taking_part(run, episode));
    if part.is_empty() {
        part = in_contacts(run);
    }
    fastest(&run.history, |body| part.is_empty() || part.contains(&body))
}

/// Name of the body, of those asked for, whose centre moves fastest, as above.
pub(super) fn fastest(history: &History, counts: impl Fn(&str) -> bool) -> Option<&str> {
    let row = first_episode(history).map_or(0, |e| e.start.saturating_sub(1));
    let movers = history.columns.iter().filter_map(|c| c.name.strip_suffix(".velocity_x"));
    let bodies = movers.filter(|name| history.column(&format!("{name}.reaction_x")).is_none());
    let bodies = bodies.filter(|name| counts(name));
    let speeds =
        bodies.filter_map(|b| Some((b, *norms(&vector(history, &format!("{b}.velocity"))).get(row)?)));
    speeds
        .reduce(|best, next| if next.1 > best.1 * (1.0 + ROUND_OFF) { next } else { best })
        .map(|(body, _)| body)
}

/// Time and height of the apex: the vertex of the parabola through the highest row and the adjacent
/// rows.
pub(super) fn apex(given: &Given) -> Option<(f64, f64)> {
    let history = given.history;
    let striker = given.run.map_or_else(|| fastest(history, |_| true), striker)?;
    let center = *vector(history, &format!("{striker}.center")).last()?;
    let first = given.first()?;
    let own = |run| own_episode(run, striker, first, default_bridge(history));
    let after = given.run.map_or(first, own).end?;
    let (i, top) = extreme(&center[after..], f64::gt).map(|(i, x)| (i + after, x))?;
    let t = history.times();
    let y = center;
    // The striker still rises when the record ends: the apex was not reached.
    if i + 1 == y.len() {
        return None;
    }
    if i == after {
        // A striker that falls when the contact ends has no apex after it.
        return (after > 0 && y[after] >= y[after - 1]).then_some((t[i], top - y[0]));
    }
    let slope = |a: usize, b: usize| (y[b] - y[a]) / (t[b] - t[a]);
    let left = slope(i - 1, i);
    let right = slope(i, i + 1);
    let curvature = (right - left) / (0.5 * (t[i + 1] - t[i - 1]));
    let there = left + 0.5 * curvature * (t[i] - t[i - 1]);
    if curvature == 0.0 {
        return Some((t[i], top - y[0]));
    }
    Some((t[i] - there / curvature, top - 0.5 * there * there / curvature - y[0]))
}
