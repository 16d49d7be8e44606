//! Where the energy of a step went (design.md §5): exact for eq. (15), because it uses the same averaged forces.
//!
//! ```text
//! F̄ = (1−α_f) F_{s+1} + α_f F_s,   Δy = y_{s+1} − y_s
//! external_work += Δy·F̄_ext (beyond the potential) + Δy_moved·R̄ + Δy/Δt·M J        contact_work += −Δy·F̄_cont
//! ```
//!
//! R̄ is the residual of eq. (15) at moved dofs, the force of their supports. J = v_{s+1} − v_s − Δt ā at moved dofs is what their velocities change
//! beyond their averaged acceleration ā: where a motion's velocity jumps, the impulse M J is the support's too, and its work is that of the mean
//! velocity. Load steps without inertia take the mean of both ends, F̄ = (F_{s+1} + F_s)/2: exact where forces are linear in the displacements.
//!
//! The increment of the dissipation then equals (Δy·F̄_int − ΔU) − (γ+α_m−1) Δy·MΔa + Δt² (β−γ/2) Δa·M(a_s + γΔa) to round-off (Krenk 2006).

use carom_contact::Linearised;

use crate::balance::{contact_weights, mean_acceleration};
use crate::case::ForceTime;
use crate::model::{Model, dot};
use crate::newton::Workspace;
use crate::state::State;

/// Books a solved step into `next`, before any projection. `work` holds the converged evaluation.
pub(crate) fn account<const D: usize>(
    model: &Model<D>,
    state: &State,
    next: &mut State,
    strain: f64,
    increment: &[f64],
    dt: f64,
    work: &Workspace<D>,
) {
    let (weights, before) = (work.stage.weights, work.stage.before);
    for i in 0..increment.len() {
        let averaged = if model.massless[i] {
            work.forces.contact[i] / weights.external
        } else {
            work.forces.contact[i] + before.contact * state.f_contact[i]
        };
        next.ledger.contact_work -= increment[i] * averaged;
    }
    next.ledger.external_work += work_of_loads(model, state, next, increment, work);
    if !work.motions.is_empty() {
        next.ledger.external_work += work_of_motions(model, state, next, increment, dt, work);
    }
    next.ledger.work = state.ledger.work + work_of_ends(model, state, next, increment, dt, work);
    book_contact_forces(model, next);
    for (k, contact) in model.contacts.iter().enumerate() {
        let (now, before) = contact_weights(&work.stage, contact.force);
        for i in 0..2 {
            next.ledger.impulse[i] += dt * (now * next.contact_forces[k][i] + before * state.contact_forces[k][i]);
        }
    }
    next.ledger.strain = strain;
    next.ledger.potential = model.potential(&next.y);
    book_kinetic(model, next);
}

/// Δy·F̄ of the loads.
fn work_of_loads<const D: usize>(
    model: &Model<D>,
    state: &State,
    next: &State,
    increment: &[f64],
    work: &Workspace<D>,
) -> f64 {
    if model.loads.is_empty() {
        return 0.0;
    }
    let (now, before) = (work.stage.weights.external, work.stage.before.external);
    let averaged = |i: usize| {
        if work.stage.is_static() {
            0.5 * (next.f_external[i] + state.f_external[i])
        } else if model.massless[i] {
            next.f_external[i]
        } else {
            now * work.forces.loads[i] + before * state.f_external[i]
        }
    };
    (0..increment.len()).map(|i| increment[i] * averaged(i)).sum()
}

/// Work of the supports that move.
fn work_of_motions<const D: usize>(
    model: &Model<D>,
    state: &State,
    next: &State,
    increment: &[f64],
    dt: f64,
    work: &Workspace<D>,
) -> f64 {
    if work.stage.is_static() {
        // Without inertia the force of a support is what is left of the others; contact at the step's start is known as far as it is averaged.
        let left = |s: &State, i: usize| s.f_internal[i] + s.f_contact[i] - model.gravity[i] - s.f_external[i];
        return model.motions.dofs().map(|i| 0.5 * increment[i] * (left(next, i) + left(state, i))).sum();
    }
    let weights = work.stage.weights;
    let mut jump = vec![0.0; increment.len()];
    let mut sum = 0.0;
    for i in model.motions.dofs() {
        let force = if model.massless[i] { work.residual[i] / weights.external } else { work.residual[i] };
        sum += increment[i] * force;
        jump[i] = next.v[i] - state.v[i] - dt * mean_acceleration(&work.stage, next.a[i], state.a[i]);
    }
    let mut impulse = vec![0.0; increment.len()];
    model.mass.multiply_into(&jump, &mut impulse);
    sum + dot(increment, &impulse) / dt
}

/// ∫F·dy of loads and moved supports over the step by the trapezoidal rule: what the guard holds energies against. The averaged forces of eq. (15) miss it
/// by (½ − α_f) Δy·ΔF, to first order in Δt, where forces change and α_f ≠ ½, though nothing is created.
fn work_of_ends<const D: usize>(
    model: &Model<D>,
    state: &State,
    next: &State,
    increment: &[f64],
    dt: f64,
    work: &Workspace<D>,
) -> f64 {
    let mean = |i: usize| 0.5 * (next.f_external[i] + state.f_external[i]);
    let loads = if model.loads.is_empty() { 0.0 } else { (0..increment.len()).map(|i| increment[i] * mean(i)).sum() };
    if work.motions.is_empty() {
        return loads;
    }
    // The force of a contact that acts at the end of the step is not known at its start.
    if work.stage.is_static() || model.contacts.iter().any(|c| c.force == ForceTime::End) {
        return loads + work_of_motions(model, state, next, increment, dt, work);
    }
    let (mut inertia, mut impulse) = (vec![0.0; increment.len()], vec![0.0; increment.len()]);
    let accelerations: Vec<f64> = next.a.iter().zip(&state.a).map(|(now, before)| now + before).collect();
    model.mass.multiply_into(&accelerations, &mut inertia);
    let (mut jump, mut sum) = (vec![0.0; increment.len()], loads);
    for i in model.motions.dofs() {
        let left = |s: &State| s.f_internal[i] + s.f_contact[i] - model.gravity[i] - s.f_external[i];
        sum += 0.5 * increment[i] * (inertia[i] + left(next) + left(state));
        jump[i] = next.v[i] - state.v[i] - 0.5 * dt * accelerations[i];
    }
    model.mass.multiply_into(&jump, &mut impulse);
    sum + dot(increment, &impulse) / dt
}

/// Kinetic energy of the velocities, and the largest energy so far.
pub(crate) fn book_kinetic<const D: usize>(model: &Model<D>, state: &mut State) {
    state.ledger.kinetic = model.kinetic(&state.v);
    state.ledger.largest = state.ledger.largest.max(state.ledger.kinetic + state.ledger.strain);
}

/// Force on the secondary side of each contact, −Σ λ ∂g/∂y_N.
pub(crate) fn book_contact_forces<const D: usize>(model: &Model<D>, state: &mut State) {
    let mut gap = Linearised::default();
    for (k, contact) in model.contacts.iter().enumerate() {
        let mut force = [0.0; 2];
        for pair in state.pairs[k].iter().filter(|p| p.active) {
            if contact.method.linearise(&mut pair.clone(), state.y.as_chunks::<D>().0, 0.0, &mut gap).is_ok() {
                for i in 0..D.min(2) {
                    force[i] -= pair.lambda * gap.gradient[0][i];
                }
            }
        }
        state.contact_forces[k] = force;
    }
}
