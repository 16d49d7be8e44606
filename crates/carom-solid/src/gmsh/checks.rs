//! Orientation and folding of cells. The Jacobian J(ξ) = det ∂X/∂ξ of a cell of degree k is a
//! polynomial of degree at most 2(k − 1). It is evaluated on a lattice of ten steps, including
//! edges and corners, where folds begin.

use carom_algebra::Vector;

use super::error::{Fault, MshError};
use super::group::Group;
use crate::reference::{gradient, interpolate};
use crate::shape::{Domain, Shape};

/// Reverses clockwise cells (`mirror`: the nodes of a cell in the other direction); a folded one is
/// an error.
pub(super) fn orient<const D: usize, const N: usize, S: Shape<D, N>>(
    group: &mut Group<D>,
    mirror: [usize; N],
) -> Result<(), MshError> {
    let points = if S::DEGREE == 1 { vec![S::Domain::CENTRE] } else { lattice() };
    let slopes: Vec<_> = points.iter().map(S::gradients).collect();
    let mut turned = 0;
    for (cell, row) in group.cells.as_chunks_mut::<N>().0.iter_mut().zip(&group.rows) {
        let x: [Vector<D>; N] = cell.map(|n| Vector(group.positions[n]));
        let jacobians: Vec<f64> = slopes.iter().map(|g| gradient(&x, g).det()).collect();
        let sign: f64 = if jacobians.iter().sum::<f64>() < 0.0 { -1.0 } else { 1.0 };
        let least =
            (0..points.len()).min_by(|&a, &b| (sign * jacobians[a]).total_cmp(&(sign * jacobians[b])));
        let least = least.unwrap_or(0);
        let jacobian = sign * jacobians[least];
        let size: f64 = (0..D).map(|_| (x[1] - x[0]).norm().max((x[D] - x[0]).norm())).product();
        if jacobian <= 1e-12 * size {
            let at = interpolate(&S::values(&points[least]), &x).0.to_vec();
            let fault = Fault::Folded { name: group.name.to_owned(), cell: row.tag, jacobian, at };
            return Err(group.file.at(row, fault));
        }
        if sign < 0.0 {
            turned += 1;
            *cell = mirror.map(|a| cell[a]);
        }
    }
    if turned > 0 {
        let direction = if D == 1 { "against the x axis" } else { "clockwise" };
        let all = group.rows.len();
        group.repairs.push(format!("{turned} of {all} cells were {direction}; their nodes were reordered"));
    }
    Ok(())
}

/// Ten steps along each edge of the reference cell.
fn lattice<const D: usize>() -> Vec<Vector<D>> {
    let step = |i: usize| i as f64 / 10.0;
    if D == 1 {
        return (0..=10).map(|i| Vector([2.0 * step(i) - 1.0; D])).collect();
    }
    let point = |i: usize, j: usize| Vector(std::array::from_fn(|d| step([i, j][d])));
    (0..=10).flat_map(|i| (0..=10 - i).map(move |j| point(i, j))).collect()
}
