//! Central differences with a lumped mass, contact by forward increments (Carpenter, Taylor, Katona
//! 1991), and Paoli and Schatzman's law (2002).
//!
//! ```text
//! M (v_{n+½} − v_{n−½}) = Δt (f_n + G_nᵀP_n),   y_{n+1} = y_n + Δt v_{n+½}
//! 0 ≤ P_n ⊥ g(ȳ) ≥ 0,   ȳ = (y_{n+1} + e y_{n−1})/(1 + e),   central-difference: e = 0
//! ```
//!
//! P_n prevents penetration at y_{n+1}, and is the force at t_n: it acts along G_n = ∇g(y_n), as in
//! SHAKE (Ryckaert, Ciccotti, Berendsen 1977), so that force and moment balance at t_n. With
//! linearised g, P solves a small complementarity problem with G M⁻¹Gᵀ; the linearisation is
//! repeated until every gap agrees to 1e-12 L.
//!
//! The state at t_n therefore includes v_{n+½} and with it P_n, v_n = (v_{n−½} + v_{n+½})/2 =
//! (y_{n+1} − y_{n−1})/2Δt, and a_n; M a_n + f_int − f_ext − G_nᵀP_n = 0 in every row of the
//! record. Works and the impulse of contact follow the trapezoidal rule, which is exact for
//! momentum and gives, with R = M a,
//!
//! ```text
//! Δ dissipation = Δy·½(f_int,n + f_int,n+1) − ΔU − Δt²/8 Δ(a·M a)
//! ```
//!
//! The law lets a node go behind its facet within a step, and takes it out in the next one. In
//! shorter steps Δt < H that follow a step of H it is taken out at the same rate,
//! g(y_{n+1}) ≥ (1 − Δt/H) g(y_n): within Δt it would be thrown out with g/Δt.
//!
//! With friction Q acts along H_n, the row of the slip (`friction.rs`), and its law is that of the
//! mean slip rate H_n v_{n+½}: P and Q solve one small problem (`carom_algebra::Cone`).
//!
//! The first step, and one of another size, starts with v_{n−½} := v_n − Δt/2 M⁻¹f_n; a contact
//! force at t_n then acts over a whole step.

use super::finish::Finish;
use super::increments::Increments;
use super::tied_mass::TiedMass;
use super::watch::{approach, depth};
use super::{Accepted, StepReport, Stepper};
use crate::ledger::book_materials;
use crate::model::Model;
use crate::rejected::Rejected;
use crate::stability::{SAFETY, lumped};
use crate::state::{HalfStepVelocity, State};
use crate::timings::timed;
use crate::works;
use crate::workspace::Workspace;
use carom_solid::Configuration;

/// Dofs of a task of a thread.
const BLOCK: usize = 1 << 14;
/// Work of internal forces, relative to the energies, that may be round-off.
const ROUND_OFF: f64 = 1e-12;

/// The explicit stepper.
pub struct Explicit {
    /// Mass per dof.
    mass: Vec<f64>,
    /// 1/m per dof; zero if constrained.
    inverse_mass: Vec<f64>,
}

impl Explicit {
    /// A stepper for a model with lumped masses.
    pub fn new(model: &Model) -> Self {
        let mass = lumped(model);
        let inverse = |(mass, constrained): (&f64, &bool)| if *constrained { 0.0 } else { mass.recip() };
        Self { inverse_mass: mass.iter().zip(&model.fixed).map(inverse).collect(), mass }
    }

    /// Updates the kinetic energy ½ Σ m v².
    fn book_kinetic(&self, model: &Model, state: &mut State) {
        let [doubled] = model.threads.sums([&self.mass, &state.v], |[m, v]| [m * v * v]);
        state.ledger.kinetic = 0.5 * doubled;
    }
}

