//! The memory that a run needs, estimated from the numbers of a case before anything is allocated.
//!
//! Bytes for a body of n nodes and e cells with N nodes each, in dimension D, with c nodes coupled
//! to a node (itself included; mean over a large mesh: 3, 4, 5 for L2 L3 L4; 7, 12, 19 for T3 T6
//! T10; 9, 16 for Q4 Q9; 15, 29, 51 for Tet4 Tet10 Tet20; 27, 64 for Hex8 Hex27):
//!
//! ```text
//! model     n (58 D + 8 + m) + e (16 N + 4 N D + 8 D² + 64)       m = 12 c for a consistent mass, 12 for a lumped one
//!           + e' q (N D + 1) 8                                    e' cells with q quadrature points of their own (curved, or of constant strain)
//! lists     4 e N² + 24 n                                         nodes that share a cell, while a structure is made from them
//! steps     8 D n V                                               V vectors: states, iterates, and those of the solver
//! ```
//!
//! Additional bytes for the solver:
//!
//! ```text
//! explicit  n (c + 1)/2 (4 D² + 8), for the stable step; freed before the first step
//! iterative n ((c + 1)/2 (4 D² + 8) + 16 D²) + 2 e N²             blocks between nodes in single precision, and slots
//! direct    40 n c D²/2 + 2 e (N D)²                              pattern, mass, stiffness, structure of the factor; slots
//!           + 8 or 4 F, and 8 F for a consistent mass             factors in double precision, from 10 000 unknowns on in single, too
//! F         n D ·  c/2  |  c D log₂(n)/3  |  c D √n/6             fill on a line, in the plane and in space with minimum degree,
//!                                                                 at most 2 D n/ℓ in a column for a body of ℓ layers of nodes
//! impulses  16 D n k                                              solutions for each of k nodes in contact, a quarter of the sides
//! ```
//!
//! The record is read at the end: 40 bytes for each number of `history.csv`, of which 20 are text.
//! Not estimated: rows of `contact.csv`, which depend on the solution, the dense matrix of the
//! nodes in contact, and what a report page adds.
//!
//! The constants of fill and V are measured (`scripts/memory_table.py` compares estimates with
//! peaks).

use carom_record::available_memory;
use carom_solid::Element;

use crate::columns::history_columns;
use crate::{BodySpec, Case, MassKind, MeshSpec, Problem};

/// Bytes of the process before it allocates anything.
const PROGRAM: f64 = 18.0 * 1024.0 * 1024.0;
/// Bytes per number of `history.csv` when it is read.
const PER_NUMBER: f64 = 40.0;
/// Unknowns from which factors of tangents are in single precision.
const SINGLE: f64 = 1e4;

/// Memory of a run by purpose, in bytes.
#[derive(Clone, Copy, Debug, Default, PartialEq, serde::Serialize)]
pub struct Memory {
    /// The process before it allocates anything.
    pub program: f64,
    /// Bodies with their meshes and masses, and the largest structure made while they are built.
    pub model: f64,
    /// Vectors over nodes: states, iterates, buffers.
    pub steps: f64,
    /// Matrices and what preconditions iterations.
    pub matrices: f64,
    /// Factors of matrices.
    pub factors: f64,
    /// The tables of the record when they are read.
    pub record: f64,
}

impl Memory {
    /// Total memory in bytes.
    pub fn total(&self) -> f64 {
        let total = self.program + self.model + self.steps + self.matrices + self.factors + self.record;
        // ∞ − ∞ of a shape beyond all numbers.
        if total.is_nan() { f64::INFINITY } else { total }
    }
}

/// Solver of a case, as far as it determines the memory.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Solver {
    Explicit,
    Iterative,
    Direct { is_static: bool, has_impulses: bool },
}

impl Case {
    /// The memory that a run of this case needs.
    pub fn memory(&self) -> Memory {
        self.memory_with(self.solver())
    }

    /// Memory of a run of this case if the tangent is factorised, whatever solver the case has.
    pub fn memory_factored(&self) -> Memory {
        self.memory_with(Solver::Direct { is_static: false, has_impulses: false })
    }

    fn memory_with(&self, solver: Solver) -> Memory {
        let unknowns = self.nodes() * self.dimension as f64;
        let each = self.bodies.iter().map(|body| of_body(body, self, solver, unknowns));
        let record = PER_NUMBER * history_columns(self).len() as f64 * self.rows();
        each.fold(Memory { program: PROGRAM, record, ..Memory::default() }, |sum, one| Memory {
            model: sum.model + one.model,
            steps: sum.steps + one.steps,
            matrices: sum.matrices + one.matrices,
            factors: sum.factors + one.factors,
            ..sum
        })
    }

