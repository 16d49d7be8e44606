//! The impulses of the contacts of a step: a complementarity problem of impulses and velocities,
//!
//! ```text
//! 0 ≤ G v + e G v_n ⊥ P ≥ 0,   G v = b + D P
//! ```
//!
//! with D symmetric and positive definite. With friction (`carom_algebra::Cone`) each normal row
//! has one of slip, H at the predicted positions, whose impulse obeys Coulomb's law with the rate
//! H v; e acts on normal rates alone, which can create energy.

use carom_algebra::{Cone, Couplings, Kind, LinearError};
use carom_contact::{Along, Law, Pairing, Rows, Tangential};
use carom_time::ImpulseShares;

use super::rubbing::{combined, friction_state, kind};
use super::watch::{active, measure_into, moves, overconstrained};
use crate::contact::constraints::Constraints;
use crate::contact::independent::{HELD, dependent_on_others, is_dependent, share_nodes};
use crate::contact::loose::loose;
use crate::model::Model;
use crate::rejected::Rejected;
use crate::stage::equations::Equations;
use crate::stage::evaluation::Evaluation;
use crate::state::State;
use crate::workspace::Workspace;

/// A predicted gap of at most this fraction of L is a tie, which round-off does not decide: it is
/// open, as the published results of these schemes require, unless the pair has been closed since
/// the start of the run, or touches at rest at the start. Otherwise a body pressed at rest would
/// spring off.
pub(super) const TIE: f64 = 1e-10;

/// The contacts of a step, and their impulses.
pub(super) struct Impulses {
    /// Rows at the predicted positions.
    pub rows: Constraints,
    /// e of each contact; 0 of slips.
    restitution: Vec<f64>,
    /// The law of each row.
    kinds: Vec<Kind>,
    /// Whether rows depend on each other.
    dependent: bool,
    /// G v_n.
    before: Vec<f64>,
    /// P ≥ 0.
    pub values: Vec<f64>,
    /// M⁻¹Gᵀ, if the scheme needs it.
    released: Vec<Vec<f64>>,
}

impl Impulses {
    pub(super) fn none(dimension: usize) -> Self {
        Self {
            rows: Constraints::none(dimension),
            restitution: Vec::new(),
            kinds: Vec::new(),
            dependent: false,
            before: Vec::new(),
            values: Vec::new(),
            released: Vec::new(),
        }
    }

    /// Gaps that are not negative at the end of a step of backward Euler, linearised at the
    /// positions `at`: 0 ≤ g + G (y_s + Δt v − at) ⊥ P ≥ 0, in the form above with e = 1 and what G
    /// v lacks in place of G v_n.
    pub(super) fn linearised(
        model: &Model,
        (state, dt): (&State, f64),
        at: &[f64],
        pairings: &[Pairing],
        measured: &[Rows],
    ) -> Result<Self, Rejected> {
        let (places, stuck): (Vec<_>, Vec<_>) =
            active(pairings).partition(|&(k, p)| moves(model, measured[k].row(p)));
        let pair_of = |(k, p): (usize, usize)| &pairings[k].pairs[p];
        for place in stuck {
            let gap = measured[place.0].row(place.1).gap;
            if gap < -TIE * model.scale {
                return Err(overconstrained(&model.contacts[place.0], pair_of(place), gap));
            }
        }
        let dependent = is_dependent(model, places.iter().map(|&(k, p)| measured[k].row(p)));
        let rows =
            Constraints::plain(model.dimension, places.iter().map(|&(k, p)| ((k, p), measured[k].row(p))));
        let back: Vec<f64> = state.y.iter().zip(at).map(|(y, at)| y - at).collect();
        Ok(Self {
            restitution: vec![1.0; places.len()],
            kinds: vec![Kind::Normal; places.len()],
            dependent,
            before: rows.rows.iter().map(|row| (row.gap + row.along(&back)) / dt).collect(),
            values: places.iter().map(|&place| -dt * pair_of(place).lambda).collect(),
            rows,
            released: Vec::new(),
        })
    }

