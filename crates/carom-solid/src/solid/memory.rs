//! Steps of cells: what the points of a cell remember, in blocks of points one after the other.

use super::Solid;
use crate::material::{Past, Pointwise};
use crate::shape::Shape;

/// Energy that a cell stores, and energy that it dissipates in a step.
#[derive(Clone, Copy, Default)]
pub(super) struct Energies {
    pub(super) stored: f64,
    pub(super) dissipated: f64,
}

/// A law in a cell.
pub(super) struct Step<'a, const D: usize> {
    pub(super) law: &'a dyn Pointwise<D>,
    pub(super) cell: usize,
    /// Memory of the cell's points at the start of the step.
    pub(super) past: Past<'a>,
    /// Memory of these points at the end of the step; not asked for if empty.
    pub(super) memory: &'a mut [f64],
}

impl<'a, const D: usize> Step<'a, D> {
    /// A law without memory in a cell.
    pub(super) fn elastic(law: &'a dyn Pointwise<D>, cell: usize) -> Self {
        Self { law, cell, past: Past::default(), memory: &mut [] }
    }
}

impl<const D: usize, const N: usize, S: Shape<D, N>> Solid<D, N, S> {
    /// Count of numbers of the cell with the most: those of all its points, of the law that
    /// remembers most.
    pub(super) fn memory_of_cells(&self) -> usize {
        let of_point = self.media.iter().map(|medium| medium.law.memory()).max().unwrap_or(0);
        let has = |curved: bool| usize::from(self.curved.contains(&curved));
        let points =
            [false, true].map(|curved| has(curved) * self.force_rules[usize::from(curved)].points.len());
        of_point * points[0].max(points[1])
    }
}
