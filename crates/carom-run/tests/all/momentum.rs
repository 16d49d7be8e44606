//! The impulse of contact is the change of momentum, for every scheme, law and enforcement, in
//! every case of the repository. The α family carries momentum in its accelerations besides its
//! velocities: P = Σ M [v + (1 − γ − α_m) Δt a] of a body that nothing supports changes by the
//! impulses of its contacts, beyond the momentum that its loads give to a particle with the same
//! scheme. Forces between two bodies have no moment either: Σ y × ∇g = 0 and Σ y × H = 0 for the
//! rows of every closed pair and of its slips. And no contact pulls: λ ≤ 0 at the end of a step.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Debug;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicUsize, Ordering};

use carom_contact::{Row, Rows};
use carom_run::case::{Case, ContactSpec, Document, MeshSpec, read};
use carom_run::model::{LoadsAt, Model};
use carom_run::{GridReport, LogEvent, Setup, Simulation, State};

use carom_study::Plan;
use carom_time::{Kernel, Nonsmooth};

use super::common::{BAR, schemes};
use super::particle::Particle;

/// Σ over the nodes of bodies.
fn resultant(model: &Model, bodies: &[usize], vector: &[f64]) -> [f64; 3] {
    let d = model.dimension;
    let mut sum = [0.0; 3];
    for (i, sum) in sum.iter_mut().enumerate().take(d) {
        *sum = nodes(model, bodies).map(|node| vector[node * d + i]).sum();
    }
    sum
}

fn nodes(model: &Model, bodies: &[usize]) -> impl Iterator<Item = usize> {
    bodies.iter().flat_map(|body| model.parts[*body].nodes())
}

/// The bodies, those together that ties join.
fn tied(model: &Model) -> Vec<Vec<usize>> {
    let mut groups: Vec<Vec<usize>> = (0..model.parts.len()).map(|body| vec![body]).collect();
    for tie in &model.ties {
        let [a, b] = tie.bodies.map(|body| groups.iter().position(|group| group.contains(&body)).unwrap());
        if a != b {
            let other = groups.remove(a.max(b));
            groups[a.min(b)].extend(other);
        }
    }
    groups
}

struct Balance {
    bodies: Vec<usize>,
    /// Directions in which nothing supports it.
    free: Vec<usize>,
    /// P at the start.
    start: [f64; 3],
    gravity: [f64; 3],
    /// Has the momentum of the other loads.
    loaded: Particle,
    factor: f64,
    /// Σ Δt |f| over all forces of all steps: where they cancel, their round-off is left.
    summed: f64,
}

impl Balance {
    /// Of every body of a dynamic case that nothing supports in some direction.
    fn all(case: &Case, sim: &Simulation) -> Vec<Self> {
        let (model, state) = (sim.model(), sim.state());
        let factor = case.time.scheme.kernel().map_or(0.0, |kernel| kernel.carried());
        let d = model.dimension;
        let of_bodies = |bodies: Vec<usize>| {
            let is_free = |&i: &usize| nodes(model, &bodies).all(|node| !model.fixed[node * d + i]);
            let free: Vec<usize> = (0..d).filter(is_free).collect();
            let gravity = resultant(model, &bodies, &model.gravity);
            let loaded = Particle::new(resultant(model, &bodies, &state.f_external), state.time);
            let mut balance = Self { bodies, free, start: [0.0; 3], gravity, loaded, factor, summed: 0.0 };
            balance.start = balance.momentum(model, state, sim.dt());
            balance
        };
        let all = tied(model).into_iter().filter(|_| !case.time.scheme.is_static()).map(of_bodies);
        all.filter(|balance| !balance.free.is_empty()).collect()
    }

