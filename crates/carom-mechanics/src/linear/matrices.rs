//! The matrices of the bodies over free dofs, in one pattern: the constant mass M, the tangent K =
//! ∂f_int/∂y at given positions, and the symmetric part of K_ext = ∂f_ext/∂y of follower pressures
//! (equal to it if the pressure is uniform and the side closed or constrained at its ends).
//!
//! The pattern is built once, with the slots of every cell, where a tangent or a mass with entries
//! between nodes is needed: an explicit run, whose mass is lumped, has none. It excludes contact,
//! whose rows act on the last unknowns of a factor (`direct.rs`).

use std::sync::Arc;

use carom_algebra::Pattern;

use crate::linear::tangents::{coupled, each_tangent};
use crate::model::{LoadsAt, Model};
use crate::rejected::Rejected;
use carom_solid::Configuration;

/// Slot of an entry that is not stored: of a constrained dof, or in a facet's upper triangle.
const SKIP: u32 = u32::MAX;
/// Slot of an entry of a point, which several unknowns carry.
const CARRIED: u32 = u32::MAX - 1;

/// The matrices of a model.
pub struct Matrices {
    /// The entries that all three store.
    pub pattern: Arc<Pattern>,
    /// K.
    pub stiffness: Vec<f64>,
    /// M.
    pub mass: Vec<f64>,
    /// The symmetric part of K_ext; empty without follower loads.
    pub follower: Vec<f64>,
    /// Slots of each cell's pairs of dofs, the lower triangle by rows, cell after cell over all
    /// bodies.
    slots: Vec<u32>,
    /// Slots of every pair of dofs of the facets under pressure.
    facet_slots: Vec<u32>,
}

impl Matrices {
    /// Pattern and slots of the bodies of a model.
    pub fn new(model: &Model) -> Self {
        let pattern = Arc::new(pattern(model));
        let mut slots = Vec::new();
        for part in &model.parts {
            for cell in 0..part.body.mesh().cell_count() {
                let dofs = part.cell_dofs(cell);
                for (row, a) in dofs.iter().enumerate() {
                    let row = dofs[..=row].iter();
                    slots.extend(row.map(|b| slot_of(model, &pattern, [*a as usize, *b as usize])));
                }
            }
        }
        let d = model.dimension;
        let mut mass = vec![0.0; pattern.len()];
        for node in 0..model.mass.nodes() {
            for (other, value) in model.mass.row(node) {
                for i in 0..d {
                    add_carried(model, &pattern, [node * d + i, other * d + i], value, &mut mass);
                }
            }
        }
        let mut facet_slots = Vec::new();
        model.loads.each_facet_tangent(d, None, |nodes, _| {
            let dofs = || nodes.iter().flat_map(|n| (0..d).map(move |i| n * d + i));
            for a in dofs() {
                for b in dofs() {
                    let slot = slot_of(model, &pattern, [a, b]);
                    let is_upper = slot != CARRIED && model.unknown(a) < model.unknown(b);
                    facet_slots.push(if is_upper { SKIP } else { slot });
                }
            }
        });
        let follower = vec![0.0; if model.loads.follow_sides() { pattern.len() } else { 0 }];
        let stiffness = vec![0.0; pattern.len()];
        Self { pattern, stiffness, mass, follower, slots, facet_slots }
    }

    /// Assembles the symmetric part of the loads' tangent at a time and positions `y`, which matter
    /// in space only.
    pub fn assemble_loads(&mut self, model: &Model, time: f64, y: &[f64]) -> Result<(), Rejected> {
        let mut at = LoadsAt::default();
        let mut slots = self.facet_slots.iter();
        model.loads.at(&model.parts, model.dofs(), time, &mut at)?;
        self.follower.fill(0.0);
        let follower = &mut self.follower;
        let pattern = &self.pattern;
        let d = model.dimension;
        model.loads.each_facet_tangent(d, Some((&at, y)), |nodes, k| {
            let n = nodes.len() * d;
            for entry in 0..n * n {
                let [row, column] = [entry / n, entry % n];
                let value = 0.5 * (k[entry] + k[column * n + row]);
                match slots.next() {
                    Some(&CARRIED) => {
                        let dofs = [row, column].map(|i| nodes[i / d] * d + i % d);
                        add_carried(model, pattern, dofs, value, follower);
                    }
                    Some(&slot) if slot != SKIP => follower[slot as usize] += value,
                    _ => {}
                }
            }
        });
        Ok(())
    }

