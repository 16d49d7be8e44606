//! The rows of a state, as a run records them.

use carom_algebra::Vector;
use carom_case::{Case, history_columns};
use carom_contact::{self as contact, FrictionState, Pair, Row, Tangential, length};
use carom_mechanics::model::{Contact, Model};
use carom_mechanics::{
    GridReport, Pressures, Simulation, State, Surfaces, active_rows, each_slip, penetration,
};
use carom_record::{Column, ContactRow};

use super::columns::{Recorded, Since, center_weights, row};

/// Rows of a simulation that is advanced step by step.
pub struct Rows {
    columns: Vec<Column>,
    recorded: Recorded,
    pub(super) surfaces: Surfaces,
    /// Events since the previous row.
    pub(super) since: Since,
}

/// The active contact nodes of a state.
pub type ContactStates<'a> = Vec<ContactRow<'a>>;

impl Rows {
    /// Rows that begin with the initial state of a simulation.
    pub fn new(case: &Case, simulation: &Simulation) -> Self {
        let model = simulation.model();
        let mut rows = Self {
            columns: history_columns(case),
            recorded: Recorded { weights: center_weights(model), yielding: case.yielding().collect() },
            surfaces: Surfaces::new(model, case.thickness),
            since: Since::default(),
        };
        rows.begin(simulation);
        rows
    }

    /// The state is one from which a simulation begins, or that was restored: no step has led to
    /// it.
    pub fn begin(&mut self, simulation: &Simulation) {
        let penetration = penetration(simulation.model(), simulation.state());
        self.advanced(&GridReport { penetration, ..GridReport::default() });
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
        self.history(simulation, &active_rows(simulation.model(), simulation.state()))
    }

    /// The active contact nodes of the current state.
    pub fn contact<'a>(&self, simulation: &'a Simulation) -> ContactStates<'a> {
        self.pairs(simulation, &active_rows(simulation.model(), simulation.state()))
    }

    /// [`row`](Self::row) and [`contact`](Self::contact), side by side.
    pub(super) fn both<'a>(&self, simulation: &'a Simulation) -> (Vec<f64>, ContactStates<'a>) {
        let model = simulation.model();
        let measured = active_rows(model, simulation.state());
        model.threads.join(|| self.history(simulation, &measured), || self.pairs(simulation, &measured))
    }

    fn history(&self, simulation: &Simulation, measured: &[contact::Rows]) -> Vec<f64> {
        row(simulation, measured, &self.since, &self.recorded)
    }

    fn pairs<'a>(&self, simulation: &'a Simulation, measured: &[contact::Rows]) -> ContactStates<'a> {
        contact_rows(simulation.model(), &self.surfaces, simulation.state(), measured)
    }
}

/// Pairs of which a thread describes the states.
const SHARE: usize = 64;

/// The active contact nodes of a state with the rows of its pairs.
fn contact_rows<'a>(
    model: &'a Model,
    surfaces: &Surfaces,
    state: &State,
    measured: &[contact::Rows],
) -> ContactStates<'a> {
    if state.pairs.iter().flatten().all(|pair| !pair.active) {
        return Vec::new();
    }
    let described = Described {
        model,
        state,
        pressures: surfaces.pressures(model, state, measured),
        measured,
        rubbing: rubbing(model, state),
        has_field: model.contacts.iter().any(|contact| contact.kinematics.is_of_field(0)),
    };
    let pairs = state.pairs.iter().enumerate();
    let active: Vec<[usize; 2]> = pairs
        .flat_map(|(k, pairs)| (0..pairs.len()).filter(|&p| pairs[p].active).map(move |p| [k, p]))
        .collect();
    let mut rows = vec![ContactRow::default(); active.len()];
    model.threads.for_each_block(&mut rows, SHARE, |first, rows| {
        rows.iter_mut().zip(&active[first..]).for_each(|(row, [k, p])| *row = described.row(*k, *p));
    });
    rows
}

/// Forces of friction on the secondary side, in space: for each contact one for each pair, none of
/// contacts without friction.
fn rubbing(model: &Model, state: &State) -> Vec<Vec<[f64; 3]>> {
    let in_space = model.dimension == 3;
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
    rubbing
}

