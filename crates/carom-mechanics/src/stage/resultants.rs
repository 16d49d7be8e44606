//! Balance of the bodies as wholes. With the rigid modes u that supports leave free
//!
//! ```text
//! |u·r| ≤ 1e-13 Σ_j |u·f_j| + 16 ε |u|·(Σ_j |f_j| + w.mass a' |M d| + Σ w k |∇g| |y|)        r = Σ_j f_j, the terms of the balance
//! ```
//!
//! with the length |M d| of the motion of a node, whatever its direction, and the stiffness k of
//! the compressed springs of penalties.
//!
//! ‖r‖ alone does not say that: the stresses of a stiff body are known to fewer digits than the
//! forces that move it, but their sum over the body is zero to round-off. The second term is that
//! of the sums: of the nodal forces, of an acceleration that is a difference of velocities over Δt,
//! and of a gap that is a difference of positions. A stiff spring changes its force by k ε |y| with
//! the last digit of a position, and by no less.
//!
//! Without friction, also where μ is zero at the time, the symmetric system of the contacts leaves
//! no such rest, and momentum balances to 1e-12 without this test
//! (`carom-run/tests/all/momentum.rs`): it would cost up to a fifth more iterations for nothing.
//! Conserving springs are the exception: the last correction changes their force, a quotient of
//! differences, by more than it was predicted to.

use crate::model::Contact;
use crate::stage::balance::{contact_weights, terms};
use crate::stage::equations::Equations;
use crate::stage::evaluation::Evaluation;

/// Resultant of a residual, relative to those of its terms.
const BALANCED: f64 = 1e-13;
/// Digits lost in sums.
const SUMMED: f64 = 16.0 * f64::EPSILON;

/// Whether the resultants of the residual are zero; asked of friction and of conserving springs,
/// but not of constraints that conserve energy, whose states more iterations disturb, nor of bodies
/// in free flight, whose forces are not above the `noise` of the positions.
pub(crate) fn are_balanced(equations: &Equations, now: &Evaluation, noise: f64) -> bool {
    let model = equations.model;
    let conserves = model.contacts.iter().any(Contact::conserves);
    let rubs = equations.laws.iter().flatten().any(|law| !law.is_none());
    let asked = rubs && !conserves || model.contacts.iter().any(is_conserving_spring);
    if model.unconstrained.is_empty() || !asked || now.measure.forces <= noise {
        return true;
    }
    let d = model.dimension;
    let mut motion = vec![0.0; model.dofs()];
    model.mass.multiply_into(&now.at.increment, &mut motion);
    let slope = equations.mass_factor();
    let springs = of_springs(equations, now);
    model.unconstrained.iter().all(|mode| {
        let mut sums = [0.0; 5];
        let mut sizes = 0.0;
        let mut whole = 0.0;
        let of_motions = mode.motions.iter();
        for (rigid, node) in of_motions.flat_map(|rigid| rigid.nodes.iter().map(move |&n| (rigid, n))) {
            let place = &now.y[node * d..(node + 1) * d];
            let moved = motion[node * d..(node + 1) * d].iter().map(|m| m * m).sum::<f64>().sqrt();
            for (axis, i) in (node * d..(node + 1) * d).enumerate() {
                let u = rigid.at(place, axis);
                if model.fixed[i] && u.abs() > SUMMED {
                    // The body has deformed, and its supports do not leave this motion free.
                    return true;
                }
                let terms = terms(model, &equations.stage, &now.forces, &equations.known, i);
                sums.iter_mut().zip(terms).for_each(|(sum, term)| *sum += u * term);
                let size = terms.iter().map(|term| term.abs()).sum::<f64>() + springs[i];
                sizes += u.abs() * (size + slope * moved);
                whole += u * now.residual[i];
            }
        }
        whole.abs() <= BALANCED * sums.iter().map(|sum| sum.abs()).sum::<f64>() + SUMMED * sizes
    })
}

/// Whether its force is a quotient of differences, which is not linear in the gap.
fn is_conserving_spring(contact: &Contact) -> bool {
    contact.interface.direction().accumulates()
}

/// Round-off of the residual due to that of the gaps of compressed springs.
pub(crate) fn round_off_of_springs(equations: &Equations, now: &Evaluation) -> f64 {
    let mut square = 0.0;
    each_spring(equations, now, |_, force| square += force * force);
    SUMMED * square.sqrt()
}

/// Σ w k |∇g| |y| of the compressed springs over all dofs.
fn of_springs(equations: &Equations, now: &Evaluation) -> Vec<f64> {
    let d = equations.model.dimension;
    let mut forces = vec![0.0; equations.model.dofs()];
    each_spring(equations, now, |node, force| {
        forces[node * d..(node + 1) * d].iter_mut().for_each(|sum| *sum += force);
    });
    forces
}

/// Calls `add(node, w k |∇g| |y|)` for the nodes of each compressed spring; |y| is the largest
/// coordinate of the nodes of a gap, which is a difference of their positions.
fn each_spring(equations: &Equations, now: &Evaluation, mut add: impl FnMut(usize, f64)) {
    let model = equations.model;
    for (k, p) in now.pressing() {
        let compliance = now.answers[k][p].compliance;
        if compliance > 0.0 {
            let weight = contact_weights(&equations.stage, model.contacts[k].at_the_end).0;
            // Springs along the tangents are as stiff.
            let row = now.rows[k].row(p);
            let reach = row.entries().fold(0.0_f64, |most, (dof, _)| most.max(now.y[dof].abs()));
            let factor = weight * reach / compliance;
            for (node, slopes) in row.nodes.iter().zip(row.gradient.chunks_exact(model.dimension)) {
                let length = slopes.iter().map(|slope| slope * slope).sum::<f64>().sqrt();
                add(*node, factor * length);
            }
        }
    }
}
