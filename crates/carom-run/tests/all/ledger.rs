//! The ledger with friction and ties, in every case of `cases/friction` and `cases/tie`, against
//! what its scheme dissipates by a formula that knows neither contact nor friction. Equations of
//! motion summed with the increment Δy say what all forces from outside, contact and friction do;
//! what is left of the booked works after the change of the recomputed energies has to be
//!
//! ```text
//! Δy·M Δv/Δt − ΔK + Δy·F̄_int − ΔU                             stages, with their mean internal force
//! Δy·(P_s + P_s+1)/2 − ΔU − ΔK          α family, with the forces P that its balance needs, also in load steps
//! (Δy·F̄_int − ΔU) + Δy·M((1−α_m) a_s+1 + α_m a_s) − (½−α_f) Δy·ΔF_ext − Δt v̄·M((1−γ) a_s + γ a_s+1)     with jumps of v
//! Δy·F_int(y_½) − ΔU                                             Moreau and Jean's rule with θ = ½
//! Δy·(F_int,s + F_int,s+1)/2 − ΔU − Δ((v − Δy/Δt)·M(v − Δy/Δt))/2             central differences
//! ```
//!
//! with v before projections, v̄ the mean of those at both ends, and a without impulses.
//! Intermediate stages, of which a state knows nothing, follow from the velocity at the end of the
//! step, where no projection has changed it.

use std::collections::HashSet;
use std::path::Path;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

use carom_mechanics::Materials;
use carom_run::case::{BodySpec, Case};
use carom_run::model::Model;
use carom_run::stability::stable_step;
use carom_run::{GridReport, LogEvent, Setup, Simulation, State};
use carom_solid::Configuration;
use carom_time::{Impulse, Integrator, Kernel, Memory, Nonsmooth, Scheme, Stage};

use super::common::{case, dot};

/// The energies of a state, recomputed.
struct Energies {
    kinetic: f64,
    strain: f64,
    internal: Vec<f64>,
}

impl Energies {
    fn of(model: &Model, y: &[f64], v: &[f64]) -> Self {
        let mut internal = vec![0.0; model.dofs()];
        let strain =
            model.internal_force(&Configuration::at(y), &mut internal, &mut Materials::default()).unwrap();
        Self { kinetic: model.kinetic(v), strain, internal }
    }
}

fn times_mass(model: &Model, x: &[f64]) -> Vec<f64> {
    let mut product = vec![0.0; x.len()];
    model.mass.multiply_into(x, &mut product);
    product
}

fn sum(x: &[f64], factor: f64, y: &[f64]) -> Vec<f64> {
    x.iter().zip(y).map(|(x, y)| x + factor * y).collect()
}