    /// Follows the loads over a step to a state. `before`: whether the scheme knew the step before.
    fn follow(&mut self, case: &Case, sim: &Simulation, report: &GridReport, before: bool) {
        let (model, state) = (sim.model(), sim.state());
        if model.loads.is_empty() {
            return;
        }
        let bodies = &self.bodies;
        let impulsive = match case.time.scheme.nonsmooth() {
            Some(Nonsmooth::Impulse(scheme)) => Some(scheme),
            _ => None,
        };
        let implicit = case.time.scheme.kernel();
        let kernel = impulsive.as_deref().map(|scheme| scheme as &dyn Kernel).or(implicit.as_deref());
        let load_at = |time: f64| {
            let mut force = state.f_external.clone();
            if (time - state.time).abs() > 1e-9 * sim.dt() {
                assert!(!model.loads.follow_sides(), "{}: pressure within a step", case.title);
                model.loads_into(time, &state.y, &mut LoadsAt::default(), &mut force).unwrap();
            }
            resultant(model, bodies, &force)
        };
        let dt = state.time - self.loaded.time;
        self.loaded.advance(kernel, dt, before, load_at);
        let projects = |event: &LogEvent| match event {
            LogEvent::ActiveSet { contact, active, .. } => *active && model.contacts[*contact].projects,
            LogEvent::Projection { .. } => true,
            _ => false,
        };
        if implicit.is_some() && report.events.iter().any(projects) {
            self.loaded.project(dt);
        }
    }

    /// P without the part of the loads.
    fn momentum(&self, model: &Model, state: &State, dt: f64) -> [f64; 3] {
        let bodies = &self.bodies;
        let mut product = vec![0.0; model.dofs()];
        model.mass.multiply_into(&state.v, &mut product);
        let p = resultant(model, bodies, &product);
        model.mass.multiply_into(&state.a, &mut product);
        let q = resultant(model, bodies, &product);
        let Particle { v, a, .. } = &self.loaded;
        std::array::from_fn(|i| p[i] - v[i] + self.factor * dt * (q[i] - self.gravity[i] - a[i]))
    }

    /// What is missing in the balance at a state, and the largest term of it.
    fn error(&mut self, sim: &Simulation) -> [f64; 2] {
        let (model, state) = (sim.model(), sim.state());
        let bodies = &self.bodies;
        let dt = state.carried.dt().unwrap_or(sim.dt());
        let now = self.momentum(model, state, dt);
        let forces = state.pairs.iter().flatten().map(|pair| pair.lambda.abs()).sum::<f64>()
            + nodes(model, bodies).map(|node| state.f_external[node * model.dimension].abs()).sum::<f64>();
        self.summed += dt * forces;
        let bodies = &self.bodies;
        let mut missing = 0.0_f64;
        let mut scale = f64::MIN_POSITIVE.max(self.summed);
        for &i in &self.free {
            let fallen = self.gravity[i] * state.time;
            let mut contact = 0.0;
            for (k, impulse) in state.impulses.iter().enumerate() {
                let of = |is: bool| if is { impulse[i] } else { 0.0 };
                let secondary = model.contacts[k].kinematics.secondary();
                // Corners of the primary side, if there are any, follow the secondary nodes.
                contact +=
                    of(secondary.first().is_some_and(|node| nodes(model, bodies).any(|own| own == *node)));
                contact -= of(model.contacts[k].primary_part.is_some_and(|body| bodies.contains(&body)));
                // Of all directions: where symmetry leaves none in one, round-off is no error.
                scale = impulse.iter().fold(scale, |scale, impulse| scale.max(impulse.abs()));
            }
            missing = missing.max((now[i] - self.start[i] - fallen - contact).abs());
            scale = [now[i], self.start[i], fallen, self.loaded.v[i]]
                .iter()
                .fold(scale, |scale, x| scale.max(x.abs()));
        }
        [missing, scale]
    }
}

/// Number of rows between two bodies at a state, and the largest moment of their forces, relative
/// as in [`moment`].
fn moments(sim: &Simulation) -> (usize, f64) {
    let (model, y) = (sim.model(), &sim.state().y);
    let (mut count, mut largest) = (0, 0.0_f64);
    for (k, contact) in model.contacts.iter().enumerate() {
        if contact.primary_part.is_none() || model.dimension == 1 {
            continue;
        }
        for pair in sim.state().pairs[k].iter().filter(|pair| pair.active) {
            let (mut at, mut rows) = (*pair, Rows::new(model.dimension));
            contact.kinematics.measure(&mut at, y, &mut rows).unwrap();
            if contact.friction.is_some() {
                contact.kinematics.slip(&at, y, &[], &mut rows).unwrap();
            }
            count += rows.iter().count();
            largest = rows.iter().map(|row| moment(row, y)).fold(largest, f64::max);
        }
    }
    (count, largest)
}