impl Stepper for Explicit {
    fn step(
        &self,
        model: &Model,
        state: &State,
        dt: f64,
        to: f64,
        work: &mut Workspace,
    ) -> Result<Accepted, Rejected> {
        if work.explicit.ties.is_none() {
            work.explicit.ties = TiedMass::new(model, &self.inverse_mass)?;
        }
        let mut report = StepReport::default();
        let mut begun = None;
        if state.half_step.dt != dt {
            let mut state = work.copy(state);
            self.begin(model, &mut state, dt, work, &mut report)?;
            begun = Some(state);
        }
        let start = begun.as_ref().unwrap_or(state);
        let mut next = work.following(start);
        model.threads.for_each_block(&mut next.y, BLOCK, |first, block| {
            let before = start.y[first..].iter().zip(&start.half_step.velocity[first..]);
            block.iter_mut().zip(before).for_each(|(now, (y, v))| *now = y + dt * v);
        });
        let at = Configuration { before: None, y: &next.y, past: start.materials.past(dt) };
        next.ledger.strain = timed(&mut work.timings.assembly, || {
            model.internal_force(&at, &mut next.f_internal, &mut next.materials)
        })
        .map_err(|(body, inverted)| Rejected::Inverted { body, inverted })?;
        self.check_stability(model, start, &next, dt)?;
        model.loads_into(to, &next.y, &mut work.explicit.loads, &mut next.f_external)?;
        next.time = to;
        self.advance_half_step(model, &mut next, &start.half_step.velocity, dt, work, &mut report)?;
        self.record_work(model, start, &mut next, dt);

        // Positions were admissible when they were predicted; a node handed over since may be
        // behind its new facet by a fraction of its sliding distance.
        let bound = depth(model, start) + approach(model, &start.half_step.velocity, dt);
        if let Some(state) = begun {
            work.put(state);
        }
        let leaves = Some(bound);
        let finish = Finish {
            model,
            start: state,
            dt,
            carried: 0.0,
            leads: [0.0; 2],
            means: false,
            impulses: works::Works::default(),
            paths: Vec::new(),
            previous: None,
            leaves,
        };
        finish.accept(next, report, work)
    }
}

impl Explicit {
    /// Rejects a step that is certain to exceed the stability limit of the bodies as they are
    /// deformed: Rayleigh's quotient Δy·Δf_int/Δy·MΔy of the mean tangent is at most its largest
    /// ω², and beyond 4/Δt² only if that is. Motion that grows comes to consist of such modes.
    fn check_stability(&self, model: &Model, start: &State, next: &State, dt: f64) -> Result<(), Rejected> {
        let moved =
            |[inverse_mass, before, now]: [f64; 3]| if inverse_mass > 0.0 { now - before } else { 0.0 };
        let [stiffness, inertia] = model.threads.sums(
            [&self.mass, &self.inverse_mass, &start.y, &next.y, &start.f_internal, &next.f_internal],
            |[m, inverse, before, now, pulled, pulls]| {
                let moved = moved([inverse, before, now]);
                [moved * (pulls - pulled), m * moved * moved]
            },
        );
        let round_off = ROUND_OFF * (start.ledger.kinetic + start.ledger.strain);
        if dt * dt * stiffness > 4.0 * inertia && stiffness > round_off {
            return Err(Rejected::Unstable { longest: 2.0 * (inertia / stiffness).sqrt() });
        }
        Ok(())
    }

    /// How much contact raises the energy M v·v/2 in a step in which its forces change from
    /// those of `start` to those of `next` and do this work, up to what it has taken so far: with
    /// restitution nodes turn over several steps, and the velocity between those that the law
    /// relates, a mean of them, may be zero. With a_c = −M⁻¹f_contact the rise is
    ///
    /// ```text
    /// Δt v_{n+½}·M(a_c,n + a_c,n+1)/2 + Δt²/8 Δ(2 a·M a_c − a_c·M a_c)
    /// ```
    fn returned(&self, model: &Model, [start, next]: [&State; 2], dt: f64, work: f64) -> f64 {
        let turns = |state: &State| {
            let of = [&self.inverse_mass[..], &state.a, &state.f_contact];
            let [sum] = model.threads.sums(of, |[inverse, a, f]| [-f * (2.0 * a + inverse * f)]);
            0.125 * dt * dt * sum
        };
        let taken = -(start.ledger.contact_work + start.ledger.friction_work);
        (work + turns(next) - turns(start)).min(taken)
    }

