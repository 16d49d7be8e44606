//! Coulomb's law in a step of the schemes with their own contact law. The step has one coefficient:
//! μ_s for a node that was sticking, and for others that of their slip rate at its start. So a node
//! that comes into contact while it moves along the other side slips from the start.

use carom_algebra::Kind;
use carom_algebra::sums::max_abs;
use carom_contact::{Along, FrictionState, Law, Pair, Rows, length};

use crate::contact::loose::AT_REST;
use crate::state::State;

/// Distance from the edge of the cone, relative to its radius, at which a node slips.
const EDGE: f64 = 1e-12;

/// The law of the tangential forces of a pair in a step from a state; `of` is the index of its
/// normal force, `slips` has its H, `v` the velocities at the start.
pub(super) fn kind(
    law: &Law,
    of: usize,
    state: &State,
    (contact, pair): (usize, &Pair),
    slips: &Rows,
    v: &[f64],
) -> Kind {
    let mut rate = [0.0; 2];
    rate.iter_mut().zip(slips.iter()).for_each(|(rate, row)| *rate = row.along(v));
    let touches = state.past(contact, pair).is_none();
    let friction_state =
        if touches { FrictionState::of(rate, AT_REST * max_abs(v)) } else { pair.tangential.friction_state };
    let coefficient =
        if friction_state == FrictionState::Stick { law.stick } else { law.coefficient(length(rate)).value };
    Kind::Tangential { of, coefficient, limit: law.limit }
}

/// Whether a pair of this law sticks under these forces, or where it slips.
pub(super) fn friction_state(kind: Kind, normal: f64, tangential: Along) -> FrictionState {
    let Kind::Tangential { coefficient, limit, .. } = kind else { return FrictionState::Stick };
    let radius = (coefficient * normal).min(limit);
    let sticks = length(tangential) < radius * (1.0 - EDGE);
    if sticks { FrictionState::Stick } else { FrictionState::of(tangential.map(|q| -q), 0.0) }
}

/// Values of the rows of slips, along these components, as vectors; with the index of their normal
/// force.
pub(super) fn combined<'a>(
    kinds: &'a [Kind],
    along: &'a [Along],
    values: &'a [f64],
) -> impl Iterator<Item = (usize, Along)> + 'a {
    let of = |kind: &Kind| if let Kind::Tangential { of, .. } = *kind { Some(of) } else { None };
    let rows = kinds.iter().filter_map(of).zip(along).zip(values);
    rows.map(|((of, along), value)| (of, along.map(|part| value * part)))
}
