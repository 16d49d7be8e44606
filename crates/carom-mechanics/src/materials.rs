//! What the materials of bodies remember, the energy that they store and dissipate, and the
//! smallest J.
//!
//! The memory of the state before a step stays as it is while trials of the step compute theirs, so
//! that a rejected step leaves nothing behind. What each body dissipates is the sum of what its law
//! dissipates at every quadrature point (`ledger.rs`); the `dissipation` of the ledger remains that
//! of the integrator.

use std::sync::Arc;

use carom_solid::Past;
use serde::{Deserialize, Serialize};

/// Memory of the materials of all bodies; empty if none has any.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Materials {
    /// Memory of all cells, body after body; copied where it is changed.
    pub(crate) memory: Arc<Vec<f64>>,
    /// Energy that each body stores.
    pub(crate) stored: Vec<f64>,
    /// Energy that each body with memory has dissipated so far.
    pub(crate) dissipated: Vec<f64>,
    /// Energy that each body dissipates in the step that led to this memory, until it is booked.
    #[serde(skip)]
    pub(crate) lost: Vec<f64>,
    /// Smallest J over the quadrature points of all bodies, if the pass that computed their forces
    /// knows it.
    pub(crate) min_det_f: Option<f64>,
}

impl Materials {
    /// Materials of so many bodies that remember nothing yet, with so many numbers.
    pub(crate) fn new(bodies: usize, numbers: usize) -> Self {
        let mut new = Self::default();
        if numbers > 0 {
            new.dissipated = vec![0.0; bodies];
            new.resize(bodies, numbers);
        }
        new
    }

    /// Makes room for the memory of so many bodies, which is to be overwritten: that of other
    /// states is neither changed nor copied.
    pub(crate) fn resize(&mut self, bodies: usize, numbers: usize) {
        if Arc::get_mut(&mut self.memory).is_none_or(|memory| memory.len() != numbers) {
            self.memory = Arc::new(vec![0.0; numbers]);
        }
        self.stored.resize(bodies, 0.0);
        self.lost.resize(bodies, 0.0);
    }

    /// Energy that each body has dissipated so far; zero of bodies without memory, empty if none
    /// has any.
    pub fn dissipated(&self) -> &[f64] {
        &self.dissipated
    }

    /// Memory of the materials at the start of a step of length `dt`.
    pub fn past(&self, dt: f64) -> Past<'_> {
        Past::new(&self.memory, dt)
    }

    /// Becomes a copy of others in all but the memory, which a step overwrites.
    pub(crate) fn follow(&mut self, others: &Self) {
        self.stored.clone_from(&others.stored);
        self.dissipated.clone_from(&others.dissipated);
        self.lost.clone_from(&others.lost);
        self.min_det_f = others.min_det_f;
    }

    /// Takes over what a trial stores, remembers and dissipates.
    pub(crate) fn accept(&mut self, trial: &Self) {
        self.memory.clone_from(&trial.memory);
        self.stored.clone_from(&trial.stored);
        self.lost.clone_from(&trial.lost);
        self.min_det_f = trial.min_det_f;
    }
}
