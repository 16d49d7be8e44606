//! The balance of forces, eq. (15): where space, contact and time meet.
//!
//! ```text
//! r(d, λ) =  w.mass M a(d) + w.internal f_int + w.contact Gᵀλ − w.external f_ext
//!          + b.mass M a_s  + b.internal f_int,s + b.contact f_cont,s − b.external f_ext,s
//! ```
//!
//! with y = y_s + d, a(d) and the weights w (now), b (before) from the stage. The unknown is the
//! increment d: formed from rounded positions, the acceleration would carry their last digit
//! divided by Δt². A dof without mass has no inertia to average with: its balance holds at s + 1
//! alone. f_ext is gravity and the loads at the same time (and, of pressures, positions) as f_int.
//! The residual of a held dof is what its support must exert.
//!
//! At dofs that move as a formula says, the acceleration ü is known, and M ü acts on the neighbours
//! like an external force, averaged with α_f. The scheme's own a is another quantity, late by (α_f
//! − α_m)Δt (Erlicher, Bonaventura, Bursi 2002): ü averaged with α_m in its place costs an order.

use carom_time::{Stage, Weights};

use crate::model::Model;
use crate::state::State;

/// The forces of one evaluation, flat over all dofs.
#[derive(Clone, Debug, Default)]
pub(crate) struct Forces {
    /// M a(d).
    pub inertia: Vec<f64>,
    /// f_int.
    pub internal: Vec<f64>,
    /// f_ext without gravity.
    pub loads: Vec<f64>,
    /// Σ w.contact Gᵀλ, weighted per contact.
    pub contact: Vec<f64>,
}

/// Weight of a contact's force now and before: averaged like eq. (15), or all at the end.
pub(crate) fn contact_weights(stage: &Stage, at_the_end: bool) -> (f64, f64) {
    if at_the_end { (1.0, 0.0) } else { (stage.weights.contact, stage.before.contact) }
}

/// Mean over the step of the known acceleration of a moved dof: the weights are those of external
/// forces.
pub(crate) fn mean_acceleration(stage: &Stage, now: f64, before: f64) -> f64 {
    let (weight, known) = (stage.weights.external, stage.before.external);
    weight * (1.0 - stage.average) * now + (known + weight * stage.average) * before
}

/// The lower line of the balance: what is known from the state at the step's start.
pub(crate) fn known_into(model: &Model, stage: &Stage, state: &State, known: &mut Vec<f64>) {
    let Weights { mass, internal, external, contact } = stage.before;
    known.clear();
    known.resize(model.dofs(), 0.0);
    if stage.before == Weights::default() {
        return;
    }
    model.mass.multiply_into(&state.a, known);
    for i in 0..known.len() {
        known[i] = if model.massless[i] {
            0.0
        } else {
            mass * known[i] + internal * state.f_internal[i] + contact * state.f_contact[i]
                - external * (model.gravity[i] + state.f_external[i])
        };
    }
}

/// r over all dofs. Its norm over the free ones is returned, and the sum of the norms of its terms,
/// the scale it is small against.
pub(crate) fn residual_into(
    model: &Model,
    stage: &Stage,
    forces: &Forces,
    known: &[f64],
    residual: &mut [f64],
) -> (f64, f64) {
    let Weights { mass, internal, external, .. } = stage.weights;
    let mut squares = [0.0_f64; 6];
    for i in 0..residual.len() {
        let terms = [
            mass * forces.inertia[i],
            internal * forces.internal[i],
            forces.contact[i],
            -external * (model.gravity[i] + forces.loads[i]),
            known[i],
        ];
        residual[i] = terms.iter().sum();
        if !model.fixed[i] {
            for (square, term) in squares.iter_mut().zip(terms) {
                *square += term * term;
            }
            squares[5] += residual[i] * residual[i];
        }
    }
    let norms = squares.map(f64::sqrt);
    (norms[5], norms[..5].iter().sum())
}
