//! All that the next step depends on. A clone is a checkpoint.

use carom_contact::Pair;
use serde::{Deserialize, Serialize};

use crate::kept::Kept;

/// Energies and works, design.md §5: cumulative from the start of the run.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Ledger {
    /// ½ vᵀM v.
    pub kinetic: f64,
    /// U.
    pub strain: f64,
    /// Potential of constant conservative loads.
    pub potential: f64,
    /// Total energy at the start.
    pub total_at_start: f64,
    /// Work of loads that are not in the potential, of supports and of moving primaries.
    pub external_work: f64,
    /// Work of the contact forces on the bodies, and the jump of kinetic energy where contact begins.
    pub contact_work: f64,
    /// Largest kinetic + strain energy so far.
    pub largest: f64,
    /// Time integral of the contact force on the secondary sides, projections included.
    pub impulse: [f64; 2],
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
    pub contact_forces: Vec<[f64; 2]>,
    /// Pairs of each contact.
    pub pairs: Vec<Vec<Pair>>,
    /// Energies and works.
    pub ledger: Ledger,
    /// What the kept factor was made of.
    pub kept: Kept,
}
