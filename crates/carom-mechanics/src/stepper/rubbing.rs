//! Coulomb's law in a step of the schemes with their own contact law. The step has one coefficient:
//! μ_s for a node that stuck, and for others that of their slip rate at its start. So a node that
//! touches while it moves along the other side slips from the start.

use carom_algebra::Kind;
use carom_contact::{Along, Hold, Law, Pair, Rows, length};

use crate::cone::AT_REST;
use crate::state::State;
use crate::sums::max_abs;

/// Distance from the edge of the cone, relative to its radius, at which a node slips.
const EDGE: f64 = 1e-12;

/// The law of the tangential forces of a pair in a step from a state; `of` is the index of its
/// normal force, `slips` has its H from the row `first` on, `v` the velocities at the start.
pub(super) fn kind(
    law: &Law,
    of: usize,
    state: &State,
    (contact, pair): (usize, &Pair),
    (slips, first): (&Rows, usize),
    v: &[f64],
) -> Kind {
    let mut rate = [0.0; 2];
    rate.iter_mut().zip(slips.iter().skip(first)).for_each(|(rate, row)| *rate = row.along(v));
    let touches = state.closed(contact, pair.node).is_none();
    let hold = if touches { Hold::of(rate, AT_REST * max_abs(v)) } else { pair.tangential.hold };
    let coefficient = if hold == Hold::Stick { law.stick } else { law.coefficient(length(rate)).0 };
    Kind::Tangential { of, coefficient, limit: law.limit }
}

/// Whether a pair of this law sticks under these forces, or where it slips.
pub(super) fn hold(kind: Kind, normal: f64, tangential: Along) -> Hold {
    let Kind::Tangential { coefficient, limit, .. } = kind else { return Hold::Stick };
    let radius = (coefficient * normal).min(limit);
    let sticks = length(tangential) < radius * (1.0 - EDGE);
    if sticks { Hold::Stick } else { Hold::of(tangential.map(|q| -q), 0.0) }
}

/// The normal force of every tangential one, and its tangent.
pub(super) fn tangents(kinds: &[Kind]) -> impl Iterator<Item = (usize, usize, usize)> + '_ {
    let of = |i: usize| if let Kind::Tangential { of, .. } = kinds[i] { Some(of) } else { None };
    (0..kinds.len()).filter_map(move |i| {
        let normal = of(i)?;
        Some((i, normal, usize::from(i > 0 && of(i - 1) == Some(normal))))
    })
}
