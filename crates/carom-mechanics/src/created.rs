//! Energy that no force has supplied: the rise of E = total − external work above its running
//! minimum, so that what was lost before does not hide it. It is judged against the largest energy
//! that was there or was supplied, max (kinetic + strain, Σ |ΔW_ext|).

use serde::{Deserialize, Serialize};

use crate::state::Ledger;

/// The running minimum of E, and what rose above it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Created {
    lowest: f64,
    /// [`Ledger::open`] at that minimum.
    open: f64,
    /// Largest rise so far.
    most: f64,
    /// Σ |ΔW_ext| so far, and W_ext at its last term.
    worked: f64,
    work: f64,
}

impl Created {
    /// Of the energies at the start.
    pub(crate) fn at_start(ledger: &Ledger) -> Self {
        Self { lowest: ledger.total(), ..Self::default() }
    }

    /// Largest rise so far.
    pub fn most(&self) -> f64 {
        self.most
    }
}

impl Ledger {
    /// Rise of total − external work above its running minimum.
    pub fn rise(&self) -> f64 {
        self.total() - self.external_work - self.created.lowest
    }

    /// Energy that a rise is judged against.
    pub fn scale(&self) -> f64 {
        self.largest.max(self.created.worked)
    }

    /// How much of a rise may be the work of loads and supports over a step, which a scheme knows
    /// only to the order of the change of their forces.
    pub(crate) fn unknown_work(&self) -> f64 {
        (self.open - self.created.open).abs()
    }

    /// Takes the energies at the end of a step into the running minimum and maximum.
    pub(crate) fn observe(&mut self) {
        let energy = self.total() - self.external_work;
        let created = &mut self.created;
        created.worked += (self.external_work - created.work).abs();
        created.work = self.external_work;
        if energy < created.lowest {
            (created.lowest, created.open) = (energy, self.open);
        }
        created.most = created.most.max(energy - created.lowest);
    }
}
