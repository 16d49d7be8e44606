//! The constant data of a simulation as plain numbers. Every vector over nodes is flat, with
//! `dimension` components per node.

use std::sync::Arc;

use carom_algebra::Threads;
use carom_algebra::sums::dot;
use carom_solid::{Ask, Configuration, Inverted, Past, Response};

use super::body_instance::BodyInstance;
use super::contact::Contact;
use super::formulas::NoValue;
use super::loads::{Loads, LoadsAt};
use super::mass::Mass;
use super::motion::Motions;
use super::points::Points;
use super::probe::{Probe, past_of};
use super::rigid::Mode;
use crate::cells;
use crate::materials::Materials;

/// A named support: the dofs whose reaction is recorded.
pub struct Support {
    /// Name in the case.
    pub name: String,
    /// Global dofs that it constrains.
    pub dofs: Vec<usize>,
    /// Point about which their moment is recorded.
    pub moment_about: Option<Pivot>,
}

/// A point about which a moment is recorded.
#[derive(Clone, Debug, PartialEq)]
pub enum Pivot {
    /// Fixed in space.
    Point(Vec<f64>),
    /// The centre of rotation of an obstacle, which travels with this node.
    Node(usize),
}

/// A named tie, whose force is recorded.
pub struct Tie {
    /// Name in the case.
    pub name: String,
    /// Global numbers of the nodes of its secondary side that it makes points of the primary one,
    /// and, where ties meet, of the primary side that it makes points of the secondary one.
    pub tied: [Vec<usize>; 2],
    /// Dofs of tied nodes that a support holds on both sides, which takes the force there;
    /// ascending.
    pub supported: Vec<usize>,
    /// Global numbers of the nodes of both sides.
    pub surface: Vec<usize>,
    /// Bodies of the secondary and of the primary side.
    pub bodies: [usize; 2],
}

/// The constant data of a simulation.
pub struct Model {
    /// Components of a position: 1, 2 or 3.
    pub dimension: usize,
    /// Bodies; their nodes are numbered consecutively in this order.
    pub parts: Vec<BodyInstance>,
    /// Reference positions X, flat.
    pub reference: Vec<f64>,
    /// Positions at t = 0, flat.
    pub initial_position: Vec<f64>,
    /// Initial velocities, flat; zero where fixed.
    pub initial_velocity: Vec<f64>,
    /// Dofs that a support stops at the start, with the initial velocities that the case gives
    /// them.
    pub stopped: Vec<(usize, f64)>,
    /// Whether a dof is constrained: fixed or prescribed.
    pub fixed: Vec<bool>,
    /// Unknown dofs, ascending: those that neither are constrained nor belong to a point.
    pub free: Vec<usize>,
    /// Index of a dof among the unknown ones; `usize::MAX` of others.
    pub unknown: Vec<usize>,
    /// Nodes that are points of other bodies.
    pub points: Points,
    /// Named ties.
    pub ties: Vec<Tie>,
    /// Mass matrix.
    pub mass: Mass,
    /// Whether a dof is massless.
    pub massless: Vec<bool>,
    /// Constant gravity as nodal forces, with potential −f·y; one that varies in time is a load.
    pub gravity: Vec<f64>,
    /// Loads on sides and in bodies.
    pub loads: Loads,
    /// Moving supports.
    pub motions: Motions,
    /// Rigid modes that supports leave free.
    pub unconstrained: Vec<Mode>,
    /// Contacts.
    pub contacts: Vec<Contact>,
    /// Named supports.
    pub supports: Vec<Support>,
    /// Probes.
    pub probes: Vec<Probe>,
    /// Length L that tolerances refer to: the largest body's diameter.
    pub scale: f64,
    /// Gap that counts as closed; see [`gap_tolerance`].
    pub gap_tolerance: f64,
    /// Threads; no result depends on their number.
    pub threads: Threads,
}

/// Cells of a task of a thread.
const BLOCK: usize = 4096;
/// Gap, as a fraction of L, that counts as closed.
const GAP_TOLERANCE: f64 = 1e-12;

/// Gap that counts as closed, for bodies of size L and these coordinates and radii of obstacles: a
/// fraction of L, and what their round-off makes of none.
pub fn gap_tolerance(scale: f64, coordinates: impl Iterator<Item = f64>) -> f64 {
    let furthest = coordinates.fold(0.0_f64, |most, x| most.max(x.abs()));
    GAP_TOLERANCE * scale + 4.0 * f64::EPSILON * furthest
}

impl std::fmt::Debug for Model {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Model").field("dofs", &self.dofs()).finish_non_exhaustive()
    }
}

/// Sums over the cells of a body with memory.
struct Remembering<'a> {
    force: &'a mut [f64],
    memory: &'a mut [f64],
    lost: &'a mut f64,
}

