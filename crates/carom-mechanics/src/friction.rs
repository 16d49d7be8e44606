//! Friction in a stage and in a state. With y_½ = (y_s + y)/2, the row H of
//! [`Kinematics::slip`](carom_contact::Kinematics::slip) and the states of
//! `carom_contact::StickSlip`:
//!
//! ```text
//! S = H(y_½)·(Δy − Δy_free),   force  λ∇g + qH(y_½),   ∂S/∂y = H + ½ ∂H/∂yᵀ (Δy − Δy_free)
//! ```
//!
//! Δy_free = 0, except for a pair that was open at the step's start: what slips before it touches
//! does not count. Its S is the velocity at the end of the stage, v(Δy) = v'·(Δy − Δy_free),
//! divided by v'; on a spring, the share of Δy in which the gap is negative. The force of a contact
//! that conserves acts over the whole step, and so does its S: its work −qS is never positive. Ṡ is
//! this velocity, or S over the time in which it slips; in load steps, the time of their formulas.
//!
//! A pair that slips has q = s r(λ, Ṡ) and is the normal row with the direction ∇g − s ∂r/∂|λ| H;
//! one that sticks is a row of its own with the multiplier q, S = 0 or, on a spring,
//! S = (q − q_s)/k. A spring that slipped in the last step goes on to do so while its stick would
//! exceed r, whatever a stick could hold.
//!
//! Between steps q acts along H(y_s): in the averaged forces of the next step and in what is
//! recorded.

use carom_contact::{ContactError, Hold, Law, Pair, Radius, Row, Rows, Tangential};

use crate::balance::contact_weights;
use crate::equations::Equations;
use crate::evaluation::Evaluation;
use crate::model::{Contact, Model, NoValue};
use crate::state::State;

impl Model {
    /// Whether a contact has friction.
    pub(crate) fn has_friction(&self) -> bool {
        self.contacts.iter().any(|contact| contact.friction.is_some())
    }

    /// The laws of the secondary nodes of each contact at a time; none without friction.
    ///
    /// # Errors
    /// If a coefficient has no value.
    pub(crate) fn friction_laws(&self, time: f64) -> Result<Vec<Vec<Law>>, NoValue> {
        let of = |contact: &Contact| contact.friction.as_ref().map_or(Ok(Vec::new()), |f| f.laws(time));
        self.contacts.iter().map(of).collect()
    }

    /// Energy of the tangential springs of closed pairs.
    pub(crate) fn stick_energy<'a>(&self, pairs: impl Iterator<Item = &'a [Pair]>) -> f64 {
        let of = |(contact, pairs): (&Contact, &'a [Pair])| {
            let springs = contact.friction.as_ref().map_or(&[][..], |friction| &friction.springs);
            let closed = pairs.iter().filter(|pair| pair.active && !springs.is_empty());
            closed.map(|pair| 0.5 * pair.tangential.traction.powi(2) / springs[pair.node]).sum::<f64>()
        };
        self.contacts.iter().zip(pairs).map(of).sum()
    }
}

/// Part of the motion of a pair that counts as slip.
#[derive(Clone, Copy)]
pub(crate) enum Counted {
    /// This share of the step's increment.
    Share(f64),
    /// What gives the velocity at the end of the stage.
    Velocity,
}

/// A closed pair that rubs.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Rubbing {
    /// s, 0 in stick.
    pub sign: f64,
    /// The traction of a slip.
    pub radius: Radius,
    /// Factor between S and the rate of slip.
    pub rate: f64,
}

