//! Iterative solution: conjugate gradients under the rows of contact with the frozen tangent,
//! stored by blocks of nodes in single precision, and with the mass. Nothing is factored but the
//! complement of the active rows.
//!
//! A solve with the tangent need not be more accurate than the frozen tangent itself; the linear
//! problem of an iteration (`linear_problem.rs`) applies the exact one. A solve with the mass is
//! accurate to round-off.

use std::sync::Arc;

use carom_algebra::{
    ConjugateGradients, ConstraintPreconditioner, ConstraintRows, DiagonalBlocks, Goal, LinearError,
    NodeMatrix,
};

use crate::contact::constraints::Constraints;
use crate::linear::preconditioner::Preconditioner;
use crate::linear::tangents::{coupled, each_tangent};
use crate::model::Model;
use crate::rejected::Rejected;
use crate::stage::renewal::Point;
use carom_solid::Configuration;

/// Cost of assembling a tangent, in solves with it and evaluations of the residual.
const COST: f64 = 2.0;
/// Reduction of the residual by a solve with the tangent, and with the mass.
const REDUCTION: f64 = 0.01;
const ROUND_OFF: f64 = 1e-15;
/// Iterations after which a solve has failed.
const MOST: usize = 5000;

/// The frozen tangent of the bodies, and what solves with it.
pub struct Iterative {
    matrix: NodeMatrix,
    /// Slots of the stored blocks of each cell, by rows, cell after cell over all bodies.
    slots: Vec<u32>,
    diagonals: [Vec<f64>; 2],
    /// The point of the matrix.
    point: Option<Arc<Point>>,
    /// Diagonal blocks of the tangent and of the mass.
    blocks: [DiagonalBlocks; 2],
    constrained: Vec<usize>,
    massless: Vec<usize>,
    of_mass: bool,
    /// The rows of contacts as they are, and over the included dofs; and whether the second
    /// derivatives of the former count.
    contacts: Constraints,
    rows: ConstraintRows,
    curved: bool,
    method: ConjugateGradients,
    iterations: u64,
    forces: Vec<f64>,
    gaps: Vec<f64>,
}

impl Iterative {
    /// The structure for the bodies of a model.
    pub fn new(model: &Model) -> Self {
        let d = model.dimension;
        let matrix = NodeMatrix::new(d, coupled(model)).on(&model.threads);
        let mut slots = Vec::new();
        for part in &model.parts {
            let mesh = part.body.mesh();
            for cell in (0..mesh.cell_count()).map(|cell| mesh.cell(cell)) {
                for (a, b) in stored(cell) {
                    let [a, b] = [cell[a], cell[b]].map(|node| part.first_node + node);
                    slots.push(matrix.slot(a, b).unwrap_or_default() as u32);
                }
            }
        }
        let of_node: Vec<f64> = (0..model.mass.nodes())
            .map(|node| model.mass.row(node).filter(|(other, _)| *other == node).map(|(_, m)| m).sum())
            .collect();
        let mut blocks = [DiagonalBlocks::default(), DiagonalBlocks::default()];
        blocks[1].invert(d, of_node.len(), |node, block| {
            block.fill(0.0);
            for i in 0..d {
                block[i * d + i] = if model.massless[node * d + i] { 1.0 } else { of_node[node] };
            }
        });
        let mass = model.free.iter().map(|dof| of_node[dof / d]).collect();
        let stiffness = vec![0.0; model.free.len()];
        Self {
            matrix,
            slots,
            diagonals: [mass, stiffness],
            point: None,
            blocks,
            constrained: (0..model.dofs()).filter(|dof| model.fixed[*dof]).collect(),
            massless: model.free.iter().copied().filter(|dof| model.massless[*dof]).collect(),
            of_mass: false,
            contacts: Constraints::none(d),
            rows: ConstraintRows::default(),
            curved: false,
            method: ConjugateGradients::default(),
            iterations: 0,
            forces: Vec::new(),
            gaps: Vec::new(),
        }
    }

