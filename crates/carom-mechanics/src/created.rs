//! Energy that no force has supplied: the rise of E = total − external work above its running
//! minimum, so that what was lost before does not hide it. It is judged against the largest energy
//! that was there or was supplied, max (kinetic + strain, Σ |ΔW_ext|).

use crate::state::Ledger;

/// Round-off relative to the energies.
const ROUND_OFF: f64 = 1e-12;

impl Ledger {
    /// Rise of total − external work above its running minimum.
    pub fn rise(&self) -> f64 {
        self.total() - self.external_work - self.created.lowest
    }

    /// The rise beyond what may be the work of loads, or round-off of the energies.
    pub(crate) fn created(&self) -> f64 {
        let energies = self.kinetic + self.strain.abs() + self.potential.abs() + self.total_at_start.abs();
        self.rise() - self.unknown_work() - ROUND_OFF * energies
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
