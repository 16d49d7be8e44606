//! The constant data of a simulation as plain numbers. Every vector over nodes is flat, with
//! `dimension` components per node.

use carom_algebra::Threads;
use carom_algebra::sums::{dot, sum};
use carom_solid::Inverted;

use super::body_instance::BodyInstance;
use super::contact::Contact;
use super::formulas::NoValue;
use super::loads::{Loads, LoadsAt};
use super::mass::Mass;
use super::motion::Motions;
use super::points::Points;
use super::probe::Probe;
use super::rigid::Mode;
use crate::cells;

/// A named support: the dofs whose reaction is recorded.
pub struct Support {
    /// Name in the case.
    pub name: String,
    /// Global dofs that it constrains.
    pub dofs: Vec<usize>,
    /// Point about which their moment is recorded.
    pub moment_about: Option<Vec<f64>>,
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

/// Gap, as a fraction of L, that counts as closed.
const GAP_TOLERANCE: f64 = 1e-12;

/// Gap that counts as closed, for bodies of size L at `positions`: a fraction of L, and what
/// round-off of positions makes of none.
pub fn gap_tolerance(scale: f64, positions: &[f64]) -> f64 {
    let furthest = positions.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
    GAP_TOLERANCE * scale + 4.0 * f64::EPSILON * furthest
}

impl std::fmt::Debug for Model {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Model").field("dofs", &self.dofs()).finish_non_exhaustive()
    }
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

    /// Internal forces ∂U/∂y at positions `y`, overwriting `force`. Returns the strain energy U.
    ///
    /// # Errors
    /// The body's name and the inverted cell.
    pub fn internal_force(&self, y: &[f64], force: &mut [f64]) -> Result<f64, (String, Inverted)> {
        self.add_cells(force, |part, first, local, energies| {
            part.body.cell_forces(first, part.of(y), local, energies)
        })
    }

    /// Discrete gradient of the strain energy between positions, overwriting `force`. Returns
    /// U(now).
    ///
    /// # Errors
    /// The body's name and the inverted cell.
    pub fn internal_between(
        &self,
        before: &[f64],
        now: &[f64],
        force: &mut [f64],
    ) -> Result<f64, (String, Inverted)> {
        self.add_cells(force, |part, first, local, energies| {
            let between = |cell: usize, local: &mut [f64]| {
                part.body.cell_between(cell, part.of(before), part.of(now), local)
            };
            cells::one_by_one(part.body.mesh().element.dofs(), between)(first, local, energies)
        })
    }

    /// ∂f_int/∂y · `change` at `y`, overwriting `product`; with `before`, that of the discrete
    /// gradient from there.
    ///
    /// # Errors
    /// The body's name and the inverted cell.
    pub fn internal_product(
        &self,
        before: Option<&[f64]>,
        y: &[f64],
        change: &[f64],
        product: &mut [f64],
    ) -> Result<(), (String, Inverted)> {
        let products = |part: &BodyInstance, first: usize, local: &mut [f64], none: &mut [f64]| {
            let of_cell = |cell: usize, local: &mut [f64]| {
                let before = before.map(|y| part.of(y));
                part.body.cell_product(cell, before, part.of(y), part.of(change), local).map(|()| 0.0)
            };
            cells::one_by_one(part.body.mesh().element.dofs(), of_cell)(first, local, none)
        };
        self.add_cells(product, products).map(|_| ())
    }

    fn add_cells(
        &self,
        force: &mut [f64],
        of_cells: impl Fn(&BodyInstance, usize, &mut [f64], &mut [f64]) -> Result<(), Inverted> + Sync,
    ) -> Result<f64, (String, Inverted)> {
        force.fill(0.0);
        let mut strain = 0.0;
        for part in &self.parts {
            let mesh = part.body.mesh();
            let own = part.of_mut(force);
            let add = |first: usize, locals: &[f64]| part.body.add_cells(first, locals, own);
            let compute = |first: usize, local: &mut [f64], energies: &mut [f64]| {
                of_cells(part, first, local, energies)
            };
            strain += cells::for_each(&self.threads, mesh.cell_count(), mesh.element.dofs(), compute, add)
                .map_err(|inverted| (part.name.clone(), inverted))?;
        }
        Ok(strain)
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
        -sum([&self.gravity, y, &self.reference], |[f, y, x]| f * (y - x))
    }

    /// Largest angle by which a quadrature point of a body has turned, and largest norm of the
    /// strain.
    pub fn turn(&self, body: usize, y: &[f64]) -> [f64; 2] {
        let part = &self.parts[body];
        let cells = 0..part.body.mesh().cell_count();
        let turns = cells.map(|cell| part.body.cell_turn(cell, part.of(y)));
        turns.fold([0.0; 2], |most, one| [0, 1].map(|i| f64::max(most[i], one[i])))
    }

    /// Smallest J over all quadrature points.
    pub fn min_det_f(&self, y: &[f64]) -> f64 {
        let mut least = f64::INFINITY;
        for part in &self.parts {
            for cell in 0..part.body.mesh().cell_count() {
                least = least.min(part.body.cell_min_det_f(cell, part.of(y)));
            }
        }
        least
    }
}