    /// Replaces the matrix by `factor` K at positions.
    fn assemble_times(&mut self, model: &Model, at: &Configuration, factor: f64) -> Result<(), Rejected> {
        self.point = None;
        self.matrix.clear();
        let matrix = &mut self.matrix;
        let [_, diagonal] = &mut self.diagonals;
        let d = model.dimension;
        diagonal.fill(0.0);
        let mut slots = self.slots.iter();
        each_tangent(model, at, |part, cell, tangent| {
            let mesh = part.body.mesh();
            let n = mesh.element.dofs();
            for (a, b) in stored(mesh.cell(cell)) {
                let Some(slot) = slots.next() else { return };
                for (i, row) in matrix.block_mut(*slot as usize).chunks_exact_mut(d).enumerate() {
                    let from = (a * d + i) * n + b * d;
                    let entries = row.iter_mut().zip(&tangent[from..from + d]);
                    entries.for_each(|(entry, k)| *entry += (factor * k) as f32);
                }
            }
            for (i, dof) in part.cell_dofs(cell).iter().enumerate() {
                if let Some(unknown) = model.unknown(*dof as usize) {
                    diagonal[unknown] += tangent[i * n + i];
                }
            }
        })
    }

    /// Prepares solves with these rows, over the dofs that are `included`.
    fn constrain(
        &mut self,
        model: &Model,
        rows: &Constraints,
        included: impl Fn(usize) -> bool,
    ) -> Result<(), LinearError> {
        debug_assert!(!rows.is_skew, "friction is solved directly");
        self.rows.clear();
        for (row, constraint) in rows.rows.iter().zip(&rows.list) {
            let weight = constraint.weight;
            let entries = model.points.pulled(row.entries());
            let entries = entries.filter(|(dof, _)| !model.fixed[*dof] && included(*dof));
            let entries = entries.map(|(dof, slope)| (dof, weight * slope));
            // A row that yields is eliminated like a spring, and its multiplier found afterwards.
            self.rows.push(weight * (constraint.compliance + constraint.yields), entries);
        }
        self.contacts.clone_from(rows);
        self.rows.factor(&self.blocks[usize::from(self.of_mass)])
    }
}

impl Preconditioner for Iterative {
    fn cost(&self) -> f64 {
        COST
    }

    fn iterations(&self) -> Option<u64> {
        Some(self.iterations)
    }

    fn diagonals(&self) -> &[Vec<f64>; 2] {
        &self.diagonals
    }

    fn assemble(&mut self, model: &Model, at: &Configuration) -> Result<(), Rejected> {
        self.assemble_times(model, at, 1.0)
    }

    fn of(&self, point: &Arc<Point>) -> Option<bool> {
        (self.point.as_ref() == Some(point)).then_some(true)
    }

    fn form(&mut self, model: &Model, point: &Arc<Point>, _double: bool) -> Result<bool, Rejected> {
        self.assemble_times(model, &point.configuration(), point.stiffness)?;
        let d = model.dimension;
        for node in 0..model.mass.nodes() {
            for (other, mass) in model.mass.row(node).filter(|(other, _)| *other >= node) {
                let Some(slot) = self.matrix.slot(node, other) else { continue };
                let diagonal = self.matrix.block_mut(slot).iter_mut().step_by(d + 1);
                diagonal.for_each(|entry| *entry += (point.mass * mass) as f32);
            }
        }
        let matrix = &self.matrix;
        self.blocks[0].invert(d, matrix.nodes(), |node, block| {
            let slot = matrix.slot(node, node).unwrap_or_default();
            let values = matrix.block(slot).iter().enumerate();
            for (entry, (k, value)) in block.iter_mut().zip(values) {
                let i = k / d;
                let j = k % d;
                let is_free = !model.fixed[node * d + i] && !model.fixed[node * d + j];
                *entry = if is_free { f64::from(*value) } else { f64::from(u8::from(i == j)) };
            }
        });
        self.point = Some(point.clone());
        Ok(true)
    }

    fn form_mass(&mut self, model: &Model, rows: &Constraints) -> Result<(), Rejected> {
        self.of_mass = true;
        Ok(self.constrain(model, rows, |dof| !model.massless[dof])?)
    }

    fn boundary(&self, _: &Model, _: &[f64], _: &Constraints, _: Option<&Point>) -> Vec<usize> {
        Vec::new()
    }

    fn spans(&self, _: &Model, _: &Constraints) -> bool {
        self.point.is_some()
    }

