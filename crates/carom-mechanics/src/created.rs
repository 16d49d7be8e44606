//! Energy that no force has supplied: the rise of E = total − external work above its running
//! minimum, so that what was lost before does not hide it. It is judged against the largest energy
//! that was there or was supplied, max (kinetic + strain, Σ |ΔW_ext|).
//!
//! The work of a load or a support that changes over a step belongs to the path, to second order
//! Δy·(F_s + F_{s+1})/2. That of a scheme's mean is τ Δy·ΔF more, where the mean belongs to the
//! instant (½ + τ) Δt of the step: τ = ½ − α_f in the α family, which carries the missing momentum
//! in its accelerations. A rise by −Σ τ Δy·ΔF is no creation: a wall of constant velocity V that
//! presses with R lends τ Δt V R until it is left. Schemes with τ = 0 have no such work.

use crate::state::Ledger;

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

    /// Takes the energies at the end of a step into the running minimum and maximum.
    pub(crate) fn observe(&mut self) {
        let energy = self.total() - self.external_work;
        self.created.worked += (self.external_work - self.created.work).abs();
        self.created.work = self.external_work;
        if energy < self.created.lowest {
            (self.created.lowest, self.created.unbooked) = (energy, self.unbooked);
        }
        self.created.most = self.created.most.max(self.created());
    }
}