impl Equations<'_> {
    /// Whether the friction of a contact is on springs, and the stiffness of a pair's.
    pub(crate) fn stick_spring(&self, contact: usize, pair: &Pair) -> Option<f64> {
        self.model.contacts[contact].friction.as_ref()?.springs.get(pair.node).copied()
    }

    /// Adds the row H of a closed pair at y_½, with S as its gap, and returns what counts in it.
    /// `gap`: that of the pair.
    pub(crate) fn slip_into(
        &self,
        contact: usize,
        pair: &Pair,
        gap: f64,
        middle: &[f64],
        increment: &[f64],
        slips: &mut Rows,
    ) -> Result<Counted, ContactError> {
        let kinematics = &self.model.contacts[contact].kinematics;
        let mut at_middle = *pair;
        kinematics.measure(&mut at_middle, middle, slips)?;
        slips.pop();
        let part = self.part(contact, pair, gap, slips);
        kinematics.slip(&at_middle, middle, slips)?;
        let row = slips.row(slips.len() - 1);
        let counted = |(dof, slope): (usize, f64)| slope * self.counted(dof, part, increment);
        let slip = row.entries().map(counted).sum();
        *slips.gap_mut(slips.len() - 1) = slip;
        Ok(part)
    }

    /// S of a pair that closes in an iterate; 0 if it has none.
    pub(crate) fn slip(&self, contact: usize, pair: &Pair, middle: &[f64], increment: &[f64]) -> f64 {
        let mut rows = Rows::new(self.model.dimension);
        self.slip_into(contact, pair, 0.0, middle, increment, &mut rows).map_or(0.0, |_| rows.row(0).gap)
    }

    /// Sets the traction of a closed pair from its slip.
    fn rub(&self, contact: usize, pair: &mut Pair, slip: f64, part: Counted) -> Rubbing {
        let (law, pressure) = (self.laws[contact][pair.node], (-pair.lambda).max(0.0));
        let rate = self.rate(part);
        let radius = law.slip(pressure, slip.abs() * rate);
        if let Some(stiffness) = self.stick_spring(contact, pair) {
            let start = self.state.closed(contact, pair.node).map(|old| old.tangential);
            let trial = start.map_or(0.0, |_| pair.tangential.before) + stiffness * slip;
            let slipped = start.map_or(0.0, |start| start.hold.sign()) * trial > 0.0;
            let edge = if slipped { radius.value } else { law.grip(pressure) };
            pair.tangential.hold = if trial.abs() <= edge { Hold::Stick } else { Hold::of(trial, 0.0) };
            pair.tangential.traction = trial;
        }
        let sign = pair.tangential.hold.sign();
        if sign != 0.0 {
            pair.tangential.traction = sign * radius.value;
        }
        Rubbing { sign, radius, rate }
    }

    /// Adds the friction of a pair with this gap: the row of its slip, the direction of its force,
    /// and what acts beyond that.
    pub(crate) fn add_friction(
        &self,
        contact: usize,
        pair: &mut Pair,
        gap: f64,
        evaluation: &mut Evaluation,
    ) -> Result<(), ContactError> {
        let weight = contact_weights(&self.stage, self.model.contacts[contact].at_the_end).0;
        let Evaluation { at, middle, rows, turned, slips, rests, forces, measure, .. } = evaluation;
        let (rows, turned, slips) = (&rows[contact], &mut turned[contact], &mut slips[contact]);
        if !pair.active {
            slips.push_open();
            if turned.len() < rows.len() {
                turned.push_open();
            }
            return Ok(());
        }
        // Not there yet unless it is a discrete gradient.
        if turned.len() < rows.len() {
            turned.push_row(rows.row(rows.len() - 1));
        }
        let part = self.slip_into(contact, pair, gap, middle, &at.increment, slips)?;
        let slip = slips.row(slips.len() - 1);
        let Rubbing { sign, radius, .. } = self.rub(contact, pair, slip.gap, part);
        let turn = sign * radius.by_pressure;
        let direction = turned.gradient_mut(rows.len() - 1).iter_mut().zip(slip.gradient);
        direction.for_each(|(along, h)| *along -= turn * h);
        let rest = pair.tangential.traction + turn * pair.lambda;
        rests[contact].push(rest);
        slip.add_to(weight * rest, &mut forces.contact);
        slip.add_to(weight * pair.tangential.traction, &mut forces.friction);
        match self.stick_spring(contact, pair) {
            Some(stiffness) => {
                evaluation.stick_springs += 0.5 * pair.tangential.traction.powi(2) / stiffness;
            }
            None if sign == 0.0 => {
                (measure.gap, measure.sticks) = (measure.gap.max(slip.gap.abs()), true);
            }
            None => {}
        }
        Ok(())
    }

    fn part(&self, contact: usize, pair: &Pair, gap: f64, rows: &mut Rows) -> Counted {
        if !self.closes(contact, pair) || self.model.contacts[contact].conserves() {
            return Counted::Share(1.0);
        }
        if self.stick_spring(contact, pair).is_none() {
            return Counted::Velocity;
        }
        let start = self.gap_at_start(contact, pair, rows).unwrap_or(0.0);
        Counted::Share(if start > 0.0 { (gap / (gap - start)).clamp(0.0, 1.0) } else { 1.0 })
    }

    /// Factor between S and the rate of slip.
    fn rate(&self, part: Counted) -> f64 {
        match part {
            Counted::Velocity => self.stage.velocity.slope,
            Counted::Share(share) if share > 0.0 => (share * self.duration).recip(),
            Counted::Share(_) => 0.0,
        }
    }

    /// A component of Δy − Δy_free.
    fn counted(&self, dof: usize, part: Counted, increment: &[f64]) -> f64 {
        let velocity = &self.stage.velocity;
        match part {
            Counted::Share(share) => share * increment[dof],
            Counted::Velocity => increment[dof] + velocity.at_start[dof] / velocity.slope,
        }
    }

    /// Share of the step after the touch of a pair that closes, which approaches with its velocity
    /// at the start, or at the mean one if that is larger.
    fn since_touch(&self, contact: usize, pair: &Pair, gap: Row, rows: &mut Rows) -> f64 {
        let start = self.gap_at_start(contact, pair, rows).unwrap_or(0.0);
        let approach = (-gap.along(&self.state.v)).max(start / self.duration);
        if start > 0.0 { 1.0 - start / (self.duration * approach) } else { 1.0 }
    }

    /// Whether a pair was open at the step's start.
    fn closes(&self, contact: usize, pair: &Pair) -> bool {
        !self.stage.is_static() && self.state.closed(contact, pair.node).is_none()
    }

    /// ∂H/∂y of a pair at y_½ halved, the derivative of its row by the end of the step, row-major;
    /// and ∂S/∂y.
    pub(crate) fn slip_derivatives(
        &self,
        evaluation: &Evaluation,
        (contact, p): (usize, usize),
        rows: &mut Rows,
    ) -> (Vec<f64>, Vec<f64>) {
        let kinematics = &self.model.contacts[contact].kinematics;
        let (row, pair) = (evaluation.slips[contact].row(p), &evaluation.at.pairings[contact].pairs[p]);
        let mut matrix = vec![0.0; row.gradient.len().pow(2)];
        rows.clear();
        let part = self.part(contact, pair, evaluation.rows[contact].row(p).gap, rows);
        let share = if let Counted::Share(share) = part { share } else { 1.0 };
        let mut gradient: Vec<f64> = row.gradient.iter().map(|h| share * h).collect();
        let mut at_middle = *pair;
        // It was measured in the evaluation.
        if kinematics.measure(&mut at_middle, &evaluation.middle, rows).is_err() {
            return (matrix, gradient);
        }
        kinematics.slip_derivative_into(&at_middle, &evaluation.middle, &mut matrix);
        matrix.iter_mut().for_each(|entry| *entry *= 0.5);
        let counted = row.entries().map(|(dof, _)| self.counted(dof, part, &evaluation.at.increment));
        for (turned, moved) in matrix.chunks_exact(gradient.len()).zip(counted) {
            gradient.iter_mut().zip(turned).for_each(|(slope, h)| *slope += h * moved);
        }
        (matrix, gradient)
    }

    /// Adds the derivative of the force s r H of a slipping pair, beyond that of r by λ, over the
    /// nodes of its row.
    pub(crate) fn slip_curvature_into(
        &self,
        evaluation: &Evaluation,
        (contact, p): (usize, usize),
        rows: &mut Rows,
        curvature: &mut [f64],
    ) {
        let slip = evaluation.slips[contact].row(p);
        let mut pair = evaluation.at.pairings[contact].pairs[p];
        let part = self.part(contact, &pair, evaluation.rows[contact].row(p).gap, rows);
        let Rubbing { sign, radius, rate } = self.rub(contact, &mut pair, slip.gap, part);
        if sign == 0.0 {
            return;
        }
        let (turned, gradient) = self.slip_derivatives(evaluation, (contact, p), rows);
        let by_slip = radius.by_rate * rate * slip.gap.signum() * sign;
        for (i, row) in curvature.chunks_exact_mut(gradient.len()).enumerate() {
            for (j, entry) in row.iter_mut().enumerate() {
                *entry += sign * radius.value * turned[i * gradient.len() + j]
                    + by_slip * slip.gradient[i] * gradient[j];
            }
        }
    }
}