/// Dissipation of a step of the α family: work of the forces that follow from its balance, with the
/// mean of both ends, less the change of the energies. None with contacts of both kinds, of which
/// the balance gives the sum alone.
pub(super) fn of_alpha(model: &Model, scheme: &Scheme, before: &State, now: &State, dt: f64) -> Option<f64> {
    let struck = struck(model, before, now);
    let moved = sum(&now.y, -1.0, &before.y);
    let mut a = sum(&moved, -dt, &before.v);
    a = sum(&a, -(0.5 - scheme.beta) * dt * dt, &before.a);
    a.iter_mut().for_each(|a| *a /= scheme.beta * dt * dt);
    let mut v = sum(&sum(&before.v, dt * (1.0 - scheme.gamma), &before.a), dt * scheme.gamma, &a);
    for dof in model.motions.dofs() {
        a[dof] = now.a[dof];
        v[dof] = now.v[dof];
    }
    let acts_at_end = model.contacts.iter().filter(|contact| contact.at_the_end).count();
    if acts_at_end > 0 && acts_at_end < model.contacts.len() {
        return None;
    }
    let [start, end] = [(&before.y, &before.v), (&now.y, &v)].map(|(y, v)| Energies::of(model, y, v));
    let mixed = |x: f64, y: f64, old: f64| old * x + (1.0 - old) * y;
    let mean_a: Vec<f64> =
        before.a.iter().zip(&a).map(|(old, new)| mixed(*old, *new, scheme.alpha_m)).collect();
    let inertia = times_mass(model, &mean_a);
    let change = times_mass(model, &sum(&v, -1.0, &before.v));
    let prescribed: Vec<usize> = model.motions.dofs().collect();
    // Share of the contact force at the step's end in the velocity update: γ (1 − α_f)/(1 − α_m).
    let weight = if acts_at_end > 0 { 1.0 } else { 1.0 - scheme.alpha_f };
    let share = scheme.gamma * weight / (1.0 - scheme.alpha_m);
    let work = |i: usize| {
        let internal = 0.5 * (start.internal[i] + end.internal[i]);
        if prescribed.contains(&i) {
            return moved[i] * (change[i] / dt + internal);
        }
        let load = |state: &State| model.gravity[i] + state.f_external[i];
        let old = load(before) - before.f_contact[i];
        let balanced = inertia[i] + mixed(start.internal[i], end.internal[i], scheme.alpha_f);
        let new = if model.massless[i] {
            end.internal[i]
        } else if acts_at_end > 0 {
            balanced - mixed(load(before), load(now), scheme.alpha_f) + load(now)
        } else {
            (balanced - scheme.alpha_f * old) / (1.0 - scheme.alpha_f)
        };
        // An impulse works at the mean velocity, not along the path.
        let has_impulse = struck.contains(&(i / model.dimension)) && !model.massless[i];
        let contact = if has_impulse { load(now) - new - before.f_contact[i] } else { 0.0 };
        let beyond = contact * (0.5 * share * dt * (before.v[i] + v[i]) - 0.5 * moved[i]);
        0.5 * moved[i] * (old + new) - beyond
    };
    let worked: f64 = (0..moved.len()).map(work).sum();
    let alpha_f = if acts_at_end > 0 { 0.0 } else { scheme.alpha_f };
    let stored = end.strain - start.strain + end.kinetic - start.kinetic;
    let mut rubs = model.contacts.iter().filter(|contact| contact.friction.is_some());
    let on_springs = !rubs.all(|contact| contact.interface.is_constraint());
    let lag = if on_springs { friction_lag(before, now, alpha_f) } else { 0.0 };
    Some(worked + lag - stored)
}

/// The nodes of contacts whose velocities are projected and of which a gap has closed.
fn struck(model: &Model, before: &State, now: &State) -> HashSet<usize> {
    let strikes = |&k: &usize| {
        let was_closed = |node: usize| before.pairs[k].iter().any(|old| old.active && old.node == node);
        now.pairs[k].iter().any(|pair| pair.active && !was_closed(pair.node))
    };
    let contacts = (0..model.contacts.len()).filter(|k| model.contacts[*k].projects).filter(strikes);
    contacts.flat_map(|k| &model.contacts[k].surface).copied().collect()
}

/// Work of loads on the momentum in accelerations that a projection at the end of a step leaves to
/// the velocities, c Δy·x with (1 − α_m) x = (α_f − α_m) ΔF_ext − α_m x_s.
pub(super) fn kept_by_projection(scheme: &Scheme, before: &State, now: &State) -> f64 {
    let moved = sum(&now.y, -1.0, &before.y);
    let change = dot(&moved, &sum(&now.f_external, -1.0, &before.f_external));
    let ahead = (scheme.alpha_f - scheme.alpha_m) * change - scheme.alpha_m * before.ledger.relaxing;
    (1.0 - scheme.gamma - scheme.alpha_m) * ahead / (1.0 - scheme.alpha_m)
}

fn has_friction(model: &Model) -> bool {
    model.contacts.iter().any(|contact| contact.friction.is_some())
}

/// Work of friction on springs and in load steps, in the forces that follow from the balance, with
/// the mean of both ends, less that with its mean (1 − α_f) q_s+1 + α_f q_s, which is booked.
fn friction_lag(before: &State, now: &State, alpha_f: f64) -> f64 {
    let moved = sum(&now.y, -1.0, &before.y);
    let stored = now.ledger.stick_springs - before.ledger.stick_springs;
    let booked = stored - (now.ledger.friction_work - before.ledger.friction_work);
    let old = dot(&moved, &before.f_friction);
    let new = (booked - alpha_f * old) / (1.0 - alpha_f);
    0.5 * (old + new) - booked
}

