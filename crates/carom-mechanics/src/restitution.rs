//! Restitution of the conserving constraint: velocity updates that return energy, after T. A.
//! Laursen and G. R. Love (2002). Contact owes e² of the energy D that it has taken,
//!
//! ```text
//! owed = Σ e² D − Σ returned,      D = −Δ contact_work of a step, and what its projection takes
//! v⁺ = v + μ w,   M w + Gᵀq = 0,   G w = s,      ½ a μ² + b μ = owed,   a = −s·q,   b = v·M w = −q·G v
//! ```
//!
//! and returns it where pairs close or open. s are their approach speeds, after the projection,
//! with which b = 0, or their separation speeds; zero for pairs that remain closed. Owed energy makes
//! nodes separate faster. Energy that contact has created, owed < 0, makes them separate slower, at
//! most until b + a μ = 0; the rest is carried. Gradients are those at y_{n+1}, so momentum and
//! moment of momentum do not change.

use carom_contact::Row;

use crate::active_rows::{measure, pressing};
use crate::constraints::{Constraints, independent_rows};
use crate::ledger::book_kinetic;
use crate::model::Model;
use crate::rejected::Rejected;
use crate::state::State;
use crate::system::System;

/// The step in which pairs closed.
pub(crate) struct Impact<'a> {
    /// Its size.
    pub dt: f64,
    /// Velocities at its start.
    pub velocity: &'a [f64],
    /// The gaps at its start of pairs that closed in it: (contact, pair), gap.
    pub closed: Vec<((usize, usize), f64)>,
}

impl Impact<'_> {
    /// Returns energy to projected velocities. `rows`: the constraints of the projection, with
    /// which `system` has factored the mass.
    pub(crate) fn restitute(
        &self,
        model: &Model,
        state: &mut State,
        rows: &Constraints,
        system: &mut System,
    ) -> Result<(), Rejected> {
        let places = rows.places.iter().zip(rows.rows.iter());
        let speeds: Vec<f64> = places.map(|(place, row)| self.approach(*place, row)).collect();
        settle(model, state, rows, &speeds, system)
    }

    /// Approach speed of a pair: at the step's start, or the mean over the step if that is larger,
    /// for a pair that was accelerated towards the contact.
    fn approach(&self, place: (usize, usize), row: Row) -> f64 {
        let gap = self.closed.iter().find(|(closed, _)| *closed == place);
        gap.map_or(0.0, |(_, gap)| (-row.along(self.velocity)).max(gap / self.dt).max(0.0))
    }
}

/// Adds e² of the energy that contact took to what it owes.
pub(crate) fn take(model: &Model, state: &mut State, energy: f64) {
    let conserving = model.contacts.iter().filter(|contact| contact.conserves());
    // The same for all contacts that have one.
    let restitution = conserving.map(|contact| contact.restitution).fold(0.0, f64::max);
    state.ledger.owed += restitution * restitution * energy;
}

/// Returns energy where contact ends: `released` are the contacts and secondary nodes of pairs that
/// opened in the step. The jump of kinetic energy is recorded as contact work and returned.
pub(crate) fn separate(
    model: &Model,
    state: &mut State,
    released: &[(usize, usize)],
    system: &mut System,
) -> Result<f64, Rejected> {
    if state.ledger.owed == 0.0 {
        return Ok(0.0);
    }
    let opened = |&(k, node): &(usize, usize)| {
        let secondary = model.contacts[k].kinematics.secondary();
        let p = state.pairs[k].iter().position(|pair| secondary[pair.node] == node)?;
        model.contacts[k].conserves().then_some((k, p))
    };
    let opened: Vec<(usize, usize)> = released.iter().filter_map(opened).collect();
    let gaps = measure(model, state, |k, p, pair| pair.active || opened.contains(&(k, p)))?;
    let mut places: Vec<(usize, usize)> = pressing(state).chain(opened.iter().copied()).collect();
    places.sort_unstable();
    let places = independent_rows(model, places.into_iter(), &gaps);
    let rows = Constraints::plain(model.dimension, places.iter().map(|&(k, p)| ((k, p), gaps[k].row(p))));
    let separation = |(place, row): (&(usize, usize), Row)| {
        if opened.contains(place) { row.along(&state.v).max(0.0) } else { 0.0 }
    };
    let speeds: Vec<f64> = rows.places.iter().zip(rows.rows.iter()).map(separation).collect();
    if speeds.iter().all(|s| *s == 0.0) {
        return Ok(0.0);
    }
    system.factor_mass(model, &rows)?;
    let before = state.ledger.kinetic;
    settle(model, state, &rows, &speeds, system)?;
    book_kinetic(model, state);
    let jump = state.ledger.kinetic - before;
    state.ledger.contact_work += jump;
    Ok(jump)
}

/// Changes velocities along the response of the mass, factored with these rows, to `speeds`.
fn settle(
    model: &Model,
    state: &mut State,
    rows: &Constraints,
    speeds: &[f64],
    system: &mut System,
) -> Result<(), Rejected> {
    if state.ledger.owed == 0.0 {
        return Ok(());
    }
    let dofs = model.dofs();
    let (mut response, mut impulses) = (vec![0.0; dofs], Vec::new());
    system.factor.solve(model, &vec![0.0; dofs], speeds, &mut response, &mut impulses)?;
    let size: f64 = -speeds.iter().zip(&impulses).map(|(s, q)| s * q).sum::<f64>();
    let slope: f64 = -rows.rows.iter().zip(&impulses).map(|(row, q)| q * row.along(&state.v)).sum::<f64>();
    if size <= 0.0 {
        return Ok(());
    }
    let factor = root(size, slope, state.ledger.owed);
    for i in (0..dofs).filter(|&i| !model.massless[i]) {
        state.v[i] += factor * response[i];
    }
    for (&(k, _), (row, impulse)) in rows.places.iter().zip(rows.rows.iter().zip(&impulses)) {
        let normal = row.normal();
        (0..3).for_each(|i| state.impulses[k][i] -= factor * impulse * normal[i]);
    }
    state.ledger.owed -= factor * (0.5 * size * factor + slope);
    Ok(())
}

/// μ of ½ a μ² + b μ = owed, a > 0: the larger root, with which nodes separate; the vertex if there
/// is none; 0 if nothing can be taken from nodes that do not separate.
fn root(a: f64, b: f64, owed: f64) -> f64 {
    let discriminant = (b * b + 2.0 * a * owed).max(0.0).sqrt();
    match (owed > 0.0, b > 0.0) {
        (true, true) => 2.0 * owed / (b + discriminant),
        (true, false) => (discriminant - b) / a,
        (false, true) => (2.0 * owed / (b + discriminant)).max(-b / a),
        (false, false) => 0.0,
    }
}

#[cfg(test)]
mod tests {
    use super::root;

    #[test]
    fn the_root_returns_the_energy_or_what_nodes_can_lose() {
        for (a, b, owed) in [(2.0, 3.0, 1.0), (2.0, 0.0, 1.0), (2.0, -3.0, 1.0), (2.0, 3.0, -1.0)] {
            let factor: f64 = root(a, b, owed);
            assert!((0.5 * a * factor * factor + b * factor - owed).abs() < 1e-15, "{a} {b} {owed}");
            assert_eq!(factor > 0.0, owed > 0.0);
        }
        assert_eq!(root(2.0, 3.0, -3.0), -1.5);
        assert_eq!(root(2.0, -3.0, -1.0), 0.0);
    }
}
