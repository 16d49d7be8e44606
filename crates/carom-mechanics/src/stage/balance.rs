//! The balance of forces, eq. (15), which combines space, contact and time.
//!
//! ```text
//! r(d, λ) =  w.mass M a(d) + w.internal f_int + w.contact Gᵀλ − w.external f_ext
//!          + b.mass M a_s  + b.internal f_int,s + b.contact f_cont,s − b.external f_ext,s
//! ```
//!
//! with y = y_s + d, a(d) and the weights w (end of stage) and b (start of step) from the stage.
//! The unknown is the increment d: formed from rounded positions, the acceleration would carry
//! their last digit divided by Δt². A massless dof has no inertia to average with: its balance
//! is enforced at s + 1 only. f_ext is gravity and the loads, evaluated at the same time (and, for
//! pressures, positions) as f_int. The residual of a constrained dof is its reaction force.
//!
//! A lack of balance at the start of a run, as where a support lets go of a strained body or a load
//! acts at once, does not become smaller with a load step. Where no step reaches balance from
//! there, it fades in proportion to the time until the end of the first step of the grid.
//!
//! At prescribed dofs the acceleration ü is known, and M ü acts on the neighbours like an external
//! force, averaged with α_f. The scheme's own a is another quantity, with a delay of (α_f − α_m)Δt
//! (Erlicher, Bonaventura, Bursi 2002): averaging ü with α_m instead costs an order.

use carom_algebra::sums::dot;
use carom_algebra::wide;
use carom_time::{Stage, Weights};

use crate::model::Model;
use crate::state::State;

/// The forces of one evaluation, flat over all dofs.
#[derive(Clone, Debug, Default)]
pub struct Forces {
    /// M a(d).
    pub inertia: Vec<f64>,
    /// f_int.
    pub internal: Vec<f64>,
    /// f_ext without gravity.
    pub loads: Vec<f64>,
    /// Σ w.contact Gᵀλ, weighted per contact.
    pub contact: Vec<f64>,
    /// The part of friction in them; empty without friction.
    pub friction: Vec<f64>,
}

/// Weights of a contact's force at the end and the start: averaged as in eq. (15), or end only.
pub(crate) fn contact_weights(stage: &Stage, at_the_end: bool) -> (f64, f64) {
    if at_the_end { (1.0, 0.0) } else { (stage.weights.contact, stage.before.contact) }
}

/// Mean over the step of the known acceleration of a prescribed dof, with the weights of external
/// forces.
pub(crate) fn mean_acceleration(stage: &Stage, now: f64, before: f64) -> f64 {
    let weight = stage.weights.external;
    let known = stage.before.external;
    weight * (1.0 - stage.average) * now + (known + weight * stage.average) * before
}

/// The second line of the balance: terms known from the state at the step's start.
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
            let averaged = state.f_contact[i] - state.f_at_end.get(i).copied().unwrap_or(0.0);
            mass * known[i] + internal * state.f_internal[i] + contact * averaged
                - external * (model.gravity[i] + state.f_external[i])
        };
    }
}

/// Share of the forces above which they are not in balance: far above the tolerance of a step.
const UNBALANCED: f64 = 1e-6;

/// Whether the forces of a state without inertia are not in balance.
pub(crate) fn lacks_balance(model: &Model, state: &State) -> bool {
    let mut lacking = Vec::new();
    imbalance_into(model, state, 1.0, &mut lacking);
    let all = [&state.f_internal, &state.f_contact, &state.f_external, &model.gravity];
    norm(&lacking) > UNBALANCED * all.map(|forces| norm(forces)).iter().sum::<f64>()
}

fn norm(x: &[f64]) -> f64 {
    dot(x, x).sqrt()
}

/// Overwrites `known` with a share of the lack of balance of the forces at the start of a load
/// step; nothing on prescribed dofs, where it is their reaction.
pub(crate) fn imbalance_into(model: &Model, state: &State, share: f64, known: &mut Vec<f64>) {
    known.clear();
    known.extend((0..model.dofs()).map(|i| {
        let loads = model.gravity[i] + state.f_external[i];
        -share * (state.f_internal[i] + state.f_contact[i] - loads)
    }));
    model.points.gather(known);
    known.iter_mut().zip(&model.fixed).filter(|(_, fixed)| **fixed).for_each(|(known, _)| *known = 0.0);
}

