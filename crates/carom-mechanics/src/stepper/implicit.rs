//! Kernels that are lists of implicit stages: guess, solve, record, and project where contact or
//! stick begins. And single steps of backward Euler with contact implicit in velocity
//! (`in_velocity.rs`) in place of a step that is not accepted.

use std::collections::BTreeSet;

use carom_algebra::sums::dot;
use carom_contact::{Pairing, Rows};
use carom_time::schemes::backward_euler::BackwardEuler;
use carom_time::{Kernel, Memory, PreviousStep, Stage, Weights};

use super::finish::Finish;
use super::in_velocity::solve_in_velocity;
use super::meetings::Path;
use super::within::project_within;
use super::{Accepted, StepReport, Stepper, difference};
use crate::carried;
use crate::contact::update::{search, start_step};
use crate::friction_state::take_slips;
use crate::ledger;
use crate::model::{Contact, LoadsAt, Model};
use crate::rejected::{Rejected, SINGULAR};
use crate::settings::{Linear, Settings};
use crate::stage::equations::Equations;
use crate::stage::evaluation::Iterate;
use crate::stage::grip::solve_by_grip;
use crate::stage::newton::solve_stage;
use crate::state::{Means, Previous, State};
use crate::velocity::persistency::contact_forces_into;
use crate::works::{self, Works};
use crate::workspace::Workspace;
use carom_solid::Configuration;

/// The implicit stepper.
pub struct Implicit {
    kernel: Box<dyn Kernel>,
    settings: Settings,
    /// c of the momentum in accelerations (`carried.rs`).
    carried: f64,
    /// Whether contact is implicit in velocity.
    in_velocity: bool,
}

impl Implicit {
    /// A stepper for a kernel.
    pub fn new(kernel: Box<dyn Kernel>, settings: Settings) -> Self {
        Self { carried: kernel.carried(), kernel, settings, in_velocity: false }
    }

    /// A stepper for steps of backward Euler with contact implicit in velocity between those of a
    /// scheme that carries momentum in its accelerations with the factor `carried`
    /// ([`Kernel::carried`]).
    pub fn in_velocity(carried: f64, settings: Settings) -> Self {
        Self { kernel: Box::new(BackwardEuler), settings, carried, in_velocity: true }
    }
}

/// Motion at the end of a stage.
struct Point {
    y: Vec<f64>,
    v: Vec<f64>,
    a: Vec<f64>,
}

impl Stepper for Implicit {
    fn is_static(&self) -> bool {
        self.kernel.is_static()
    }

    fn linear(&self) -> Linear {
        self.settings.linear
    }

