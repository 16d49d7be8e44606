//! Energy that no force has supplied: the rise of E = total − external work above its running
//! minimum, so that what was lost before does not hide it. It is judged against the largest energy
//! that was there or was supplied, max (kinetic + strain, Σ |ΔW_ext|).
//!
//! The α family carries the momentum c Δt M a in its accelerations, c = 1 − γ − α_m (`carried.rs`),
//! which the kinetic energy of its velocities does not contain. A load or a support that changes by
//! ΔF over a step does the work c Δy·ΔF on it. A rise by −Σ c Δy·ΔF is no creation: a wall of
//! constant velocity V that presses with R lends −c Δt V R until it is left. For α_m = α_f = 0 and
//! a linear body, with the scheme's own energy H (Krenk 2006),
//!
//! ```text
//! Δ[E + ½ (β − γ/2) Δt² a·Ma] = −c Δy·ΔF − (γ − ½) [Δy·KΔy + (β − γ/2) Δt² Δa·MΔa]
//! ```
//!
//! Schemes with c = 0 have no such work.

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
