//! What a step needs to know and never changes: bodies with their nodes numbered through, masses, loads, supports, contacts and
//! probes, as plain numbers. Every vector over nodes is flat, `dimension` components a node.

mod formulas;
mod loads;
mod manufactured;
mod mass;
mod motion;
mod probe;
mod redistribution;
mod rigid;

use carom_contact::{Interface, Kinematics};
use carom_solid::{Body, FacetShape, Inverted};

pub use formulas::{NoValue, value};
pub use loads::{Amplitude, Load, Loads, LoadsAt};
pub use manufactured::Manufactured;
pub use mass::Mass;
pub use motion::{Motions, Prescribed};
pub use probe::{Probe, Quantity, von_mises};
pub use redistribution::redistribute;
pub use rigid::{Mode, Unheld, free_motions};

/// A body and its place among the global nodes.
pub struct Part {
    /// Name in the case.
    pub name: String,
    /// Global number of its first node.
    pub first_node: usize,
    /// Forces, masses and stresses at positions.
    pub body: Box<dyn Body>,
    /// Total mass.
    pub total_mass: f64,
    /// Global dofs of its cells, cell after cell.
    dofs: Vec<u32>,
}

impl Part {
    /// A body whose nodes are numbered from `first_node` on.
    pub fn new(name: String, first_node: usize, body: Box<dyn Body>) -> Self {
        let mesh = body.mesh();
        let (d, mut volumes) = (mesh.dimension(), vec![0.0; mesh.element.nodes()]);
        let mut volume = 0.0;
        for cell in 0..mesh.cell_count() {
            body.cell_volumes(cell, &mut volumes);
            volume += volumes.iter().sum::<f64>();
        }
        let total_mass = volume * body.density();
        let dofs = mesh.cells.iter().flat_map(|node| (0..d).map(move |i| ((first_node + node) * d + i) as u32));
        let dofs = dofs.collect();
        Self { name, first_node, total_mass, dofs, body }
    }

    /// Whether its density is zero: its balance holds at s + 1 without inertia.
    pub fn is_massless(&self) -> bool {
        self.body.density() == 0.0
    }

    /// Global numbers of its nodes.
    pub fn nodes(&self) -> std::ops::Range<usize> {
        self.first_node..self.first_node + self.body.mesh().nodes.len()
    }

    /// Its share of a vector over all nodes.
    pub fn of<'a>(&self, all: &'a [f64]) -> &'a [f64] {
        let (nodes, d) = (self.nodes(), self.body.mesh().dimension());
        &all[nodes.start * d..nodes.end * d]
    }

    /// Global dofs of a cell, node-major.
    pub fn cell_dofs(&self, cell: usize) -> &[u32] {
        let n = self.body.mesh().element.dofs();
        &self.dofs[cell * n..(cell + 1) * n]
    }
}

/// A contact: where its surfaces are to each other, what its gaps are answered with, and what schemes are to do about it.
pub struct Contact {
    /// Name in the case.
    pub name: String,
    /// Gaps at positions.
    pub kinematics: Box<dyn Kinematics>,
    /// Law and enforcement.
    pub interface: Box<dyn Interface>,
    /// Body of the primary side; `None` for a rigid primary.
    pub primary_part: Option<usize>,
    /// Facets of the secondary side in global nodes: for consistent weights.
    pub secondary_facets: Vec<Vec<usize>>,
    /// Their shape.
    pub secondary_shape: FacetShape,
    /// Whether the predictor y + Δt v is kept out of the primary too.
    pub predictor: bool,
    /// Nodes of both sides, ascending.
    pub surface: Vec<usize>,
    /// Whether its force is all taken at the end of the step, not averaged with the scheme's weights.
    pub at_the_end: bool,
    /// Whether velocities and accelerations are projected where it begins.
    pub projects: bool,
    /// Whether the active set may change before Newton's method has converged.
    pub within: bool,
    /// Newton's e; 0 unless the scheme treats contact itself.
    pub restitution: f64,
}

/// A named support: the dofs whose reaction is recorded.
pub struct Support {
    /// Name in the case.
    pub name: String,
    /// Global dofs it holds.
    pub dofs: Vec<usize>,
}

