//! Where the energy of a step went (design.md §5): exact for eq. (15), because it uses the same averaged forces.
//!
//! ```text
//! F̄ = (1−α_f) F_{s+1} + α_f F_s,   Δy = y_{s+1} − y_s
//! external_work += Δy·F̄_ext (beyond the potential)        contact_work += −Δy·F̄_cont
//! ```
//!
//! The increment of the dissipation then equals (Δy·F̄_int − ΔU) − (γ+α_m−1) Δy·MΔa + Δt² (β−γ/2) Δa·M(a_s + γΔa) to round-off (Krenk 2006).

use carom_contact::Linearised;

use crate::balance::contact_weights;
use crate::model::Model;
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
