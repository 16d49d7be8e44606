//! Common helpers: cases from text and settings, runs to the end, sums over bodies.

use carom_run::case::{Case, Document, read};
use carom_run::{GridReport, Simulation, State};
use carom_time::{KINDS, KindInfo, Member};

/// Two discs that collide off centre, in contact within the run.
pub(crate) const DISCS: &str = r#"
title = "Two discs, off centre"
dimension = 2
[[material]]
name = "rubber"
law = "neo-hookean"
density = 0.25
lambda = 20.0
mu = 15.0
[[body]]
name = "left"
material = "rubber"
element = "T6"
mass = "lumped"
mesh = { shape = "disc", radius = 0.5, center = [-0.55, 0.1], size = 0.25 }
velocity = [1.5, 0.0]
[[body]]
name = "right"
material = "rubber"
element = "T6"
mass = "lumped"
mesh = { shape = "disc", radius = 0.5, center = [0.55, -0.1], size = 0.25 }
velocity = [-1.5, 0.0]
[[contact]]
name = "strike"
secondary = "left.arc"
primary = "right.arc"
[time]
end = 0.4
step = 1e-3
scheme = { kind = "hu" }
"#;

/// A bar that bounces on a wall.
pub(crate) const BAR: &str = r#"
title = "A bar that bounces on a wall"
dimension = 1
material = [{ name = "steel", law = "neo-hookean", density = 1.0, young = 900.0, poisson = 0.0 }]
[[body]]
name = "bar"
material = "steel"
element = "L2"
mass = "lumped"
mesh = { shape = "interval", min = 0.02, max = 10.02, cells = 12 }
velocity = [-1.0]
gravity = [-3.0]
[[contact]]
name = "wall"
secondary = "bar.left"
primary = { plane = { point = [0.0], normal = [1.0] } }
[time]
end = 3.0
step = 0.01
energy_guard = false
scheme = { kind = "hu" }
"#;

/// A case from its text, with some of its keys changed.
pub(crate) fn case<S: AsRef<str>>(text: &str, sets: &[S]) -> Case {
    let sets: Vec<String> = sets.iter().map(|set| set.as_ref().to_owned()).collect();
    let document = Document::parse("case.toml", text, &sets).unwrap_or_else(|e| panic!("{e}"));
    read(&document).unwrap_or_else(|p| panic!("{}", document.diagnose_all(&p)))
}

/// Changes the state of a simulation.
pub(crate) fn change(simulation: &mut Simulation, how: impl FnOnce(&mut State)) {
    let mut state = simulation.state().clone();
    how(&mut state);
    simulation.restore(state).unwrap();
}

/// A simulation at another state of its model.
pub(crate) fn restored(mut simulation: Simulation, state: State) -> Simulation {
    simulation.restore(state).unwrap();
    simulation
}

/// The members of every kind with its own contact law, or of all others: name as in a case, and
/// published properties.
pub(crate) fn schemes(nonsmooth: bool) -> impl Iterator<Item = (String, &'static Member)> {
    let kinds = KINDS.iter().filter(move |kind| kind.is_nonsmooth() == nonsmooth);
    kinds.flat_map(|kind: &KindInfo| {
        kind.members.iter().map(|member| (kind.named(member).to_string(), member))
    })
}

/// A simulation of a case, on one thread.
pub(crate) fn simulation(text: &str, sets: &[impl AsRef<str>]) -> Simulation {
    on_threads(text, sets, 1)
}

pub(crate) fn on_threads(text: &str, sets: &[impl AsRef<str>], threads: usize) -> Simulation {
    carom_run::Setup::new(&case(text, sets)).threads(threads).start().unwrap_or_else(|p| panic!("{p:?}"))
}

/// Continues a run from its state with two threads, for so many steps, in which it touches.
pub(crate) fn continues_with_the_same_bits(case: &Case, mut whole: Simulation, steps: usize) {
    let setup = carom_run::Setup::new(case).threads(2);
    let mut resumed = setup.resume(whole.state().clone()).unwrap();
    let mut touched = false;
    for _ in 0..steps {
        whole.step().unwrap();
        resumed.step().unwrap();
        touched |= whole.state().pairs[0].iter().any(|pair| pair.active);
    }
    assert!(touched);
    assert_eq!(whole.state(), resumed.state());
}

/// Stops a run in the first state for which a condition holds, and continues it for a while from
/// its checkpoint.
pub(crate) fn resumes_with_the_same_bits(text: &str, sets: &[String], there: impl Fn(&State) -> bool) {
    const STEPS: usize = 80;
    let mut whole = simulation(text, sets);
    while !there(whole.state()) {
        assert!(!whole.finished(), "{sets:?}");
        whole.advance(&mut GridReport::default()).unwrap();
    }
    let checkpoint = postcard::to_stdvec(whole.state()).unwrap();
    let state = postcard::from_bytes(&checkpoint).unwrap();
    let mut resumed = carom_run::Setup::new(&case(text, sets)).resume(state).unwrap();
    for _ in 0..STEPS {
        whole.advance(&mut GridReport::default()).unwrap();
        resumed.advance(&mut GridReport::default()).unwrap();
    }
    assert_eq!(resumed.state(), whole.state(), "{sets:?}");
}

/// Runs to the end.
pub(crate) fn finish(mut sim: Simulation) -> Simulation {
    while !sim.finished() {
        sim.advance(&mut GridReport::default()).unwrap();
    }
    sim
}

/// A vector turned by 50° about (2, 3, 6)/7.
pub(crate) fn turned(x: [f64; 3]) -> [f64; 3] {
    let (n, (s, c)) = ([2.0 / 7.0, 3.0 / 7.0, 6.0 / 7.0], 50_f64.to_radians().sin_cos());
    let along: f64 = (0..3).map(|i| n[i] * x[i]).sum();
    std::array::from_fn(|i| {
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        c * x[i] + (1.0 - c) * along * n[i] + s * (n[j] * x[k] - n[k] * x[j])
    })
}

/// Linear and angular momentum of the velocities `v` at the current positions.
pub(crate) fn momenta(sim: &Simulation, v: &[f64]) -> [f64; 3] {
    let mut p = vec![0.0; v.len()];
    sim.model().mass.multiply_into(v, &mut p);
    sums(&p, &sim.state().y)
}

/// Sums of vectors at the nodes `y` and of their moments.
pub(crate) fn sums(vectors: &[f64], y: &[f64]) -> [f64; 3] {
    let pairs = vectors.as_chunks::<2>().0.iter().zip(y.as_chunks::<2>().0);
    pairs.fold([0.0; 3], |s, (f, y)| [s[0] + f[0], s[1] + f[1], s[2] + y[0] * f[1] - y[1] * f[0]])
}

pub(crate) fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(x, y)| x * y).sum()
}
