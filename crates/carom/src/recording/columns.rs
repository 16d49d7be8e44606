//! Columns of `history.csv` (design.md §1.4): one list that gives names, units and values, so that they cannot drift apart.

use carom_contact::Linearised;
use carom_record::Column;

use super::units::Labels;
use crate::case::{Case, Quantity};
use crate::evaluation::add_gradient;
use crate::model::{Model, Part};
use crate::simulation::GridReport;
use crate::state::State;

const AXES: [&str; 2] = ["x", "y"];

/// Names, units and meanings of the columns of a case.
pub fn columns<const D: usize>(case: &Case, model: &Model<D>) -> Vec<Column> {
    let label = Labels::of(case);
    let mut columns = Vec::new();
    let mut add = |name: String, unit: &str, description: &str, integer: bool| {
        columns.push(Column { name, unit: unit.into(), description: description.into(), integer });
    };
    let axes = &AXES[..D.min(2)];
    add("step".into(), "", "step on the grid of times", true);
    add("time".into(), &label.time, "time, step × Δt", false);
    add("dt".into(), &label.time, "time step of the grid", false);
    for (name, what) in [
        ("kinetic", "kinetic energy ½ vᵀM v"),
        ("strain", "strain energy"),
        ("potential", "potential of constant conservative loads"),
        ("total", "kinetic + strain + potential"),
        ("external_work", "work of the other loads and of supports, cumulative"),
        ("contact_work", "work of the contact forces on the bodies and of projections, cumulative"),
        ("dissipation", "external_work + contact_work − (total − total at the start); negative: created"),
    ] {
        add(name.into(), &label.energy, what, false);
    }
    for axis in axes {
        add(format!("momentum_{axis}"), &label.momentum, "momentum of all bodies", false);
    }
    if D > 1 {
        add("angular_momentum".into(), &label.angular_momentum, "moment of momentum about the origin", false);
    }
    for axis in axes {
        add(
            format!("contact_force_{axis}"),
            &label.force,
            "contact force on the secondary sides, end of the step",
            false,
        );
    }
    for axis in axes {
        add(
            format!("contact_impulse_{axis}"),
            &label.momentum,
            "its time integral so far, projections included",
            false,
        );
    }
    for (name, what) in [
        ("active", "pairs in contact"),
        ("activations", "nodes that came into contact in this step"),
        ("releases", "nodes that left contact in this step"),
        ("newton", "Newton iterations of this step"),
        ("rejected", "rejected (bisected) steps in this step"),
    ] {
        add(name.into(), "", what, true);
    }
    add("penetration".into(), &label.length, "depth of the deepest secondary node", false);
    add("min_det_f".into(), "", "smallest J over all quadrature points", false);
    for part in &model.parts {
        for axis in axes {
            add(format!("{}.center_{axis}", part.name), &label.length, "centre of mass", false);
        }
        for axis in axes {
            add(format!("{}.velocity_{axis}", part.name), &label.velocity, "velocity of the centre of mass", false);
        }
    }
    if model.contacts.len() > 1 {
        for contact in &model.contacts {
            for axis in axes {
                add(
                    format!("{}.force_{axis}", contact.name),
                    &label.force,
                    "contact force on its secondary side",
                    false,
                );
            }
        }
    }
    for support in &model.supports {
        for axis in axes {
            add(format!("{}.reaction_{axis}", support.name), &label.force, "force of the support on the bodies", false);
        }
    }
    for probe in &model.probes {
        for quantity in &probe.record {
            let (name, unit, what) = match quantity {
                Quantity::Ux => ("ux", &label.length, "displacement along x"),
                Quantity::Uy => ("uy", &label.length, "displacement along y"),
                Quantity::Vx => ("vx", &label.velocity, "velocity along x"),
                Quantity::Vy => ("vy", &label.velocity, "velocity along y"),
                Quantity::Ax => ("ax", &label.acceleration, "acceleration along x"),
                Quantity::Ay => ("ay", &label.acceleration, "acceleration along y"),
                Quantity::SigmaXx => ("sigma_xx", &label.stress, "Cauchy stress"),
                Quantity::SigmaYy => ("sigma_yy", &label.stress, "Cauchy stress"),
                Quantity::SigmaXy => ("sigma_xy", &label.stress, "Cauchy stress"),
                Quantity::VonMises => ("von_mises", &label.stress, "von Mises stress of the Cauchy stress"),
                Quantity::DetF => ("det_f", &label.none, "volume ratio J"),
            };
            add(format!("{}.{name}", probe.name), unit, what, false);
        }
    }
    if model.loads.manufactured.is_some() {
        add("error_l2".into(), "", "√∫|y_h − y|² dΩ₀ against the motion of [manufactured]", false);
        add("error_h1".into(), "", "√∫|∂y_h/∂X − ∂y/∂X|² dΩ₀ against the motion of [manufactured]", false);
    }
    columns
}