    /// The contacts whose gap is closed at the predicted positions.
    pub(super) fn closed(
        model: &Model,
        (state, dt): (&State, f64),
        shares: ImpulseShares,
        predicted: &[f64],
        pairings: &mut [Pairing],
        work: &mut Workspace,
    ) -> Result<Self, Rejected> {
        let mut measured = Vec::new();
        measure_into(model, predicted, pairings, &mut measured)?;
        let path: Vec<f64> = predicted.iter().zip(&state.y).map(|(to, from)| to - from).collect();
        let tie = TIE * model.scale;
        for (pairing, rows) in pairings.iter_mut().zip(&measured) {
            for (pair, row) in pairing.pairs.iter_mut().zip(rows.iter()) {
                pair.rests |= state.step == 0 && row.along(&path).abs() <= tie;
                pair.active = row.gap < if pair.rests { tie } else { -tie };
                pair.rests &= pair.active;
            }
        }
        let (places, stuck): (Vec<_>, Vec<_>) =
            active(pairings).partition(|&(k, p)| moves(model, measured[k].row(p)));
        for (k, p) in stuck {
            // No impulse changes its velocity.
            let row = measured[k].row(p);
            let sinks = -row.along(&path);
            if sinks > TIE * model.scale {
                return Err(overconstrained(&model.contacts[k], &pairings[k].pairs[p], row.gap));
            }
        }
        let dependent = is_dependent(model, places.iter().map(|&(k, p)| measured[k].row(p)));
        let mut rows =
            Constraints::plain(model.dimension, places.iter().map(|&(k, p)| ((k, p), measured[k].row(p))));
        let mut kinds = vec![Kind::Normal; places.len()];
        let mut restitution: Vec<f64> = places.iter().map(|&(k, _)| model.contacts[k].restitution).collect();
        let middle = state.time + 0.5 * dt;
        let laws = model.friction_laws(middle, &state.pairs)?;
        let mut combination = Rows::new(model.dimension);
        for (of, &(k, p)) in places.iter().enumerate().filter(|_| model.has_friction()) {
            let contact = &model.contacts[k];
            let pair = &mut pairings[k].pairs[p];
            let Some(law) = model.law_of((k, pair), &laws, middle)? else { continue };
            let failed = |error| Rejected::Contact { contact: contact.name.clone(), error };
            let mut slips = Rows::new(model.dimension);
            contact.kinematics.slip(pair, predicted, &[], &mut slips).map_err(failed)?;
            pair.tangential.tangents = slips.tangents(0);
            let law = Law { limit: dt * law.limit, ..law };
            let kind = kind(&law, of, state, (k, pair), &slips, &state.v);
            for along in loose(model, measured[k].row(p), &slips, &path, HELD) {
                combination.clear();
                combination.push_combined(&slips, 0, &along[..slips.len()]);
                rows.push_plain((k, p), combination.row(0), Some(along));
                kinds.push(kind);
                restitution.push(0.0);
            }
        }
        let may_depend = model.dimension == 3 || share_nodes(model, pairings, &places);
        let dependent =
            dependent || model.has_friction() && may_depend && is_dependent(model, rows.rows.iter());
        let mut released = Vec::new();
        if !rows.is_empty() && (shares.velocity != 0.0 || shares.acceleration != 0.0) {
            work.system.mass_with(model, &Constraints::none(model.dimension))?;
            let mut force = vec![0.0; model.dofs()];
            for row in rows.rows.iter() {
                force.fill(0.0);
                row.add_to(1.0, &mut force);
                let mut column = vec![0.0; model.dofs()];
                work.system.solve(model, [&force, &[]], &mut column, &mut Vec::new())?;
                released.push(column);
            }
        }
        Ok(Self {
            restitution,
            kinds,
            dependent,
            before: rows.rows.iter().map(|row| row.along(&state.v)).collect(),
            values: vec![0.0; rows.len()],
            rows,
            released,
        })
    }

