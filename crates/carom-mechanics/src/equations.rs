//! A stage as a system of equations: the balance of forces and the contact conditions, evaluated at
//! an iterate.
//!
//! ```text
//! r(d, λ) = 0   (balance.rs),   c(d, λ) = 0 for each active pair   (carom_contact::Interface)
//! ```

use std::sync::Arc;

use carom_contact::{Answer, ContactError, Direction, DiscreteGradient, Law, Pair, Pairing, Point, Rows};
use carom_time::{Internal, Stage};

use crate::balance::{Forces, contact_weights, known_into, mean_acceleration, residual_into};
use crate::model::{LoadsAt, Model, Prescribed};
use crate::rejected::Rejected;
use crate::renewal::Point as FactorPoint;
use crate::state::State;
use crate::timings::{Timings, timed};

/// The unknowns of a stage.
#[derive(Clone, Debug, Default)]
pub(crate) struct Iterate {
    /// d = y − y_s.
    pub increment: Vec<f64>,
    /// Pairs of each contact, multipliers included.
    pub pairings: Vec<Pairing>,
}

impl Iterate {
    /// The start of a step: no increment, the pairs of the state.
    pub(crate) fn at_start(state: &State) -> Self {
        let pairings = state.pairs.iter().cloned().map(Pairing::new).collect();
        Self { increment: vec![0.0; state.y.len()], pairings }
    }
}

/// Results at an iterate.
#[derive(Clone, Debug, Default)]
pub(crate) struct Evaluation {
    /// The iterate, with contact points updated to its positions and the activity of springs set.
    pub at: Iterate,
    /// y = y_s + d.
    pub y: Vec<f64>,
    /// Positions at which internal forces and loads are evaluated; for a discrete gradient, the
    /// midpoint of the step.
    pub place: Vec<f64>,
    /// Forces over all dofs.
    pub forces: Forces,
    /// a(d).
    pub acceleration: Vec<f64>,
    /// r over all dofs: the reaction force at constrained ones.
    pub residual: Vec<f64>,
    /// A row per pair of each contact.
    pub rows: Vec<Rows>,
    /// Directions of the contact forces where they are not the gradients of these rows: discrete
    /// gradients, or those of slipping pairs, for active pairs; empty for other contacts.
    pub discrete_gradients: Vec<Rows>,
    /// H at the middle of the step, with the slip S as gap, for active pairs with friction; empty for other
    /// contacts.
    pub slips: Vec<Rows>,
    /// y_½ = y_s + d/2; empty without friction.
    pub middle: Vec<f64>,
    /// Traction of each active pair of a contact beyond what acts along its direction.
    pub rests: Vec<Vec<f64>>,
    /// Energy of tangential springs, a part of `springs`.
    pub stick_springs: f64,
    /// The interface's response to each row.
    pub answers: Vec<Vec<Answer>>,
    /// Strain energy of the bodies at `y`, or at the averaged positions.
    pub strain: f64,
    /// Energy of penalty springs.
    pub springs: f64,
    /// Size of the residual and its reference.
    pub measure: Measure,
    /// Buffers.
    gradient: DiscreteGradient,
}

impl Evaluation {
    /// Directions of the forces of a contact, a row per pair.
    pub(crate) fn directions(&self, contact: usize) -> &Rows {
        let discrete = &self.discrete_gradients[contact];
        if discrete.is_empty() { &self.rows[contact] } else { discrete }
    }
}

/// Size of a residual and its reference.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Measure {
    /// ‖r‖ over the free dofs.
    pub residual: f64,
    /// Sum of the norms of its terms.
    pub forces: f64,
    /// Largest |g| of the active constraints, and |S| of those that stick.
    pub gap: f64,
    /// Whether any sticks.
    pub friction: bool,
}

/// Unused evaluations, whose memory is reused.
#[derive(Debug, Default)]
pub(crate) struct Spare(Vec<Evaluation>);

impl Spare {
    fn take(&mut self) -> Evaluation {
        self.0.pop().unwrap_or_default()
    }

    /// Returns the memory of an evaluation.
    pub(crate) fn put(&mut self, evaluation: Evaluation) {
        self.0.push(evaluation);
    }

    /// A copy of an iterate in reused memory.
    pub(crate) fn copy(&mut self, of: &Iterate) -> Iterate {
        let mut iterate = self.0.last_mut().map(|spare| std::mem::take(&mut spare.at)).unwrap_or_default();
        iterate.increment.clone_from(&of.increment);
        iterate.pairings.resize_with(of.pairings.len(), Pairing::default);
        iterate.pairings.iter_mut().zip(&of.pairings).for_each(|(to, from)| to.copy_from(from));
        iterate
    }
}

