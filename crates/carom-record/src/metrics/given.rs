//! Input of the metrics.

use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;

use super::episode::{Episode, default_bridge, episodes};
use crate::facts::{ContactFacts, body_of};
use crate::{History, Overlay, Run};

/// A history with its contact episodes; where a metric needs them, the run, a column or measured
/// data.
#[derive(Clone, Debug)]
pub struct Given<'a> {
    pub(crate) history: &'a History,
    pub(super) episodes: Vec<Episode>,
    pub(crate) run: Option<&'a Run>,
    /// The column that a metric of columns is computed of.
    pub(super) column: Option<&'a str>,
    pub(super) measured: Option<&'a Overlay>,
}

impl<'a> Given<'a> {
    /// The whole history.
    pub fn of(history: &'a History) -> Self {
        let episodes = episodes(history, default_bridge(history));
        Self { history, episodes, run: None, column: None, measured: None }
    }

    pub(crate) fn of_run(run: &'a Run) -> Self {
        Self::of_changed(run, &run.history)
    }

    /// Input of the metrics of a run whose history has other values, as averaged ones.
    pub(super) fn of_changed(run: &'a Run, history: &'a History) -> Self {
        Self { run: Some(run), ..Self::of(history) }
    }

    /// With a column that a metric is computed of.
    pub fn with_column(&self, column: &'a str) -> Self {
        Self { column: Some(column), ..self.clone() }
    }

    /// Beside measured data of a column.
    pub fn beside(&self, measured: &'a Overlay) -> Self {
        Self { column: Some(&measured.column), measured: Some(measured), ..self.clone() }
    }

    /// Values of the column.
    pub(super) fn values(&self) -> Option<&'a [f64]> {
        self.history.column(self.column?)
    }

    pub(super) fn first(&self) -> Option<Episode> {
        self.episodes.first().copied()
    }

    /// Rows of the first episode, from the row before it to the row that ends it.
    pub(super) fn rows(&self) -> Option<Range<usize>> {
        Some(self.first()?.span(self.history))
    }

    /// Rows in contact of the first episode.
    pub(super) fn rows_in_contact(&self) -> Option<Range<usize>> {
        let Episode { start, end } = self.first()?;
        Some(start..end.unwrap_or(self.history.times().len()))
    }

    /// Time over which peaks of the first episode are averaged.
    pub(super) fn window(&self) -> Option<f64> {
        self.first()?.window(self.history.times())
    }

    pub(super) fn time(&self, row: usize) -> f64 {
        self.history.times()[row]
    }

    pub(super) fn duration(&self) -> Option<f64> {
        let first = self.first()?;
        Some(self.time(first.end?) - self.time(first.start))
    }

    /// Contacts of the run; none where only a history is known.
    fn contacts(&self) -> &'a [ContactFacts] {
        self.run.map_or(&[], |run| &run.manifest.facts.contacts)
    }

    /// Magnitude of the contact force in every row, of contacts that do not count as one the
    /// largest.
    pub(super) fn force(&self) -> Vec<f64> {
        force(self.history, self.contacts(), self.run)
    }

    /// Magnitude of the contact force in every row; of contacts that do not count as one, that of
    /// the contact with the largest force in the first episode.
    pub(super) fn force_of_first(&self) -> Option<Vec<f64>> {
        if count_as_one(self.contacts()) {
            return Some(self.force());
        }
        let rows = self.rows_in_contact()?;
        let peak = |force: &[f64]| force[rows.clone()].iter().copied().fold(0.0, f64::max);
        let larger = |one: Vec<f64>, other: Vec<f64>| if peak(&other) > peak(&one) { other } else { one };
        of_contacts(self.history, self.contacts(), self.run).reduce(larger)
    }

    /// The impulse of all contacts, if they count as one and act on two parties.
    pub(super) fn impulses(&self) -> Option<Vec<&'a [f64]>> {
        let acts = count_as_one(self.contacts()) && !self.contacts().iter().any(is_of_itself);
        acts.then(|| vector(self.history, "contact_impulse"))
    }

    /// Change of the impulse along an axis over the first episode.
    pub(super) fn impulse(&self, axis: usize) -> Option<f64> {
        let p = *self.impulses()?.get(axis)?;
        let rows = self.rows()?;
        Some(p[rows.end - 1] - p[rows.start])
    }

    /// Last value of a column.
    pub(super) fn last(&self, column: &str) -> Option<f64> {
        self.history.column(column)?.last().copied()
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

/// Magnitude of the sum of the contact forces in every row.
pub(crate) fn total_force(history: &History) -> Vec<f64> {
    norms(&vector(history, "contact_force"))
}

/// Whether the forces of contacts are added: of a single one, or of one body with several rigid
/// obstacles. Other sums are forces on no body, and depend on which sides are secondary.
pub(crate) fn count_as_one(contacts: &[ContactFacts]) -> bool {
    let bodies: BTreeSet<&str> = contacts.iter().map(|of| body_of(&of.secondary)).collect();
    contacts.len() < 2 || bodies.len() == 1 && contacts.iter().all(|of| of.primary.is_none())
}

/// Whether a side is in contact with itself.
pub(super) fn is_of_itself(of: &ContactFacts) -> bool {
    of.primary.as_deref() == Some(&of.secondary)
}

/// Sum of the normal forces of a contact in every row, from contact.csv. Where a side meets itself,
/// either of two places may be the secondary one, and the forces on secondary places may cancel.
fn pressing(run: &Run, history: &History, contact: &str) -> Vec<f64> {
    let mut sums: BTreeMap<u64, f64> = BTreeMap::new();
    for row in run.contact.iter().filter(|row| row.contact == contact) {
        *sums.entry(row.step).or_default() += row.multiplier.abs();
    }
    let steps = history.column("step").unwrap_or(&[]);
    steps.iter().map(|step| sums.get(&(*step as u64)).copied().unwrap_or(0.0)).collect()
}

/// Magnitudes of the forces of contacts that have columns of their own.
fn of_contacts<'a>(
    history: &'a History,
    contacts: &'a [ContactFacts],
    run: Option<&'a Run>,
) -> impl Iterator<Item = Vec<f64>> + 'a {
    let force = move |of: &ContactFacts| match run {
        Some(run) if is_of_itself(of) => pressing(run, history, &of.name),
        _ => norms(&vector(history, &format!("{}.force", of.name))),
    };
    contacts.iter().map(force).filter(|force| !force.is_empty())
}

/// Magnitude of the contact force in every row, of contacts that do not count as one the largest.
fn force(history: &History, contacts: &[ContactFacts], run: Option<&Run>) -> Vec<f64> {
    if let ([of], Some(run)) = (contacts, run)
        && is_of_itself(of)
    {
        return pressing(run, history, &of.name);
    }
    if count_as_one(contacts) {
        return total_force(history);
    }
    let larger = |one: Vec<f64>, other: Vec<f64>| one.iter().zip(&other).map(|(a, b)| a.max(*b)).collect();
    let largest = of_contacts(history, contacts, run).reduce(larger);
    largest.unwrap_or_else(|| total_force(history))
}

/// Magnitude of the contact force in every row, of contacts that do not count as one the largest.
pub fn contact_force(run: &Run) -> Vec<f64> {
    force(&run.history, &run.manifest.facts.contacts, Some(run))
}