    /// P of the linearised step: b and D from the solutions for −r₀ and for each row.
    pub(super) fn solve(
        &self,
        equations: &Equations,
        shares: ImpulseShares,
        now: &Evaluation,
        correction: &[f64],
        columns: &[Vec<f64>],
        values: &mut Vec<f64>,
    ) -> Result<(), LinearError> {
        let count = self.rows.len();
        let velocity = &equations.stage.velocity;
        let end: Vec<f64> = (0..correction.len())
            .map(|i| velocity.slope * (now.at.increment[i] + correction[i]) + velocity.at_start[i])
            .collect();
        let mut matrix = vec![0.0; count * count];
        let mut right = vec![0.0; count];
        for (i, row) in self.rows.rows.iter().enumerate() {
            right[i] = row.along(&end) + self.restitution[i] * self.before[i];
            for j in 0..=i {
                let direct = self.released.get(j).map_or(0.0, |r| shares.velocity * row.along(r));
                matrix[i * count + j] = velocity.slope * shares.force * row.along(&columns[j]) + direct;
            }
        }
        for i in 0..count {
            (0..i).for_each(|j| matrix[j * count + i] = matrix[i * count + j]);
        }
        values.clone_from(&self.values);
        let matrix = &mut Couplings::dense(count, matrix);
        Cone { matrix, right: &mut right, kinds: &self.kinds, is_dependent: self.dependent }.solve(values)
    }

    /// The gaps, by contact and pair, whose friction may as well be that of another contact.
    pub(super) fn with_arbitrary_friction(&self, model: &Model) -> Vec<(usize, usize)> {
        if !self.dependent || !model.has_friction() {
            return Vec::new();
        }
        let rows = self.rows.list.iter().zip(self.rows.rows.iter());
        let gaps = rows.filter(|(constraint, _)| constraint.slip.is_none());
        dependent_on_others(model, gaps.map(|(constraint, row)| (constraint.place, row)))
    }

    /// x += factor M⁻¹GᵀP.
    pub(super) fn release(&self, x: &mut [f64], factor: f64) {
        for (column, impulse) in self.released.iter().zip(&self.values) {
            for (x, c) in x.iter_mut().zip(column) {
                *x += factor * impulse * c;
            }
        }
    }

    /// Adds impulses to the ledger and, as forces P/Δt, to those of the contacts and of their
    /// pairs: work ½(Gv⁻ + Gv⁺)·P.
    pub(super) fn record(&self, dt: f64, next: &mut State, pairings: &mut [Pairing]) {
        for pair in pairings.iter_mut().flat_map(|pairing| &mut pairing.pairs) {
            let Tangential { tangents, slip, .. } = pair.tangential;
            (pair.lambda, pair.tangential) = (0.0, Tangential { tangents, slip, ..Tangential::default() });
        }
        next.contact_forces.fill([0.0; 3]);
        for (r, (row, impulse)) in self.rows.rows.iter().zip(&self.values).enumerate() {
            let normal = row.normal();
            for i in 0..3 {
                next.contact_forces[self.rows.list[r].place.0][i] += impulse * normal[i] / dt;
                next.impulses[self.rows.list[r].place.0][i] += impulse * normal[i];
            }
            let work = 0.5 * impulse * (self.before[r] + row.along(&next.v));
            let is_slip = self.rows.list[r].slip.is_some();
            *(if is_slip { &mut next.ledger.friction_work } else { &mut next.ledger.contact_work }) += work;
            if !is_slip {
                let (k, p) = self.rows.list[r].place;
                pairings[k].pairs[p].lambda = -impulse / dt;
            }
        }
        let along: Vec<Along> = self.rows.list.iter().filter_map(|row| row.slip).collect();
        let first = self.values.len() - along.len();
        let mut rubbed = vec![[0.0; 2]; first];
        for (of, impulse) in combined(&self.kinds, &along, &self.values[first..]) {
            (0..2).for_each(|a| rubbed[of][a] += impulse[a]);
        }
        let slips: Vec<f64> = self.rows.rows.iter().skip(first).map(|row| dt * row.along(&next.v)).collect();
        for ((of, slip), kind) in combined(&self.kinds, &along, &slips).zip(&self.kinds[first..]) {
            let (k, p) = self.rows.list[of].place;
            let tangential = &mut pairings[k].pairs[p].tangential;
            tangential.friction_state = friction_state(*kind, self.values[of], rubbed[of]);
            tangential.traction = rubbed[of].map(|impulse| -impulse / dt);
            (0..2).for_each(|a| tangential.slip[a] += slip[a]);
        }
    }
}