/// |Σ (y − c) × f| / Σ |y − c||f| of a row f, with arms of at least a thousandth of |y|.
fn moment(row: Row, y: &[f64]) -> f64 {
    let d = row.dimension();
    let mut forces: BTreeMap<usize, [f64; 3]> = BTreeMap::new();
    row.entries().for_each(|(dof, slope)| forces.entry(dof / d).or_default()[dof % d] += slope);
    let place =
        |node: usize| -> [f64; 3] { std::array::from_fn(|i| if i < d { y[node * d + i] } else { 0.0 }) };
    let count = forces.len() as f64;
    let centre: [f64; 3] =
        std::array::from_fn(|i| forces.keys().map(|&node| place(node)[i]).sum::<f64>() / count);
    let (mut moment, mut scale) = ([0.0; 3], f64::MIN_POSITIVE);
    let size = |x: [f64; 3]| x.iter().map(|x| x * x).sum::<f64>().sqrt();
    for (&node, &f) in &forces {
        let at = place(node);
        let r: [f64; 3] = std::array::from_fn(|i| at[i] - centre[i]);
        for (i, moment) in moment.iter_mut().enumerate() {
            let (j, k) = ((i + 1) % 3, (i + 2) % 3);
            *moment += r[j] * f[k] - r[k] * f[j];
        }
        // Where nodes meet, their distance is round-off of their places.
        scale += size(r).max(1e-3 * size(at)) * size(f);
    }
    size(moment) / scale
}

/// What a run has shown.
#[derive(Clone, Copy, Debug, Default)]
struct Seen {
    /// Largest error of the balance of a body, and largest momentum of any body so far.
    missing: f64,
    scale: f64,
    /// Largest moment of a row between two bodies, and how many were looked at.
    turning: f64,
    rows: usize,
    /// Largest multiplier that pulls, relative to the largest so far.
    pulling: f64,
    has_touched: bool,
}

impl Seen {
    fn is_wrong(&self) -> bool {
        // The round-off of hundreds of steps adds up.
        self.missing > 2e-12 * self.scale || self.turning >= 1e-12 || self.pulling >= 1e-9
    }
}

/// How long a run is followed, in steps or parts of steps: for so many after contact has begun, and
/// so many at most.
#[derive(Clone, Copy)]
struct Span {
    after: u64,
    at_most: u64,
}

const WHOLE: Span = Span { after: u64::MAX, at_most: u64::MAX };

/// The balances of a run; moments where its first rows close and where it is left. A run that stops
/// is judged up to there.
fn seen(case: &Case, span: Span) -> Seen {
    let mut sim = Setup::new(case).start().unwrap_or_else(|e| panic!("{}: {e:?}", case.title));
    // The particles take whole steps.
    if sim.has_fallback() || !case.loads.is_empty() {
        sim.limit_bisections(0);
    }
    let mut balances = Balance::all(case, &sim);
    let (mut seen, mut began, mut left) = (Seen::default(), false, span.at_most);
    let mut strongest = f64::MIN_POSITIVE;
    // Of bodies that are all supported, the first rows are looked at.
    let has_rows = sim.model().contacts.iter().any(|contact| contact.primary_part.is_some());
    if balances.is_empty() && (!has_rows || case.contacts.iter().any(ContactSpec::is_of_itself)) {
        return seen;
    }
    let look = |sim: &Simulation, seen: &mut Seen| {
        let (rows, turning) = moments(sim);
        (seen.rows, seen.turning) = (seen.rows + rows, seen.turning.max(turning));
        rows > 0
    };
    while !sim.finished() && left > 0 {
        let before = sim.state().previous.is_some();
        let Ok(report) = sim.step() else { break };
        balances.iter_mut().for_each(|balance| balance.follow(case, &sim, &report, before));
        left -= 1;
        if !seen.has_touched && sim.state().impulses.as_flattened().iter().any(|impulse| *impulse != 0.0) {
            seen.has_touched = true;
            left = left.min(span.after);
        }
        let multipliers = || sim.state().pairs.iter().flatten().map(|pair| pair.lambda);
        strongest = multipliers().fold(strongest, |most, lambda| most.max(lambda.abs()));
        seen.pulling = multipliers().fold(seen.pulling, |most, lambda| most.max(lambda / strongest));
        began = began || look(&sim, &mut seen);
        if balances.is_empty() && began {
            return seen;
        }
        let errors = balances.iter_mut().map(|balance| balance.error(&sim));
        let [missing, scale] = errors.fold([0.0; 2], |[a, b], [c, d]| [f64::max(a, c), f64::max(b, d)]);
        (seen.missing, seen.scale) = (seen.missing.max(missing), seen.scale.max(scale));
    }
    look(&sim, &mut seen);
    seen
}