    /// Works and the impulse of contact over a step, by the trapezoidal rule.
    fn record_work(&self, model: &Model, start: &State, next: &mut State, dt: f64) {
        let ledger = &mut next.ledger;
        if !model.loads.is_empty() {
            for (i, (before, now)) in start.f_external.iter().zip(&next.f_external).enumerate() {
                ledger.external_work += dt * start.half_step.velocity[i] * 0.5 * (before + now);
            }
        }
        book_materials(next);
        let in_contact = |state: &State| state.pairs.iter().flatten().any(|pair| pair.active);
        let touches = in_contact(start) || in_contact(next);
        let work = |before: &[f64], now: &[f64]| {
            // Forces of friction are empty without.
            if before.is_empty() || now.is_empty() {
                return 0.0;
            }
            let of = [&start.half_step.velocity[..], before, now];
            let [work] = model.threads.sums(of, |[v, before, now]| [dt * v * 0.5 * (before + now)]);
            work
        };
        let of_contact = if touches { -work(&start.f_contact, &next.f_contact) } else { 0.0 };
        if touches {
            let friction = work(&start.f_friction, &next.f_friction);
            next.ledger.contact_work += of_contact + friction;
            next.ledger.friction_work -= friction;
        }
        next.ledger.potential = model.potential(&next.y);
        // Twice the kinetic energy, and a·M a at both ends.
        let of = [&self.mass[..], &next.v, &next.a, &start.a];
        let [moving, now, before] =
            model.threads.sums(of, |[m, v, now, before]| [m * v * v, m * now * now, m * before * before]);
        let lent = self.lent(model, next, dt, now) - self.lent(model, start, dt, before);
        if touches && model.contacts.iter().any(|contact| contact.restitution > 0.0) {
            // A part of what returns may be lent already.
            let returned = self.returned(model, [start, next], dt, of_contact);
            next.ledger.unbooked += f64::max(0.0, returned - lent);
        }
        let State { impulses, contact_forces, .. } = next;
        for ((before, now), impulse) in start.contact_forces.iter().zip(contact_forces).zip(impulses) {
            for i in 0..3 {
                impulse[i] += 0.5 * dt * (before[i] + now[i]);
            }
        }
        // Gaps are closed to a tolerance, over which the work of their forces is not known.
        let pressed = |state: &State| state.pairs.iter().flatten().map(|pair| -pair.lambda).sum::<f64>();
        next.ledger.unbooked += model.gap_tolerance * (pressed(start) + pressed(next));
        next.ledger.unbooked += lent;
        next.ledger.kinetic = 0.5 * moving;
    }

    /// The part Δt²/8 a·M a of M v·v/2 that the works of a step do not contain: v_n is the mean of
    /// the half steps, and v_{n−½}·M v_{n+½}/2 changes by the works. A step of a share of the limit
    /// lends at most the square of that share of the strain energy, and Δt²/8 f·M⁻¹f of the loads:
    /// what grows beyond is instability. `inertia` is a·M a.
    fn lent(&self, model: &Model, state: &State, dt: f64, inertia: f64) -> f64 {
        let factor = 0.125 * dt * dt;
        let loads = if model.loads.is_empty() {
            0.0
        } else {
            model.threads.sums([&self.inverse_mass, &state.f_external], |[m, f]| [m * f * f])[0]
        };
        (factor * inertia).min(SAFETY * SAFETY * state.ledger.strain + factor * loads)
    }

    /// Initialises the half-step velocity for a step of this size, from positions and velocities.
    fn begin(
        &self,
        model: &Model,
        state: &mut State,
        dt: f64,
        work: &mut Workspace,
        report: &mut StepReport,
    ) -> Result<(), Rejected> {
        let mut free = Vec::new();
        self.accelerate_freely(model, state, &mut work.explicit.ties, &mut free);
        let before: Vec<f64> = state.v.iter().zip(&free).map(|(v, a)| v - 0.5 * dt * a).collect();
        let velocity = state.v.clone();
        let kinetic = state.ledger.kinetic;
        let last = state.half_step.dt;
        let inertia = |a: &[f64]| model.threads.sums([&self.mass, a], |[m, a]| [m * a * a])[0];
        // Before the first step nothing is lent but by the forces without contact.
        let lent = if last > 0.0 {
            self.lent(model, state, last, inertia(&state.a))
        } else {
            self.lent(model, state, dt, inertia(&free))
        };
        self.advance_half_step(model, state, &before, dt, work, report)?;
        if state.pairs.iter().flatten().all(|p| !p.active) {
            // Without contact v_n remains bitwise unchanged.
            state.v = velocity;
        }
        // Half of the step of the contact force precedes t_n: a jump there, which works like the
        // first half of every step.
        self.book_kinetic(model, state);
        // A shorter step lends less, and what is not lent any more is created.
        state.ledger.unbooked += self.lent(model, state, dt, inertia(&state.a)) - lent;
        report.begun = state.ledger.kinetic - kinetic;
        let of_half = |force: &[f64]| 0.5 * dt * before.iter().zip(force).map(|(v, f)| v * f).sum::<f64>();
        let friction = of_half(&state.f_friction);
        state.ledger.contact_work -= of_half(&state.f_contact) - friction;
        state.ledger.friction_work -= friction;
        for (impulse, force) in state.impulses.iter_mut().zip(&state.contact_forces) {
            for i in 0..3 {
                impulse[i] += 0.5 * dt * force[i];
            }
        }
        Ok(())
    }

