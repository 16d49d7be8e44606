//! Values of the columns of `history.csv`, in the order of `columns.rs` of `carom-case`, which has
//! their names.

use std::borrow::Cow;

use carom_contact::{FrictionState, Pair, Rows};
use carom_mechanics::model::{Model, Pivot};
use carom_mechanics::{Depths, GridReport, Simulation, State, each_slip};

use serde::{Deserialize, Serialize};

/// Whether a contact has friction.
fn rubs(model: &Model) -> bool {
    model.contacts.iter().any(|contact| contact.friction.is_some())
}

/// Weights of a body's nodes in its centre of mass, or of volume if it is massless. They sum to
/// one.
pub(super) fn center_weights(model: &Model) -> Vec<f64> {
    let mut weights = vec![0.0; model.mass.nodes()];
    for part in &model.parts {
        let mesh = part.body.mesh();
        let mut volumes = vec![0.0; mesh.element.nodes()];
        for node in part.nodes() {
            weights[node] = model.mass.row(node).map(|(_, m)| m).sum();
        }
        if part.is_massless() {
            for cell in 0..mesh.cell_count() {
                part.body.cell_volumes(cell, &mut volumes);
                for (&node, volume) in mesh.cell(cell).iter().zip(&volumes) {
                    weights[part.first_node + node] += volume;
                }
            }
        }
        if part.is_rigid() {
            // The carrier of an obstacle; the next node is its angle.
            weights[part.first_node] = 1.0;
        }
        let total: f64 = weights[part.nodes()].iter().sum();
        weights[part.nodes()].iter_mut().for_each(|w| *w /= total);
    }
    weights
}

/// Counts and weights that the rows of a run need beside its state.
pub(super) struct Recorded {
    /// Weights of a body's nodes in its centre of mass.
    pub(super) weights: Vec<f64>,
    /// Bodies that yield.
    pub(super) yielding: Vec<usize>,
}

/// The row of the current state, in the order of
/// [`history_columns`](carom_case::history_columns). `measured`:
/// [`active_rows`](carom_mechanics::active_rows) there.
pub(super) fn row(simulation: &Simulation, measured: &[Rows], since: &Since, of: &Recorded) -> Vec<f64> {
    let Recorded { weights, yielding } = of;
    let model = simulation.model();
    let state = simulation.state();
    let ledger = &state.ledger;
    let d = model.dimension;
    let mut row = Vec::new();
    row.extend([state.step as f64, state.time, simulation.grid().length(state.step)]);
    row.extend([ledger.kinetic, ledger.strain, ledger.potential, ledger.total()]);
    row.extend([ledger.external_work, ledger.contact_work, ledger.friction_work, ledger.dissipation()]);
    row.extend([ledger.created.most(), ledger.scale()]);

    let momenta = model.momenta(&state.y, &state.v);
    row.extend(&momenta.linear[..d]);
    match d {
        2 => row.push(momenta.angular[2]),
        3 => row.extend(momenta.angular),
        _ => {}
    }
    row.extend((0..d).map(|i| state.contact_forces.iter().map(|f| f[i]).sum::<f64>()));
    row.extend(&state.impulse()[..d]);
    row.extend(&ledger.algorithmic_impulse[..d]);

    let active = state.pairs.iter().flatten().filter(|p| p.active).count();
    row.push(active as f64);
    row.extend([since.activations, since.releases, since.newton, since.rejected].map(f64::from));
    row.extend(simulation.has_fallback().then_some(f64::from(since.fallbacks)));
    row.extend([since.penetration.all, since.penetration.constrained]);
    row.push(state.min_det_f(model));
    if rubs(model) {
        let sticks = |pair: &&Pair| pair.active && pair.tangential.friction_state == FrictionState::Stick;
        let rubbing =
            model.contacts.iter().zip(&state.pairs).filter(|(contact, _)| contact.friction.is_some());
        row.push(rubbing.flat_map(|(_, pairs)| pairs).filter(sticks).count() as f64);
        row.extend([ledger.rubbed.stick_time, ledger.rubbed.contact_time, ledger.rubbed.farthest]);
    }
    for part in &model.parts {
        for field in [&state.y, &state.v] {
            row.extend(&model.mean(part, weights, field)[..d]);
        }
    }
    if !yielding.is_empty() {
        row.push(0.0 - ledger.materials);
    }
    let memory = state.materials.past(0.0).memory;
    for &body in yielding {
        row.push(0.0 - state.materials.dissipated().get(body).copied().unwrap_or(0.0));
        row.push(model.plastic_strain(body, memory));
    }
    if model.contacts.len() > 1 {
        row.extend(state.contact_forces.iter().flat_map(|f| f[..d].to_vec()));
    }
    if !model.supports.is_empty() || !model.ties.is_empty() {
        let mut reaction = reactions(model, state, measured);
        let mut transmitted = reaction.clone();
        model.points.pass_on(&mut transmitted);
        for tie in &model.ties {
            let force = |nodes: &[usize], i: usize| {
                let dofs = nodes.iter().map(|node| node * d + i);
                let own = dofs.filter(|dof| tie.supported.binary_search(dof).is_err());
                own.map(|dof| transmitted[dof]).sum::<f64>()
            };
            let [secondary, primary] = &tie.tied;
            row.extend((0..d).map(|i| force(secondary, i) - force(primary, i)));
        }
        model.points.gather(&mut reaction);
        for support in &model.supports {
            row.extend((0..d).map(|i| {
                support.dofs.iter().filter(|dof| *dof % d == i).map(|&dof| reaction[dof]).sum::<f64>()
            }));
            if let Some(pivot) = &support.moment_about {
                let about = match pivot {
                    Pivot::Point(point) => point,
                    Pivot::Node(node) => &state.y[node * d..(node + 1) * d],
                };
                let moment = moment(&support.dofs, &reaction, &state.y, about);
                row.extend(&moment[if d == 2 { 2..3 } else { 0..3 }]);
            }
        }
    }
    for probe in &model.probes {
        probe.values(
            &model.parts,
            &model.reference,
            [&state.y, &state.v, &accelerations(state)],
            state.materials.past(0.0).memory,
            &mut row,
        );
    }
    if let Some(motion) = &model.loads.manufactured {
        row.extend(motion.errors(&model.parts, &state.y, state.time));
    }
    row
}