/// The equations of a stage.
#[derive(Debug)]
pub(crate) struct Equations<'a> {
    pub model: &'a Model,
    /// The state at the step's start.
    pub state: &'a State,
    pub stage: Stage,
    /// The time at which internal forces are evaluated, and the loads then.
    pub time: f64,
    pub loads: LoadsAt,
    /// Prescribed dofs at the stage's end.
    pub motions: Vec<Prescribed>,
    /// Terms of the balance known from the step's start.
    pub known: Vec<f64>,
    /// Laws of friction of the secondary nodes of each contact at the stage's end.
    pub laws: Vec<Vec<Law>>,
    /// Time since the step's start.
    pub duration: f64,
}

impl std::fmt::Debug for Model {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Model").field("dofs", &self.dofs()).finish_non_exhaustive()
    }
}

impl<'a> Equations<'a> {
    /// The equations of a stage that ends at the time `to`.
    ///
    /// # Errors
    /// If a load or a motion has no value.
    pub(crate) fn new(model: &'a Model, state: &'a State, stage: Stage, to: f64) -> Result<Self, Rejected> {
        let average = stage.average;
        let time = if average == 0.0 { to } else { (1.0 - average) * to + average * state.time };
        let mut equations = Self {
            model,
            state,
            stage,
            time,
            loads: LoadsAt::default(),
            motions: Vec::new(),
            known: Vec::new(),
            laws: model.friction_laws(to)?,
            duration: to - state.time,
        };
        if !model.loads.is_empty() {
            model.loads.at(&model.parts, model.dofs(), time, &mut equations.loads)?;
        }
        model.motions.at(to, &mut equations.motions)?;
        known_into(model, &equations.stage, state, &mut equations.known);
        Ok(equations)
    }

    /// Whether internal forces are a discrete gradient over the step.
    pub(crate) fn between(&self) -> bool {
        self.stage.internal == Internal::DiscreteGradient
    }

    /// Factor of the mass matrix in the tangent.
    pub(crate) fn mass_factor(&self) -> f64 {
        self.stage.weights.mass * self.stage.acceleration.slope
    }

    /// Factor of the internal tangent.
    pub(crate) fn stiffness_factor(&self) -> f64 {
        match self.stage.internal {
            Internal::Gradient => self.stage.weights.internal * (1.0 - self.stage.average),
            // Its tangent already refers to the end of the step.
            Internal::DiscreteGradient => self.stage.weights.internal,
        }
    }

    /// Factor of the internal tangent at one configuration: for a discrete gradient, the end
    /// contributes half of the tangent at the midpoint.
    pub(crate) fn factor_stiffness(&self) -> f64 {
        if self.between() { 0.5 * self.stiffness_factor() } else { self.stiffness_factor() }
    }

    /// Factor of the loads' tangent.
    pub(crate) fn follower_factor(&self) -> f64 {
        self.stage.weights.external * (1.0 - self.stage.average)
    }

    /// The point of a factor at these positions, with these nodes eliminated last.
    pub(crate) fn point(&self, at: &[f64], boundary: &[usize]) -> Arc<FactorPoint> {
        Arc::new(FactorPoint {
            at: at.to_vec(),
            mass: self.mass_factor(),
            stiffness: self.factor_stiffness(),
            follower: if self.model.loads.follow_sides() { self.follower_factor() } else { 0.0 },
            time: if self.model.loads.follow_sides() { self.time } else { 0.0 },
            boundary: boundary.to_vec(),
        })
    }

    /// Remaining displacements of prescribed dofs.
    pub(crate) fn remaining(&self, at: &Iterate) -> impl Iterator<Item = (usize, f64)> {
        self.motions.iter().map(move |moved| {
            let target = self.model.reference[moved.dof] + moved.motion[0];
            (moved.dof, (target - self.state.y[moved.dof]) - at.increment[moved.dof])
        })
    }

    /// Sets prescribed dofs to their exact positions.
    pub(crate) fn arrive(&self, increment: &mut [f64]) {
        for moved in &self.motions {
            increment[moved.dof] =
                self.model.reference[moved.dof] + moved.motion[0] - self.state.y[moved.dof];
        }
    }

