//! The tangents of the cells of a model, and the nodes that they couple.

use carom_solid::{Ask, Configuration, Response};

use crate::cells;
use crate::model::{BodyInstance, Model};
use crate::rejected::Rejected;

/// Calls `add(part, cell, tangent)` with ∂f_int/∂y of every cell at a configuration, by rows, in
/// the order of the cells.
///
/// # Errors
/// If a cell is inverted there.
pub(crate) fn each_tangent(
    model: &Model,
    at: &Configuration,
    mut add: impl FnMut(&BodyInstance, usize, &[f64]) + Send,
) -> Result<(), Rejected> {
    for (part, at) in model.configurations(at) {
        let mesh = part.body.mesh();
        let n = mesh.element.dofs();
        let numbers = n + n * n;
        let compute = |first: usize, numbers: &mut [f64], energies: &mut [f64]| {
            let out = Response { numbers, energies, memory: &mut [], dissipated: &mut [] };
            part.body.respond(first, &at, Ask::Tangent, out)
        };
        let add = cells::added_one_by_one(numbers, |cell, local: &[f64]| add(part, cell, &local[n..]));
        cells::for_each(&model.threads, mesh.cell_count(), numbers, compute, add)
            .map_err(|inverted| Rejected::Inverted { body: part.name.clone(), inverted })?;
    }
    Ok(())
}

/// The nodes that share a cell with each node, with repetitions; none for those of rigid obstacles.
pub(crate) fn coupled(model: &Model) -> Vec<Vec<u32>> {
    let mut coupled = vec![Vec::new(); model.dofs() / model.dimension];
    for part in &model.parts {
        let mesh = part.body.mesh();
        for cell in (0..mesh.cell_count()).map(|cell| mesh.cell(cell)) {
            for a in cell {
                coupled[part.first_node + a].extend(cell.iter().map(|b| (part.first_node + b) as u32));
            }
        }
    }
    coupled
}
