//! Stress and plastic strain of materials with memory between quadrature points, where nothing is
//! remembered. (Strain follows from positions alone.) In each cell they are the polynomial that is
//! nearest to the values at the quadrature points, with the least sum of squares: of degree k − 1
//! for shape functions of degree k, which is that of the strain, but at least 1, and not more than
//! the points determine. The projection is exact for fields of this degree.

use carom_algebra::Vector;

use super::Solid;
use crate::body::{Inverted, PointState};
use crate::material::{Past, Pointwise};
use crate::shape::Shape;

/// States at the quadrature points of a cell, with what each remembers.
pub(super) struct Projection<'a> {
    pub(super) states: Vec<PointState>,
    past: Past<'a>,
}

impl<const D: usize, const N: usize, S: Shape<D, N>> Solid<D, N, S> {
    /// States at the quadrature points of a cell of a law with memory.
    pub(super) fn projection<'a>(
        &self,
        law: &dyn Pointwise<D>,
        cell: usize,
        y: &[f64],
        past: &Past<'a>,
    ) -> Result<Projection<'a>, Inverted> {
        let past = past.part(cell, self.memory);
        let points = self.force_rules[usize::from(self.curved[cell])].points.iter().enumerate();
        let at = |(q, point): (usize, &Vector<D>)| {
            self.point_of(law, cell, &point.0, y, &past.part(q, law.memory()))
        };
        Ok(Projection { states: points.map(at).collect::<Result<_, _>>()?, past })
    }

    /// State at a point of a cell of a law with memory; J is that with the memory of the nearest
    /// quadrature point, and what has yielded is a share of the points of the cell.
    pub(super) fn projected(
        &self,
        law: &dyn Pointwise<D>,
        cell: usize,
        xi: &[f64],
        y: &[f64],
        Projection { states, past }: &Projection,
    ) -> Result<PointState, Inverted> {
        let points = &self.force_rules[usize::from(self.curved[cell])].points;
        let nearest = past.part(nearest(points, xi), law.memory());
        let mut state = self.point_of(law, cell, xi, y, &nearest)?;
        state.cauchy = [[0.0; 3]; 3];
        state.plastic_strain = 0.0;
        state.yielded = 0.0;
        let weights = weights(points, xi, (S::DEGREE - 1).max(1));
        for (of_point, weight) in states.iter().zip(weights) {
            add(&mut state.cauchy, weight, &of_point.cauchy);
            state.plastic_strain += weight * of_point.plastic_strain;
            state.yielded += of_point.yielded / states.len() as f64;
        }
        // The field is nowhere negative, but its polynomial may be. A NaN stays.
        state.plastic_strain = if state.plastic_strain < 0.0 { 0.0 } else { state.plastic_strain };
        Ok(state)
    }
}

/// Index of the point that is nearest to ξ.
fn nearest<const D: usize>(points: &[Vector<D>], xi: &[f64]) -> usize {
    let distance = |point: &Vector<D>| (0..D).map(|i| (point[i] - xi[i]).powi(2)).sum::<f64>();
    let nearest = points.iter().enumerate().min_by(|a, b| distance(a.1).total_cmp(&distance(b.1)));
    nearest.map_or(0, |(k, _)| k)
}

fn add(sum: &mut [[f64; 3]; 3], weight: f64, tensor: &[[f64; 3]; 3]) {
    for (sum, component) in sum.as_flattened_mut().iter_mut().zip(tensor.as_flattened()) {
        *sum += weight * component;
    }
}

/// Weight of the value at each point in the polynomial at ξ: p(ξ)·(Σ p(ξ_q) p(ξ_q)ᵀ)⁻¹ p(ξ_q) with
/// the monomials p, of the largest degree of which the points determine all.
pub fn weights<const D: usize>(points: &[Vector<D>], xi: &[f64], degree: usize) -> Vec<f64> {
    let at_points = |degree: usize| points.iter().map(move |point| monomials(&point.0, degree));
    for degree in (1..=degree).rev() {
        let mut wanted = monomials(xi, degree);
        let count = wanted.len();
        let mut squares = vec![vec![0.0; count]; count];
        for p in at_points(degree) {
            for (row, a) in squares.iter_mut().zip(&p) {
                row.iter_mut().zip(&p).for_each(|(entry, b)| *entry += a * b);
            }
        }
        if count <= points.len() && solve(&mut squares, &mut wanted) {
            return at_points(degree).map(|p| p.iter().zip(&wanted).map(|(a, b)| a * b).sum()).collect();
        }
    }
    vec![1.0 / points.len() as f64; points.len()]
}

/// All monomials up to a degree.
pub fn monomials(xi: &[f64], degree: usize) -> Vec<f64> {
    let mut all = vec![1.0];
    // Monomials of each degree, with the axis of their last factor: later factors do not go back.
    let mut last = vec![(1.0, 0)];
    for _ in 0..degree {
        let next = last
            .iter()
            .flat_map(|&(value, first)| (first..xi.len()).map(move |axis| (value * xi[axis], axis)));
        last = next.collect();
        all.extend(last.iter().map(|(value, _)| *value));
    }
    all
}

/// Replaces `right` by the solution of a positive definite system; false if it is singular.
fn solve(matrix: &mut [Vec<f64>], right: &mut [f64]) -> bool {
    let count = right.len();
    let largest = (0..count).fold(0.0, |most, i| f64::max(most, matrix[i][i]));
    for pivot in 0..count {
        if matrix[pivot][pivot] <= 1e-10 * largest {
            return false;
        }
        for row in pivot + 1..count {
            let factor = matrix[row][pivot] / matrix[pivot][pivot];
            for column in pivot..count {
                matrix[row][column] -= factor * matrix[pivot][column];
            }
            right[row] -= factor * right[pivot];
        }
    }
    for row in (0..count).rev() {
        let known: f64 = (row + 1..count).map(|column| matrix[row][column] * right[column]).sum();
        right[row] = (right[row] - known) / matrix[row][row];
    }
    true
}