/// What a step of one or two stages that end with a balance dissipates; none if a projection has
/// changed the velocity from which the middle follows.
fn of_stages(
    model: &Model,
    kernel: &dyn Kernel,
    before: &State,
    now: &State,
    dt: f64,
    projected: bool,
) -> Option<f64> {
    let moved = sum(&now.y, -1.0, &before.y);
    let start = (&before.y[..], &before.v[..], &before.a[..]);
    let stage = |k: usize, states: &[(&[f64], &[f64], &[f64])]| {
        let mut stage = Stage::default();
        kernel.stage_into(k, dt, &Memory { states, before: None }, &mut stage);
        stage
    };
    let first = stage(0, &[start]);
    let at = |stage: &Stage, moved: &[f64]| {
        let [mut v, mut a] = [vec![0.0; moved.len()], vec![0.0; moved.len()]];
        stage.velocity.value_into(moved, &mut v);
        stage.acceleration.value_into(moved, &mut a);
        (v, a)
    };
    let (v, means) = if kernel.stages() == 1 {
        let mut v = at(&first, &moved).0;
        // Those of moving supports are given.
        model.motions.dofs().for_each(|dof| v[dof] = now.v[dof]);
        (v, vec![(first.mean, now.y.clone())])
    } else if projected {
        return None;
    } else {
        // The velocity at the end is affine in the increment to the middle.
        let end = |middle: &[f64]| {
            let (v, a) = at(&first, middle);
            let y = sum(&before.y, 1.0, middle);
            let second = stage(1, &[start, (&y, &v, &a)]);
            (at(&second, &moved).0, second.mean)
        };
        let (none, one) = (vec![0.0; moved.len()], vec![dt; moved.len()]);
        let (without, mean) = end(&none);
        let with = end(&one).0;
        let middle: Vec<f64> =
            (0..moved.len()).map(|i| dt * (now.v[i] - without[i]) / (with[i] - without[i])).collect();
        (now.v.clone(), vec![(first.mean, sum(&before.y, 1.0, &middle)), (mean, now.y.clone())])
    };
    let [start, end] = [(&before.y, &before.v), (&now.y, &v)].map(|(y, v)| Energies::of(model, y, v));
    let mut work = 0.0;
    for ([_, at_start, at_end], y) in means {
        work += at_start * dot(&moved, &start.internal);
        work += at_end * dot(&moved, &Energies::of(model, &y, &v).internal);
    }
    if first.internal == carom_time::Internal::DiscreteGradient {
        work = end.strain - start.strain;
    }
    let inertia = times_mass(model, &sum(&v, -1.0, &before.v));
    if kernel.stages() == 1 {
        // An impulse works at the mean velocity, not along the path.
        let struck = struck(model, before, now);
        let has_impulse = |i: &usize| struck.contains(&(i / model.dimension));
        for i in (0..moved.len()).filter(has_impulse).filter(|i| !model.fixed[*i] && !model.massless[*i]) {
            let contact = model.gravity[i] + now.f_external[i] - end.internal[i] - inertia[i] / dt;
            work -= (0.5 * dt * (before.v[i] + v[i]) - moved[i]) * (contact - before.f_contact[i]);
        }
    }
    Some(dot(&moved, &inertia) / dt - (end.kinetic - start.kinetic) + work - (end.strain - start.strain))
}

/// What a step of Chung and Hulbert's scheme with jumps of the velocity dissipates, or one of
/// Moreau and Jean's rule with θ = ½.
fn of_impulses(model: &Model, scheme: &dyn Impulse, before: &State, now: &State, dt: f64) -> f64 {
    let moved = sum(&now.y, -1.0, &before.y);
    let strain = |y: &[f64]| Energies::of(model, y, &now.v);
    let [start, end] = [strain(&before.y), strain(&now.y)];
    let stored = end.strain - start.strain;
    let Some(alpha) = scheme.alpha() else {
        return dot(&moved, &strain(&sum(&before.y, 0.5, &moved)).internal) - stored;
    };
    let mixed = |old: f64, x: &[f64], y: &[f64]| -> Vec<f64> {
        x.iter().zip(y).map(|(x, y)| old * x + (1.0 - old) * y).collect()
    };
    let inertia = times_mass(model, &mixed(alpha.alpha_m, &before.a, &now.a));
    let smooth = times_mass(model, &mixed(1.0 - alpha.gamma, &before.a, &now.a));
    let loads = sum(&now.f_external, -1.0, &before.f_external);
    dot(&moved, &mixed(alpha.alpha_f, &start.internal, &end.internal)) - stored + dot(&moved, &inertia)
        - (0.5 - alpha.alpha_f) * dot(&moved, &loads)
        - 0.5 * dt * dot(&sum(&before.v, 1.0, &now.v), &smooth)
}

