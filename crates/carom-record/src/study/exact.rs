//! The exact solution of an arm, from the formulas of [exact].
//!
//! ```text
//! histories    formulas at the rows of the run that is compared, and, of forces and stresses, at PARTS − 1 instants between two
//! metrics      of formulas at ROWS even instants; uncertain by what half of them change, and events by a row
//! ```
//!
//! Nothing is interpolated at the rows of a run; between them forces and stresses are, for their
//! averages.

use std::collections::BTreeMap;

use carom_formula::Formula;

use super::groups::is_trajectory;
use super::trajectory::{FORCE, Trajectory, forces};
use crate::facts::ContactFacts;
use crate::metrics;
use crate::{Column, History, Reason};

/// Parts of a row in which formulas are evaluated.
const PARTS: usize = 8;
/// Number of even instants of the histories of which metrics are computed.
const ROWS: usize = 16_384;

/// Formulas of an exact solution.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Exact {
    texts: BTreeMap<String, String>,
    contacts: Vec<ContactFacts>,
    /// Time at which the solution ends.
    pub(super) end: f64,
}

impl Exact {
    /// The formulas of a case, in t; those of the sums of all contact forces and impulses say
    /// nothing of contacts that do not count as one.
    pub(super) fn of(texts: &BTreeMap<String, String>, contacts: &[ContactFacts], end: f64) -> Self {
        let mut texts = texts.clone();
        let is_sum = |name: &str| name.starts_with("contact_force_") || name.starts_with("contact_impulse_");
        texts.retain(|name, _| metrics::count_as_one(contacts) || !is_sum(name));
        Self { texts, contacts: contacts.to_vec(), end }
    }

    /// Distance of the instants of which metrics are computed.
    pub(super) fn row(&self) -> f64 {
        self.end / ROWS as f64
    }

    /// The histories of the formulas at these times.
    fn history(&self, times: Vec<f64>) -> History {
        let read = |(name, text): (&String, &String)| {
            let formula = Formula::parse(text, &["t"]).ok()?;
            Some((name.clone(), times.iter().map(|t| formula.value(&[*t])).collect::<Vec<f64>>()))
        };
        let read: Vec<(String, Vec<f64>)> = self.texts.iter().filter_map(read).collect();
        let names = std::iter::once("time").chain(read.iter().map(|(name, _)| name.as_str()));
        let columns = names.map(|name| Column {
            name: name.into(),
            unit: String::new(),
            description: String::new(),
            integer: false,
        });
        let columns = columns.collect();
        let values = std::iter::once(times).chain(read.into_iter().map(|(_, values)| values));
        History::new(columns, values.collect())
    }

    fn trajectory(&self, history: &History) -> Trajectory {
        let names = history.columns.iter().map(|column| column.name.as_str()).filter(|name| *name != "time");
        let columns = names.filter_map(|name| Some((name.to_owned(), history.column(name)?.to_vec())));
        let mut columns: BTreeMap<String, Vec<f64>> = columns.collect();
        if history.column("contact_force_x").is_some() {
            columns.insert(FORCE.to_owned(), metrics::total_force(history));
        }
        let forces = forces(history, &self.contacts);
        Trajectory { times: history.times().to_vec(), columns, forces, metrics: Vec::new() }
    }

    /// The solution with its metrics at two numbers of even instants, the larger one last.
    pub(super) fn sampled(&self) -> [Trajectory; 2] {
        [ROWS / 2, ROWS].map(|rows| {
            let history = self.history(self.even(rows));
            let mut known = metrics::all(&history);
            for column in self.texts.keys() {
                known.extend(metrics::of_column(&history, column));
            }
            Trajectory { metrics: known, ..self.trajectory(&history) }
        })
    }

    /// The solution at even instants, without metrics.
    pub(super) fn samples(&self) -> Trajectory {
        self.trajectory(&self.history(self.even(ROWS)))
    }

    fn even(&self, rows: usize) -> Vec<f64> {
        (0..=rows).map(|i| self.end * i as f64 / rows as f64).collect()
    }

    /// The solution beside a run with these times of rows.
    pub(super) fn beside(&self, rows: &[f64]) -> Trajectory {
        // Only what is averaged is needed between rows.
        let parts = if self.texts.keys().all(|column| is_trajectory(column)) { 1 } else { PARTS };
        let within = |pair: &[f64]| {
            let from = pair[0];
            let length = pair[1] - from;
            (0..parts).map(move |k| from + k as f64 / parts as f64 * length)
        };
        let mut times: Vec<f64> = rows.windows(2).flat_map(within).chain(rows.last().copied()).collect();
        times.dedup();
        self.trajectory(&self.history(times))
    }

    /// Whether two solutions have the same formulas, to the same end.
    pub(super) fn is_alike(&self, other: &Self) -> bool {
        self.texts == other.texts && self.end == other.end
    }

    /// The first instant of a sampled solution at which one of these columns, or components of the
    /// contact force, is not a number.
    pub(super) fn undefined<'a>(
        sampled: &Trajectory,
        columns: impl IntoIterator<Item = &'a String>,
    ) -> Option<Reason> {
        columns.into_iter().find_map(|column| {
            let force = sampled.forces.get(column).map(|force| &force.values);
            let values = sampled.columns.get(column).or(force)?;
            let row = values.iter().position(|value| !value.is_finite())?;
            let what = if force.is_some() { "the contact force along " } else { "" };
            let value = values[row];
            let time = sampled.times[row];
            Some(format!("the formula of {what}`{column}` in [exact] is {value} at t = {time:.6}").into())
        })
    }
}
