//! All that the next step depends on. A clone is a checkpoint.

use carom_contact::{Pair, Pairing};
use serde::{Deserialize, Serialize};

use crate::renewal::FrozenTangent;

/// Energies and works, design.md §5: cumulative from the start of the run.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Ledger {
    /// ½ vᵀM v.
    pub kinetic: f64,
    /// U, of the bodies and of the springs of penalties.
    pub strain: f64,
    /// The springs' part of it.
    pub springs: f64,
    /// Potential of constant conservative loads.
    pub potential: f64,
    /// Total energy at the start.
    pub total_at_start: f64,
    /// Work of loads that are not in the potential, of supports and of moving primaries.
    pub external_work: f64,
    /// Σ Δy·ΔF of the loads: their work as they are at the ends of steps less that as they are at
    /// the starts, the scale of what no scheme knows better. Where a load has only begun it is as
    /// large as the work itself.
    pub open: f64,
    /// Work of the contact forces on the bodies, and the jump of kinetic energy where contact
    /// begins.
    pub contact_work: f64,
    /// Largest kinetic + strain energy so far.
    pub largest: f64,
    /// Time integral of the contact force on the secondary sides, projections included.
    pub impulse: [f64; 3],
}

impl Ledger {
    /// Kinetic, strain and potential energy together.
    pub fn total(&self) -> f64 {
        self.kinetic + self.strain + self.potential
    }

    /// Energy that the scheme has taken out; negative where it was created.
    pub fn dissipation(&self) -> f64 {
        self.external_work + self.contact_work - (self.total() - self.total_at_start)
    }

    /// Energy that came from nowhere: what the guard watches.
    pub fn created(&self) -> f64 {
        self.total() - self.total_at_start - self.external_work
    }
}

/// What a two-step scheme takes from the step before.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Previous {
    /// Size of that step: one of another size does not go on from it.
    pub dt: f64,
    /// Increment of positions over it.
    pub increment: Vec<f64>,
    /// Velocities at its start.
    pub velocity: Vec<f64>,
    /// Means over it.
    pub means: Means,
}

/// Means over a step, as its own velocity update weighs start and stages; flat over all dofs.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Means {
    /// Contact forces.
    pub contact: Vec<f64>,
    /// Loads, gravity apart.
    pub loads: Vec<f64>,
    /// Forces of moved supports; zero at other dofs.
    pub supports: Vec<f64>,
    /// Accelerations of moved supports; zero at other dofs.
    pub accelerations: Vec<f64>,
    /// Impulse of the contact forces on the secondary sides.
    pub impulse: [f64; 3],
}

impl Means {
    /// Nothing yet.
    pub fn new(dofs: usize) -> Self {
        let mut means = Self::default();
        means.clear(dofs);
        means
    }

    /// Back to nothing.
    pub(crate) fn clear(&mut self, dofs: usize) {
        for mean in [&mut self.contact, &mut self.loads, &mut self.supports, &mut self.accelerations] {
            mean.clear();
            mean.resize(dofs, 0.0);
        }
        self.impulse = [0.0; 3];
    }
}

/// What an explicit scheme knows beyond the state's time: the step it has looked ahead with.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct HalfStepVelocity {
    /// v_{n+½}, of which y_{n+1} = y_n + Δt v_{n+½} is admissible.
    pub velocity: Vec<f64>,
    /// Its Δt; 0 where nothing is known yet. Another step begins anew from v_n.
    pub dt: f64,
}

/// The state at the end of a step.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct State {
    /// Step on the grid of times.
    pub step: u64,
    /// Time; step·Δt on the grid.
    pub time: f64,
    /// Positions, flat.
    pub y: Vec<f64>,
    /// Velocities.
    pub v: Vec<f64>,
    /// Algorithmic accelerations: carried, never derived anew from the balance.
    pub a: Vec<f64>,
    /// Internal forces at `y`.
    pub f_internal: Vec<f64>,
    /// Loads at `y`, gravity apart: their known share of the next step.
    pub f_external: Vec<f64>,
    /// Σ Gᵀλ of the contacts whose force is averaged: the known share of the next step.
    pub f_contact: Vec<f64>,
    /// Force on the secondary side of each contact.
    pub contact_forces: Vec<[f64; 3]>,
    /// Pairs of each contact.
    pub pairs: Vec<Vec<Pair>>,
    /// Energies and works.
    pub ledger: Ledger,
    /// The step before, for a two-step scheme; none at the start and where contact has just begun.
    pub previous: Option<Previous>,
    /// Of an explicit scheme.
    pub half_step: HalfStepVelocity,
    /// What the kept factor was made of.
    pub frozen: FrozenTangent,
    /// How grid steps went of late.
    pub bisection: Bisection,
}

impl State {
    /// Becomes a copy of another state in the memory it has.
    pub(crate) fn copy_from(&mut self, other: &Self) {
        let Self { step, time, y, v, a, f_internal, f_external, f_contact, contact_forces, pairs, .. } = self;
        (*step, *time) = (other.step, other.time);
        let from = [&other.y, &other.v, &other.a, &other.f_internal, &other.f_external, &other.f_contact];
        for (to, from) in [y, v, a, f_internal, f_external, f_contact].into_iter().zip(from) {
            to.clone_from(from);
        }
        contact_forces.clone_from(&other.contact_forces);
        pairs.clone_from(&other.pairs);
        self.ledger = other.ledger.clone();
        self.previous.clone_from(&other.previous);
        self.half_step.velocity.clone_from(&other.half_step.velocity);
        self.half_step.dt = other.half_step.dt;
        self.frozen = other.frozen.clone();
        self.bisection = other.bisection;
    }

    /// Takes the pairs that a solve ended with.
    pub(crate) fn take_pairs(&mut self, pairings: &[Pairing]) {
        self.pairs.iter_mut().zip(pairings).for_each(|(pairs, pairing)| pairs.clone_from(&pairing.pairs));
    }
}

/// Grid steps that had to be bisected: after several in a row the next ones begin with half the
/// step, 1, 3, 7, … of them.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Bisection {
    /// Grid steps left that begin with half the step.
    left: u32,
    /// How many after the next one that is bisected.
    next: u32,
}

impl Bisection {
    /// Most grid steps that begin with half the step before the whole one is tried again.
    const MOST: u32 = 63;

    /// How often the next grid step is halved from the start.
    pub(crate) fn level(self) -> u32 {
        u32::from(self.left > 0)
    }

    /// After a grid step; `bisected`: whether it was rejected in full.
    #[must_use]
    pub(crate) fn after(self, bisected: bool) -> Self {
        match (self.left, bisected) {
            (0, false) => Self::default(),
            (0, true) => Self { left: self.next, next: (2 * self.next + 1).min(Self::MOST) },
            (left, _) => Self { left: left - 1, next: self.next },
        }
    }
}