    fn step(
        &self,
        model: &Model,
        state: &State,
        dt: f64,
        to: f64,
        work: &mut Workspace,
    ) -> Result<Accepted, Rejected> {
        let previous = state.previous.as_ref().filter(|previous| previous.dt == dt);
        let mut next = work.copy(state);
        next.jumps.clear();
        let factor = self.carried;
        carried::change_step(&mut next, factor, dt);
        let mut report = StepReport::default();
        let mut finished: Vec<Point> = Vec::new();
        let mut means = Means::new(model.dofs(), model.contacts.len());
        let mut guess = Iterate::at_start(state);
        start_step(model, &state.y, &mut guess.pairings);
        let shift = self.predictor_shift(model, state, dt, to, work)?;
        let mut end = 0.0;
        let mut ends = vec![state.time];
        let mut last = None;
        for k in 0..self.kernel.stages() {
            let mut stage = self.stage(k, dt, state, &finished);
            if let Some(shift) = &shift {
                for map in [&mut stage.velocity, &mut stage.acceleration] {
                    map.at_start.iter_mut().zip(shift).for_each(|(at_start, c)| *at_start -= map.slope * c);
                }
            }
            let time = if stage.end == 1.0 { to } else { state.time + stage.end * dt };
            let mut equations = Equations::new(model, state, stage, time)?;
            if let Some(end) = work.fade_until {
                equations.fade_until(end);
            }
            let before = finished.last().map_or(&state.y, |point| &point.y);
            guess.predict(&next.v, &next.a, (equations.stage.end - end) * dt);
            if goes_on(&equations)
                && let Some(previous) = &state.previous
            {
                guess.extrapolate(&previous.increment, dt / previous.dt);
            }
            end = equations.stage.end;
            ends.push(time);
            let (mut solved, effort) = if self.in_velocity {
                solve_in_velocity(&equations, dt, &self.settings, guess.pairings, work)?
            } else if equations.stage.is_static() && model.has_friction() {
                let again = guess.clone();
                let solved = solve_stage(&equations, &next.frozen, before, &self.settings, guess, work);
                solved.or_else(|rejected| {
                    solve_by_grip(&mut equations, &next.frozen, before, &self.settings, again, work)
                        .map_err(|_| rejected)
                })?
            } else {
                solve_stage(&equations, &next.frozen, before, &self.settings, guess, work)?
            };
            report.newton += effort.iterations;
            if let Some(regularity) = effort.regularity.filter(|regularity| *regularity < SINGULAR) {
                report.ambiguity = Some(report.ambiguity.map_or(regularity, |before| before.min(regularity)));
            }
            report.unstable |= effort.unstable;
            report.dependent.extend(effort.dependent);
            report.events.extend(effort.events);
            next.frozen = effort.frozen;
            next.a.clone_from(&solved.acceleration);
            equations.stage.velocity.value_into(&solved.at.increment, &mut next.v);
            take_motions(&equations, &mut next);
            let is_last = k + 1 == self.kernel.stages();
            let projected =
                if is_last { None } else { project_within(&equations, &mut solved, &mut next, work)? };
            report.projected_within |= projected.is_some();
            let contact_forces = projected.unwrap_or_else(|| ledger::contact_forces(model, &solved));
            ledger::add_stage(&equations, &solved, &contact_forces, previous, &mut means);
            guess = work.spare.copy(&solved.at);
            if is_last {
                last = Some((equations, solved));
            } else {
                finished.push(Point { y: solved.y.clone(), v: next.v.clone(), a: next.a.clone() });
                work.spare.put(solved);
            }
        }
        let Some((equations, solved)) = last else {
            return Err(Rejected::NotFinite { what: "a scheme of no stages" });
        };

        next.time = to;
        next.y.clone_from(&solved.y);
        for (i, massless) in model.massless.iter().enumerate() {
            if *massless && !equations.stage.is_static() {
                // Without inertia there is no integration: the velocity is the mean one, the
                // acceleration zero.
                (next.v[i], next.a[i]) = (solved.at.increment[i] / dt, 0.0);
            }
        }
        take_motions(&equations, &mut next);
        next.take_pairs(&solved.at.pairings);
        take_slips(&equations, &solved, &mut next);
        next.open_covered(model);
        next.f_external.clone_from(&solved.forces.loads);
        next.f_internal.clone_from(&solved.forces.internal);
        let mut strain = solved.strain;
        next.materials.accept(&solved.materials);
        if equations.stage.average != 0.0 {
            let past = state.materials.past(dt);
            let reached = Configuration { before: None, y: &next.y, past };
            strain = model
                .internal_force(&reached, &mut next.f_internal, &mut next.materials)
                .map_err(|(body, inverted)| Rejected::Inverted { body, inverted })?;
            model.loads_into(to, &next.y, &mut LoadsAt::default(), &mut next.f_external)?;
        }
        contact_forces_into(model, &mut next, &solved.rows);
        ledger::account(&equations, &solved, &mut next, strain, dt, &means);
        let impulses = if self.in_velocity || equations.stage.is_static() {
            Works::default()
        } else {
            let closing: BTreeSet<usize> = difference(&next, state).into_iter().map(|(k, _)| k).collect();
            Works::beyond_path(&equations, &solved, &next, dt, (&means, &closing))
        };
        let accumulates = |contact: &Contact| contact.interface.direction().accumulates();
        let conserves = model.contacts.iter().any(accumulates);
        let differs = model.has_friction() && (self.kernel.stages() > 1 || equations.stage.is_static());
        if differs || conserves {
            ledger::keep_forces(model, &solved, &mut next);
        }
        if self.in_velocity {
            carried::replace(&mut next, factor, &means.contact_forces);
        } else if factor != 0.0 {
            let weights = [equations.stage.weights.mass, equations.stage.before.mass];
            carried::advance(&mut next, &means.contact_forces, weights);
        }
        if let Some(shift) = &shift {
            // Work on positions shifted by the predictor's contact: the forces of the step sum to M
            // (v − v_s)/Δt.
            let change: Vec<f64> = next.v.iter().zip(&state.v).map(|(v, old)| (v - old) / dt).collect();
            let mut forces = vec![0.0; model.dofs()];
            model.mass.multiply_into(&change, &mut forces);
            next.ledger.contact_work -= dot(shift, &forces);
        }
        for (k, contact) in model.contacts.iter().enumerate().filter(|(_, contact)| accumulates(contact)) {
            debug_assert_eq!(next.pairs[k].len(), solved.rows[k].len(), "contact {}", contact.name);
            // The next step continues from the accumulated gap.
            let gaps = solved.rows[k].iter().map(|row| Some(row.gap));
            next.pairs[k].iter_mut().zip(gaps).for_each(|(pair, gap)| pair.start = gap);
        }

        let stage = &equations.stage;
        let is_ahead = stage.works_at_both_ends && !stage.is_static();
        let leads = if is_ahead { works::leads(stage, dt) } else { [0.0; 2] };
        let keeps = self.kernel.two_step() || goes_on(&equations);
        let previous = keeps.then(|| Previous {
            dt,
            increment: solved.at.increment.clone(),
            velocity: state.v.clone(),
            means,
        });
        work.spare.put(solved);
        let paths = paths(state, &finished, &ends);
        let finish = Finish {
            model,
            start: state,
            dt,
            carried: factor,
            leads,
            means: equations.between(),
            impulses,
            paths,
            previous,
            leaves: None,
        };
        finish.accept(next, report, work)
    }
}

