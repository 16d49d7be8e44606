//! The matrices of the bodies over free dofs, in one pattern: the constant mass M, the tangent K =
//! ∂f_int/∂y at given positions, and the symmetric part of K_ext = ∂f_ext/∂y of follower pressures
//! (equal to it if the pressure is uniform and the side closed or constrained at its ends).
//!
//! The pattern is built once, with the slots of every cell, where a tangent or a mass with entries
//! between nodes is needed: an explicit run, whose mass is lumped, has none. It excludes contact,
//! whose rows act on the last unknowns of a factor (`direct.rs`).

use carom_algebra::Pattern;

use crate::linear::tangents::{coupled, each_tangent};
use crate::model::{LoadsAt, Model};
use crate::rejected::Rejected;
use carom_solid::Configuration;

/// Slot of an entry that is not stored: of a constrained dof, or in a facet's upper triangle.
const SKIP: u32 = u32::MAX;

/// The matrices of a model.
pub(crate) struct Matrices {
    pub pattern: Pattern,
    pub stiffness: Vec<f64>,
    pub mass: Vec<f64>,
    /// Empty without follower loads.
    pub follower: Vec<f64>,
    /// Slots of each cell's pairs of dofs, the lower triangle by rows, cell after cell over all
    /// bodies.
    slots: Vec<u32>,
    /// Slots of every pair of dofs of the facets under pressure.
    facet_slots: Vec<u32>,
}

impl Matrices {
    /// Pattern and slots of the bodies of a model.
    pub(crate) fn new(model: &Model) -> Self {
        let pattern = pattern(model);
        let mut slots = Vec::new();
        for_each_cell_pair(model, |pair| {
            slots.push(pair.and_then(|(a, b)| pattern.slot(a, b)).map_or(SKIP, |s| s as u32));
        });
        let (d, mut mass) = (model.dimension, vec![0.0; pattern.len()]);
        for node in 0..model.mass.nodes() {
            for (other, value) in model.mass.row(node) {
                for i in 0..d {
                    if let (Some(a), Some(b)) = (model.unknown(node * d + i), model.unknown(other * d + i))
                        && a >= b
                        && let Some(slot) = pattern.slot(a, b)
                    {
                        mass[slot] += value;
                    }
                }
            }
        }
        let mut facet_slots = Vec::new();
        model.loads.each_facet_tangent(d, None, |nodes, _| {
            let dofs =
                || nodes.iter().flat_map(|n| (0..d).map(move |i| n * d + i)).map(|dof| model.unknown(dof));
            for a in dofs() {
                for b in dofs() {
                    let slot = a.zip(b).filter(|(a, b)| a >= b).and_then(|(a, b)| pattern.slot(a, b));
                    facet_slots.push(slot.map_or(SKIP, |s| s as u32));
                }
            }
        });
        let follower = vec![0.0; if model.loads.follow_sides() { pattern.len() } else { 0 }];
        let stiffness = vec![0.0; pattern.len()];
        Self { pattern, stiffness, mass, follower, slots, facet_slots }
    }

    /// Assembles the symmetric part of the loads' tangent at a time and positions `y`, which matter
    /// in space only.
    pub(crate) fn assemble_loads(&mut self, model: &Model, time: f64, y: &[f64]) -> Result<(), Rejected> {
        let (mut at, mut slots) = (LoadsAt::default(), self.facet_slots.iter());
        model.loads.at(&model.parts, model.dofs(), time, &mut at)?;
        self.follower.fill(0.0);
        let follower = &mut self.follower;
        model.loads.each_facet_tangent(model.dimension, Some((&at, y)), |nodes, k| {
            let n = nodes.len() * model.dimension;
            for entry in 0..n * n {
                if let Some(&slot) = slots.next().filter(|slot| **slot != SKIP) {
                    follower[slot as usize] += 0.5 * (k[entry] + k[entry % n * n + entry / n]);
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
    pub(crate) fn assemble(&mut self, model: &Model, at: &Configuration) -> Result<Vec<f64>, Rejected> {
        self.stiffness.fill(0.0);
        let (mut slots, stiffness) = (self.slots.iter(), &mut self.stiffness);
        each_tangent(model, at, |part, _, tangent| {
            let n = part.body.mesh().element.dofs();
            for (row, k) in tangent.chunks_exact(n).enumerate() {
                for (value, slot) in k[..=row].iter().zip(slots.by_ref()) {
                    if *slot != SKIP {
                        stiffness[*slot as usize] += value;
                    }
                }
            }
        })?;
        // The first entry of each column of the lower triangle.
        Ok(self.pattern.starts[..self.pattern.size()].iter().map(|&slot| self.stiffness[slot]).collect())
    }
}

/// The pattern of the bodies: unknowns of every two nodes that share a cell. Nodes are paired
/// first, which avoids a list of all pairs of dofs.
fn pattern(model: &Model) -> Pattern {
    let (d, mut neighbours) = (model.dimension, coupled(model));
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

/// Calls `visit` with the unknowns of every two dofs of every cell, the larger first, in the order
/// of the lower triangles of the cells' tangents; with none if one is constrained.
fn for_each_cell_pair(model: &Model, mut visit: impl FnMut(Option<(usize, usize)>)) {
    let mut unknowns = Vec::new();
    for part in &model.parts {
        for cell in 0..part.body.mesh().cell_count() {
            unknowns.clear();
            unknowns.extend(part.cell_dofs(cell).iter().map(|dof| model.unknown(*dof as usize)));
            for (row, a) in unknowns.iter().enumerate() {
                for b in &unknowns[..=row] {
                    visit(a.zip(*b).map(|(a, b)| (a.max(b), a.min(b))));
                }
            }
        }
    }
}
