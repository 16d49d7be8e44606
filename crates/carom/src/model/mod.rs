//! A case made computable: bodies with their nodes numbered through, masses, loads, supports, contacts and probes. Never changes during a run.

mod build;
mod dimension;
mod formulas;
mod held;
mod loads;
mod manufactured;
mod mass;
mod motion;
mod probe;
mod redistribution;

use carom_contact::ContactMethod;
use carom_solid::{Body, Inverted};

pub use build::{build, overlaps};
pub use dimension::{Dimension, Space};
pub use formulas::NoValue;
pub use held::{Mode, Unheld};
pub use loads::{Loads, LoadsAt};
pub use manufactured::Manufactured;
pub use mass::Mass;
pub use motion::{Motions, Prescribed};
pub use probe::Probe;

use crate::case::{ForceTime, Persistency, Quantity};

/// A body and its place among the global nodes.
pub struct Part<const D: usize> {
    /// Name in the case.
    pub name: String,
    /// Global number of its first node.
    pub first_node: usize,
    /// Forces, masses and stresses at positions.
    pub body: Box<dyn Body<D>>,
    /// Whether its density is zero: its balance holds at s + 1 without inertia.
    pub massless: bool,
    /// Total mass.
    pub total_mass: f64,
}

impl<const D: usize> Part<D> {
    /// Global numbers of its nodes.
    pub fn nodes(&self) -> std::ops::Range<usize> {
        self.first_node..self.first_node + self.body.mesh().nodes.len()
    }
}

/// A contact and the rules of the case for it.
pub struct Contact<const D: usize> {
    /// Name in the case.
    pub name: String,
    /// Gaps at positions.
    pub method: Box<dyn ContactMethod<D>>,
    /// Body of the primary side; `None` for a rigid primary.
    pub primary_part: Option<usize>,
    /// Facets of the secondary side in global nodes: for consistent weights.
    pub secondary_facets: Vec<Vec<usize>>,
    /// Stiffness of a penalty for each secondary node; none where the constraint is kept by multipliers.
    pub penalty: Option<Vec<f64>>,
    /// Whether the predictor y + Δt v is kept out of the primary too.
    pub predictor: bool,
    /// Nodes of both sides, ascending.
    pub surface: Vec<usize>,
    /// Averaged with α_f or taken at the end.
    pub force: ForceTime,
    /// What happens to velocities where contact begins.
    pub persistency: Persistency,
    /// Whether the active set may change before Newton has converged.
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
pub struct Model<const D: usize> {
    /// Bodies, nodes numbered through in this order.
    pub parts: Vec<Part<D>>,
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
    pub loads: Loads<D>,
    /// Supports that move.
    pub motions: Motions<D>,
    /// Rigid motions that supports leave to bodies; only looked for where there is no inertia.
    pub unheld: Vec<Mode>,
    /// Contacts.
    pub contacts: Vec<Contact<D>>,
    /// Named supports.
    pub supports: Vec<Support>,
    /// Probes.
    pub probes: Vec<Probe>,
    /// Length L that tolerances refer to: the largest body's diameter.
    pub scale: f64,
}

impl<const D: usize> Model<D> {
    /// Number of dofs, held ones included.
    pub fn dofs(&self) -> usize {
        self.reference.len()
    }

    /// Internal forces ∂U/∂y at positions `y`, overwriting `force`; the strain energy U is returned.
    ///
    /// # Errors
    /// The body's name and the cell that is inverted.
    pub fn internal_force(&self, y: &[f64], force: &mut [f64]) -> Result<f64, (String, Inverted)> {
        self.add_cells(force, |part, cell, local| {
            part.body.cell_force(cell, &y.as_chunks::<D>().0[part.nodes()], local)
        })
    }

    /// Discrete gradient of the strain energy between positions, overwriting `force`; U(now) is returned.
    ///
    /// # Errors
    /// The body's name and the cell that is inverted.
    pub fn internal_between(&self, before: &[f64], now: &[f64], force: &mut [f64]) -> Result<f64, (String, Inverted)> {
        self.add_cells(force, |part, cell, local| {
            let [before, now] = [before, now].map(|y| &y.as_chunks::<D>().0[part.nodes()]);
            part.body.cell_between(cell, before, now, local, None)
        })
    }

    fn add_cells(
        &self,
        force: &mut [f64],
        of_cell: impl Fn(&Part<D>, usize, &mut [f64]) -> Result<f64, Inverted>,
    ) -> Result<f64, (String, Inverted)> {
        force.fill(0.0);
        let mut strain = 0.0;
        for part in &self.parts {
            let (body, first) = (&part.body, part.first_node);
            let n = body.mesh().element.nodes();
            let mut local = [0.0; MAX_CELL_DOFS];
            for cell in 0..body.mesh().cell_count() {
                strain += of_cell(part, cell, &mut local[..n * D]).map_err(|inverted| (part.name.clone(), inverted))?;
                for (k, &node) in body.mesh().cell(cell).iter().enumerate() {
                    for i in 0..D {
                        force[(first + node) * D + i] += local[k * D + i];
                    }
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
            let positions = &y.as_chunks::<D>().0[part.nodes()];
            for cell in 0..part.body.mesh().cell_count() {
                least = least.min(part.body.cell_min_det_f(cell, positions));
            }
        }
        least
    }
}

/// Dofs of the largest cell (T10 in the plane, Tet4 in space).
pub const MAX_CELL_DOFS: usize = 20;

/// Scalar product with one fixed order of summation.
pub fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(x, y)| x * y).sum()
}

/// Whether a quantity exists in dimension `d`.
pub(crate) fn exists_in(quantity: Quantity, d: usize) -> bool {
    d > 1 || matches!(quantity, Quantity::Ux | Quantity::Vx | Quantity::Ax | Quantity::SigmaXx | Quantity::DetF)
}