    /// Forces, gaps and residual at an iterate.
    ///
    /// # Errors
    /// If a cell is inverted, or an active pair has no gap.
    pub(crate) fn evaluate(
        &self,
        at: Iterate,
        spare: &mut Spare,
        timings: &mut Timings,
    ) -> Result<Evaluation, Rejected> {
        let mut evaluation = spare.take();
        evaluation.at = at;
        match self.fill(&mut evaluation, timings) {
            Ok(()) => Ok(evaluation),
            Err(rejected) => {
                spare.put(evaluation);
                Err(rejected)
            }
        }
    }

    fn fill(&self, evaluation: &mut Evaluation, timings: &mut Timings) -> Result<(), Rejected> {
        let Self { model, state, stage, .. } = self;
        let Evaluation { at, y, place, forces, acceleration, residual, .. } = evaluation;
        let dofs = model.dofs();
        for vector in [&mut *y, place, acceleration, residual, &mut forces.inertia, &mut forces.internal] {
            vector.resize(dofs, 0.0);
        }
        forces.loads.resize(dofs, 0.0);
        let share = if self.between() { 0.5 } else { 1.0 - stage.average };
        for i in 0..dofs {
            y[i] = state.y[i] + at.increment[i];
            place[i] = state.y[i] + share * at.increment[i];
        }
        evaluation.strain = timed(&mut timings.assembly, || {
            if self.between() {
                model.internal_between(&state.y, y, &mut forces.internal)
            } else {
                model.internal_force(place, &mut forces.internal)
            }
        })
        .map_err(|(body, inverted)| Rejected::Inverted { body, inverted })?;
        if !model.loads.is_empty() {
            model.loads.force_into(&self.loads, place, &mut forces.loads);
        }
        stage.acceleration.value_into(&at.increment, acceleration);
        if !stage.is_static() {
            for moved in &self.motions {
                // The acceleration for which the balance, with its averages, gives this mean.
                let before = state.a[moved.dof];
                let mean = mean_acceleration(stage, moved.motion[2], before);
                acceleration[moved.dof] = (mean - stage.before.mass * before) / stage.weights.mass;
            }
        }
        model.mass.multiply_into(acceleration, &mut forces.inertia);
        timed(&mut timings.contact, || self.evaluate_contacts(evaluation))?;
        let Evaluation { forces, residual, measure, .. } = evaluation;
        (measure.residual, measure.forces) = residual_into(model, stage, forces, &self.known, residual);
        Ok(())
    }

