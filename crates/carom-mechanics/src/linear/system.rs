//! The linear system of a model: its preconditioner, restored, prepared for the rows of an iterate
//! or formed anew, and the scales that follow from its diagonal.

use std::sync::Arc;

use carom_algebra::LinearError;
use carom_algebra::sums::max_abs;

use crate::contact::constraints::Constraints;
use crate::linear::direct::Direct;
use crate::linear::iterative::Iterative;
use crate::linear::preconditioner::Preconditioner;
use crate::model::Model;
use crate::rejected::Rejected;
use crate::settings::Linear;
use crate::stage::equations::Equations;
use crate::stage::evaluation::Evaluation;
use crate::stage::renewal::{Point, Renewal};
use carom_solid::Configuration;

/// The preconditioner of a model.
pub struct System {
    pub(crate) preconditioner: Box<dyn Preconditioner>,
    /// Tangents and masses formed so far.
    pub factorisations: u64,
    /// The point of the tangent of a resumed state, until one is formed.
    pub restored: Option<Arc<Point>>,
    /// The point of the last tangent that was assembled, whose diagonal gives the scales; none
    /// where nothing may depend on it.
    assembled: Option<Arc<Point>>,
}

impl System {
    /// For a model.
    pub(crate) fn new(model: &Model, linear: Linear) -> Self {
        let preconditioner: Box<dyn Preconditioner> = match linear {
            Linear::Direct => Box::new(Direct::new(model)),
            Linear::Iterative => Box::new(Iterative::new(model)),
        };
        Self { preconditioner, factorisations: 0, restored: None, assembled: None }
    }