impl Implicit {
    /// The law "predictor" (P. Deuflhard, R. Krause, S. Ertel, Int. J. Numer. Meth. Engng 73 (2008)
    /// 1274–1290): y_s + Δt v_s in Newmark's formula is replaced by the nearest admissible point in
    /// the mass norm,
    ///
    /// ```text
    /// min ½ ‖q − (y_s + Δt v_s)‖²_M   with   g(q) ≥ 0
    /// ```
    ///
    /// and velocities are not affected by the difference. It is solved as a separate stage. Returns
    /// q − (y_s + Δt v_s), or none if nothing would penetrate.
    fn predictor_shift(
        &self,
        model: &Model,
        state: &State,
        dt: f64,
        to: f64,
        work: &mut Workspace,
    ) -> Result<Option<Vec<f64>>, Rejected> {
        if !model.contacts.iter().any(|contact| contact.predictor) {
            return Ok(None);
        }
        let mut stage = Stage::default();
        stage.at_the_end(1.0, [0.0, 0.0, 1.0]);
        stage.weights = Weights { mass: 1.0, internal: 0.0, external: 0.0, contact: 1.0 };
        stage.acceleration.slope = 1.0 / (dt * dt);
        let mut equations = Equations::new(model, state, stage, to)?;
        let mut guess = Iterate::at_start(state);
        guess.predict(&state.v, &vec![0.0; model.dofs()], dt);
        // A support takes its prescribed position regardless of contact.
        equations.arrive(&mut guess.increment);
        let free = guess.increment.clone();
        equations.stage.acceleration.at_start = free.iter().map(|d| -d / (dt * dt)).collect();
        equations.stage.velocity.at_start = vec![0.0; model.dofs()];
        for pair in guess.pairings.iter_mut().flat_map(|pairing| &mut pairing.pairs) {
            pair.lambda = 0.0;
        }
        let y: Vec<f64> = state.y.iter().zip(&free).map(|(y, d)| y + d).collect();
        if !penetrates(model, &state.y, &y, &mut guess.pairings) {
            return Ok(None);
        }
        let (solved, _) = solve_stage(&equations, &state.frozen, &state.y, &self.settings, guess, work)?;
        let shift = solved.at.increment.iter().zip(&free).map(|(d, free)| d - free).collect();
        work.spare.put(solved);
        Ok(Some(shift))
    }

    /// Stage `k` of a step.
    fn stage(&self, k: usize, dt: f64, state: &State, finished: &[Point]) -> Stage {
        let mut states: Vec<(&[f64], &[f64], &[f64])> = vec![(&state.y, &state.v, &state.a)];
        states.extend(finished.iter().map(|p| (&p.y[..], &p.v[..], &p.a[..])));
        let previous = state.previous.as_ref().filter(|previous| previous.dt == dt);
        let before = previous.map(|p| PreviousStep { increment: &p.increment, velocity: &p.velocity });
        let mut stage = Stage::default();
        self.kernel.stage_into(k, dt, &Memory { states: &states, before }, &mut stage);
        stage
    }
}

/// The stages as parts of a step, from the state and the points at which they begin.
fn paths<'a>(state: &'a State, finished: &'a [Point], ends: &[f64]) -> Vec<Path<'a>> {
    let first: [&[f64]; 3] = [&state.y, &state.v, &state.a];
    let starts = std::iter::once(first).chain(finished.iter().map(|p| [&p.y[..], &p.v[..], &p.a[..]]));
    starts.zip(ends.windows(2)).map(|(start, ends)| Path { start, from: ends[0], to: ends[1] }).collect()
}

/// Whether the guess of a stage goes on as the last step went. At the start of a load step the
/// points that flowed last lie on the yield surface, and round-off decides whether their tangent is
/// that of flow or the elastic one: Newton's method from there does not find the equilibrium of a
/// bar that necks.
fn goes_on(equations: &Equations) -> bool {
    equations.stage.is_static() && equations.model.remembers()
}

/// Moving supports have their own velocities and accelerations, not the scheme's.
fn take_motions(equations: &Equations, next: &mut State) {
    for moved in equations.motions.iter().filter(|_| !equations.stage.is_static()) {
        [next.v[moved.dof], next.a[moved.dof]] = [moved.motion[1], moved.motion[2]];
    }
    equations.model.points.carry(&mut next.v);
    equations.model.points.carry(&mut next.a);
}

/// Whether any pair penetrates after motion from `before` to `now`.
fn penetrates(model: &Model, before: &[f64], now: &[f64], pairings: &mut [Pairing]) -> bool {
    search(model, before, now, pairings, &mut Vec::new());
    let mut rows = Rows::new(model.dimension);
    model.contacts.iter().zip(pairings).any(|(contact, pairing)| {
        pairing.pairs.iter_mut().any(|pair| {
            rows.clear();
            let found = contact.kinematics.measure(pair, now, &mut rows);
            found.is_ok() && rows.row(0).gap < -model.gap_tolerance
        })
    })
}