    /// Why the memory that is available does not suffice for a run, at the key that makes it large;
    /// none where the system does not report how much is available.
    ///
    /// # Errors
    /// This problem.
    pub fn fits_memory(&self) -> Result<(), Problem> {
        let need = self.memory();
        let available = available_memory().unwrap_or(f64::INFINITY);
        if need.total() <= available {
            return Ok(());
        }
        let why = format!(
            "the run needs about {}, and {} are available",
            gibibytes(need.total()),
            gibibytes(available)
        );
        if need.record > need.total() / 2.0 {
            let what = format!(
                "the record is too large for the memory: {:.3e} rows of {} columns",
                self.rows(),
                history_columns(self).len()
            );
            let key = if self.output.history_every > 1 { "output.history_every" } else { "time.step" };
            let steps = self.time.steps();
            let help = format!(
                "give output.history_every, the steps between two rows, a longer step or an earlier end: end / step is {steps}"
            );
            return Err(Problem::new(key, what, why, help).of_system());
        }
        let solver = self.solver();
        let unknowns = self.nodes() * self.dimension as f64;
        let bytes = |body: &BodySpec| of_body(body, self, solver, unknowns).total();
        let largest = self.bodies.iter().enumerate().max_by(|(_, a), (_, b)| bytes(a).total_cmp(&bytes(b)));
        let Some((i, body)) = largest else { return Ok(()) };
        let (cells, nodes) = body.mesh.estimate(body.element);
        let what = format!(
            "the mesh of `{}` is too large for the memory: {nodes:.3e} nodes in {cells:.3e} cells",
            body.name
        );
        let path = if self.refine > 1.0 {
            "refine".to_owned()
        } else {
            format!("body[{i}].mesh.{}", size_key(&body.mesh))
        };
        let lower = if body.element.degree() > 1 { " or an element of lower degree" } else { "" };
        let mut help = format!("use a coarser mesh{lower}, or give the process more memory");
        if need.factors > need.total() / 2.0 && self.can_iterate() {
            let other = Self {
                newton: crate::NewtonSpec { linear: crate::LinearRule::Iterative, ..self.newton.clone() },
                ..self.clone()
            };
            let iterative = gibibytes(other.memory().total());
            help = format!("{help}; newton.linear = \"iterative\" needs about {iterative}");
        }
        Err(Problem::new(path, what, why, help).of_system())
    }

    fn nodes(&self) -> f64 {
        self.bodies.iter().map(|body| body.mesh.estimate(body.element).1).sum()
    }

    /// Number of rows of `history.csv`.
    fn rows(&self) -> f64 {
        1.0 + (self.time.steps() as f64 / self.output.history_every as f64).ceil()
    }

    /// Whether conjugate gradients can solve the linear systems of the case.
    fn can_iterate(&self) -> bool {
        let has_friction = self.contacts.iter().any(|contact| contact.friction.exists());
        self.time.scheme.nonsmooth().is_none() && !has_friction
    }

    fn solver(&self) -> Solver {
        let time = &self.time;
        if time.scheme.is_explicit() {
            return Solver::Explicit;
        }
        let unknowns = self.nodes() * self.dimension as f64;
        if self.newton.linear.iterates(self.dimension, unknowns, time, self.contacts.iter()) {
            return Solver::Iterative;
        }
        let has_impulses = time.scheme.nonsmooth().is_some() && !self.contacts.is_empty();
        Solver::Direct { is_static: time.scheme.is_static(), has_impulses }
    }
}

/// Memory of one body; `unknowns`: number of unknowns of the whole case.
fn of_body(body: &BodySpec, case: &Case, solver: Solver, unknowns: f64) -> Memory {
    let element = body.element;
    let (cells, nodes) = body.mesh.estimate(element);
    let per_cell = element.nodes() as f64;
    let d = case.dimension as f64;
    let c = coupled(element);
    let is_lumped = body.mass == MassKind::Lumped;

    let mass = if is_lumped { 12.0 } else { 12.0 * c };
    let curved = curved_cells(&body.mesh, element, cells) * points(element) * (per_cell * d + 1.0) * 8.0;
    let bodies = nodes * (58.0 * d + 8.0 + mass)
        + cells * (16.0 * per_cell + 4.0 * per_cell * d + 8.0 * d * d + 64.0)
        + curved;
    let lists = 4.0 * cells * per_cell * per_cell + 24.0 * nodes;
    let blocks = nodes * 0.5 * (c + 1.0) * (4.0 * d * d + 8.0);
    let vectors = |count: f64| 8.0 * d * nodes * count;
    let built = bodies + lists;
    match solver {
        Solver::Explicit => {
            // The matrix of the stable step is freed before the vectors of the steps are allocated.
            Memory { model: built, steps: vectors(EXPLICIT).max(blocks), ..Memory::default() }
        }
        Solver::Iterative => Memory {
            model: built,
            steps: vectors(IMPLICIT + 2.0 * case.newton.mixing.min(MOST_MIXED) as f64),
            matrices: blocks + 16.0 * d * d * nodes + 2.0 * cells * per_cell * per_cell,
            ..Memory::default()
        },
        Solver::Direct { is_static, has_impulses } => {
            let of_node = per_cell * d;
            let n = nodes * d;
            let fill = n * fill(body, case.dimension, nodes);
            let tangent = if unknowns >= SINGLE && !is_static { 4.0 } else { 8.0 };
            let of_mass = if is_lumped || is_static { 0.0 } else { 8.0 };
            let sides = if case.dimension == 3 { 2.0 * nodes.powf(2.0 / 3.0) } else { 2.0 * nodes.sqrt() };
            let columns = if has_impulses { 2.0 * sides / 4.0 } else { 0.0 };
            Memory {
                model: built,
                steps: vectors(IMPLICIT + 2.0 * case.newton.mixing.min(MOST_MIXED) as f64 + columns),
                matrices: 20.0 * n * c * d + 2.0 * cells * of_node * of_node,
                factors: fill * (tangent + of_mass),
                ..Memory::default()
            }
        }
    }
}