/// The balance closes as far as the equations of a step are solved.
const TIGHT: &str = "newton.tolerance=1e-14";

const LAWS: [&[&str]; 8] = [
    &["contact.wall.persistency=\"project\""],
    &["contact.wall.persistency=\"none\""],
    &["contact.wall.law=\"predictor\""],
    &["contact.wall.enforcement=\"penalty\"", "contact.wall.stiffness=1e4"],
    &["contact.wall.enforcement=\"augmented\""],
    &["contact.wall.force=\"end\""],
    &["time.phase=0.3"],
    // The fallback takes every step that creates energy.
    &["time.fallback=velocity", "time.energy_guard=1e-9"],
];

#[test]
fn every_scheme_law_and_enforcement() {
    let mut checked = 0;
    let kernels = schemes(false).chain(schemes(true)).map(|(scheme, _)| scheme);
    for scheme in kernels {
        for law in LAWS {
            let scheme = format!("time.scheme={scheme}");
            let sets = [&[scheme.as_str(), TIGHT][..], law].concat();
            // Not every scheme has every law.
            let Ok(case) = Case::from_text(BAR, &sets) else { continue };
            let seen = seen(&case, WHOLE);
            checked += usize::from(seen.has_touched);
            assert!(!seen.is_wrong(), "{scheme} {law:?}: {seen:?}");
        }
    }
    assert!(checked > 60, "{checked}");
}

/// Every file below a folder.
fn files(folder: &Path, found: &mut Vec<PathBuf>) {
    let mut entries: Vec<_> = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    entries.sort();
    for path in entries {
        if path.is_dir() {
            files(&path, found);
        } else if path.extension().is_some_and(|extension| extension == "toml") {
            found.push(path);
        }
    }
}

/// Cases that `carom verify --fast` omits, but that are short enough to be judged for longer by
/// night.
const SECONDS_LONG: [&str; 10] = [
    "disc/row.toml",
    "friction/bar-on-bed.toml",
    "friction/bowling.toml",
    "friction/capstan.toml",
    "ladder/comb-fast.toml",
    "ladder/slanting.toml",
    "self/pinched.toml",
    "space/slanting.toml",
    "space/sphere-strikes.toml",
    "space/vertex.toml",
];

/// The case of a file; none of a study, of a case without contact, or where it cannot be judged.
/// Its contact is judged while it begins, and for longer in the tests of every night.
fn contact_case(path: &Path, at_night: bool) -> Option<(Case, Span)> {
    let document = Document::open(path, &[TIGHT.to_owned()]).unwrap();
    let is_in = |folder: &str| path.components().any(|part| part.as_os_str() == folder);
    let is_one_of = |cases: &[&str]| cases.iter().any(|case| path.ends_with(case));
    let left_out = [];
    if document.is_study() || is_one_of(&left_out) || is_in("perf") {
        return None;
    }
    let case = read(&document).unwrap();
    let is_slow = case.expects.iter().any(|expect| expect.slow) && !(at_night && is_one_of(&SECONDS_LONG));
    let span = match ["ladder", "space", "self"].iter().any(|folder| is_in(folder)) {
        _ if is_slow => Span { after: 3, at_most: 60 },
        true => Span { after: if at_night { 20 } else { 2 }, at_most: 420 },
        false => Span { after: if at_night { 300 } else { 20 }, at_most: if at_night { 600 } else { 250 } },
    };
    (!case.contacts.is_empty()).then_some((case, span))
}

/// Every file below `cases`.
fn repository() -> Vec<PathBuf> {
    let mut cases = Vec::new();
    files(&Path::new(env!("CARGO_MANIFEST_DIR")).join("../../cases"), &mut cases);
    cases
}