    /// Diagonal of the tangent over the free dofs: force per unit of displacement.
    fn diagonal(&self, equations: &Equations) -> impl Iterator<Item = f64> + '_ {
        let [mass, stiffness] = self.preconditioner.diagonals();
        let mass_factor = equations.mass_factor();
        let stiffness_factor = if self.assembled.is_some() { equations.stiffness_factor() } else { 0.0 };
        mass.iter().zip(stiffness).map(move |(m, k)| mass_factor * m + stiffness_factor * k)
    }

    /// Round-off of the residual due to that of the positions: a body far from the origin knows
    /// them to fewer digits than its size suggests.
    pub(crate) fn round_off(&self, equations: &Equations) -> f64 {
        let reach = equations.model.scale.max(max_abs(&equations.state.y));
        16.0 * f64::EPSILON * reach * self.diagonal(equations).map(|d| d * d).sum::<f64>().sqrt()
    }

    /// Mean diagonal of the tangent: makes a gap comparable with a multiplier.
    pub(crate) fn mean_stiffness(&self, equations: &Equations) -> f64 {
        let sum: f64 = self.diagonal(equations).sum();
        // Without inertia there is no reference before the first tangent.
        if sum > 0.0 { sum / equations.model.free.len() as f64 } else { 1.0 }
    }

    /// Forms the tangent of a point unless that is done; `double`: in double precision. Returns
    /// whether it is positive definite.
    ///
    /// # Errors
    /// If a cell is inverted there, or a load has no value.
    pub(crate) fn tangent_at(
        &mut self,
        model: &Model,
        point: &Arc<Point>,
        double: bool,
    ) -> Result<bool, Rejected> {
        if let Some(positive) = self.preconditioner.of(point) {
            self.scale_at(model, point)?;
            return Ok(positive);
        }
        self.assembled = None;
        let positive = self.preconditioner.form(model, point, double)?;
        self.assembled = Some(point.clone());
        // That of a run that is resumed was counted when it was first formed.
        if self.restored.take().is_none_or(|restored| restored != *point) {
            self.factorisations += 1;
        }
        Ok(positive)
    }

    /// Starts a stage with the tangent of the state, which only a resumed run and a rejected step
    /// lack. Where another tangent is due, its diagonal is still needed: the scales of a stage must
    /// be functions of the state alone.
    ///
    /// # Errors
    /// If a cell is inverted there.
    pub(crate) fn start(&mut self, model: &Model, renewal: &Renewal) -> Result<(), Rejected> {
        let Some(point) = &renewal.frozen.point else {
            self.assembled = None;
            return Ok(());
        };
        if renewal.due {
            return self.scale_at(model, point);
        }
        self.tangent_at(model, point, renewal.double).map(|_| ())
    }

    /// Takes the scales from the tangent of a point, which is assembled unless that was done last.
    fn scale_at(&mut self, model: &Model, point: &Arc<Point>) -> Result<(), Rejected> {
        if self.assembled.as_ref() != Some(point) {
            self.assemble(model, &point.configuration())?;
            self.assembled = Some(point.clone());
        }
        Ok(())
    }

    /// Assembles the tangent of the internal forces at positions.
    ///
    /// # Errors
    /// If a cell is inverted there.
    pub(crate) fn assemble(&mut self, model: &Model, at: &Configuration) -> Result<(), Rejected> {
        self.assembled = None;
        self.preconditioner.assemble(model, at)
    }

    /// Prepares solves with a tangent and the rows of an iterate, with a new tangent if it is due.
    ///
    /// # Errors
    /// If a cell is inverted, or the rows are linearly dependent.
    pub(crate) fn prepare(
        &mut self,
        equations: &Equations,
        now: &Evaluation,
        rows: &Constraints,
        renewal: &mut Renewal,
    ) -> Result<(), Rejected> {
        for again in [true, false] {
            if renewal.due || !self.preconditioner.spans(equations.model, rows) {
                self.renew(equations, now, rows, renewal)?;
            }
            if self.preconditioner.prepare(equations.model, rows)? || !again {
                break;
            }
            renewal.due = true;
        }
        Ok(())
    }

    /// Forms the tangent at the current positions, or else at those of the step's start.
    fn renew(
        &mut self,
        equations: &Equations,
        now: &Evaluation,
        rows: &Constraints,
        renewal: &mut Renewal,
    ) -> Result<(), Rejected> {
        renewal.due = false;
        let model = equations.model;
        let last = renewal.frozen.point.as_deref();
        let boundary = self.preconditioner.boundary(model, &now.place, rows, last);
        // Far from the solution the tangent may be indefinite; with inertia, that at the step's
        // start is almost always positive definite.
        let [present, start] = [&now.place, &equations.state.y].map(|at| equations.point(at, &boundary));
        let mut chosen = &present;
        if !self.tangent_at(model, &present, renewal.double)? && !equations.stage.is_static() {
            chosen = &start;
            if !self.tangent_at(model, &start, renewal.double)? {
                chosen = &present;
                self.tangent_at(model, &present, renewal.double)?;
            }
        }
        if renewal.frozen.point.as_ref() != Some(chosen) {
            renewal.renewed(chosen.clone());
        }
        Ok(())
    }

    /// Whether the equilibrium of a load step is stable, where that is known: its tangent is
    /// positive definite for all motions that keep closed gaps closed.
    ///
    /// # Errors
    /// If the tangent has no factor there, or the rows are linearly dependent.
    pub(crate) fn is_stable(
        &mut self,
        equations: &Equations,
        now: &Evaluation,
        last: Option<&Point>,
    ) -> Result<Option<bool>, Rejected> {
        let model = equations.model;
        let rows = Constraints::of(equations, now);
        let boundary = self.preconditioner.boundary(model, &now.place, &rows, last);
        let point = equations.point(&now.place, &boundary);
        self.assembled = None;
        self.factorisations += 1;
        self.preconditioner.is_stable(model, &point, &rows)
    }

    /// Prepares solves with [M Gᵀ; G 0] over the free dofs that have mass.
    ///
    /// # Errors
    /// If M is not positive definite there, or the rows are linearly dependent.
    pub(crate) fn mass_with(&mut self, model: &Model, rows: &Constraints) -> Result<(), Rejected> {
        self.factorisations += 1;
        self.preconditioner.form_mass(model, rows)
    }

    /// See [`Preconditioner::solve`].
    pub(crate) fn solve(
        &mut self,
        model: &Model,
        right: [&[f64]; 2],
        increment: &mut [f64],
        multipliers: &mut Vec<f64>,
    ) -> Result<(), LinearError> {
        self.preconditioner.solve(model, right, increment, multipliers)
    }
}
