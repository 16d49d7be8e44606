//! Momentum in the algorithmic accelerations of the α family. Eqs. (14) and (15) summed over a free
//! body, with p = Σ M v, q = Σ M a and F̄ the mean force of the step:
//!
//! ```text
//! (1 − α_m) q_{s+1} + α_m q_s = F̄,   p_{s+1} − p_s = Δt [(1 − γ) q_s + γ q_{s+1}]
//! (p + c Δt q)_{s+1} − (p + c Δt q)_s = Δt F̄,   c = 1 − γ − α_m
//! ```
//!
//! for a constant Δt. A projection replaces q by the force at the state, and another Δt changes
//! c Δt q: the impulse c Δ(Δt q) that no force of a step accounts for. Both equations are linear,
//! so the part of q that is due to contact obeys the first one with the mean contact force. This
//! part is stored here, as a resultant on each secondary side.
//!
//! Velocities are ahead of the forces by c Δt (F − q) in schemes of second order (`works.rs`). What
//! they do not give back after a projection, or with another Δt, is work of the loads, supports and
//! obstacles whose forces these are: without it, dissipation would depend on the observer.

use crate::state::State;

/// Records a change of the step to `dt`; `factor`: c.
pub(crate) fn change_step(state: &mut State, factor: f64, dt: f64) {
    let old = std::mem::replace(&mut state.carried.dt, dt);
    if old == 0.0 || old == dt || factor == 0.0 {
        return;
    }
    keep(state, factor * (1.0 - dt / old) * state.ledger.relaxing);
    state.ledger.relaxing *= dt / old;
    for k in 0..state.carried.forces.len() {
        let force = state.carried.forces[k];
        record(state, k, force.map(|f| factor * (dt - old) * f));
    }
}

/// The first equation with the mean contact forces of a step and the weights of the inertia forces
/// at its end and start.
pub(crate) fn advance(state: &mut State, means: &[[f64; 3]], weights: [f64; 2]) {
    for (force, mean) in state.carried.forces.iter_mut().zip(means) {
        for (force, mean) in force.iter_mut().zip(mean) {
            *force = (mean - weights[1] * *force) / weights[0];
        }
    }
}

/// Records a projection: accelerations satisfy the balance at the state again.
pub(crate) fn project(state: &mut State, factor: f64) {
    keep(state, factor * state.ledger.relaxing);
    state.ledger.relaxing = 0.0;
    let forces = state.contact_forces.clone();
    replace(state, factor, &forces);
}

/// Records accelerations that satisfy the balance with these contact forces.
pub(crate) fn replace(state: &mut State, factor: f64, forces: &[[f64; 3]]) {
    for (k, &now) in forces.iter().enumerate() {
        let old = std::mem::replace(&mut state.carried.forces[k], now);
        let change = std::array::from_fn(|i| factor * state.carried.dt * (now[i] - old[i]));
        record(state, k, change);
    }
}

/// Books work on the momentum that velocities keep.
pub(crate) fn keep(state: &mut State, kept: f64) {
    state.ledger.external_work += kept;
    state.ledger.unbooked -= kept;
}

fn record(state: &mut State, contact: usize, change: [f64; 3]) {
    for i in 0..3 {
        state.impulses[contact][i] += change[i];
        state.ledger.algorithmic_impulse[i] += change[i];
    }
}