impl Model {
    /// Number of dofs, including constrained ones.
    pub fn dofs(&self) -> usize {
        self.reference.len()
    }

    /// The unknown dofs: those that neither are constrained nor belong to a point; and the index of
    /// each dof among them, `usize::MAX` of others.
    pub fn unknowns(fixed: &[bool], dimension: usize, points: &Points) -> [Vec<usize>; 2] {
        let is_unknown = |dof: &usize| !fixed[*dof] && points.of(dof / dimension).is_none();
        let free: Vec<usize> = (0..fixed.len()).filter(is_unknown).collect();
        let mut places = vec![usize::MAX; fixed.len()];
        for (place, &dof) in free.iter().enumerate() {
            places[dof] = place;
        }
        [free, places]
    }

    /// The unknowns that a dof moves with, with their weights.
    pub(crate) fn moved_by(&self, dof: usize) -> impl Iterator<Item = (usize, f64)> + '_ {
        self.points.carriers(dof).filter_map(|(dof, weight)| Some((self.unknown(dof)?, weight)))
    }

    /// The index of a dof among the unknowns, if it is one.
    pub(crate) fn unknown(&self, dof: usize) -> Option<usize> {
        Some(self.unknown[dof]).filter(|&place| place != usize::MAX)
    }

    /// Count of numbers that the materials of all bodies remember.
    pub fn memory(&self) -> usize {
        self.parts.iter().map(BodyInstance::memory).sum()
    }

    /// Whether a material remembers anything.
    pub fn remembers(&self) -> bool {
        self.parts.iter().any(|part| part.memory() > 0)
    }

    /// Materials that remember nothing yet.
    pub(crate) fn materials(&self) -> Materials {
        Materials::new(self.parts.len(), self.memory())
    }

    /// The bodies, each with its section of a configuration of all nodes.
    pub(crate) fn configurations<'a>(
        &'a self,
        at: &'a Configuration<'a>,
    ) -> impl Iterator<Item = (&'a BodyInstance, Configuration<'a>)> {
        let mut rest = at.past.memory;
        self.parts.iter().map(move |part| {
            let memory = rest.split_off(..part.memory().min(rest.len())).unwrap_or_default();
            let past = Past::new(memory, at.past.dt);
            (part, Configuration { before: at.before.map(|y| part.of(y)), y: part.of(at.y), past })
        })
    }

    /// Internal forces ∂U/∂y, or their discrete gradient over a step, overwriting `force`, and in
    /// `trial` what materials with memory remember, store and dissipate. Returns the stored energy
    /// U.
    ///
    /// # Errors
    /// The body's name and the inverted cell.
    pub fn internal_force(
        &self,
        at: &Configuration,
        force: &mut [f64],
        trial: &mut Materials,
    ) -> Result<f64, (String, Inverted)> {
        if !self.remembers() {
            let (strain, least) = self.add_cells(at, Ask::Force, force)?;
            trial.min_det_f = least;
            return Ok(strain);
        }
        trial.min_det_f = None;
        force.fill(0.0);
        trial.resize(self.parts.len(), self.memory());
        let memory = Arc::make_mut(&mut trial.memory);
        let mut rest = &mut memory[..];
        let mut strain = 0.0;
        let energies = trial.stored.iter_mut().zip(&mut trial.lost);
        for ((part, at), (stored, lost)) in self.configurations(at).zip(energies) {
            let memory = rest.split_off_mut(..part.memory()).unwrap_or_default();
            *lost = 0.0;
            *stored = self.add_remembering(part, &at, Remembering { force, memory, lost })?;
            strain += *stored;
        }
        Ok(strain)
    }

    /// ∂f_int/∂y · `change`, overwriting `product`; with positions before, that of the discrete
    /// gradient from there.
    ///
    /// # Errors
    /// The body's name and the inverted cell.
    pub fn internal_product(
        &self,
        at: &Configuration,
        change: &[f64],
        product: &mut [f64],
    ) -> Result<(), (String, Inverted)> {
        self.add_cells(at, Ask::Product(change), product).map(|_| ())
    }

    /// Overwrites `sum` with the vectors that are asked of all cells. Returns what they store, and
    /// the smallest J where all cells know theirs.
    fn add_cells(
        &self,
        at: &Configuration,
        ask: Ask,
        sum: &mut [f64],
    ) -> Result<(f64, Option<f64>), (String, Inverted)> {
        sum.fill(0.0);
        let mut strain = 0.0;
        let mut least = Some(f64::INFINITY);
        for (part, at) in self.configurations(at) {
            let mesh = part.body.mesh();
            let own = part.of_mut(sum);
            let ask = match ask {
                Ask::Product(change) => Ask::Product(part.of(change)),
                other => other,
            };
            let add = |first: usize, locals: &[f64]| part.body.add_cells(first, locals, own);
            let compute = |first: usize, numbers: &mut [f64], energies: &mut [f64]| {
                part.body.respond(
                    first,
                    &at,
                    ask,
                    Response { numbers, energies, memory: &mut [], dissipated: &mut [] },
                )
            };
            let (stored, found) =
                cells::for_each(&self.threads, mesh.cell_count(), mesh.element.dofs(), compute, add)
                    .map_err(|inverted| (part.name.clone(), inverted))?;
            strain += stored;
            least = least.zip(found).map(|(least, found)| least.min(found));
        }
        Ok((strain, least))
    }

    /// Adds the forces of a body and what it dissipates, and overwrites its memory; returns the
    /// energy that it stores.
    fn add_remembering(
        &self,
        part: &BodyInstance,
        at: &Configuration,
        out: Remembering,
    ) -> Result<f64, (String, Inverted)> {
        let Remembering { force, memory, lost } = out;
        let mesh = part.body.mesh();
        let dofs = mesh.element.dofs();
        let size = part.body.memory();
        let own = part.of_mut(force);
        // The numbers of a cell are its force, its memory, and what it dissipates.
        let count = dofs + size + 1;
        let compute = cells::one_by_one(count, |cell, local: &mut [f64]| {
            let (numbers, rest) = local.split_at_mut(dofs);
            let (memory, dissipated) = rest.split_at_mut(size);
            let mut energies = [0.0];
            let out = Response { numbers, energies: &mut energies, memory, dissipated };
            part.body.respond(cell, at, Ask::Force, out)?;
            Ok(energies[0])
        });
        let add = cells::added_one_by_one(count, |cell, local: &[f64]| {
            part.body.add_cells(cell, &local[..dofs], own);
            memory[cell * size..(cell + 1) * size].copy_from_slice(&local[dofs..dofs + size]);
            *lost += local[dofs + size];
        });
        cells::for_each(&self.threads, mesh.cell_count(), count, compute, add)
            .map(|(stored, _)| stored)
            .map_err(|inverted| (part.name.clone(), inverted))
    }

    /// Loads at a time and positions `y`, overwriting `force`; without constant gravity.
    ///
    /// # Errors
    /// A formula without a finite value.
    pub fn loads_into(
        &self,
        time: f64,
        y: &[f64],
        at: &mut LoadsAt,
        force: &mut [f64],
    ) -> Result<(), NoValue> {
        if !self.loads.is_empty() {
            self.loads.at(&self.parts, self.dofs(), time, at)?;
            self.loads.force_into(at, y, force);
        }
        Ok(())
    }

    /// The same model, using this many threads.
    #[must_use]
    pub fn on_threads(mut self, count: usize) -> Self {
        self.threads = Threads::new(count);
        self.mass.on(&self.threads);
        self.contacts.iter_mut().for_each(|contact| contact.kinematics.on(&self.threads));
        self
    }

    /// Kinetic energy ½ vᵀM v.
    pub fn kinetic(&self, v: &[f64]) -> f64 {
        let mut momentum = vec![0.0; v.len()];
        self.mass.multiply_into(v, &mut momentum);
        0.5 * dot(v, &momentum)
    }

    /// Potential of constant gravity, −f·(y − X): zero in the reference configuration.
    pub fn potential(&self, y: &[f64]) -> f64 {
        -self.threads.sums([&self.gravity, y, &self.reference], |[f, y, x]| [f * (y - x)])[0]
    }

    /// Largest angle by which a quadrature point of a body has turned, and largest norm of the
    /// strain.
    pub fn turn(&self, body: usize, y: &[f64]) -> [f64; 2] {
        let part = &self.parts[body];
        let cells = 0..part.body.mesh().cell_count();
        let turns = cells.map(|cell| part.body.cell_turn(cell, part.of(y)));
        turns.fold([0.0; 2], |most, one| [0, 1].map(|i| f64::max(most[i], one[i])))
    }

    /// Largest equivalent plastic strain over the quadrature points of a body.
    pub fn plastic_strain(&self, body: usize, memory: &[f64]) -> f64 {
        self.parts[body].body.plastic_strain(&past_of(&self.parts, body, memory))
    }

    /// Smallest J over all quadrature points, which remember `memory`.
    pub fn min_det_f(&self, y: &[f64], memory: &[f64]) -> f64 {
        let mut least = f64::INFINITY;
        for (k, part) in self.parts.iter().enumerate() {
            let past = past_of(&self.parts, k, memory);
            let count = part.body.mesh().cell_count();
            let mut of_blocks = vec![f64::INFINITY; count.div_ceil(BLOCK)];
            self.threads.for_each(&mut of_blocks, |block, least| {
                let first = block * BLOCK;
                *least = part.body.min_det_f(first..count.min(first + BLOCK), part.of(y), &past);
            });
            least = of_blocks.into_iter().fold(least, f64::min);
        }
        least
    }
}
