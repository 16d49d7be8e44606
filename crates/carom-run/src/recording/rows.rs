//! The rows of a state, as a run records them.

use carom_case::{Case, history_columns};
use carom_contact::{FrictionState, Pair, Tangential, length};
use carom_mechanics::model::{Contact, Model};
use carom_mechanics::{GridReport, Simulation, State, each_slip, penetration};
use carom_record::{Column, ContactRow};

use super::columns::{Since, center_weights, row};
use super::fields::{gap_of, weights};

/// Rows of a simulation that is advanced step by step.
pub struct Rows {
    columns: Vec<Column>,
    weights: Vec<f64>,
    since: Since,
}

/// The active contact nodes of a state.
pub type ContactStates<'a> = Vec<ContactRow<'a>>;

impl Rows {
    /// Of a case and its simulation.
    pub fn new(case: &Case, simulation: &Simulation) -> Self {
        let model = simulation.model();
        let mut rows =
            Self { columns: history_columns(case), weights: center_weights(model), since: Since::default() };
        let penetration = penetration(model, simulation.state());
        rows.advanced(&GridReport { penetration, ..GridReport::default() });
        rows
    }

    /// Names and units of the values of a row.
    pub fn columns(&self) -> &[Column] {
        &self.columns
    }

    /// Counts of a row are those of the last step.
    pub fn advanced(&mut self, report: &GridReport) {
        self.since = Since::default();
        self.since.add(report);
    }

    /// The row of the current state.
    pub fn row(&self, simulation: &Simulation) -> Vec<f64> {
        let state = simulation.state();
        let mut values = Vec::new();
        let dt = simulation.grid().length(state.step);
        let since = (&self.since, simulation.has_fallback());
        row(simulation.model(), state, dt, since, &self.weights, &mut values);
        values
    }

    /// The active contact nodes of the current state.
    pub fn contact<'a>(&self, case: &Case, simulation: &'a Simulation) -> ContactStates<'a> {
        contact_rows(case, simulation.model(), simulation.state())
    }
}

/// The active contact nodes of a state.
pub(super) fn contact_rows<'a>(case: &Case, model: &'a Model, state: &State) -> ContactStates<'a> {
    let mut rows = Vec::new();
    let in_space = model.dimension == 3;
    // Of each contact with friction in space: friction on the secondary side.
    let count = |(contact, pairs): (&Contact, &Vec<Pair>)| {
        if in_space && contact.friction.is_some() { pairs.len() } else { 0 }
    };
    let counts = model.contacts.iter().zip(&state.pairs).map(count);
    let mut rubbing: Vec<Vec<[f64; 3]>> = counts.map(|count| vec![[0.0; 3]; count]).collect();
    if rubbing.iter().any(|forces| !forces.is_empty()) {
        each_slip(model, state, |k, p, traction, row| {
            let along = row.normal();
            (0..3).for_each(|i| rubbing[k][p][i] -= traction * along[i]);
        });
    }
    for ((contact, pairs), rubbing) in model.contacts.iter().zip(&state.pairs).zip(rubbing) {
        if pairs.iter().all(|p| !p.active) {
            continue;
        }
        let weights = weights(contact, state, case.thickness);
        // In a concave corner, a node has several pairs.
        let mut of_node = vec![0.0; weights.len()];
        pairs.iter().filter(|p| p.active).for_each(|pair| of_node[pair.node] += pair.lambda);
        for (p, pair) in pairs.iter().enumerate().filter(|(_, pair)| pair.active) {
            let Tangential { traction, slip, .. } = pair.tangential;
            let node = contact.kinematics.secondary()[pair.node];
            let (gap, normal, point) = gap_of(contact, pair, state);
            rows.push(ContactRow {
                step: state.step,
                time: state.time,
                contact: contact.name.as_str().into(),
                node: node as u64,
                point,
                facet: pair.facet as u64,
                xi: pair.xi,
                eta: pair.eta,
                gap,
                multiplier: pair.lambda,
                pressure: -of_node[pair.node] / weights[pair.node],
                normal,
                friction: match (&contact.friction, pair.tangential.friction_state) {
                    _ if pair.node >= contact.kinematics.nodes() => "none",
                    (None, _) => "none",
                    (_, FrictionState::Stick) => "stick",
                    (_, FrictionState::Slip(_)) => "slip",
                }
                .into(),
                traction: if in_space { length(traction) } else { traction[0] },
                slip: if in_space { length(slip) } else { slip[0] },
                rubbing: rubbing.get(p).copied().unwrap_or_default(),
            });
        }
    }
    rows
}