    fn prepare(&mut self, model: &Model, rows: &Constraints) -> Result<bool, LinearError> {
        self.of_mass = false;
        self.curved = rows.list.iter().any(|row| row.curvature.iter().any(|value| *value != 0.0));
        self.constrain(model, rows, |_| true)?;
        Ok(true)
    }

    fn regularity(&self) -> Option<f64> {
        None
    }

    fn solve(
        &mut self,
        model: &Model,
        [forces, gaps]: [&[f64]; 2],
        increment: &mut [f64],
        multipliers: &mut Vec<f64>,
    ) -> Result<(), LinearError> {
        let Self { matrix, contacts, rows, curved, constrained, massless, of_mass, .. } = self;
        self.forces.clear();
        self.forces.extend_from_slice(forces);
        model.points.gather(&mut self.forces);
        constrained.iter().for_each(|dof| self.forces[*dof] = 0.0);
        let points = &model.points;
        let mut moved = vec![0.0; if points.is_empty() { 0 } else { forces.len() }];
        self.gaps.clear();
        self.gaps.extend((0..gaps.len()).map(|r| if rows.is_spring(r) { 0.0 } else { gaps[r] }));
        multipliers.resize(gaps.len(), 0.0);
        let yielding = contacts.list.iter().enumerate().filter(|(_, row)| row.yields != 0.0);
        yielding.clone().for_each(|(r, _)| rows.pull(r, gaps[r], &mut self.forces));
        loop {
            let product = |x: &[f64], out: &mut [f64]| {
                let mut x = x;
                if !points.is_empty() {
                    moved.copy_from_slice(x);
                    points.carry(&mut moved);
                    x = &moved;
                }
                if *of_mass {
                    model.mass.multiply_into(x, out);
                    massless.iter().for_each(|dof| out[*dof] = x[*dof]);
                } else {
                    matrix.multiply_into(x, out);
                    add_contacts(contacts, *curved, x, out);
                }
                points.gather(out);
                constrained.iter().for_each(|dof| out[*dof] = 0.0);
            };
            let ended = self.method.solve(
                &model.threads,
                product,
                ConstraintPreconditioner { blocks: &self.blocks[usize::from(*of_mass)], rows },
                [&self.forces, &self.gaps],
                [increment, multipliers],
                Goal { reduction: if *of_mass { ROUND_OFF } else { REDUCTION }, iterations: MOST },
            );
            self.iterations += ended.iterations as u64;
            if ended.is_indefinite && std::mem::take(curved) {
                // An inaccurate multiplier can make the curvature terms too large: without second
                // derivatives there is still a descent direction.
                continue;
            }
            let unusable = ended.iterations == MOST || ended.is_indefinite && ended.iterations == 1;
            if unusable || !increment.iter().all(|x| x.is_finite()) {
                let iterations = ended.iterations;
                let reduction = ended.reduction;
                return Err(LinearError::Stalled { size: model.free.len(), iterations, reduction });
            }
            yielding.for_each(|(r, _)| multipliers[r] = rows.pulled(r, gaps[r], increment));
            points.carry(increment);
            return Ok(());
        }
    }
}

/// out += of what the rows of contacts add to the tangent of positions times x; rows whose
/// multiplier is an unknown count as springs.
fn add_contacts(rows: &Constraints, curved: bool, x: &[f64], out: &mut [f64]) {
    for (row, constraint) in rows.rows.iter().zip(&rows.list) {
        let spring = constraint.compliance + constraint.yields;
        if spring == 0.0 && !curved {
            continue;
        }
        for (i, (dof, _)) in row.entries().enumerate() {
            let entry = |j: usize| constraint.stiffness(row.gradient, [i, j], spring, curved);
            out[dof] += row.entries().enumerate().map(|(j, (other, _))| entry(j) * x[other]).sum::<f64>();
        }
    }
}

/// Places of a cell's nodes whose blocks are stored.
fn stored(cell: &[usize]) -> impl Iterator<Item = (usize, usize)> + '_ {
    let pairs = (0..cell.len()).flat_map(move |a| (0..cell.len()).map(move |b| (a, b)));
    pairs.filter(|&(a, b)| cell[a] <= cell[b])
}
