//! Restitution where contact begins, for the conserving constraint: a velocity update that returns
//! energy, after T. A. Laursen and G. R. Love (2002). It follows the projection, with which G v = 0.
//!
//! ```text
//! v⁺ = v + e μ w,        M w + Gᵀq = 0,   G w = s,        ½ μ² w·M w = D
//! ```
//!
//! s: approach speeds of the pairs that were closed in the step, zero for those that were closed
//! before; D: the energy that contact took in the step and its projection. Since v·M w = −q·G v = 0,
//! the kinetic energy grows by e² D: with e = 1 the energy of the step's start is restored to
//! round-off, and one particle separates with e times its approach speed. Gradients are those at
//! y_{n+1}, so momentum and moment of momentum do not change.

use carom_contact::Row;

use crate::constraints::Constraints;
use crate::model::Model;
use crate::rejected::Rejected;
use crate::state::State;
use crate::system::System;

/// The step after which velocities are updated.
pub(crate) struct Impact<'a> {
    /// Its size.
    pub dt: f64,
    /// Velocities at its start.
    pub velocity: &'a [f64],
    /// Work of contact up to its start.
    pub contact_work: f64,
    /// The gaps at its start of pairs that were closed in it: (contact, pair), gap.
    pub closed: Vec<((usize, usize), f64)>,
}

impl Impact<'_> {
    /// Updates projected velocities. `rows`: the constraints of the projection, with which `system`
    /// has factored the mass; `lost`: kinetic energy that the projection took.
    pub(crate) fn restitute(
        &self,
        model: &Model,
        state: &mut State,
        rows: &Constraints,
        lost: f64,
        system: &mut System,
    ) -> Result<(), Rejected> {
        // The same for all contacts that have one.
        let of = |&(k, _): &(usize, usize)| model.contacts[k].restitution;
        let restitution = rows.places.iter().map(of).fold(0.0, f64::max);
        let taken = self.contact_work - state.ledger.contact_work + lost;
        if restitution == 0.0 || taken <= 0.0 {
            return Ok(());
        }
        let speeds: Vec<f64> =
            rows.places.iter().zip(rows.rows.iter()).map(|(place, row)| self.approach(*place, row)).collect();
        let dofs = model.dofs();
        let (mut response, mut impulses) = (vec![0.0; dofs], Vec::new());
        system.factor.solve(model, &vec![0.0; dofs], &speeds, &mut response, &mut impulses)?;
        // w·M w.
        let size: f64 = -speeds.iter().zip(&impulses).map(|(s, q)| s * q).sum::<f64>();
        if size <= 0.0 {
            return Ok(());
        }
        let factor = restitution * (2.0 * taken / size).sqrt();
        for i in (0..dofs).filter(|&i| !model.massless[i]) {
            state.v[i] += factor * response[i];
        }
        for (&(k, _), (row, impulse)) in rows.places.iter().zip(rows.rows.iter().zip(&impulses)) {
            let normal = row.normal();
            (0..3).for_each(|i| state.impulses[k][i] -= factor * impulse * normal[i]);
        }
        Ok(())
    }

    /// Approach speed of a pair: at the step's start, or the mean over the step if that is larger,
    /// for a pair that was accelerated towards the contact.
    fn approach(&self, place: (usize, usize), row: Row) -> f64 {
        let gap = self.closed.iter().find(|(closed, _)| *closed == place);
        gap.map_or(0.0, |(_, gap)| (-row.along(self.velocity)).max(gap / self.dt).max(0.0))
    }
}