/// What an explicit step dissipates. Its increment is that of its velocity: a step from rest can be
/// shorter than the last digit of positions.
fn of_central(model: &Model, before: &State, now: &State, dt: f64) -> f64 {
    let velocity = &before.half_step.velocity;
    let [start, end] =
        [before, now].map(|state| Energies::of(model, &state.y, &sum(&state.v, -1.0, velocity)));
    0.5 * dt * dot(velocity, &sum(&start.internal, 1.0, &end.internal))
        - (end.strain - start.strain)
        - (end.kinetic - start.kinetic)
}

/// Dissipation of a load step: the means of forces that are in equilibrium at its ends work,
/// whatever was in equilibrium at the start of the run.
fn of_statics(model: &Model, before: &State, now: &State) -> f64 {
    let [start, end] = [before, now].map(|state| Energies::of(model, &state.y, &state.v));
    let work = |i: usize| {
        let held = model.gravity[i] + before.f_external[i] - before.f_contact[i];
        let old = if model.fixed[i] { start.internal[i] } else { held };
        0.5 * (old + end.internal[i])
    };
    let moved = now.y.iter().zip(&before.y).enumerate();
    let worked = moved.map(|(i, (y, old))| (y - old) * work(i)).sum::<f64>();
    let lag = if has_friction(model) { friction_lag(before, now, 0.0) } else { 0.0 };
    worked + lag - (end.strain - start.strain)
}

/// Newton's tolerance.
const TIGHT: &str = "newton.tolerance=1e-13";
/// Number of steps of a case, and at night with its own scheme: with stops, reversals and impacts.
const STEPS: u64 = 16;
const STEPS_AT_NIGHT: u64 = 600;

/// What was found over the first steps of a case.
#[derive(Default)]
struct Judged {
    /// Largest error of the identity in a step, and of the energies in the ledger.
    errors: [f64; 2],
    /// Largest energies.
    scale: f64,
    /// Largest work of what the last digit of the positions changes in the internal forces, and
    /// the last digits of the weight's potential.
    noise: f64,
    /// Number of steps in which friction did work.
    rubbed: usize,
}

/// The first steps of a case. None without a formula for its scheme.
fn judge(case: &Case, steps: u64) -> Option<Judged> {
    let mut sim: Simulation = Setup::new(case).start().ok()?;
    let (scheme, is_static) = (&case.time.scheme, case.time.scheme.is_static());
    let integrator = scheme.integrator().ok();
    let alpha = integrator.as_ref().and_then(Integrator::alpha);
    let kernel = scheme.kernel();
    let (mut judged, mut bisected) = (Judged::default(), false);
    while !sim.finished() && sim.state().step < steps {
        let before = sim.state().clone();
        let mut report = GridReport::default();
        sim.advance(&mut report).unwrap_or_else(|e| panic!("{}: {e}", case.title));
        let (model, now) = (sim.model(), sim.state());
        let energies = Energies::of(model, &now.y, &now.v);
        let ledger = &now.ledger;
        let total = energies.kinetic + energies.strain + ledger.springs + model.potential(&now.y);
        judged.scale = judged
            .scale
            .max(ledger.scale() + ledger.potential.abs() + ledger.external_work.abs() - ledger.friction_work);
        judged.errors[1] = judged.errors[1].max((total - ledger.total()).abs());
        let reach = now.y.iter().fold(0.0_f64, |most, y| most.max(y.abs()));
        let digit = |(i, y): (usize, &f64)| y + f64::EPSILON * reach * if i % 2 == 0 { 1.0 } else { -1.0 };
        let beside: Vec<f64> = now.y.iter().enumerate().map(digit).collect();
        let changed = sum(&Energies::of(model, &beside, &now.v).internal, -1.0, &energies.internal);
        let work = changed.iter().zip(&sum(&now.y, -1.0, &before.y)).map(|(f, d)| (f * d).abs()).sum::<f64>();
        let weight: f64 = model.gravity.iter().zip(&now.y).map(|(f, y)| (f * y).abs()).sum();
        judged.noise = judged.noise.max(work + f64::EPSILON * weight);
        if scheme.conserves() {
            // Its internal forces are quotients of changes of energy.
            let digits: f64 = energies.internal.iter().map(|f| f64::EPSILON * reach * f.abs()).sum();
            judged.noise = judged.noise.max(digits);
        }
        // A grid step that was bisected, now or where the last one was, is several steps.
        let dt = now.time - before.time;
        let was_bisected = std::mem::replace(&mut bisected, report.rejected > 0);
        let another = now.carried.dt().is_some_and(|last| (last - dt).abs() > 1e-9 * dt);
        if bisected || was_bisected || another {
            continue;
        }
        let projected = now.pairs.iter().zip(&before.pairs).any(|(now, before)| {
            now.iter()
                .filter(|pair| pair.active)
                .any(|pair| !before.iter().any(|old| old.active && old.node == pair.node))
        });
        let projected = projected || report.projected_within;
        let projected = projected || report.events.iter().any(|e| matches!(e, LogEvent::Projection { .. }));
        let predicted = match (&integrator, &alpha, &kernel) {
            _ if is_static => Some(of_statics(model, &before, now)),
            // The friction of a projection is booked with that of its step.
            (_, Some(_), _) if has_friction(model) && projected => None,
            (_, Some(alpha), _) => of_alpha(model, alpha, &before, now, dt),
            (Some(Integrator::Nonsmooth(Nonsmooth::Impulse(scheme), _)), ..) => {
                Some(of_impulses(model, &**scheme, &before, now, dt))
            }
            // The first step also begins: its contact force acts before the start, too.
            (Some(Integrator::Nonsmooth(Nonsmooth::Explicit(_), _)), ..) => {
                (before.half_step.dt == now.half_step.dt).then(|| of_central(model, &before, now, dt))
            }
            (_, None, Some(kernel)) if !kernel.two_step() => {
                of_stages(model, &**kernel, &before, now, dt, projected)
            }
            _ => None,
        };
        let Some(predicted) = predicted else { continue };
        let booked = ledger.dissipation() - before.ledger.dissipation();
        judged.errors[0] = judged.errors[0].max((booked - predicted).abs());
        judged.rubbed += usize::from(ledger.friction_work != before.ledger.friction_work);
    }
    Some(judged)
}