/// Moment of the forces at some dofs about a point.
fn moment(dofs: &[usize], forces: &[f64], y: &[f64], about: &[f64]) -> [f64; 3] {
    let d = about.len();
    let mut moment = [0.0; 3];
    for &dof in dofs {
        let axis = dof % d;
        let node = dof / d;
        // e_i × e_axis = ± e_j.
        for i in (0..d).filter(|&i| i != axis) {
            let arm = y[node * d + i] - about[i];
            let sign = if (i + 1) % 3 == axis { 1.0 } else { -1.0 };
            moment[3 - i - axis] += sign * arm * forces[dof];
        }
    }
    moment
}

/// Events since the previous row: their sums do not depend on how often rows are written.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct Since {
    newton: u32,
    rejected: u32,
    fallbacks: u32,
    activations: u32,
    releases: u32,
    penetration: Depths,
}

impl Since {
    /// Adds a step.
    pub(super) fn add(&mut self, report: &GridReport) {
        self.newton += report.newton;
        self.rejected += report.rejected;
        self.fallbacks += report.fallbacks;
        self.activations += report.activations;
        self.releases += report.releases;
        self.penetration = self.penetration.max(report.penetration);
    }
}

/// Accelerations, with the velocity jumps of impulses that do not enter those of the scheme.
fn accelerations(state: &State) -> Cow<'_, [f64]> {
    if state.jumps.is_empty() {
        return Cow::Borrowed(&state.a);
    }
    state.a.iter().zip(&state.jumps).map(|(a, jump)| a + jump).collect()
}

/// Reaction forces on the bodies at constrained dofs and tied nodes: M a + f_int + Gᵀλ − f_ext,
/// with the contact forces of the balance; where impulses take their place, with those of the
/// pairs.
fn reactions(model: &Model, state: &State, measured: &[Rows]) -> Vec<f64> {
    let mut force = vec![0.0; model.dofs()];
    model.mass.multiply_into(&accelerations(state), &mut force);
    for i in 0..force.len() {
        force[i] += state.f_internal[i] - model.gravity[i] - state.f_external[i];
    }
    if state.f_contact.iter().any(|force| *force != 0.0) {
        force.iter_mut().zip(&state.f_contact).for_each(|(force, contact)| *force += contact);
        return force;
    }
    for (rows, pairs) in measured.iter().zip(&state.pairs) {
        rows.iter().zip(pairs).for_each(|(row, pair)| row.add_to(pair.lambda, &mut force));
    }
    each_slip(model, state, |_, _, traction, row| row.add_to(traction, &mut force));
    force
}
