//! Where stick begins. A pair that slipped and now sticks does not move in the step, but its slip
//! rate at the end is what the scheme makes of the one at the start: of the trapezoidal rule and of
//! the midpoint rule Hv_{s+1} = −Hv_s, for ever, since their spectral radius at infinite frequency
//! is one. Its traction then alternates about the right one, by as much at any step, and leaves the
//! cone too early. So
//!
//! ```text
//! M Δv + Gᵀp + Hᵀq = 0,    G Δv = 0,    H (v + Δv) = 0 in stick
//! ```
//!
//! and accelerations follow (`persistency.rs`). The impulse q has no cone: the step has decided
//! that the pair sticks, and Hv is only what its size leaves, O(Δt). Its work is that of friction,
//! and where a support carries the other side, of that support.

use carom_contact::{FrictionState, Pair, inner};

use crate::linear::system::System;
use crate::model::Model;
use crate::rejected::Rejected;
use crate::state::State;
use crate::velocity::cone::{Closed, Works};

/// Whether an active pair of a state sticks which slipped before.
pub(crate) fn begins_to_stick(state: &State, before: &State, (contact, p): (usize, usize)) -> bool {
    let pair = &state.pairs[contact][p];
    let sticks = |pair: &Pair| pair.tangential.friction_state == FrictionState::Stick;
    sticks(pair) && before.past(contact, pair).is_some_and(|old| !sticks(old))
}

/// Stops the slips of pairs that stick.
pub(crate) fn stop_slips(
    model: &Model,
    state: &mut State,
    closed: &Closed,
    system: &mut System,
) -> Result<Works, Rejected> {
    let rates = closed.slip_rates(&state.v);
    let jump = closed.stop(model, state, &rates, system)?;
    let friction = -0.5 * rates.iter().zip(&jump.tangential).map(|(rate, q)| inner(*rate, *q)).sum::<f64>();
    let external = closed.work_of_supports(model, state, &jump);
    closed.strike(model, state, &jump);
    Ok(Works { friction, external })
}