/// Schemes by which every dynamic case is run, besides its own.
const OTHERS: [&str; 7] = [
    r#"time.scheme={ kind = "chung-hulbert", rho_inf = 0.5 }"#,
    r#"time.scheme={ kind = "newmark", beta = 0.25, gamma = 0.5 }"#,
    r#"time.scheme={ kind = "energy-momentum" }"#,
    r#"time.scheme={ kind = "moreau-jean", theta = 0.5 }"#,
    r#"time.scheme={ kind = "nonsmooth-generalized-alpha", rho_inf = 0.5 }"#,
    r#"time.scheme={ kind = "central-difference" }"#,
    r#"time.scheme={ kind = "paoli-schatzman" }"#,
];

/// A case with one of these schemes, if it allows it: explicit ones with lumped masses, and a step
/// that is stable.
fn with_scheme(path: &Path, own: &Case, scheme: &str) -> Option<Case> {
    let mut sets = vec![TIGHT.to_owned(), scheme.to_owned()];
    let lumped = |body: &BodySpec| format!(r#"body.{}.mass="lumped""#, body.name);
    let read = |sets: &[String]| {
        let sets: Vec<&str> = sets.iter().map(String::as_str).collect();
        Case::from_file(path, &sets).ok()
    };
    if let Some(case) = read(&sets).filter(|case| !case.time.scheme.is_explicit()) {
        return Some(case);
    }
    sets.extend(own.bodies.iter().map(lumped));
    let model = Setup::new(&read(&sets)?).build().ok()?;
    let longest = 0.9 * stable_step(&model, &Configuration::at(&model.initial_position))?.power;
    if longest < own.time.step {
        let end = (STEPS + 1) as f64 * longest;
        sets.extend([format!("time.step={longest:e}"), format!("time.end={end:e}")]);
    }
    read(&sets)
}

/// The case with its own scheme and with others, by day with one of them in turn; studies are other
/// runs of the same cases.
fn variants(path: &Path, turn: usize, at_night: bool) -> Vec<(String, Case)> {
    let name = |scheme: &str| format!("{} {scheme}", path.file_name().unwrap().to_string_lossy());
    let Ok(own) = Case::from_file(path, &[TIGHT]) else { return Vec::new() };
    let others =
        OTHERS.iter().enumerate().filter(|(k, _)| at_night || k % OTHERS.len() == turn % OTHERS.len());
    let others = others.map(|(_, other)| other).filter(|_| !own.time.scheme.is_static());
    let others = others.filter_map(|other| Some((name(other), with_scheme(path, &own, other)?)));
    let others: Vec<_> = others.collect();
    std::iter::once((name(""), own)).chain(others).collect()
}

#[test]
fn booked_works_leave_what_the_scheme_dissipates() {
    assert!(judged_pairs("friction", false, 1e-12) > 30);
}

/// The forces of a tie do no work. Displacements there are small: the digits of positions are fewer
/// of the energies.
#[test]
fn booked_works_with_ties_leave_what_the_scheme_dissipates() {
    judged_pairs("tie", false, 1e-8);
}

#[test]
#[ignore = "every tie with every scheme: .ci/nightly"]
fn booked_works_with_ties_leave_what_every_scheme_dissipates() {
    judged_pairs("tie", true, 1e-8);
}

#[test]
#[ignore = "every case with every scheme: .ci/nightly"]
fn booked_works_leave_what_every_scheme_dissipates() {
    assert!(judged_pairs("friction", true, 1e-12) > 300);
}

/// Judges the cases of a folder of `cases`, by day every third one; returns the number of pairs
/// that rubbed. `round_off`: relative to the energies.
fn judged_pairs(folder: &str, at_night: bool, round_off: f64) -> usize {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../cases").join(folder);
    let mut cases: Vec<_> = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    cases.retain(|path| path.extension().is_some_and(|extension| extension == "toml"));
    cases.sort();
    let cases: Vec<_> = cases.into_iter().step_by(if at_night { 1 } else { 3 }).collect();
    let (next, rubbed) = (AtomicUsize::new(0), AtomicUsize::new(0));
    let missed = Mutex::new(Vec::new());
    let work = || {
        loop {
            let turn = next.fetch_add(1, Ordering::Relaxed);
            let Some(path) = cases.get(turn) else { break };
            for (k, (name, case)) in variants(path, turn, at_night).into_iter().enumerate() {
                let steps = if at_night && k == 0 { STEPS_AT_NIGHT } else { STEPS };
                let Some(judged) = judge(&case, steps) else { continue };
                let Judged { errors: [identity, energies], scale, noise, .. } = judged;
                let closes = identity < round_off * scale + 16.0 * noise && energies < round_off * scale;
                if !closes {
                    missed
                        .lock()
                        .unwrap()
                        .push(format!("{name}: {identity:e} {energies:e} of {scale:e}, {noise:e}"));
                }
                rubbed.fetch_add(judged.rubbed, Ordering::Relaxed);
            }
        }
    };
    std::thread::scope(|scope| {
        scope.spawn(work);
        work();
    });
    assert_eq!(missed.into_inner().unwrap(), Vec::<String>::new());
    rubbed.into_inner()
}

/// A case of blocks of one cell with lumped mass, each over a plane of its own.
fn blocks(of: &[&str], scheme: &str, phase: f64) -> Case {
    case(&text_of_blocks(of, scheme, phase), &[""; 0])
}

/// A case of [`blocks`] up to a time.
fn blocks_until(of: &[&str], scheme: &str, end: f64) -> Case {
    case(&text_of_blocks(of, scheme, 0.0), &[format!("time.end={end}")])
}

fn text_of_blocks(of: &[&str], scheme: &str, phase: f64) -> String {
    let start = r#"
dimension = 2
[[material]]
name = "m"
law = "linear-elastic"
density = 2.0
young = 1.0
poisson = 0.0
"#;
    let time = format!(
        "[time]\nend = 0.104\nstep = 1e-3\nphase = {phase}\nscheme = {{ {scheme} }}\nenergy_guard = false\n"
    );
    format!("{start}{}{time}", of.concat())
}

/// A block at x that moves with a velocity, and the keys of its contact with the plane.
fn block(x: f64, velocity: [f64; 2], contact: &str) -> String {
    let [u, v] = velocity;
    format!(
        r#"
[[body]]
name = "block{x}"
material = "m"
element = "Q4"
mass = "lumped"
mesh = {{ shape = "rectangle", min = [{x}, 0.05], max = [{}, 1.05], cells = [1, 1] }}
velocity = [{u}, {v}]
[[contact]]
name = "floor{x}"
secondary = "block{x}.bottom"
{contact}
"#,
        x + 1.0
    )
}

const FIXED: &str = "primary = { plane = { point = [0.0, 0.0], normal = [0.0, 1.0] } }\n";

/// Work of friction and of contact, and dissipation, at the end of a case.
fn split(case: &Case) -> [f64; 3] {
    let mut sim = Setup::new(case).start().unwrap();
    while !sim.finished() {
        sim.advance(&mut GridReport::default()).unwrap();
    }
    let ledger = &sim.state().ledger;
    [ledger.friction_work, ledger.contact_work, ledger.dissipation()]
}

/// A block with lumped mass that falls flat on a rough plane, all nodes of its side in one
/// step: the impact of particles. With the mass m = 1 of the side, v = (1, −½) and μ = 0.3
/// friction takes μ P times the mean slip rate, P = m/2 being the impulse, and contact m/8; the
/// time integrator takes nothing, whatever its damping and the phase of its steps.
#[test]
fn an_impact_is_split_as_that_of_particles() {
    let rough = block(0.0, [1.0, -0.5], &format!("{FIXED}mu = 0.3"));
    let schemes = [
        r#"kind = "newmark", beta = 0.25, gamma = 0.5"#,
        r#"kind = "hht", alpha = 0.1"#,
        r#"kind = "chung-hulbert", rho_inf = 0.1"#,
        r#"kind = "chung-hulbert", rho_inf = 0.5"#,
        r#"kind = "hu""#,
        r#"kind = "bdf2""#,
        r#"kind = "backward-euler""#,
        r#"kind = "tr-bdf2""#,
        r#"kind = "bathe", rho_inf = 0.5"#,
        r#"kind = "energy-momentum""#,
        r#"kind = "moreau-jean", theta = 0.5"#,
    ];
    for scheme in schemes {
        for phase in [0.0, 0.33, 0.66] {
            let found = split(&blocks(&[&rough], scheme, phase));
            let right = [-0.3 * 0.5 * (1.0 - 0.5 * 0.15), -0.125, 0.0];
            let off = found.iter().zip(right).map(|(x, y)| (x - y).abs()).fold(0.0, f64::max);
            assert!(off < 2e-3, "{scheme}, phase {phase}: {found:?} instead of {right:?}");
        }
    }
}

/// A plane that begins to move within the step in which it meets a block at rest: the trapezoidal
/// rule and energy–momentum dissipate nothing.
#[test]
fn the_velocity_of_an_obstacle_may_jump_where_it_meets_a_body() {
    let plane = "primary = { plane = { point = [0.0, 0.0499], normal = [0.0, 1.0] }, \
                 motion = { y = \"if(t < 0.0505, 0, 0.5*(t - 0.0505))\" } }\n";
    let still = block(0.0, [0.0, 0.0], plane);
    for scheme in [r#"kind = "newmark", beta = 0.25, gamma = 0.5"#, r#"kind = "energy-momentum""#] {
        for phase in [0.1, 0.7] {
            let [_, contact, dissipation] = split(&blocks(&[&still], scheme, phase));
            assert!(dissipation.abs() < 1e-9 && contact < 0.0, "{scheme}, {phase}: {contact} {dissipation}");
        }
    }
}

/// A block that lands does not change the works of another one, far away, that bounces on springs:
/// those of both are the sums of separate runs.
#[test]
fn an_impact_does_not_change_the_works_of_another_contact() {
    let lands = block(0.0, [0.5, -3.0], &format!("{FIXED}mu = 0.3"));
    let springs = format!("{FIXED}mu = 0.2\nenforcement = \"penalty\"\nstiffness = 1e4");
    let bounces = block(5.0, [1.0, -6.0], &springs);
    for scheme in [r#"kind = "bathe", rho_inf = 0.0"#, r#"kind = "backward-euler""#, r#"kind = "tr-bdf2""#] {
        let of = |blocks: &[&str]| split(&blocks_until(blocks, scheme, 0.02));
        let [one, other, both] = [of(&[&lands]), of(&[&bounces]), of(&[&lands, &bounces])];
        for ((one, other), both) in one.iter().zip(other).zip(both) {
            assert!((one + other - both).abs() < 1e-9, "{scheme}: {one} + {other} for {both}");
        }
        assert!(other[1].abs() > 1e-4 && one[1].abs() > 1e-3, "{scheme}: {one:?} {other:?}");
    }
}
