//! Where the energy of a step went (design.md §5): exact for eq. (15), because it uses the same averaged forces.
//!
//! ```text
//! F̄ = (1−α_f) F_{s+1} + α_f F_s,   Δy = y_{s+1} − y_s                    F̄ of other kernels: the mean their velocity update makes, `Stage::mean`
//! external_work += Δy·F̄_ext (beyond the potential)        contact_work += −Δy·F̄_cont
//! ```
//!
//! The increment of the dissipation of the α family then equals (Δy·F̄_int − ΔU) − (γ+α_m−1) Δy·MΔa + Δt² (β−γ/2) Δa·M(a_s + γΔa) to round-off
//! (Krenk 2006).

use carom_contact::{Linearised, Pair};

use crate::case::ForceTime;
use crate::model::Model;
use crate::newton::Workspace;
use crate::state::{Previous, State};

/// Adds what a solved stage gives to the mean contact force over the step (`work.mean`, nodal; cleared before the first stage) and to its impulse.
/// `work` holds the converged evaluation, `previous` the step before of a two-step scheme.
pub(crate) fn add_stage<const D: usize>(
    model: &Model<D>,
    state: &State,
    previous: Option<&Previous>,
    pairs: &[Vec<Pair>],
    dt: f64,
    impulse: &mut [f64; 2],
    work: &mut Workspace<D>,
) {
    let [old, start, now] = work.stage.mean;
    let (share, last) = (now / work.stage.weights.contact, work.stage.end == 1.0);
    for i in 0..work.mean.len() {
        let contact = work.forces.contact[i];
        if model.massless[i] {
            // Without inertia there is nothing to average with: the force at the end of the step.
            work.mean[i] = if last { contact / work.stage.weights.external } else { 0.0 };
        } else {
            work.mean[i] += share * contact + start * state.f_contact[i];
        }
    }
    if let Some(previous) = previous {
        for (i, force) in previous.contact.iter().enumerate().filter(|(i, _)| !model.massless[*i]) {
            work.mean[i] += old * force;
        }
        (0..2).for_each(|i| impulse[i] += old * previous.impulse[i]);
    }
    for (k, contact) in model.contacts.iter().enumerate() {
        let (now, start) = if contact.force == ForceTime::End { (1.0, 0.0) } else { (now, start) };
        let force = secondary_force(&pairs[k], &work.gaps[k]);
        for i in 0..2 {
            impulse[i] += dt * (now * force[i] + start * state.contact_forces[k][i]);
        }
    }
}

/// Books a solved step into `next`, before any projection. `work.mean` is the mean contact force.
pub(crate) fn account<const D: usize>(
    model: &Model<D>,
    next: &mut State,
    strain: f64,
    increment: &[f64],
    impulse: [f64; 2],
    work: &Workspace<D>,
) {
    for (moved, force) in increment.iter().zip(&work.mean) {
        next.ledger.contact_work -= moved * force;
    }
    // What went into springs is not lost: it is counted with the strain energy.
    next.ledger.contact_work += work.springs - next.ledger.springs;
    next.ledger.springs = work.springs;
    book_contact_forces(model, next);
    (0..2).for_each(|i| next.ledger.impulse[i] += impulse[i]);
    next.ledger.strain = strain + work.springs;
    next.ledger.potential = model.potential(&next.y);
    book_kinetic(model, next);
}

/// Force on a secondary side, −Σ λ ∂g/∂y_N, from gaps that are linearised already.
fn secondary_force<const D: usize>(pairs: &[Pair], gaps: &[Linearised<D>]) -> [f64; 2] {
    let mut force = [0.0; 2];
    for (pair, gap) in pairs.iter().zip(gaps).filter(|(pair, _)| pair.active) {
        for i in 0..D.min(2) {
            force[i] -= pair.lambda * gap.gradient[0][i];
        }
    }
    force
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
