//! The part of a run that is compared with a reference.

use std::collections::BTreeMap;

use crate::facts::ContactFacts;
use crate::metrics::{self, Metric};
use crate::{History, Run};

/// The part of a run that is used for comparisons.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Trajectory {
    /// Times of the rows.
    pub times: Vec<f64>,
    /// Columns of probes and of centres of bodies, and [`FORCE`], the magnitude of the contact
    /// force.
    pub columns: BTreeMap<String, Vec<f64>>,
    /// Components of the contact force by axis, or by contact and axis.
    pub forces: BTreeMap<String, Force>,
    /// Metrics of the run.
    pub metrics: Vec<Metric>,
}

/// A component of the contact force.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Force {
    /// Values at the rows.
    pub values: Vec<f64>,
    /// The impulse up to each row, as the time integrator accumulates it; where several contacts
    /// act, the integral of the values.
    pub impulse: Vec<f64>,
}

/// Column name of the magnitude of the contact force.
pub const FORCE: &str = "contact force";
/// Axes of vectors.
const AXES: [&str; 3] = ["x", "y", "z"];

/// The body whose centre a column is.
fn center_of(column: &str) -> Option<&str> {
    let (body, quantity) = column.rsplit_once('.')?;
    quantity.starts_with("center_").then_some(body)
}

/// Components of the contact force with their impulses, which are recorded; of contacts that do not
/// count as one those of each, as their sum depends on which sides are secondary.
pub(super) fn forces(history: &History, contacts: &[ContactFacts]) -> BTreeMap<String, Force> {
    if metrics::count_as_one(contacts) {
        let component = |axis: &&str| {
            let values = history.column(&format!("contact_force_{axis}"))?.to_vec();
            let impulse = history.column(&format!("contact_impulse_{axis}"))?.to_vec();
            Some(((*axis).to_owned(), Force { values, impulse }))
        };
        return AXES.iter().filter_map(component).collect();
    }
    let force =
        |contact: &ContactFacts, axis: &str| history.column(&format!("{}.force_{axis}", contact.name));
    let touches = |contact: &&ContactFacts| {
        AXES.iter().filter_map(|axis| force(contact, axis)).flatten().any(|force| *force != 0.0)
    };
    let is_known = contacts.iter().all(|contact| AXES.iter().any(|axis| force(contact, axis).is_some()));
    let is_alone = is_known && contacts.iter().filter(touches).count() == 1;
    let of_contact = |contact: &ContactFacts| {
        let component = |axis: &&str| {
            let values = force(contact, axis)?.to_vec();
            // The sum that is recorded is that of the only one.
            let recorded = history.column(&format!("contact_impulse_{axis}"));
            let recorded = recorded.filter(|_| is_alone && touches(&contact));
            let impulse = match recorded {
                Some(impulse) => impulse.to_vec(),
                None => metrics::integral(history.times(), &values),
            };
            Some((format!("{}.{axis}", contact.name), Force { values, impulse }))
        };
        AXES.iter().filter_map(component).collect::<Vec<_>>()
    };
    // The force of a side on itself depends on which of two places is secondary.
    let between_bodies =
        contacts.iter().filter(|contact| contact.primary.as_ref() != Some(&contact.secondary));
    between_bodies.flat_map(of_contact).collect()
}

impl Trajectory {
    /// Extracts the trajectory from a record.
    pub fn of(run: &Run, metrics: &[Metric]) -> Self {
        let history = &run.history;
        let all = history.columns.iter().map(|column| column.name.as_str());
        let centers = all.filter(|name| center_of(name).is_some());
        let names = metrics::probe_columns(run).into_iter().chain(centers);
        let columns = names.filter_map(|name| Some((name.to_owned(), history.column(name)?.to_vec())));
        let mut columns: BTreeMap<_, _> = columns.collect();
        columns.insert(FORCE.to_owned(), metrics::contact_force(run));
        let forces = forces(history, &run.manifest.facts.contacts);
        Self { times: history.times().to_vec(), columns, forces, metrics: metrics.to_vec() }
    }

    /// Without the centres of all bodies but one.
    pub(super) fn with_center_of(mut self, body: Option<&str>) -> Self {
        self.columns.retain(|name, _| center_of(name).is_none_or(|owner| Some(owner) == body));
        self
    }

    pub(super) fn value(&self, metric: &str) -> Option<f64> {
        self.metrics.iter().find(|m| m.name == metric)?.value
    }
}