/// Calls `visit(contact, pair, H)` for the closed pairs of a state that have friction, with H at
/// its positions.
pub fn each_slip(model: &Model, state: &State, mut visit: impl FnMut(usize, usize, Row)) {
    let mut rows = Rows::new(model.dimension);
    let rubs = |(_, contact): &(usize, &Contact)| contact.friction.is_some();
    for (k, contact) in model.contacts.iter().enumerate().filter(rubs) {
        for (p, pair) in state.pairs[k].iter().enumerate().filter(|(_, pair)| pair.active) {
            let mut at = *pair;
            rows.clear();
            if contact.kinematics.measure(&mut at, &state.y, &mut rows).is_ok()
                && contact.kinematics.slip(&at, &state.y, &mut rows).is_ok()
            {
                visit(k, p, rows.row(1));
            }
        }
    }
}

/// Force on a secondary side of the tractions that are not in the direction of λ:
/// −Σ (q + s ∂r/∂|λ| λ) ∂S/∂y_N over the closed pairs.
pub(crate) fn secondary_friction(evaluation: &Evaluation, contact: usize) -> [f64; 3] {
    let mut force = [0.0; 3];
    let pairs = evaluation.at.pairings[contact].pairs.iter();
    let closed = pairs.zip(evaluation.slips[contact].iter()).filter(|(pair, _)| pair.active);
    for ((_, row), rest) in closed.zip(&evaluation.rests[contact]) {
        let along = row.normal();
        (0..3).for_each(|i| force[i] -= rest * along[i]);
    }
    force
}