/// Shares of a body's nodes in its centre of mass; of its volume where it has no mass. They add up to one.
pub(super) fn center_weights<const D: usize>(model: &Model<D>) -> Vec<f64> {
    let mut weights = vec![0.0; model.mass.nodes()];
    for part in &model.parts {
        let mesh = part.body.mesh();
        let mut volumes = vec![0.0; mesh.element.nodes()];
        for node in part.nodes() {
            weights[node] = model.mass.row(node).map(|(_, m)| m).sum();
        }
        if part.massless {
            for cell in 0..mesh.cell_count() {
                part.body.cell_volumes(cell, &mut volumes);
                for (&node, volume) in mesh.cell(cell).iter().zip(&volumes) {
                    weights[part.first_node + node] += volume;
                }
            }
        }
        let total: f64 = weights[part.nodes()].iter().sum();
        weights[part.nodes()].iter_mut().for_each(|w| *w /= total);
    }
    weights
}

/// One row, in the order of [`columns`].
pub(super) fn row<const D: usize>(
    model: &Model<D>,
    state: &State,
    dt: f64,
    report: &GridReport,
    weights: &[f64],
    row: &mut Vec<f64>,
) {
    let ledger = &state.ledger;
    let axes = D.min(2);
    row.clear();
    row.extend([state.step as f64, state.time, dt]);
    row.extend([ledger.kinetic, ledger.strain, ledger.potential, ledger.total()]);
    row.extend([ledger.external_work, ledger.contact_work, ledger.dissipation()]);

    let mut momentum = vec![0.0; state.v.len()];
    model.mass.multiply_into(&state.v, &mut momentum);
    let nodal = momentum.as_chunks::<D>().0;
    row.extend((0..axes).map(|i| nodal.iter().map(|p| p[i]).sum::<f64>()));
    if D > 1 {
        let y = state.y.as_chunks::<D>().0;
        row.push(y.iter().zip(nodal).map(|(y, p)| y[0] * p[1] - y[1] * p[0]).sum());
    }
    row.extend((0..axes).map(|i| state.contact_forces.iter().map(|f| f[i]).sum::<f64>()));
    row.extend(&ledger.impulse[..axes]);

    let active = state.pairs.iter().flatten().filter(|p| p.active).count();
    row.push(active as f64);
    row.extend([report.activations, report.releases, report.newton, report.rejected].map(f64::from));
    row.push(penetration(model, state));
    row.push(model.min_det_f(&state.y));
    for part in &model.parts {
        for field in [&state.y, &state.v] {
            row.extend((0..axes).map(|i| mean(part, field, weights, i)));
        }
    }
    if model.contacts.len() > 1 {
        row.extend(state.contact_forces.iter().flat_map(|f| f[..axes].to_vec()));
    }
    if !model.supports.is_empty() {
        let reaction = reactions(model, state);
        for support in &model.supports {
            row.extend(
                (0..axes)
                    .map(|i| support.dofs.iter().filter(|dof| *dof % D == i).map(|&dof| reaction[dof]).sum::<f64>()),
            );
        }
    }
    for probe in &model.probes {
        probe.values(model, state, row);
    }
    if let Some(motion) = &model.loads.manufactured {
        row.extend(motion.errors(&model.parts, &state.y, state.time));
    }
}

fn mean<const D: usize>(part: &Part<D>, field: &[f64], weights: &[f64], i: usize) -> f64 {
    part.nodes().map(|node| weights[node] * field[node * D + i]).sum()
}

/// Depth of the deepest secondary node, ≥ 0.
fn penetration<const D: usize>(model: &Model<D>, state: &State) -> f64 {
    let mut gap = Linearised::default();
    let mut depth = 0.0_f64;
    for (contact, pairs) in model.contacts.iter().zip(&state.pairs) {
        for pair in pairs {
            if contact.method.linearise(&mut pair.clone(), state.y.as_chunks::<D>().0, 0.0, &mut gap).is_ok() {
                depth = depth.max(-gap.gap);
            }
        }
    }
    depth
}

/// What supports do to the bodies at held dofs: M a + f_int + Gᵀλ − f_ext there.
fn reactions<const D: usize>(model: &Model<D>, state: &State) -> Vec<f64> {
    let mut force = vec![0.0; model.dofs()];
    model.mass.multiply_into(&state.a, &mut force);
    for i in 0..force.len() {
        force[i] += state.f_internal[i] - model.gravity[i] - state.f_external[i];
    }
    let mut gap = Linearised::default();
    for (contact, pairs) in model.contacts.iter().zip(&state.pairs) {
        for pair in pairs.iter().filter(|p| p.active) {
            if contact.method.linearise(&mut pair.clone(), state.y.as_chunks::<D>().0, 0.0, &mut gap).is_ok() {
                add_gradient(&gap, pair.lambda, &mut force);
            }
        }
    }
    force
}