/// A state with what the rows of its pairs need.
struct Described<'a, 's> {
    model: &'a Model,
    state: &'s State,
    pressures: Pressures,
    /// Rows of the gaps: for each contact one for each pair.
    measured: &'s [contact::Rows],
    rubbing: Vec<Vec<[f64; 3]>>,
    has_field: bool,
}

impl<'a> Described<'a, '_> {
    /// The row of a pair of a contact.
    fn row(&self, k: usize, p: usize) -> ContactRow<'a> {
        let Self { model, state, pressures, .. } = self;
        let contact = &model.contacts[k];
        let pair = &state.pairs[k][p];
        let in_space = model.dimension == 3;
        let Tangential { traction, slip, .. } = pair.tangential;
        let node = contact.kinematics.secondary()[pair.node];
        let Opposed { gap, normal, size, shares, center } = opposed(contact, pair, &self.measured[k].row(p));
        let traction = traction.map(|of| size * of);
        let mean = |shares: &[(usize, f64)], of: &dyn Fn(usize) -> f64| {
            shares.iter().map(|(node, share)| share * of(*node)).sum()
        };
        let coordinate = |shares: &[(usize, f64)], i: usize| {
            let at = |node: usize| state.y[node * model.dimension + i];
            if i < model.dimension { mean(shares, &at) } else { 0.0 }
        };
        ContactRow {
            step: state.step,
            time: state.time,
            contact: contact.name.as_str().into(),
            node: node as u64,
            point: std::array::from_fn(|i| coordinate(&shares, i)),
            facet: pair.facet as u64,
            xi: pair.xi,
            eta: pair.eta,
            gap,
            multiplier: size * pair.lambda,
            pressure: mean(&shares, &|node| pressures.actual(k, node)),
            nominal: pressures.nominal(k, node),
            center: std::array::from_fn(|i| if self.has_field { coordinate(&center, i) } else { 0.0 }),
            normal,
            friction: match (&contact.friction, pair.tangential.friction_state) {
                (None, _) => "none",
                (Some(friction), _) if !friction.acts_on(pair.node) => "none",
                (_, FrictionState::Stick) => "stick",
                (_, FrictionState::Slip(_)) => "slip",
            }
            .into(),
            traction: if in_space { length(traction) } else { traction[0] },
            slip: if in_space { length(slip) } else { slip[0] },
            rubbing: self.rubbing[k].get(p).copied().unwrap_or_default(),
        }
    }
}

/// The position of a pair's node, or of the contact point of its edge, relative to the other side.
struct Opposed {
    /// NaN without a unique closest point.
    gap: f64,
    /// Outward unit normal of the primary; NaN without a unique closest point.
    normal: [f64; 3],
    /// Normal force for a multiplier of one: of a coefficient of a pressure field the share of its
    /// area that is covered, otherwise 1.
    size: f64,
    /// The nodes between which the contact point lies on its own side, with their shares in it.
    shares: Vec<(usize, f64)>,
    /// The nodes between which the resultant acts, with their shares in that point: it is the
    /// contact point but for coefficients of a pressure field, which stand for a node.
    center: Vec<(usize, f64)>,
}

fn opposed(contact: &Contact, pair: &Pair, row: &Row) -> Opposed {
    if row.nodes.is_empty() {
        let shares = vec![(contact.kinematics.secondary()[pair.node], 1.0)];
        return Opposed { gap: f64::NAN, normal: [f64::NAN; 3], size: 1.0, center: shares.clone(), shares };
    }
    let gap = row.gap - contact.kinematics.allowed(pair.node) - pair.depth;
    if !contact.kinematics.is_of_field(pair.node) {
        let shares: Vec<(usize, f64)> = row.shares().collect();
        return Opposed { gap, normal: row.normal(), size: 1.0, center: shares.clone(), shares };
    }
    let size = Vector(row.normal()).norm();
    let all: f64 = row.shares().map(|(_, share)| share).sum();
    Opposed {
        gap,
        normal: row.normal().map(|n| n / size),
        size,
        shares: vec![(contact.kinematics.secondary()[pair.node], 1.0)],
        center: row.shares().map(|(node, share)| (node, share / all)).collect(),
    }
}