/// Everything a step needs to know that does not change.
pub struct Model {
    /// Components of a position: 1 or 2.
    pub dimension: usize,
    /// Bodies, nodes numbered through in this order.
    pub parts: Vec<Part>,
    /// Reference positions X, flat.
    pub reference: Vec<f64>,
    /// Positions at t = 0, flat.
    pub initial_position: Vec<f64>,
    /// Initial velocities, flat; zero where fixed.
    pub initial_velocity: Vec<f64>,
    /// Whether a dof is held, fixed or moved.
    pub fixed: Vec<bool>,
    /// Dofs that are not held, ascending.
    pub free: Vec<usize>,
    /// Place of a dof among the free ones; `usize::MAX` where held.
    pub unknown: Vec<usize>,
    /// Mass matrix.
    pub mass: Mass,
    /// Whether a dof has no mass.
    pub massless: Vec<bool>,
    /// Gravity as nodal forces; constant, with potential −f·y.
    pub gravity: Vec<f64>,
    /// Loads on sides and in bodies.
    pub loads: Loads,
    /// Supports that move.
    pub motions: Motions,
    /// Rigid motions that supports leave to bodies; only looked for where there is no inertia.
    pub unheld: Vec<Mode>,
    /// Contacts.
    pub contacts: Vec<Contact>,
    /// Named supports.
    pub supports: Vec<Support>,
    /// Probes.
    pub probes: Vec<Probe>,
    /// Length L that tolerances refer to: the largest body's diameter.
    pub scale: f64,
}

impl Model {
    /// Number of dofs, held ones included.
    pub fn dofs(&self) -> usize {
        self.reference.len()
    }

    /// The place of a dof among the unknowns, if it is one.
    pub(crate) fn unknown(&self, dof: usize) -> Option<usize> {
        Some(self.unknown[dof]).filter(|&place| place != usize::MAX)
    }

    /// Internal forces ∂U/∂y at positions `y`, overwriting `force`; the strain energy U is returned.
    ///
    /// # Errors
    /// The body's name and the cell that is inverted.
    pub fn internal_force(&self, y: &[f64], force: &mut [f64]) -> Result<f64, (String, Inverted)> {
        self.add_cells(force, |part, cell, local| part.body.cell_force(cell, part.of(y), local))
    }

    /// Discrete gradient of the strain energy between positions, overwriting `force`; U(now) is returned.
    ///
    /// # Errors
    /// The body's name and the cell that is inverted.
    pub fn internal_between(&self, before: &[f64], now: &[f64], force: &mut [f64]) -> Result<f64, (String, Inverted)> {
        self.add_cells(force, |part, cell, local| {
            part.body.cell_between(cell, part.of(before), part.of(now), local, None)
        })
    }

    fn add_cells(
        &self,
        force: &mut [f64],
        of_cell: impl Fn(&Part, usize, &mut [f64]) -> Result<f64, Inverted>,
    ) -> Result<f64, (String, Inverted)> {
        force.fill(0.0);
        let mut strain = 0.0;
        for part in &self.parts {
            let mesh = part.body.mesh();
            let mut local = vec![0.0; mesh.element.dofs()];
            for cell in 0..mesh.cell_count() {
                strain += of_cell(part, cell, &mut local).map_err(|inverted| (part.name.clone(), inverted))?;
                for (dof, f) in part.cell_dofs(cell).iter().zip(&local) {
                    force[*dof as usize] += f;
                }
            }
        }
        Ok(strain)
    }

    /// Loads at a time and positions `y`, overwriting `force`; gravity is not among them.
    ///
    /// # Errors
    /// A formula without a finite value.
    pub fn loads_into(&self, time: f64, y: &[f64], at: &mut LoadsAt, force: &mut [f64]) -> Result<(), NoValue> {
        if !self.loads.is_empty() {
            self.loads.at(&self.parts, self.dofs(), time, at)?;
            self.loads.force_into(at, y, force);
        }
        Ok(())
    }

    /// Kinetic energy ½ vᵀM v.
    pub fn kinetic(&self, v: &[f64]) -> f64 {
        let mut momentum = vec![0.0; v.len()];
        self.mass.multiply_into(v, &mut momentum);
        0.5 * dot(v, &momentum)
    }

    /// Potential of gravity, −f·(y − X): zero in the reference position.
    pub fn potential(&self, y: &[f64]) -> f64 {
        -(0..y.len()).map(|i| self.gravity[i] * (y[i] - self.reference[i])).sum::<f64>()
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

/// Scalar product with one fixed order of summation.
pub fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(x, y)| x * y).sum()
}