/// Vectors over the nodes of an explicit scheme, and of an implicit one with its linear problem;
/// measured.
const EXPLICIT: f64 = 48.0;
const IMPLICIT: f64 = 60.0;
/// Corrections that are kept, at most: those of a linear problem.
const MOST_MIXED: usize = 30;

/// Mean number of entries in a column of the factor.
fn fill(body: &BodySpec, dimension: usize, nodes: f64) -> f64 {
    let c = coupled(body.element);
    let d = dimension as f64;
    let free = match dimension {
        1 => return 0.5 * c,
        2 => c * d * nodes.max(2.0).log2() / 3.0,
        _ => c * d * nodes.sqrt() / 6.0,
    };
    let of_layers = body.mesh.layers(body.element).map_or(f64::INFINITY, |layers| 2.0 * d * nodes / layers);
    free.min(of_layers)
}

/// Mean number of nodes that share a cell with a node, itself included.
fn coupled(element: Element) -> f64 {
    match element {
        Element::L2 => 3.0,
        Element::L3 => 4.0,
        Element::L4 => 5.0,
        Element::T3 => 7.0,
        Element::T6 => 12.0,
        Element::T10 => 19.0,
        Element::Q4 => 9.0,
        Element::Q9 => 16.0,
        Element::Hex8 => 27.0,
        Element::Hex27 => 64.0,
        Element::Tet4 => 15.0,
        Element::Tet10 => 29.0,
        Element::Tet20 => 51.0,
    }
}

/// Number of quadrature points for the forces of a curved cell.
fn points(element: Element) -> f64 {
    match element {
        Element::T3 | Element::Tet4 => 1.0,
        Element::L2 | Element::L3 | Element::L4 | Element::Q4 => 4.0,
        Element::T6 | Element::Hex8 => 8.0,
        Element::Q9 => 12.0,
        Element::T10 | Element::Tet10 => 16.0,
        Element::Hex27 => 28.0,
        Element::Tet20 => 48.0,
    }
}

/// Cells that store quadrature points of their own: those of constant strain, those of
/// quadrilaterals and hexahedra that are no parallelograms, and those of higher degree at a circle
/// in the plane. In space the interior edges of a round body are curved, too.
fn curved_cells(mesh: &MeshSpec, element: Element, cells: f64) -> f64 {
    let is_straight = match mesh {
        MeshSpec::Interval { .. } | MeshSpec::Rectangle { .. } | MeshSpec::Box { .. } => true,
        MeshSpec::Extrusion { of, .. } => matches!(**of, MeshSpec::Rectangle { .. }),
        _ => false,
    };
    match element {
        Element::T3 | Element::Tet4 => cells,
        _ if is_straight => 0.0,
        Element::Q4 | Element::Q9 | Element::Hex8 | Element::Hex27 => cells,
        _ if element.dimension() == 2 => 4.0 * cells.sqrt(),
        _ => cells,
    }
}

/// Name of the key that determines the size of a mesh.
fn size_key(mesh: &MeshSpec) -> &'static str {
    match mesh {
        MeshSpec::File(_) => "file",
        MeshSpec::Interval { .. } | MeshSpec::Rectangle { .. } | MeshSpec::Box { .. } => "cells",
        MeshSpec::Extrusion { .. } => "layers",
        _ => "size",
    }
}

/// A number of bytes as text in MiB or GiB, for messages.
pub fn gibibytes(bytes: f64) -> String {
    let gib = bytes / (1024.0 * 1024.0 * 1024.0);
    match gib {
        _ if gib < 0.1 => format!("{:.0} MiB", 1024.0 * gib),
        _ if gib < 1e6 => format!("{gib:.1} GiB"),
        _ => format!("{gib:.1e} GiB"),
    }
}
