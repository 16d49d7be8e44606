//! Friction in a state, between steps: the slips of the pairs, which a solved step adds to, the
//! tractions q along H(y_s), and what pairs with friction did. About the normal, tangents of
//! springs turn with the facet at the end of the step, by its least-squares rotation in it, or with
//! a rigid obstacle.

use std::borrow::Cow;

use carom_algebra::Mat;
use carom_contact::{FrictionState, Pair, Row, Rows, Tangential, length};

use crate::model::{Contact, Model};
use crate::stage::equations::Equations;
use crate::stage::evaluation::Evaluation;
use crate::state::State;

/// Calls `visit(contact, pair, q, H)` for every tangent of the closed pairs of a state that have
/// friction, with the traction along it and H at the positions of the state.
pub fn each_slip(model: &Model, state: &State, mut visit: impl FnMut(usize, usize, f64, Row)) {
    let mut rows = Rows::new(model.dimension);
    let rubs = |(_, contact): &(usize, &Contact)| contact.friction.is_some();
    for (k, contact) in model.contacts.iter().enumerate().filter(rubs) {
        for (p, pair) in state.pairs[k].iter().enumerate().filter(|(_, pair)| pair.active) {
            let mut at = *pair;
            rows.clear();
            if contact.kinematics.measure(&mut at, &state.y, &mut rows).is_ok()
                && contact.kinematics.slip(&at, &state.y, &[], &mut rows).is_ok()
            {
                let along = rows.iter().skip(1).zip(pair.tangential.traction);
                along.for_each(|(row, traction)| visit(k, p, traction, row));
            }
        }
    }
}

/// Forces of friction at a state; a state of a case without friction has none.
pub(crate) fn friction_forces(state: &State) -> Cow<'_, [f64]> {
    if state.f_friction.is_empty() { vec![0.0; state.y.len()].into() } else { (&state.f_friction[..]).into() }
}

/// Adds the slips of a solved step to those of the closed pairs; open pairs have none.
pub(crate) fn take_slips(equations: &Equations, solved: &Evaluation, state: &mut State) {
    let mut rows = Rows::new(equations.model.dimension);
    for (k, contact) in equations.model.contacts.iter().enumerate() {
        if contact.friction.is_none() {
            continue;
        }
        for (p, (pair, gap)) in state.pairs[k].iter_mut().zip(solved.rows[k].iter()).enumerate() {
            if pair.active {
                // On a spring, S is no more than what follows the touch.
                let touches = equations.closes(k, pair) && equations.stick_spring(k, pair).is_none();
                for (i, slip) in solved.slip_rows((k, p)).enumerate() {
                    pair.tangential.slip[i] += if touches {
                        equations.since_touch(k, pair, gap, &mut rows) * slip.along(&solved.at.increment)
                    } else {
                        slip.gap
                    };
                }
                pair.tangential.before = pair.tangential.traction;
                if equations.model.dimension == 3 && equations.stick_spring(k, pair).is_some() {
                    turn_with_primary(contact, pair, [&equations.state.y, &solved.y]);
                }
            } else {
                pair.tangential = Tangential::default();
            }
        }
    }
}

/// Turns the tangents of a pair about the normal with its primary.
fn turn_with_primary(contact: &Contact, pair: &mut Pair, ends: [&[f64]; 2]) {
    let angle = match contact.kinematics.rotation_of_primary(pair, ends) {
        Some(rotation) => twist(&rotation, pair.tangential.tangents),
        None => twist_of_nodes(contact.kinematics.facet_nodes(pair), pair.tangential.tangents, ends),
    };
    let [first, second] = pair.tangential.tangents;
    let (sin, cos) = angle.sin_cos();
    pair.tangential.tangents = [
        std::array::from_fn(|i| cos * first[i] + sin * second[i]),
        std::array::from_fn(|i| cos * second[i] - sin * first[i]),
    ];
}

/// Angle of a rotation about the normal to both tangents, beyond the smallest rotation of that
/// normal: tan ½φ = w·n/(1 + tr R) with the axial vector w of R − Rᵀ.
fn twist(rotation: &Mat<3>, [first, second]: [[f64; 3]; 2]) -> f64 {
    let r = &rotation.0;
    let mut along = 0.0;
    let mut trace = 0.0;
    for i in 0..3 {
        let j = (i + 1) % 3;
        let k = (i + 2) % 3;
        along += (first[j] * second[k] - first[k] * second[j]) * (r[k][j] - r[j][k]);
        trace += r[i][i];
    }
    2.0 * along.atan2(1.0 + trace)
}

/// Angle of the least-squares rotation of nodes in the plane of the tangents; zero of an obstacle,
/// which has none.
fn twist_of_nodes(nodes: &[usize], tangents: [[f64; 3]; 2], ends: [&[f64]; 2]) -> f64 {
    if nodes.is_empty() {
        return 0.0;
    }
    let share = (nodes.len() as f64).recip();
    // Components along the tangents of arms from the mean, before and after.
    let [[from_x, from_y], [to_x, to_y]] = ends.map(|y| {
        tangents.map(|tangent| {
            let at = |node: &usize| (0..3).map(|i| tangent[i] * y[3 * node + i]).sum::<f64>();
            let mean = share * nodes.iter().map(at).sum::<f64>();
            nodes.iter().map(|node| at(node) - mean).collect::<Vec<f64>>()
        })
    });
    let sum = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    let across = sum(&from_x, &to_y) - sum(&from_y, &to_x);
    let along = sum(&from_x, &to_x) + sum(&from_y, &to_y);
    across.atan2(along)
}

/// Adds a step of this size to what pairs with friction did.
pub(crate) fn book_states(model: &Model, state: &mut State, dt: f64) {
    let rubbed = &mut state.ledger.rubbed;
    let contacts = model.contacts.iter().zip(&state.pairs);
    let nodes = contacts.filter_map(|(contact, pairs)| Some((contact.friction.as_ref()?, pairs)));
    let rubs = nodes.flat_map(|(friction, pairs)| pairs.iter().filter(|pair| friction.acts_on(pair.node)));
    for pair in rubs.filter(|pair| pair.active) {
        rubbed.contact_time += dt;
        rubbed.stick_time += if pair.tangential.friction_state == FrictionState::Stick { dt } else { 0.0 };
        rubbed.farthest = rubbed.farthest.max(length(pair.tangential.slip));
    }
}
