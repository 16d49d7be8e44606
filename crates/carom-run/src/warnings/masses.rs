//! Warning about a body that starts strained and has massless contact nodes: these have no inertia
//! that would keep them from their equilibrium.

use carom_case::Case;
use carom_mechanics::model::{BodyInstance, Model};

use super::found::{Found, short};

/// Share of the strain energy that is warned about.
const SHARE: f64 = 1e-6;

pub(super) fn strained_massless(case: &Case, model: &Model) -> Vec<Found> {
    let strained = model.parts.iter().zip(&case.bodies);
    let strained = strained.filter(|(_, spec)| spec.mass.is_redistributed() && spec.position.is_some());
    let share = |part: &BodyInstance| {
        let [whole, at_massless] = energies(model, part)?;
        (at_massless > SHARE * whole).then(|| at_massless / whole)
    };
    let warn = |part: &BodyInstance| {
        let what = format!(
            "it starts strained and its contact nodes have no mass; their cells have {} % of its strain energy",
            short(100.0 * share(part)?)
        );
        Some(Found::of_body(&part.name, what))
    };
    strained.filter_map(|(part, _)| warn(part)).collect()
}

/// Strain energy of a body at the start, and that of its cells with a massless node; none where a
/// cell is inverted, which stops the run.
fn energies(model: &Model, part: &BodyInstance) -> Option<[f64; 2]> {
    let mesh = part.body.mesh();
    let y = part.of(&model.initial_position);
    let mut force = vec![0.0; mesh.element.dofs()];
    let mut sums = [0.0; 2];
    for cell in 0..mesh.cell_count() {
        let energy = part.body.cell_force(cell, y, &mut force).ok()?;
        sums[0] += energy;
        if part.cell_dofs(cell).iter().any(|&dof| model.massless[dof as usize]) {
            sums[1] += energy;
        }
    }
    Some(sums)
}