/// What all runs show, on two threads.
fn all_seen<'a, T: Sync>(runs: &'a [T], of: impl Fn(&T) -> Option<Seen> + Sync) -> Vec<(&'a T, Seen)> {
    let next = AtomicUsize::new(0);
    let work = || -> Vec<(&'a T, Seen)> {
        std::iter::from_fn(|| runs.get(next.fetch_add(1, Ordering::Relaxed)))
            .filter_map(|run| Some((run, of(run)?)))
            .collect()
    };
    std::thread::scope(|scope| {
        let other = scope.spawn(work);
        [work(), other.join().unwrap()].concat()
    })
}

/// Numbers of runs that touch, and that touch another body; none is wrong.
fn checked<T: Debug>(all: &[(T, Seen)]) -> [usize; 2] {
    let wrong: Vec<_> = all.iter().filter(|(_, seen)| seen.is_wrong()).collect();
    assert!(wrong.is_empty(), "{wrong:#?}");
    let count = |of: fn(&Seen) -> bool| all.iter().filter(|(_, seen)| of(seen)).count();
    [count(|seen| seen.has_touched), count(|seen| seen.rows > 0)]
}

#[test]
fn some_cases_of_the_repository() {
    every_case(false);
}

#[test]
#[ignore = "takes minutes: .ci/nightly"]
fn every_case_of_the_repository() {
    every_case(true);
}

/// By day a sample: all of them take minutes.
const BY_DAY: usize = 16;

fn every_case(at_night: bool) {
    let all: Vec<_> = repository().into_iter().step_by(if at_night { 1 } else { BY_DAY }).collect();
    let all = all_seen(&all, |path| contact_case(path, at_night).map(|(case, span)| seen(&case, span)));
    let [touched, two_bodies] = checked(&all);
    let [at_least, of_two_bodies] = if at_night { [112, 48] } else { [4, 1] };
    assert!(touched > at_least && two_bodies > of_two_bodies, "{touched} {two_bodies}");
}

/// Scheme, law and enforcement of a case, in words.
fn method(case: &Case) -> String {
    let of = |contact: &ContactSpec| {
        let friction = (contact.friction.mu.is_some(), contact.friction.stick_stiffness.is_some());
        let law = (contact.law, contact.enforcement, contact.persistency, contact.force);
        format!("{law:?} {:?} {:?} friction {friction:?}", contact.xi, contact.active_set)
    };
    let contacts: Vec<String> = case.contacts.iter().map(of).collect();
    format!("{}: {:?} {contacts:?}", case.title, case.time.scheme)
}

/// The arms of all studies, while contact begins: each scheme, law and enforcement once on each
/// case, where the case itself does not have them.
fn every_arm(at_night: bool) {
    let mut known = BTreeSet::new();
    let mut arms = Vec::new();
    for path in repository() {
        let document = Document::open(&path, &[]).unwrap();
        if document.is_study() {
            arms.extend(Plan::cases(&document, path.parent().unwrap()).unwrap());
        } else {
            known.insert(method(&read(&document).unwrap()));
        }
    }
    arms.retain(|case| !case.contacts.is_empty() && known.insert(method(case)));
    let mut arms: Vec<_> = arms.into_iter().step_by(if at_night { 1 } else { BY_DAY }).collect();
    for case in &mut arms {
        case.newton.tolerance = 1e-14;
        // The paper's cylinder need not fall first.
        for body in &mut case.bodies {
            if let MeshSpec::HalfDisc { center, radius, .. } = &mut body.mesh {
                center[1] = *radius + 1e-5;
                case.probes.clear();
            }
        }
    }
    // Loads begin small.
    let span = |case: &Case| Span { after: if case.loads.is_empty() { 20 } else { 150 }, at_most: 420 };
    let all = all_seen(&arms, |case| Some(seen(case, span(case))));
    let all: Vec<_> = all.into_iter().map(|(case, seen)| (method(case), seen)).collect();
    let [touched, two_bodies] = checked(&all);
    let [at_least, of_two_bodies] = if at_night { [135, 28] } else { [6, 0] };
    assert!(touched > at_least && two_bodies > of_two_bodies, "{touched} {two_bodies}");
}

#[test]
fn some_arms_of_the_repository() {
    every_arm(false);
}

#[test]
#[ignore = "takes minutes: .ci/nightly"]
fn every_arm_of_the_repository() {
    every_arm(true);
}