/// The terms of r at a dof: of inertia, of internal, contact and external forces, and those known.
pub(crate) fn terms(model: &Model, stage: &Stage, forces: &Forces, known: &[f64], dof: usize) -> [f64; 5] {
    let Weights { mass, internal, external, .. } = stage.weights;
    [
        mass * forces.inertia[dof],
        internal * forces.internal[dof],
        forces.contact[dof],
        -external * (model.gravity[dof] + forces.loads[dof]),
        known[dof],
    ]
}

/// r over all dofs, of points pulled back to what carries them. Returns its norm over the free
/// ones, and the sum of the norms of its terms as reference.
pub(crate) fn residual_into(
    model: &Model,
    stage: &Stage,
    forces: &Forces,
    known: &[f64],
    residual: &mut [f64],
) -> (f64, f64) {
    let balance = Terms { model, stage, forces, known };
    let mut of_blocks = vec![[0.0; 6]; residual.len().div_ceil(BLOCK)];
    model.threads.for_each(residual.chunks_mut(BLOCK).zip(&mut of_blocks), |block, (residual, squares)| {
        *squares = wide(
            #[inline(always)]
            || balance.sum_into(block * BLOCK, residual),
        );
    });
    let mut squares = [0.0; 6];
    for of_block in &of_blocks {
        squares.iter_mut().zip(of_block).for_each(|(sum, square)| *sum += square);
    }
    if !model.points.is_empty() {
        model.points.gather(residual);
        let free = (0..residual.len()).filter(|&i| !model.fixed[i]);
        squares[5] = free.map(|i| residual[i] * residual[i]).sum();
    }
    let norms = squares.map(f64::sqrt);
    (norms[5], norms[..5].iter().sum())
}

/// Dofs that a thread sums.
const BLOCK: usize = 4096;
/// Dofs that are summed at once.
const LANES: usize = 8;

/// Model, weights and forces from which the terms of the residual r are summed.
struct Terms<'a> {
    model: &'a Model,
    stage: &'a Stage,
    forces: &'a Forces,
    known: &'a [f64],
}

impl Terms<'_> {
    /// Computes r of consecutive dofs. Returns the sums of the squares of its five terms, and of
    /// its own, over the free ones.
    #[inline(always)]
    fn sum_into(&self, first: usize, residual: &mut [f64]) -> [f64; 6] {
        let Self { model, stage, forces, known } = self;
        let Weights { mass, internal, external, .. } = stage.weights;
        let mut sums = [[0.0; LANES]; 6];
        for (k, residual) in residual.chunks_mut(LANES).enumerate() {
            let i = first + k * LANES;
            let count = residual.len();
            let inertia = lane(&forces.inertia, i, count);
            let of_bodies = lane(&forces.internal, i, count);
            let contact = lane(&forces.contact, i, count);
            let gravity = lane(&model.gravity, i, count);
            let loads = lane(&forces.loads, i, count);
            let known = lane(known, i, count);
            let fixed = lane(&model.fixed, i, count);
            let mut sum = [0.0; LANES];
            for l in 0..LANES {
                let terms = [
                    mass * inertia[l],
                    internal * of_bodies[l],
                    contact[l],
                    -external * (gravity[l] + loads[l]),
                    known[l],
                ];
                sum[l] = terms[0] + terms[1] + terms[2] + terms[3] + terms[4];
                for (square, term) in sums.iter_mut().zip(terms.into_iter().chain([sum[l]])) {
                    square[l] += if fixed[l] { 0.0 } else { term * term };
                }
            }
            residual.copy_from_slice(&sum[..count]);
        }
        sums.map(|lanes| lanes.iter().sum())
    }
}

/// Consecutive entries of a vector; where there are fewer, zeros follow.
#[inline(always)]
fn lane<T: Copy + Default>(of: &[T], first: usize, count: usize) -> [T; LANES] {
    let mut lane = [T::default(); LANES];
    if count == LANES {
        lane.copy_from_slice(&of[first..first + LANES]);
    } else {
        lane[..count].copy_from_slice(&of[first..first + count]);
    }
    lane
}
