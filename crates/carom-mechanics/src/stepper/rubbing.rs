//! Coulomb's law in a step of the schemes with their own contact law. The step has one coefficient:
//! μ_s for a node that was sticking, and for others that of their slip rate at its start. So a node
//! that comes into contact while it moves along the other side slips from the start.

use carom_algebra::Kind;
use carom_algebra::sums::{dot, max_abs};
use carom_contact::{Along, FrictionState, Law, Pair, Row, Rows, length};

use crate::contact::independent::HELD;
use crate::model::Model;
use crate::state::State;
use crate::velocity::cone::AT_REST;

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

/// The components along its tangents of the slips of a pair on which its friction acts. Supports
/// may constrain its nodes along a tangent, as in a plane of symmetry: what is left of that row on
/// free dofs is a part of the row of the `gap`, or only turns the facet, times the gap. Its force
/// would take part of the cone without any other effect. `x`: a motion; where supports move the
/// nodes along that tangent, they slip.
pub(super) fn loose(model: &Model, gap: Row, slips: &Rows, x: &[f64]) -> impl Iterator<Item = Along> + use<> {
    let tangents = [[1.0, 0.0], [0.0, 1.0]];
    let Some(first) = slips.iter().next() else { return tangents.into_iter().take(0) };
    let e = first.first();
    let t = if slips.len() < 2 { [0.0; 3] } else { slips.row(1).first() };
    let is_free = |&(dof, _): &(usize, f64)| !model.fixed[dof];
    let normal: Vec<(usize, f64)> = gap.entries().filter(is_free).collect();
    let square: f64 = normal.iter().map(|(_, slope)| slope * slope).sum();
    // The part along the facet on free dofs without what the row of the gap has in common with it,
    // and the motion of the other dofs along it.
    let part = |row: Row| -> (Vec<f64>, f64) {
        let of_gap = |dof: usize| normal.iter().find(|entry| entry.0 == dof).map_or(0.0, |entry| entry.1);
        let mut free = Vec::new();
        let mut moved = 0.0;
        let d = model.dimension;
        for (node, h) in row.nodes.iter().zip(row.gradient.chunks_exact(d)) {
            let [of_e, of_t] = [e, t].map(|tangent| (0..d).map(|i| h[i] * tangent[i]).sum::<f64>());
            for (i, dof) in (d * node..).take(d).enumerate() {
                let along = of_e * e[i] + of_t * t[i];
                if model.fixed[dof] {
                    moved += along * x[dof];
                } else {
                    free.push((along, of_gap(dof)));
                }
            }
        }
        let common = free.iter().map(|(h, n)| h * n).sum::<f64>() / square.max(f64::MIN_POSITIVE);
        (free.iter().map(|(h, n)| h - common * n).collect(), moved)
    };
    let least = HELD * HELD;
    let rest = AT_REST * max_abs(x);
    if slips.len() < 2 {
        let is_constrained = |row: Row| {
            let (free, moved) = part(row);
            dot(&free, &free) <= least && moved.abs() <= rest
        };
        return tangents.into_iter().take(slips.iter().filter(|&row| !is_constrained(row)).count());
    }
    let second = slips.row(1);
    let (e, e_moved) = part(first);
    let (t, t_moved) = part(second);
    let [a, b, mixed] = [dot(&e, &e), dot(&t, &t), dot(&e, &t)];
    let most = 0.5 * (a + b) + (0.5 * (a - b)).hypot(mixed);
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
