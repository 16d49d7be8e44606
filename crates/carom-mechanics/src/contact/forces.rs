//! Contact in the equations of a stage: the row of each pair, the response of its interface, and
//! its force, weighted as in the balance.

use carom_contact::constants::ROUND_OFF;
use carom_contact::{ContactError, Direction, Pair, Point, Rows};

use crate::rejected::Rejected;
use crate::stage::balance::contact_weights;
use crate::stage::equations::Equations;
use crate::stage::evaluation::Evaluation;

impl Equations<'_> {
    /// Rows of all pairs, the responses of their interfaces, and the contact forces.
    pub(crate) fn evaluate_contacts(&self, evaluation: &mut Evaluation) -> Result<(), Rejected> {
        self.clear_contacts(evaluation);
        let mut pairings = std::mem::take(&mut evaluation.at.pairings);
        for (k, (contact, pairing)) in self.model.contacts.iter().zip(&mut pairings).enumerate() {
            for pair in &mut pairing.pairs {
                self.evaluate_pair(k, pair, evaluation)
                    .map_err(|error| Rejected::Contact { contact: contact.name.clone(), error })?;
            }
        }
        evaluation.at.pairings = pairings;
        evaluation.springs += evaluation.stick_springs;
        Ok(())
    }

    fn clear_contacts(&self, evaluation: &mut Evaluation) {
        let contacts = self.model.contacts.len();
        let dofs = self.model.dofs();
        let Evaluation { at, forces, rows, turned, slips, middle, rests, answers, measure, .. } = evaluation;
        for list in [rows, turned, slips] {
            list.resize_with(contacts, || Rows::new(self.model.dimension));
            list.iter_mut().for_each(Rows::clear);
        }
        rests.resize_with(contacts, Vec::new);
        rests.iter_mut().for_each(Vec::clear);
        answers.resize_with(contacts, Vec::new);
        answers.iter_mut().for_each(Vec::clear);
        forces.contact.clear();
        forces.contact.resize(dofs, 0.0);
        forces.friction.clear();
        middle.clear();
        if self.model.has_friction() {
            forces.friction.resize(dofs, 0.0);
            middle.extend(self.state.y.iter().zip(&at.increment).map(|(y, d)| y + 0.5 * d));
        }
        (measure.gap, measure.may_depend) = (0.0, false);
        (evaluation.springs, evaluation.stick_springs) = (0.0, 0.0);
    }

    fn evaluate_pair(
        &self,
        k: usize,
        pair: &mut Pair,
        evaluation: &mut Evaluation,
    ) -> Result<(), ContactError> {
        let contact = &self.model.contacts[k];
        let weight = contact_weights(&self.stage, contact.at_the_end).0;
        let direction = contact.interface.direction();
        let gap = self.measure_pair(k, pair, evaluation)?;
        let start = pair.start.unwrap_or(f64::INFINITY);
        contact.find_spring(pair);
        let of_augmented = || self.augmentation(k, pair, evaluation.at.stiffer).map(|springs| springs[0]);
        let stiffness = contact.spring(pair).or_else(of_augmented).unwrap_or(0.0);
        let Pair { node, lambda, active, multiplier, .. } = *pair;
        // Before the first load step a spring that touches has no force, and holds a body on it.
        let begins = self.stage.is_static() && self.state.step == 0;
        let touches = active && begins && !contact.interface.is_constraint();
        let is_round_off = (0.0..=ROUND_OFF * self.model.scale).contains(&gap);
        let pressed = if touches && is_round_off { -f64::MIN_POSITIVE } else { gap };
        let point = Point { node, gap: pressed, start, lambda, active, multiplier, stiffness };
        let answer = contact.interface.respond(&point);
        (pair.active, pair.lambda) = (answer.active, answer.lambda);
        if direction == Direction::DiscreteGradient {
            self.push_discrete_gradient(k, pair, gap, evaluation)?;
        }
        if contact.friction.is_some() {
            self.add_friction(k, pair, gap, !active, evaluation)?;
        }
        if answer.active {
            let p = evaluation.answers[k].len();
            let turned = &evaluation.turned[k];
            let along = if turned.is_empty() { &evaluation.rows[k] } else { turned };
            along.row(p).add_to(weight * answer.lambda, &mut evaluation.forces.contact);
            evaluation.measure.gap = evaluation.measure.gap.max(answer.open.abs());
            evaluation.measure.may_depend |= self.model.dimension == 3 || contact.bounds(pair);
        }
        evaluation.springs += answer.energy;
        evaluation.answers[k].push(answer);
        Ok(())
    }

    /// Adds the row of a pair, and returns its gap: at the end of the step, or accumulated along
    /// the midpoint.
    fn measure_pair(
        &self,
        k: usize,
        pair: &mut Pair,
        evaluation: &mut Evaluation,
    ) -> Result<f64, ContactError> {
        let Evaluation { at, y, place, rows, .. } = evaluation;
        let contact = &self.model.contacts[k];
        let rows = &mut rows[k];
        let at_middle = contact.interface.direction().accumulates();
        if at_middle && pair.start.is_none() {
            // The initial gap of a new pair; later it is updated.
            pair.start = match self.gap_at_start(k, pair, rows) {
                // A part of a surface that faces nothing has no gap yet.
                Ok(gap) => Some(gap).filter(|gap| gap.is_finite()),
                Err(error) if pair.active => return Err(error),
                Err(_) => None,
            };
        }
        match contact.kinematics.measure(pair, if at_middle { place } else { y }, rows) {
            Ok(()) => {}
            Err(error) if pair.active => return Err(error),
            // An inactive pair without a unique closest point is remote.
            Err(_) => rows.push_open(),
        }
        let p = rows.len() - 1;
        if at_middle {
            *rows.gap_mut(p) = pair.start.unwrap_or(f64::INFINITY) + rows.row(p).along(&at.increment);
        }
        Ok(rows.row(p).gap)
    }

    /// Adds the discrete gradient of a gap, the direction of its force.
    fn push_discrete_gradient(
        &self,
        k: usize,
        pair: &Pair,
        gap: f64,
        evaluation: &mut Evaluation,
    ) -> Result<(), ContactError> {
        let Evaluation { at, place, turned, gradient, rows, .. } = evaluation;
        let turned = &mut turned[k];
        if !pair.active {
            turned.push_open();
            return Ok(());
        }
        let start = self.gap_at_start(k, pair, turned)?;
        self.model.contacts[k].kinematics.measure(&mut pair.clone(), place, turned)?;
        let p = turned.len() - 1;
        if turned.row(p).nodes.is_empty() {
            // The pair faces the other side at the end of the step only.
            turned.pop();
            turned.push_row(rows[k].row(p));
            return Ok(());
        }
        // A part of a surface that faced nothing at the start had no gap that could change.
        let change = if start.is_finite() { gap - start } else { turned.row(p).along(&at.increment) };
        gradient.evaluate(turned.row(p), change, place, &at.increment);
        turned.gradient_mut(p).copy_from_slice(gradient.gradient());
        Ok(())
    }

    /// Gap of a pair to its present facet at the step's start. That of a closed pair which is
    /// handed over is not zero there: the gap to the extension of its new facet.
    pub(crate) fn gap_at_start(
        &self,
        contact: usize,
        pair: &Pair,
        rows: &mut Rows,
    ) -> Result<f64, ContactError> {
        self.model.contacts[contact].kinematics.measure(&mut pair.clone(), &self.state.y, rows)?;
        Ok(rows.pop())
    }
}
