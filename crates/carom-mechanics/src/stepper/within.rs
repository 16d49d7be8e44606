//! Impact within a step of several stages. The rule of the next stage weighs the start and the end
//! of this one: where gaps close in it, its velocities and accelerations are projected like those
//! at the end of a step (`persistency.rs`), before the next stage uses them.
//!
//! Without that, the trapezoidal rule to γΔt throws a mass that meets a wall after θΔt back with
//! v₁ = (1 − 2θ/γ) |v₀|, with twice the force that would stop it; the next stage lets go of it with
//!
//! ```text
//! v₂ = [(1 − θ/γ) 4q₁/γ − 1] |v₀|       more than |v₀| for θ < γ − γ²/(2q₁)
//! ```
//!
//! and up to 3 |v₀| for a gap that is zero at the start, whatever Δt.

use carom_contact::{Pair, Pairing};

use crate::friction_state::take_slips;
use crate::ledger::balance_into;
use crate::rejected::Rejected;
use crate::stage::equations::Equations;
use crate::stage::evaluation::Evaluation;
use crate::state::State;
use crate::velocity::persistency::project_stage;
use crate::workspace::Workspace;

/// Projects the velocities and accelerations of `next` at the end of a stage, and the contact
/// forces of that stage, if a gap closes in it that requires it. Returns the forces on the
/// secondary side of each contact.
///
/// # Errors
/// If there is no projection.
pub(super) fn project_within(
    equations: &Equations,
    solved: &mut Evaluation,
    next: &mut State,
    work: &mut Workspace,
) -> Result<Option<Vec<[f64; 3]>>, Rejected> {
    let Equations { model, state: start, .. } = equations;
    let closes = |(k, pairing): (usize, &Pairing)| {
        let closes = |pair: &Pair| pair.active && equations.closes(k, pair);
        model.contacts[k].projects && pairing.pairs.iter().any(closes)
    };
    if !solved.at.pairings.iter().enumerate().any(closes) {
        return Ok(None);
    }
    let mut end = work.copy(next);
    end.time = equations.time;
    end.y.clone_from(&solved.y);
    end.take_pairs(&solved.at.pairings);
    take_slips(equations, solved, &mut end);
    end.open_covered(model);
    end.f_internal.clone_from(&solved.forces.internal);
    end.f_external.clone_from(&solved.forces.loads);
    project_stage(model, &mut end, start, &mut work.system)?;

    next.v.clone_from(&end.v);
    next.a.clone_from(&end.a);
    solved.forces.contact.clone_from(&end.f_contact);
    solved.forces.friction.clone_from(&end.f_friction);
    balance_into(model, &end, &end.a, &mut solved.residual);
    let contact_forces = end.contact_forces.clone();
    work.put(end);
    Ok(Some(contact_forces))
}