    /// Accelerations without contact, into `a`.
    fn accelerate_freely(&self, model: &Model, state: &State, ties: &mut Option<TiedMass>, a: &mut Vec<f64>) {
        a.resize(state.y.len(), 0.0);
        let State { f_external, f_internal, .. } = state;
        model.threads.for_each_block(a, BLOCK, |first, block| {
            for (k, a) in block.iter_mut().enumerate() {
                let i = first + k;
                *a = self.inverse_mass[i] * (model.gravity[i] + f_external[i] - f_internal[i]);
            }
        });
        if let Some(ties) = ties {
            ties.correct(model, &self.inverse_mass, a);
        }
    }

    /// Computes contact forces, a_n, v_n and v_{n+½} from y_n and f_int,n in `state` and v_{n−½}.
    fn advance_half_step(
        &self,
        model: &Model,
        state: &mut State,
        before: &[f64],
        dt: f64,
        work: &mut Workspace,
        report: &mut StepReport,
    ) -> Result<(), Rejected> {
        let mut free = std::mem::take(&mut state.a);
        self.accelerate_freely(model, state, &mut work.explicit.ties, &mut free);
        state.a = free;
        if model.contacts.is_empty() {
            let State { a, v, half_step, .. } = state;
            half_step.velocity.resize(before.len(), 0.0);
            let blocks = half_step.velocity.chunks_mut(BLOCK).zip(v.chunks_mut(BLOCK));
            model.threads.for_each(blocks, |block, (half, v)| {
                let first = block * BLOCK;
                for k in 0..half.len() {
                    half[k] = before[first + k] + dt * a[first + k];
                    v[k] = before[first + k] + 0.5 * dt * a[first + k];
                }
            });
            half_step.longest = dt;
            half_step.dt = dt;
            return Ok(());
        }
        let mut velocity = std::mem::take(&mut state.half_step.velocity);
        let Workspace { explicit: scratch, timings, .. } = work;
        let is_behind = timed(&mut timings.contact, || {
            let step = Increments { model, state, before, dt, inverse_mass: &self.inverse_mass };
            step.solve(&mut velocity, scratch, report)
        })?;
        let dependent = std::mem::take(&mut report.dependent);
        report.dependent = work.tell(dependent);
        let Workspace { explicit: scratch, .. } = work;
        let HalfStepVelocity { longest, .. } = &mut state.half_step;
        *longest = if is_behind { longest.max(dt) } else { dt };

        state.take_pairs(&scratch.pairings);
        scratch.add_up(model, state);
        let State { a, v, f_contact, .. } = state;
        let contact = |i: usize| self.inverse_mass[i] * f_contact[i];
        let tied = scratch.ties.as_mut().map(|ties| {
            let mut pushed: Vec<f64> = (0..a.len()).map(contact).collect();
            ties.correct(model, &self.inverse_mass, &mut pushed);
            pushed
        });
        model.threads.for_each(a.chunks_mut(BLOCK).zip(v.chunks_mut(BLOCK)), |block, (a, v)| {
            let first = block * BLOCK;
            for k in 0..a.len() {
                a[k] -= tied.as_ref().map_or_else(|| contact(first + k), |pushed| pushed[first + k]);
                v[k] = before[first + k] + 0.5 * dt * a[k];
            }
        });
        (state.half_step.velocity, state.half_step.dt) = (velocity, dt);
        Ok(())
    }
}
