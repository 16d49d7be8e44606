//! A stage as a system of equations: the balance of forces and the contact conditions, evaluated at
//! an iterate.
//!
//! ```text
//! r(d, λ) = 0   (balance.rs),   c(d, λ) = 0 for each active pair   (carom_contact::Interface)
//! ```

use std::sync::Arc;

use carom_contact::Law;
use carom_solid::Configuration;
use carom_time::{Internal, Stage};

use crate::contact::augmented;
use crate::model::{LoadsAt, Model, Prescribed};
use crate::rejected::Rejected;
use crate::stage::balance::{imbalance_into, known_into, mean_acceleration, residual_into};
use crate::stage::evaluation::{Evaluation, Iterate, Spare};
use crate::stage::renewal::Point as FactorPoint;
use crate::state::State;
use crate::timings::{Timings, timed};

/// Dofs that a thread moves.
const BLOCK: usize = 4096;

/// The equations of a stage.
#[derive(Debug)]
pub struct Equations<'a> {
    /// Bodies, loads and contacts.
    pub model: &'a Model,
    /// The state at the step's start.
    pub state: &'a State,
    /// The weights of its balance, and its acceleration.
    pub stage: Stage,
    /// The time at which internal forces are evaluated.
    pub time: f64,
    /// The loads then.
    pub loads: LoadsAt,
    /// Prescribed dofs at the stage's end.
    pub motions: Vec<Prescribed>,
    /// Terms of the balance known from the step's start.
    pub known: Vec<f64>,
    /// Laws of friction of the secondary nodes of each contact: at the stage's end, or where
    /// forces are discrete gradients over the step, in the middle of it.
    pub laws: Vec<Vec<Law>>,
    /// Stiffnesses of augmented Lagrangians at the secondary nodes of each contact, normal and
    /// tangential.
    pub augmented: Vec<Vec<[f64; 2]>>,
    /// Time since the step's start.
    pub duration: f64,
}

impl<'a> Equations<'a> {
    /// The equations of a stage that ends at the time `to`.
    ///
    /// # Errors
    /// If a load or a motion has no value.
    pub fn new(model: &'a Model, state: &'a State, stage: Stage, to: f64) -> Result<Self, Rejected> {
        let average = stage.average;
        let time = if average == 0.0 { to } else { (1.0 - average) * to + average * state.time };
        let is_mean = stage.internal == Internal::DiscreteGradient;
        let laws = model.friction_laws(if is_mean { time } else { to }, &state.pairs)?;
        let mut equations = Self {
            model,
            state,
            stage,
            time,
            loads: LoadsAt::default(),
            motions: Vec::new(),
            known: Vec::new(),
            laws,
            augmented: Vec::new(),
            duration: to - state.time,
        };
        if !model.loads.is_empty() {
            model.loads.at(&model.parts, model.dofs(), time, &mut equations.loads)?;
        }
        model.motions.at(to, &mut equations.motions)?;
        known_into(model, &equations.stage, state, &mut equations.known);
        let factors = [equations.mass_factor(), equations.stiffness_factor()];
        equations.augmented = augmented::springs(model, &equations.stage, factors);
        Ok(equations)
    }

    /// Makes a load step that ends before `end` leave its share of what its start lacks of balance.
    pub(crate) fn fade_until(&mut self, end: f64) {
        let left = end - self.time;
        if left > 0.0 {
            let share = left / (end - self.state.time);
            imbalance_into(self.model, self.state, share, &mut self.known);
        }
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
        let follows = self.model.loads.follow_sides();
        let [follower, time] = if follows { [self.follower_factor(), self.time] } else { [0.0; 2] };
        let mass = self.mass_factor();
        let stiffness = self.factor_stiffness();
        let at = at.to_vec();
        let boundary = boundary.to_vec();
        let memory = self.state.materials.memory.clone();
        let dt = if memory.is_empty() { 0.0 } else { self.duration };
        Arc::new(FactorPoint { at, mass, stiffness, follower, time, memory, dt, boundary })
    }

    /// Prescribed dofs and their displacements in the step.
    fn prescribed(&self) -> impl Iterator<Item = (usize, f64)> {
        let to = |moved: &Prescribed| self.model.reference[moved.dof] + moved.motion[0];
        self.motions.iter().map(move |moved| (moved.dof, to(moved) - self.state.y[moved.dof]))
    }

    /// Remaining displacements of prescribed dofs.
    pub(crate) fn remaining(&self, at: &Iterate) -> impl Iterator<Item = (usize, f64)> {
        self.prescribed().map(|(dof, whole)| (dof, whole - at.increment[dof]))
    }

    /// Sets prescribed dofs, and the points that they carry, to their exact positions.
    pub(crate) fn arrive(&self, increment: &mut [f64]) {
        self.prescribed().for_each(|(dof, whole)| increment[dof] = whole);
        self.model.points.carry(increment);
    }

    /// Positions at which bodies respond, reached from the step's start.
    fn configuration<'b>(&'b self, y: &'b [f64]) -> Configuration<'b> {
        let before = self.between().then_some(&self.state.y[..]);
        Configuration { before, y, past: self.state.materials.past(self.duration) }
    }

    /// Forces, gaps and residual at an iterate.
    ///
    /// # Errors
    /// If a cell is inverted, or an active pair has no gap.
    pub fn evaluate(
        &self,
        at: Iterate,
        spare: &mut Spare,
        timings: &mut Timings,
    ) -> Result<Evaluation, Rejected> {
        let mut evaluation = spare.take();
        evaluation.at = at;
        self.fill(&mut evaluation, timings)?;
        Ok(evaluation)
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
        let increment = &at.increment;
        model.threads.for_each(y.chunks_mut(BLOCK).zip(place.chunks_mut(BLOCK)), |block, (y, place)| {
            let first = block * BLOCK;
            let start = state.y[first..].iter().zip(&increment[first..]);
            for ((y, place), (start, moved)) in y.iter_mut().zip(place).zip(start) {
                *y = start + moved;
                *place = start + share * moved;
            }
        });
        evaluation.strain = timed(&mut timings.assembly, || {
            let at = self.configuration(if self.between() { y } else { place });
            model.internal_force(&at, &mut forces.internal, &mut evaluation.materials)
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
            model.points.carry(acceleration);
        }
        model.mass.multiply_into(acceleration, &mut forces.inertia);
        self.change_contacts(evaluation, timings)
    }

    /// Contact forces, gaps and residual of an iterate whose pairs have changed.
    ///
    /// # Errors
    /// If an active pair has no gap.
    pub(crate) fn change_contacts(
        &self,
        evaluation: &mut Evaluation,
        timings: &mut Timings,
    ) -> Result<(), Rejected> {
        let Self { model, stage, .. } = self;
        timed(&mut timings.contact, || self.evaluate_contacts(evaluation))?;
        let Evaluation { forces, residual, measure, .. } = evaluation;
        (measure.residual, measure.forces) = residual_into(model, stage, forces, &self.known, residual);
        Ok(())
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
        let model = self.model;
        let at = self.configuration(if self.between() { &now.y } else { &now.place });
        timed(&mut timings.assembly, || model.internal_product(&at, change, product))
            .map_err(|(body, inverted)| Rejected::Inverted { body, inverted })?;
        let mass = self.mass_factor();
        let stiffness = self.stiffness_factor();
        let d = model.dimension;
        model.mass.add_product(change, mass, stiffness, product);
        if model.loads.follow_sides() {
            let factor = self.follower_factor();
            model.loads.each_facet_tangent(d, Some((&self.loads, &now.place)), |nodes, tangent| {
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