    /// out += K x over the free dofs, with the last tangent.
    pub(crate) fn stiffness_product(&self, x: &[f64], out: &mut [f64]) {
        self.pattern.multiply_add(&self.stiffness, x, out);
    }

    /// Assembles the tangent of the internal forces at positions; returns its diagonal.
    ///
    /// # Errors
    /// If a cell is inverted there.
    pub fn assemble(&mut self, model: &Model, at: &Configuration) -> Result<Vec<f64>, Rejected> {
        self.stiffness.fill(0.0);
        let Self { slots, stiffness, pattern, .. } = self;
        let mut slots = slots.iter();
        each_tangent(model, at, |part, cell, tangent| {
            let n = part.body.mesh().element.dofs();
            for (row, k) in tangent.chunks_exact(n).enumerate() {
                for (column, (value, slot)) in k[..=row].iter().zip(slots.by_ref()).enumerate() {
                    match *slot {
                        SKIP => {}
                        CARRIED => {
                            let dofs = [row, column].map(|i| part.cell_dofs(cell)[i] as usize);
                            add_carried(model, pattern, dofs, *value, stiffness);
                            if row != column {
                                add_carried(model, pattern, [dofs[1], dofs[0]], *value, stiffness);
                            }
                        }
                        slot => stiffness[slot as usize] += value,
                    }
                }
            }
        })?;
        // The first entry of each column of the lower triangle.
        Ok(self.pattern.starts[..self.pattern.size()].iter().map(|&slot| self.stiffness[slot]).collect())
    }
}

/// Slot of the entry of two dofs, whichever of their unknowns is the larger.
fn slot_of(model: &Model, pattern: &Pattern, [a, b]: [usize; 2]) -> u32 {
    let is_point = |dof: usize| model.points.of(dof / model.dimension).is_some();
    if is_point(a) || is_point(b) {
        return CARRIED;
    }
    let places = model.unknown(a).zip(model.unknown(b));
    let slot = places.and_then(|(a, b)| pattern.slot(a.max(b), a.min(b)));
    slot.map_or(SKIP, |slot| slot as u32)
}

/// Adds an entry of a matrix over all dofs to the lower triangle of the one over the unknowns that
/// carry them.
fn add_carried(model: &Model, pattern: &Pattern, [row, column]: [usize; 2], value: f64, to: &mut [f64]) {
    for (a, of_a) in model.moved_by(row) {
        for (b, of_b) in model.moved_by(column).filter(|(b, _)| a >= *b) {
            if let Some(slot) = pattern.slot(a, b) {
                to[slot] += of_a * of_b * value;
            }
        }
    }
}

/// The pattern of the bodies: unknowns of every two nodes that share a cell, or carry those of one.
/// Nodes are paired first, which avoids a list of all pairs of dofs.
fn pattern(model: &Model) -> Pattern {
    let d = model.dimension;
    let mut neighbours = coupled(model);
    add_carriers(model, &mut neighbours);
    for (node, nodes) in neighbours.iter_mut().enumerate() {
        // The mass of a rigid obstacle has no cells.
        nodes.push(node as u32);
        nodes.retain(|other| *other as usize <= node);
        nodes.sort_unstable();
        nodes.dedup();
    }
    let pairs = neighbours.iter().enumerate();
    let pairs = pairs.flat_map(|(a, below)| below.iter().map(move |&b| (a, b as usize)));
    let entries = pairs.flat_map(|(a, b)| (0..d * d).map(move |k| (a * d + k / d, b * d + k % d)));
    let unknowns = entries.filter_map(|(a, b)| model.unknown(a).zip(model.unknown(b)));
    Pattern::from_entries(model.free.len(), unknowns)
}

/// Couples the nodes that carry the nodes of a cell.
fn add_carriers(model: &Model, neighbours: &mut [Vec<u32>]) {
    if model.points.is_empty() {
        return;
    }
    for part in &model.parts {
        let mesh = part.body.mesh();
        for cell in (0..mesh.cell_count()).map(|cell| mesh.cell(cell)) {
            let nodes: Vec<usize> = cell.iter().map(|node| part.first_node + node).collect();
            if nodes.iter().any(|node| model.points.of(*node).is_some()) {
                let carriers = model.points.carrying(&nodes);
                for &a in &carriers {
                    neighbours[a].extend(carriers.iter().map(|b| *b as u32));
                }
            }
        }
    }
}
