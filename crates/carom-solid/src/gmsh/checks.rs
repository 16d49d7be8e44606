//! Orientation and folding of cells: the Jacobian J(ξ) = det ∂X/∂ξ must be positive in the whole of
//! every cell, which is certified (`validity.rs`).

use carom_algebra::Vector;

use super::error::{Fault, MshError};
use super::group::Group;
use crate::reference::{gradient, interpolate};
use crate::shape::{Domain, Shape};
use crate::validity::Validity;

/// Reverses mirrored cells; a folded one is an error.
pub(super) fn orient<const D: usize, const N: usize, S: Shape<D, N>>(
    group: &mut Group<D>,
) -> Result<(), MshError> {
    let validity = Validity::<D, N>::of::<S>();
    let centre = S::gradients(&S::Domain::CENTRE);
    // A line from its end to its start; else two reference coordinates exchanged.
    let image = |mut xi: Vector<D>| {
        if D == 1 {
            xi[0] = -xi[0];
        } else {
            xi.0.swap(0, 1);
        }
        xi
    };
    let mirror: [usize; N] = std::array::from_fn(|a| {
        let at = image(S::NODES[a]);
        S::NODES.iter().position(|node| (*node - at).norm() < 1e-9).unwrap_or(a)
    });
    let mut turned = 0;
    for (cell, row) in group.cells.as_chunks_mut::<N>().0.iter_mut().zip(&group.rows) {
        let place = |n: usize| Vector(group.positions[n]);
        if gradient(&cell.map(place), &centre).det() < 0.0 {
            turned += 1;
            *cell = mirror.map(|a| cell[a]);
        }
        let x = cell.map(place);
        if let Err(loss) = validity.margin(&x) {
            // Named where it is worst among the place found, the nodes and the centre.
            let places = S::NODES.iter().chain([&S::Domain::CENTRE, &loss.place]);
            let jacobian = |xi: &Vector<D>| gradient(&x, &S::gradients(xi)).det();
            let worst = places.copied().min_by(|a, b| jacobian(a).total_cmp(&jacobian(b)));
            let worst = worst.unwrap_or(S::Domain::CENTRE);
            let at = interpolate(&S::values(&worst), &x).0.to_vec();
            let jacobian = jacobian(&worst);
            let fault = Fault::Folded { name: group.name.to_owned(), cell: row.tag, jacobian, at };
            return Err(group.file.at(row, fault));
        }
    }
    if turned > 0 {
        let direction = ["against the x axis", "clockwise", "mirrored"][D.min(3) - 1];
        let all = group.rows.len();
        group.repairs.push(format!("{turned} of {all} cells were {direction}; their nodes were reordered"));
    }
    Ok(())
}
