//! Where contact begins: velocities and accelerations made to agree with the constraints that now hold (persistency, g ġ = 0).
//!
//! ```text
//! M Δv + Gᵀp = 0,   G (v + Δv) = 0            then       M a + Gᵀλ = f_ext − f_int,   G a = −v·∇²g·v
//! ```
//!
//! with all active rows as equalities. Projecting v alone leaves the accelerations of the impact behind and cures nothing (theory.md §5.3).
//! Dofs without mass keep their velocity: they follow what the massive side does.

use carom_contact::Linearised;

use crate::case::Persistency;
use crate::evaluation::add_gradient;
use crate::ledger::{book_contact_forces, book_kinetic};
use crate::model::Model;
use crate::rejected::Rejected;
use crate::rows::independent_rows;
use crate::state::State;
use crate::stepper::averaged_contact_into;
use crate::system::Row;
use crate::workspace::Workspace;

/// Projects `state` if one of the new contacts (contact, node) asks for it. The jump of kinetic energy is booked as contact work and returned.
pub(crate) fn project<const D: usize>(
    model: &Model<D>,
    state: &mut State,
    activations: &[(usize, usize)],
    work: &mut Workspace<D>,
) -> Result<f64, Rejected> {
    let asks = |k: usize| model.contacts[k].persistency == Persistency::Project;
    if !activations.iter().any(|&(k, _)| asks(k)) {
        return Ok(0.0);
    }
    linearise_all(model, state, work)?;
    let mut places = independent_rows(model, &state.pairs, work);
    places.retain(|&(k, _)| asks(k));
    let rows: Vec<Row<D>> =
        places.iter().map(|&(k, p)| Row { gap: &work.gaps[k][p], weight: 1.0, compliance: 0.0 }).collect();
    let inertia = work.system.factor_mass(model, &rows)?;
    if inertia.negative < rows.len() {
        let size = model.free.len() + rows.len();
        return Err(carom_algebra::LinearError::Singular { size, pivot: inertia.negative, value: 0.0 }.into());
    }
    let dofs = model.dofs();
    let (mut change, mut multipliers) = (vec![0.0; dofs], Vec::new());

    let closing: Vec<f64> = rows.iter().map(|row| -rate(row.gap, &state.v)).collect();
    work.system.solve(model, &vec![0.0; dofs], &closing, &mut change, &mut multipliers)?;
    for i in 0..dofs {
        state.v[i] += if model.massless[i] { 0.0 } else { change[i] };
    }
    for (row, impulse) in rows.iter().zip(&multipliers) {
        for i in 0..D.min(2) {
            state.ledger.impulse[i] -= impulse * row.gap.gradient[0][i];
        }
    }

    let (forces, bending) = drive(model, state, &work.gaps, &places);
    work.system.solve(model, &forces, &bending, &mut change, &mut multipliers)?;
    take_accelerations(model, state, &change);
    for (&(k, p), lambda) in places.iter().zip(&multipliers) {
        state.pairs[k][p].lambda = *lambda;
    }

    averaged_contact_into(model, &state.pairs, &work.gaps, &mut state.f_contact);
    book_contact_forces(model, state);
    let before = state.ledger.kinetic;
    book_kinetic(model, state);
    let jump = state.ledger.kinetic - before;
    state.ledger.contact_work += jump;
    Ok(jump)
}

/// Right-hand sides of M a + Gᵀλ = f_ext − f_int, G a = −v·∇²g·v for the rows in `places`, less what the accelerations of moving supports, in `state`,
/// and the forces of all other active pairs, springs among them, contribute.
pub(crate) fn drive<const D: usize>(
    model: &Model<D>,
    state: &State,
    gaps: &[Vec<Linearised<D>>],
    places: &[(usize, usize)],
) -> (Vec<f64>, Vec<f64>) {
    let dofs = model.dofs();
    let (mut moved, mut carried) = (vec![0.0; dofs], vec![0.0; dofs]);
    if !model.motions.is_empty() {
        model.motions.dofs().for_each(|dof| moved[dof] = state.a[dof]);
        model.mass.multiply_into(&moved, &mut carried);
    }
    for (k, pairs) in state.pairs.iter().enumerate() {
        for (p, pair) in pairs.iter().enumerate().filter(|(p, pair)| pair.active && !places.contains(&(k, *p))) {
            add_gradient(&gaps[k][p], pair.lambda, &mut carried);
        }
    }
    let force = |i: usize| model.gravity[i] + state.f_external[i] - state.f_internal[i] - carried[i];
    let forces = (0..dofs).map(|i| if model.massless[i] { 0.0 } else { force(i) }).collect();
    let bending = |gap: &Linearised<D>| -curvature(gap, &state.v) - rate(gap, &moved);
    (forces, places.iter().map(|&(k, p)| bending(&gaps[k][p])).collect())
}

/// Accelerations of free dofs that have mass; moving supports keep theirs.
pub(crate) fn take_accelerations<const D: usize>(model: &Model<D>, state: &mut State, solved: &[f64]) {
    for &i in &model.free {
        state.a[i] = if model.massless[i] { 0.0 } else { solved[i] };
    }
}

/// Gaps of all pairs at the state, with second derivatives for λ = 1.
pub(crate) fn linearise_all<const D: usize>(
    model: &Model<D>,
    state: &mut State,
    work: &mut Workspace<D>,
) -> Result<(), Rejected> {
    let y = state.y.as_chunks::<D>().0;
    for (k, contact) in model.contacts.iter().enumerate() {
        work.gaps[k].resize(state.pairs[k].len(), Linearised::default());
        for (pair, gap) in state.pairs[k].iter_mut().zip(&mut work.gaps[k]).filter(|(pair, _)| pair.active) {
            contact
                .method
                .linearise(pair, y, 1.0, gap)
                .map_err(|error| Rejected::Contact { contact: contact.name.clone(), error })?;
        }
    }
    Ok(())
}

/// ġ = ∇g·v.
fn rate<const D: usize>(gap: &Linearised<D>, v: &[f64]) -> f64 {
    (0..gap.count).map(|p| (0..D).map(|i| gap.gradient[p][i] * v[gap.nodes[p] * D + i]).sum::<f64>()).sum()
}

/// v·∇²g·v.
fn curvature<const D: usize>(gap: &Linearised<D>, v: &[f64]) -> f64 {
    let mut sum = 0.0;
    for p in 0..gap.count {
        for q in 0..gap.count {
            for i in 0..D {
                for j in 0..D {
                    sum += v[gap.nodes[p] * D + i] * gap.hessian[p][q].0[i][j] * v[gap.nodes[q] * D + j];
                }
            }
        }
    }
    sum
}
