//! Coulomb's law in a step of the schemes with their own contact law. The step has one coefficient:
//! μ_s for a node that was sticking, and for others that of their slip rate at its start. So a node
//! that comes into contact while it moves along the other side slips from the start.

use carom_algebra::Kind;
use carom_contact::{Along, FrictionState, Law, Pair, Row, Rows, length};

use crate::cone::AT_REST;
use crate::independent::slip_remainder;
use crate::model::Model;
use crate::state::State;
use crate::sums::{dot, max_abs};

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
    let touches = state.closed(contact, pair.node).is_none();
    let friction_state =
        if touches { FrictionState::of(rate, AT_REST * max_abs(v)) } else { pair.tangential.friction_state };
    let coefficient =
        if friction_state == FrictionState::Stick { law.stick } else { law.coefficient(length(rate)).0 };
    Kind::Tangential { of, coefficient, limit: law.limit }
}

/// Whether a pair of this law sticks under these forces, or where it slips.
pub(super) fn friction_state(kind: Kind, normal: f64, tangential: Along) -> FrictionState {
    let Kind::Tangential { coefficient, limit, .. } = kind else { return FrictionState::Stick };
    let radius = (coefficient * normal).min(limit);
    let sticks = length(tangential) < radius * (1.0 - EDGE);
    if sticks { FrictionState::Stick } else { FrictionState::of(tangential.map(|q| -q), 0.0) }
}

/// The components along its tangents of the slips of a pair on which its friction acts. In space
/// supports may constrain its nodes along a tangent: what is left of that row, along the normal,
/// only turns the facet, times the gap, and its force would take part of the cone without any other
/// effect. `x`: a motion; where supports move the nodes along that tangent, they slip.
pub(super) fn loose(model: &Model, slips: &Rows, x: &[f64]) -> impl Iterator<Item = Along> + use<> {
    let tangents = [[1.0, 0.0], [0.0, 1.0]];
    if slips.len() < 2 {
        return tangents.into_iter().take(slips.len());
    }
    let [first, second] = [slips.row(0), slips.row(1)];
    let (e, t) = (first.first(), second.first());
    let normal: [f64; 3] = std::array::from_fn(|i| {
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        e[j] * t[k] - e[k] * t[j]
    });
    // The parts along the facet on free dofs, and the motion of the others along them.
    let part = |row: Row| -> (Vec<f64>, f64) {
        let (mut free, mut moved) = (Vec::new(), 0.0);
        for (node, h) in row.nodes.iter().zip(row.gradient.as_chunks::<3>().0) {
            let across: f64 = h.iter().zip(normal).map(|(h, n)| h * n).sum();
            for (i, dof) in (3 * node..).take(3).enumerate() {
                let along = h[i] - across * normal[i];
                if model.fixed[dof] {
                    moved += along * x[dof];
                } else {
                    free.push(along);
                }
            }
        }
        (free, moved)
    };
    let ((e, e_moved), (t, t_moved)) = (part(first), part(second));
    let [a, b, mixed] = [dot(&e, &e), dot(&t, &t), dot(&e, &t)];
    let most = 0.5 * (a + b) + (0.5 * (a - b)).hypot(mixed);
    let least = slip_remainder(model).powi(2);
    let rest = AT_REST * max_abs(x);
    let rests = |[i, j]: Along| (i * e_moved + j * t_moved).abs() <= rest;
    if most <= least {
        let all_rest = tangents.into_iter().all(rests);
        return tangents.into_iter().take(if all_rest { 0 } else { 2 });
    }
    let [i, j] = if a >= b { [most - b, mixed] } else { [mixed, most - a] };
    let [i, j] = [i, j].map(|part| part / i.hypot(j));
    if a + b - most <= least && rests([-j, i]) {
        return [[i, j], [0.0; 2]].into_iter().take(1);
    }
    tangents.into_iter().take(2)
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