    /// Rows of all pairs, the responses of their interfaces, and the contact forces.
    fn evaluate_contacts(&self, evaluation: &mut Evaluation) -> Result<(), Rejected> {
        let Evaluation {
            at,
            y,
            place,
            forces,
            rows,
            discrete_gradients,
            slips,
            middle,
            rests,
            stick_springs,
            answers,
            springs,
            measure,
            gradient,
            ..
        } = evaluation;
        let contacts = self.model.contacts.len();
        forces.contact.clear();
        forces.contact.resize(self.model.dofs(), 0.0);
        rows.resize_with(contacts, || Rows::new(self.model.dimension));
        discrete_gradients.resize_with(contacts, || Rows::new(self.model.dimension));
        slips.resize_with(contacts, || Rows::new(self.model.dimension));
        rests.resize_with(contacts, Vec::new);
        forces.friction.clear();
        middle.clear();
        if self.model.has_friction() {
            forces.friction.resize(self.model.dofs(), 0.0);
            middle.extend(self.state.y.iter().zip(&at.increment).map(|(y, d)| y + 0.5 * d));
        }
        answers.resize_with(contacts, Vec::new);
        (*springs, *stick_springs, measure.gap, measure.friction) = (0.0, 0.0, 0.0, false);
        for (k, (contact, pairing)) in self.model.contacts.iter().zip(&mut at.pairings).enumerate() {
            let weight = contact_weights(&self.stage, contact.at_the_end).0;
            let (rows, discrete_gradients, answers) =
                (&mut rows[k], &mut discrete_gradients[k], &mut answers[k]);
            let (slips, rests) = (&mut slips[k], &mut rests[k]);
            slips.clear();
            rests.clear();
            let direction = contact.interface.direction();
            rows.clear();
            discrete_gradients.clear();
            answers.clear();
            for (p, pair) in pairing.pairs.iter_mut().enumerate() {
                let failed = |error| Rejected::Contact { contact: contact.name.clone(), error };
                let at_middle = direction == Direction::Midpoint;
                if at_middle && pair.start.is_none() {
                    // The initial gap of a new pair; later it is updated.
                    pair.start = match contact.kinematics.measure(&mut pair.clone(), &self.state.y, rows) {
                        Ok(()) => Some(rows.pop()),
                        Err(error) if pair.active => return Err(failed(error)),
                        Err(_) => None,
                    };
                }
                match contact.kinematics.measure(pair, if at_middle { place } else { y }, rows) {
                    Ok(()) => {}
                    Err(error) if pair.active => return Err(failed(error)),
                    // An inactive pair without a unique closest point is remote.
                    Err(_) => rows.push_open(),
                }
                let start = pair.start.unwrap_or(f64::INFINITY);
                if at_middle {
                    *rows.gap_mut(p) = start + rows.row(p).along(&at.increment);
                }
                let row = rows.row(p);
                let point =
                    Point { node: pair.node, gap: row.gap, start, lambda: pair.lambda, active: pair.active };
                let answer = contact.interface.respond(&point);
                (pair.active, pair.lambda) = (answer.active, answer.lambda);
                if direction == Direction::DiscreteGradient {
                    if answer.active {
                        let start = self.gap_at_start(k, pair, discrete_gradients).map_err(failed)?;
                        let middle = &mut pair.clone();
                        contact.kinematics.measure(middle, place, discrete_gradients).map_err(failed)?;
                        gradient.evaluate(discrete_gradients.row(p), row.gap - start, place, &at.increment);
                        discrete_gradients.gradient_mut(p).copy_from_slice(gradient.gradient());
                    } else {
                        discrete_gradients.push_open();
                    }
                }
                if contact.friction.is_some() {
                    if direction == Direction::End {
                        if answer.active {
                            discrete_gradients.push_row(row);
                        } else {
                            discrete_gradients.push_open();
                        }
                    }
                    if answer.active {
                        self.slip_into(k, pair, row.gap, middle, &at.increment, slips).map_err(failed)?;
                        let slip = slips.row(p);
                        let rubbing = self.rub(k, pair, slip.gap);
                        let (sign, radius) = (rubbing.sign, rubbing.radius);
                        let turn = sign * radius.by_pressure;
                        let along = discrete_gradients.gradient_mut(p).iter_mut().zip(slip.gradient);
                        along.for_each(|(along, h)| *along -= turn * h);
                        let rest = pair.tangential.traction + turn * pair.lambda;
                        rests.push(rest);
                        slip.add_to(weight * rest, &mut forces.contact);
                        slip.add_to(weight * pair.tangential.traction, &mut forces.friction);
                        match self.stick_spring(k, pair) {
                            Some(stiffness) => {
                                *stick_springs += 0.5 * pair.tangential.traction.powi(2) / stiffness;
                            }
                            None if sign == 0.0 => {
                                (measure.gap, measure.friction) = (measure.gap.max(slip.gap.abs()), true);
                            }
                            None => {}
                        }
                    } else {
                        slips.push_open();
                    }
                }
                if answer.active {
                    let along = if discrete_gradients.is_empty() { row } else { discrete_gradients.row(p) };
                    along.add_to(weight * answer.lambda, &mut forces.contact);
                    measure.gap = measure.gap.max(answer.open.abs());
                }
                *springs += answer.energy;
                answers.push(answer);
            }
        }
        *springs += *stick_springs;
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

    /// ∂r/∂y · `change` of bodies and loads at an iterate, without contact; exact and not
    /// symmetrised.
    ///
    /// # Errors
    /// A cell is inverted.
    pub(crate) fn product_into(
        &self,
        now: &Evaluation,
        change: &[f64],
        product: &mut [f64],
        timings: &mut Timings,
    ) -> Result<(), Rejected> {
        let Self { model, state, .. } = self;
        let (before, at) = if self.between() { (Some(&state.y[..]), &now.y) } else { (None, &now.place) };
        timed(&mut timings.assembly, || model.internal_product(before, at, change, product))
            .map_err(|(body, inverted)| Rejected::Inverted { body, inverted })?;
        let (mass, stiffness, d) = (self.mass_factor(), self.stiffness_factor(), model.dimension);
        model.mass.add_product(change, mass, stiffness, product);
        if model.loads.follow_sides() {
            let factor = self.follower_factor();
            model.loads.each_facet_tangent(d, Some(&self.loads), |nodes, tangent| {
                let dofs: Vec<usize> = nodes.iter().flat_map(|n| (0..d).map(move |i| n * d + i)).collect();
                for (dof, row) in dofs.iter().zip(tangent.chunks_exact(dofs.len())) {
                    product[*dof] -=
                        factor * row.iter().zip(&dofs).map(|(k, other)| k * change[*other]).sum::<f64>();
                }
            });
        }
        Ok(())
    }
}
