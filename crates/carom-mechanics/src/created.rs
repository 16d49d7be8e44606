//! Energy that no force has supplied: the rise of E = total − external work above its running
//! minimum, so that what was lost before does not hide it. It is judged against the largest energy
//! that was there or was supplied, max (kinetic + strain, Σ |ΔW_ext|).
//!
//! In the α family, velocities take another share of a force that changes than the mean of both
//! ends of the step with which it works (`works.rs`). A rise by what it does on them is no
//! creation: a wall of constant velocity that strikes lends it until the accelerations are those of
//! its force.

use crate::state::{Created, Ledger};

/// Round-off relative to the energies.
const ROUND_OFF: f64 = 1e-12;

impl Ledger {
    /// Rise of total − external work above its running minimum, beyond what was not booked of that
    /// work since.
    pub fn created(&self) -> f64 {
        let energy = self.total() - self.external_work;
        energy - self.created.lowest - (self.unbooked - self.created.unbooked).max(0.0)
    }

    /// The same beyond round-off of the energies.
    pub(crate) fn surely_created(&self) -> f64 {
        let energies = self.kinetic + self.strain.abs() + self.potential.abs() + self.total_at_start.abs();
        self.created() - ROUND_OFF * energies
    }

    /// Energy that a rise is judged against.
    pub fn scale(&self) -> f64 {
        self.largest.max(self.created.worked)
    }

    /// Begins at the energies of a start.
    pub(crate) fn begin(&mut self) {
        self.total_at_start = self.total();
        self.created = Created { lowest: self.total(), ..Created::default() };
        self.largest = self.kinetic + self.strain;
    }

    /// Takes the energies at the end of a step into the running minimum and maxima. Not those
    /// within it: velocities that ring before they are projected may have many times the energy of
    /// the bodies, which would hide what is created.
    pub(crate) fn observe(&mut self) {
        self.largest = self.largest.max(self.kinetic + self.strain);
        let energy = self.total() - self.external_work;
        self.created.worked += (self.external_work - self.created.work).abs();
        self.created.work = self.external_work;
        if energy < self.created.lowest {
            (self.created.lowest, self.created.unbooked) = (energy, self.unbooked);
        }
        self.created.most = self.created.most.max(self.created());
    }
}