/// Adds the slips of a solved step to those of the closed pairs; open pairs have none.
pub(crate) fn take_slips(equations: &Equations, solved: &Evaluation, state: &mut State) {
    let mut rows = Rows::new(equations.model.dimension);
    for (k, contact) in equations.model.contacts.iter().enumerate() {
        if contact.friction.is_none() {
            continue;
        }
        let of_contact = solved.slips[k].iter().zip(solved.rows[k].iter());
        for (pair, (slip, gap)) in state.pairs[k].iter_mut().zip(of_contact) {
            if pair.active {
                // On a spring, S is no more than what follows the touch.
                let touches = equations.closes(k, pair) && equations.stick_spring(k, pair).is_none();
                pair.tangential.slip += if touches {
                    equations.since_touch(k, pair, gap, &mut rows) * slip.along(&solved.at.increment)
                } else {
                    slip.gap
                };
                pair.tangential.before = pair.tangential.traction;
            } else {
                pair.tangential = Tangential::default();
            }
        }
    }
}

/// Adds a step of this size to what pairs with friction did.
pub(crate) fn book_states(model: &Model, state: &mut State, dt: f64) {
    let rubbed = &mut state.ledger.rubbed;
    let rubs = model.contacts.iter().zip(&state.pairs).filter(|(contact, _)| contact.friction.is_some());
    for pair in rubs.flat_map(|(_, pairs)| pairs).filter(|pair| pair.active) {
        rubbed.closed += dt;
        rubbed.stuck += if pair.tangential.hold == Hold::Stick { dt } else { 0.0 };
        rubbed.farthest = rubbed.farthest.max(pair.tangential.slip.abs());
    }
}
