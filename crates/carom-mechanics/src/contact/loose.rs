//! Directions of a tangent plane in which friction acts. Where supports fix both sides along a
//! tangent, as in a plane of symmetry, no slip is possible, and any traction within the cone would
//! be in balance with their reactions. It is zero: in a plane of symmetry the traction of one half
//! is that of the other, reflected. What supports or obstacles have dragged before keeps the
//! traction that it has.

use carom_algebra::sums::{dot, max_abs};
use carom_contact::{Along, Row, Rows, inner, length};

use crate::model::Model;

/// Remainder of the rows of a slip below which a stage holds them. Where the normal leans at a
/// plane of symmetry, the contact point of a node in it lies past the end of its facet by the depth
/// times that slope, and the facet's other nodes have shares in the slip.
const ALMOST: f64 = 0.02;

/// Slip rate, as a fraction of the largest velocity, that is none.
pub(crate) const AT_REST: f64 = 1e-10;

/// Part of a traction, relative to it, that is none.
const NONE: f64 = 1e-6;

/// Whether supports may hold a pair of this node.
pub(crate) fn may_be_held(model: &Model, node: usize) -> bool {
    let d = model.dimension;
    (d * node..d * (node + 1)).any(|dof| model.fixed[dof])
}

/// Clears the rows of a slip, from `first` on, in the directions in which supports fix both sides
/// of the pair, and in which it had no traction `before` the step; returns in how many it can slip.
/// `gap`: the row of its gap; `increment`: the motion.
pub(crate) fn hold(
    model: &Model,
    gap: Row,
    slips: &mut Rows,
    first: usize,
    increment: &[f64],
    before: Along,
) -> usize {
    let mut own = Rows::new(model.dimension);
    (first..slips.len()).for_each(|row| own.push_row(slips.row(row)));
    let directions: Vec<Along> = loose(model, gap, &own, increment, ALMOST).collect();
    match directions[..] {
        [] if before == [0.0; 2] => {
            (first..slips.len()).for_each(|row| slips.gradient_mut(row).fill(0.0));
            0
        }
        [along] if own.len() == 2 && inner([-along[1], along[0]], before).abs() <= NONE * length(before) => {
            let mut kept = Rows::new(model.dimension);
            kept.push_combined(&own, 0, &along);
            for (i, part) in along.iter().enumerate() {
                let row = slips.gradient_mut(first + i);
                row.iter_mut().zip(kept.row(0).gradient).for_each(|(slope, h)| *slope = part * h);
            }
            1
        }
        _ => own.len(),
    }
}

/// The components along its tangents of the slips of a pair on which its friction acts. Supports
/// may constrain its nodes along a tangent, as in a plane of symmetry: what is left of that row on
/// free dofs is a part of the row of the `gap`, or only turns the facet, times the gap. Its force
/// would take part of the cone without any other effect. `x`: a motion; where supports move the
/// nodes along that tangent, they slip. `remainder`: what is left of a row that counts as none.
pub(crate) fn loose(
    model: &Model,
    gap: Row,
    slips: &Rows,
    x: &[f64],
    remainder: f64,
) -> impl Iterator<Item = Along> + use<> {
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
    let least = remainder * remainder;
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
