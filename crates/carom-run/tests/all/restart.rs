//! Resumed runs, and runs that start where another ended.

use std::path::Path;
use std::sync::atomic::AtomicBool;

use carom_contact::Pair;
use carom_record::Source;
use carom_run::{GridReport, Simulation, State, recording};

use super::common::{DISCS, case as case_of, finish, simulation};
use super::loads::time;

const TOOL: &str = include_str!("../../../../cases/loads/tool.toml");

/// Records the run of a case; returns the table of a case that begins where it ends.
pub(super) fn initial_state(text: &str, directory: &Path) -> String {
    let source = Source { text: text.to_owned(), sets: Vec::new(), ..Source::default() };
    let stop = AtomicBool::new(false);
    recording::run(&case_of(text, &[""; 0]), source, directory, 1, &mut |_| {}, &stop).unwrap();
    format!("[initial]\nfrom = {:?}\n", directory.display().to_string())
}

/// A run resumed from a state in the middle ends bitwise equal, including loads, motions and
/// bisected steps.
#[test]
fn a_resumed_run_with_loads_and_motions_ends_with_the_same_bits() {
    let text = r#"
dimension = 2
[[material]]
name = "rubber"
law = "neo-hookean"
density = 1.0
lambda = 20.0
mu = 10.0
[[body]]
name = "block"
material = "rubber"
element = "T6"
mesh = { shape = "rectangle", min = [0.0, 0.0], max = [1.0, 1.0], cells = [3, 3] }
velocity = ["0", "0.1*X"]
[[support]]
on = ["block.bottom"]
fix = ["x"]
move = { y = "0.1*sin(3*t)" }
[[load]]
on = ["block.top"]
pressure = "2*sin(7*t)"
[[load]]
on = ["block.right"]
traction = ["0.5*t", 0]
[time]
end = 0.5
step = 0.01
scheme = { kind = "chung-hulbert", rho_inf = 0.5 }
energy_guard = false
"#;
    let case = case_of(text, &[""; 0]);
    for scheme in ["", "state"] {
        let mut case = case.clone();
        if !scheme.is_empty() {
            case.time.scheme.forces = carom_time::ForceRule::AverageState;
        }
        let mut whole = carom_run::Setup::new(&case).start().unwrap();
        let mut checkpoint = None;
        while !whole.finished() {
            if whole.state().step == 23 {
                checkpoint = Some(postcard::to_stdvec(&whole.state()).unwrap());
            }
            whole.advance(&mut GridReport::default()).unwrap();
        }
        let state = postcard::from_bytes(&checkpoint.unwrap()).unwrap();
        let resumed = finish(carom_run::Setup::new(&case).threads(2).resume(state).unwrap());
        assert_eq!(resumed.state(), whole.state());
    }
}

/// Every state alone determines the next one: what a simulation keeps of earlier steps, such as its
/// last tangent, changes no bit. Load steps with a moved support show it best, because their first
/// residual is small.
#[test]
fn every_state_alone_determines_the_next_one() {
    for (text, sets) in [
        (TOOL, vec![]),
        (TOOL, vec!["newton.tangent = \"frozen-double\""]),
        (DISCS, vec!["time.end = 0.08"]),
        (DISCS, vec!["time.end = 0.08", "time.scheme = { kind = \"chung-hulbert\", rho_inf = 0.5 }"]),
    ] {
        let case = case_of(text, &sets);
        let mut whole = carom_run::Setup::new(&case).start().unwrap();
        let mut other = carom_run::Setup::new(&case).start().unwrap();
        while !whole.finished() {
            let state = whole.state().clone();
            whole.step().unwrap();
            let mut resumed = carom_run::Setup::new(&case).resume(state.clone()).unwrap();
            resumed.step().unwrap();
            assert!(
                resumed.state() == whole.state(),
                "after step {} of {:?}, {sets:?}",
                state.step,
                case.title
            );
            // A simulation that was elsewhere before, and one that has made this step already.
            for before in ["elsewhere", "here"] {
                other.restore(state.clone()).unwrap();
                other.step().unwrap();
                assert!(other.state() == whole.state(), "{before}, after step {}, {sets:?}", state.step);
            }
        }
    }
}

/// A block compressed by a moving support springs back from the compressed state: [initial]
/// restores positions and contact.
#[test]
fn a_run_begins_where_another_ended() {
    let folder = tempfile::tempdir().unwrap();
    let text = |time: &str, initial: &str, motion: &str| {
        format!(
            r#"
dimension = 2
[[material]]
name = "rubber"
law = "neo-hookean"
density = 1.0
lambda = 20.0
mu = 10.0
[[body]]
name = "block"
material = "rubber"
element = "T6"
mesh = {{ shape = "rectangle", min = [0.0, 0.0], max = [1.0, 1.0], cells = [3, 3] }}
[[support]]
name = "press"
on = ["block.top"]
move = {{ x = 0, y = "{motion}" }}
[[contact]]
name = "floor"
secondary = "block.bottom"
primary = {{ plane = {{ point = [0.0, 0.0], normal = [0.0, 1.0] }} }}
{initial}
{time}
"#
        )
    };
    let statics = text(&time(1.0, 0.25, r#"{ kind = "static" }"#), "", "-0.1*t");
    let initial = initial_state(&statics, &folder.path().join("preload"));
    let pressed = finish(simulation(&statics, &[""; 0]));
    let again = |motion: &str| {
        text(&time(0.1, 1e-3, r#"{ kind = "chung-hulbert", rho_inf = 0.6 }"#), &initial, motion)
    };
    let mut started = simulation(&again("-0.1"), &[""; 0]);
    assert_eq!(started.state().y, pressed.state().y);
    let force = pressed.state().contact_forces[0][1];
    assert!(
        (started.state().contact_forces[0][1] - force).abs() < 1e-8 * force,
        "{:?} {force}",
        started.state().contact_forces
    );
    // It is in equilibrium: nothing moves.
    for _ in 0..20 {
        started.advance(&mut GridReport::default()).unwrap();
    }
    let moved =
        started.state().y.iter().zip(&pressed.state().y).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    assert!(moved < 1e-9, "{moved:e}");
    // A support that does not start there, and another mesh, are errors.
    for (text, expected) in [
        (again("0"), "a support would jump at the start"),
        (again("-0.1").replace("cells = [3, 3]", "cells = [3, 4]"), "body \"block\" has another mesh in"),
        (again("-0.1").replace("/preload", "/nowhere"), "cannot be used"),
    ] {
        let problems = carom_run::Setup::new(&case_of(&text, &[""; 0])).start().err().unwrap();
        assert!(problems[0].what.contains(expected), "{problems:?}");
    }
}

/// A block on an incline a millionth below the angle of friction: it starts from the equilibrium of
/// load steps and does not slide, by any kind of scheme.
#[test]
fn a_block_on_an_incline_rests_in_motion() {
    let folder = tempfile::tempdir().unwrap();
    let statics = include_str!("../../../../cases/friction/incline-sticks.toml");
    let initial = initial_state(statics, &folder.path().join("rests"));
    let at_rest = finish(simulation(statics, &[""; 0]));
    let text = format!("{}\n{initial}", statics.split("[[expect]]").next().unwrap());
    for scheme in [
        r#"{ kind = "chung-hulbert", rho_inf = 0.5 }"#,
        r#"{ kind = "bathe", rho_inf = 0.5 }"#,
        r#"{ kind = "energy-momentum" }"#,
        r#"{ kind = "moreau-jean", theta = 0.5 }"#,
    ] {
        let sets = [&format!("time.scheme={scheme}"), "time.step=0.01", "time.end=0.5"];
        let moving = finish(simulation(&text, &sets));
        let (now, rest) = (moving.state(), at_rest.state());
        let moved = now.y.iter().zip(&rest.y).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        assert!(moved < 1e-12, "{scheme}: {moved:e}");
        assert!(now.ledger.friction_work.abs() < 1e-12, "{scheme}: {:e}", now.ledger.friction_work);
    }
}

/// A block that is pressed and sheared in load steps stays as it is in motion: the tractions of
/// every node and the anchors of springs are those of the other run, and all nodes stick.
#[test]
fn a_run_with_friction_begins_where_another_ended() {
    let folder = tempfile::tempdir().unwrap();
    let text = |law: &str, pressed: &str, time: &str, initial: &str| {
        format!(
            r#"
dimension = 2
[[material]]
name = "rubber"
law = "neo-hookean"
density = 1.0
young = 100.0
poisson = 0.0
[[body]]
name = "block"
material = "rubber"
element = "T6"
mesh = {{ shape = "rectangle", min = [0.0, 0.0], max = [1.0, 0.1], cells = [6, 2] }}
{pressed}
[[contact]]
name = "floor"
secondary = "block.bottom"
primary = {{ plane = {{ point = [0.0, 0.0], normal = [0.0, 1.0] }} }}
mu = 0.5
{law}
[time]
{time}
[newton]
tolerance = 1e-14
{initial}
"#
        )
    };
    let schemes = [
        r#"{ kind = "chung-hulbert", rho_inf = 0.5 }"#,
        r#"{ kind = "newmark", beta = 0.25, gamma = 0.5 }"#,
        r#"{ kind = "bathe", rho_inf = 0.5 }"#,
        r#"{ kind = "energy-momentum" }"#,
        r#"{ kind = "moreau-jean", theta = 0.5 }"#,
    ];
    // Neither impulses nor discrete gradients have springs with friction. A block on springs is
    // held by its top: springs that are not compressed yet hold nobody.
    let load = |traction: &str| format!("[[load]]\non = [\"block.top\"]\ntraction = {traction}");
    let grip = |t: &str| {
        let motion = format!("{{ x = \"2e-4*{t}\", y = \"-1e-3*{t}\" }}");
        format!("[[support]]\nname = \"grip\"\non = [\"block.top\"]\nmove = {motion}")
    };
    let problems = [
        ("", load(r#"["0.2*t", "-t"]"#), load(r#"["0.2", "-1"]"#), &schemes[..]),
        ("enforcement = \"penalty\"", grip("t"), grip("1"), &schemes[..3]),
    ];
    for (k, (law, growing, constant, schemes)) in problems.into_iter().enumerate() {
        let time = "end = 1.0\nstep = 0.25\nscheme = { kind = \"static\" }";
        let statics = text(law, &growing, time, "");
        let initial = initial_state(&statics, &folder.path().join(format!("pressed-{k}")));
        let at_rest = finish(simulation(&statics, &[""; 0]));
        let forces = at_rest.state().contact_forces[0];
        assert!(forces[0] < -0.05 && forces[1] > 0.5, "{forces:?}");
        for scheme in schemes {
            let time = format!("end = 0.2\nstep = 0.01\nscheme = {scheme}");
            let mut sim = simulation(&text(law, &constant, &time, &initial), &[""; 0]);
            while !sim.finished() {
                sim.advance(&mut GridReport::default()).unwrap();
                let (now, rest) = (sim.state(), at_rest.state());
                assert_eq!(now.pairs[0].len(), rest.pairs[0].len(), "{scheme}");
                for (now, rest) in now.pairs[0].iter().zip(&rest.pairs[0]) {
                    assert_eq!(
                        now.tangential.friction_state,
                        carom_contact::FrictionState::Stick,
                        "{scheme}"
                    );
                    let changes =
                        [now.lambda - rest.lambda, now.tangential.traction[0] - rest.tangential.traction[0]];
                    let largest = rest.lambda.abs();
                    assert!(
                        changes.iter().all(|change| change.abs() < 1e-12 * largest),
                        "{law} {scheme}: {changes:?} of {largest}"
                    );
                }
                let worked = now.ledger.friction_work;
                assert!(worked.abs() < 1e-18, "{scheme}: {worked:e}");
            }
        }
    }
}

/// A block on springs goes on where their obstacle has carried it, as deep as it was there; deeper
/// than that its springs would drive it away.
#[test]
fn springs_go_on_where_their_obstacle_has_moved() {
    let folder = tempfile::tempdir().unwrap();
    let text = |load: &str, floor: &str, time: &str, initial: &str| {
        format!(
            r#"
dimension = 2
material = [{{ name = "rubber", law = "neo-hookean", density = 1.0, young = 100.0, poisson = 0.3 }}]
[[body]]
name = "block"
material = "rubber"
element = "Q4"
mesh = {{ shape = "rectangle", min = [0.0, 0.0], max = [1.0, 0.6], cells = [5, 3] }}
[[load]]
on = ["block.top"]
traction = {load}
[[contact]]
name = "floor"
secondary = "block.bottom"
primary = {{ plane = {{ point = {floor} }}
mu = 0.5
enforcement = "penalty"
[time]
{time}
{initial}
"#
        )
    };
    let lifted = r#"[0.0, 0.0], normal = [0.0, 1.0] }, motion = { y = "0.05*t" }"#;
    let time = "end = 1.0\nstep = 0.1\nscheme = { kind = \"static\" }";
    let first = text(r#"["t", "-5*t"]"#, lifted, time, "");
    let initial = initial_state(&first, &folder.path().join("lifted"));
    let at_rest = finish(simulation(&first, &[""; 0]));
    let time = "end = 0.02\nstep = 4e-3\nscheme = { kind = \"chung-hulbert\", rho_inf = 0.5 }";
    let second = |height: f64| {
        let floor = format!("[0.0, {height}], normal = [0.0, 1.0] }}");
        text("[1.0, -5.0]", &floor, time, &initial)
    };
    let goes_on = finish(simulation(&second(0.05), &[""; 0]));
    let [then, now] = [&at_rest, &goes_on].map(|run| run.state().contact_forces[0]);
    for i in 0..2 {
        assert!((then[i] - now[i]).abs() < 1e-9 * then[1], "{then:?} {now:?}");
    }
    let fastest = goes_on.state().v.iter().fold(0.0_f64, |most, v| most.max(v.abs()));
    assert!(fastest < 1e-9, "{fastest:e}");
    let problems = carom_run::Setup::new(&case_of(&second(0.06), &[""; 0])).start().err().unwrap();
    assert!(problems[0].what.contains("overlap at the start"), "{problems:?}");
}

/// A block that is dragged over another one and goes on where the run ended: velocities at the end
/// of a step ring from node to node, and do not decide which nodes stick. The run of both parts is
/// the reference.
#[test]
fn a_motion_with_friction_goes_on() {
    let folder = tempfile::tempdir().unwrap();
    let text = |start: f64, end: f64, initial: &str| {
        let time = format!("(t + {start})");
        format!(
            r#"
dimension = 2
material = [{{ name = "metal", law = "neo-hookean", density = 1.0, young = 500.0, poisson = 0.3 }}]
[[body]]
name = "slider"
material = "metal"
element = "T6"
mesh = {{ shape = "rectangle", min = [-0.3, 0.0], max = [0.3, 0.5], cells = [3, 3] }}
[[body]]
name = "bed"
material = "metal"
element = "T6"
mesh = {{ shape = "rectangle", min = [-1.0, -0.5], max = [1.0, 0.0], cells = [10, 2] }}
[[support]]
name = "ground"
on = ["bed.bottom"]
fix = ["x", "y"]
[[load]]
name = "drag"
on = ["slider.top"]
traction = ["4*sin(10*{time})", "-8*min(1, {time}/0.05)"]
[[contact]]
name = "face"
secondary = "slider.bottom"
primary = "bed.top"
mu = 0.3
[time]
end = {end}
step = 2e-3
scheme = {{ kind = "newmark", beta = 0.25, gamma = 0.5 }}
energy_guard = false
{initial}
"#
        )
    };
    let first = text(0.0, 0.1, "");
    let second = text(0.1, 0.06, &initial_state(&first, &folder.path().join("first")));
    let stopped = finish(simulation(&first, &[""; 0]));
    let started = simulation(&second, &[""; 0]);
    let [then, now] = [&stopped, &started].map(|run| run.state().contact_forces[0]);
    assert!((then[0] - now[0]).abs() < 1e-3 * then[0].abs(), "{then:?} {now:?}");
    let whole = finish(simulation(&text(0.0, 0.16, ""), &[""; 0]));
    let both = finish(started);
    let [reference, resumed] = [&whole, &both].map(|run| &run.state().y);
    let apart = reference.iter().zip(resumed).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    assert!(apart < 1e-7, "{apart:e}");
}

/// A state of another model is refused with the difference, wherever it is given.
#[test]
fn states_of_other_models() {
    let state = simulation(DISCS, &[""; 0]).into_state();
    let (dofs, nodes) =
        (state.y.len(), simulation(DISCS, &[""; 0]).model().contacts[0].kinematics.secondary().len());
    let why = |state: &State, sets: &[&str]| {
        let resumed = carom_run::Setup::new(&case_of(DISCS, sets)).resume(state.clone());
        let message = resumed.err().map(|problems| problems[0].what.clone()).unwrap_or_default();
        let restored = simulation(DISCS, sets).restore(state.clone());
        assert_eq!(restored.err().map(|other| other.to_string()).unwrap_or_default(), message);
        message
    };
    assert_eq!(why(&state, &[]), "");
    assert_eq!(
        why(&state, &["contact=[]"]),
        "the state belongs to another model: it has 1 contacts with pairs, this one 0"
    );
    assert!(
        why(&state, &["body.left.mesh.size=0.5"]).contains(&format!("it has {dofs} positions, this one "))
    );
    let changed = |how: fn(&mut State)| {
        let mut state = state.clone();
        how(&mut state);
        why(&state, &[])
    };
    assert!(changed(|state| state.f_contact.truncate(1)).contains(" contact forces"));
    assert!(changed(|state| state.impulses.clear()).contains("it has 0 contacts with impulses, this one 1"));
    let foreign = changed(|state| state.pairs[0].push(Pair::open(1000, 0, 0.0)));
    let unordered = changed(|state| state.pairs[0] = [1, 0].map(|node| Pair::open(node, 0, 0.0)).to_vec());
    assert!(
        unordered.contains("the pairs of contact \"strike\" are not in the order of nodes"),
        "{unordered}"
    );
    assert!(
        changed(|state| state.v[1] = f64::NAN).contains("position, velocity or acceleration 1 is not finite")
    );
    assert!(foreign.contains(&format!("node 1000 of contact \"strike\" with {nodes} nodes")), "{foreign}");
}

/// The steps are computed, whatever happens to the record behind them.
#[test]
fn a_run_is_finished_even_if_its_record_cannot_be_read() {
    let folder = tempfile::tempdir().unwrap();
    let directory = folder.path().join("run");
    let source = Source { text: DISCS.to_owned(), sets: Vec::new(), ..Source::default() };
    let stop = AtomicBool::new(false);
    let damage = &mut |progress: &recording::Progress| {
        if progress.step == progress.steps {
            std::fs::write(directory.join("contact.csv"), "no columns\n").unwrap();
        }
    };
    let case = case_of(DISCS, &["time.end=0.01"]);
    let run = recording::run(&case, source, &directory, 1, damage, &stop);
    assert!(matches!(run, Err(recording::RunError::Record(_))), "{run:?}");
    let manifest = carom_record::Manifest::read(&directory).unwrap();
    assert_eq!(manifest.status, carom_record::Status::Finished);
}

#[test]
fn a_restricted_state_has_the_energy_of_its_own_springs() {
    let text = r#"
dimension = 2
material = [{ name = "m", law = "neo-hookean", density = 1.0, young = 100.0, poisson = 0.3 }]
time = { end = 0.2, step = 1e-3, scheme = { kind = "newmark", beta = 0.25, gamma = 0.5 } }
"#;
    let block = |name: &str, left: f64, gravity: f64| {
        format!(
            r#"
[[body]]
name = "{name}"
material = "m"
element = "T3"
mesh = {{ shape = "rectangle", min = [{left}, 0.0], max = [{left}, 1.0], cells = [3, 3] }}
gravity = [0.0, -{gravity}]
[[contact]]
name = "under-{name}"
secondary = "{name}.bottom"
primary = {{ plane = {{ point = [0.0, 0.0], normal = [0.0, 1.0] }} }}
enforcement = "penalty"
"#
        )
        .replace(&format!("max = [{left}"), &format!("max = [{}", left + 1.0))
    };
    let both = text.to_owned() + &block("gone", 0.0, 3.0) + &block("kept", 2.0, 1.0);
    let alone = text.to_owned() + &block("kept", 2.0, 1.0);
    let mut large = simulation(&both, &[""; 0]);
    (0..100).for_each(|_| drop(large.step().unwrap()));
    let small = simulation(&alone, &[""; 0]);
    let first = large.model().parts[1].nodes().start;
    let dofs: Vec<usize> = (2 * first..2 * first + small.model().dofs()).collect();
    let part = large.state().restricted(large.model(), small.model(), &dofs, &[1]).unwrap();
    // ½ k g² = ½ |λ| |g| of each spring.
    let springs = |sim: &Simulation, state: &State| {
        let mut energy = 0.0;
        for (contact, pairs) in sim.model().contacts.iter().zip(&state.pairs) {
            for pair in pairs.iter().filter(|pair| pair.active) {
                let gap = contact.kinematics.signed_distance(pair.node, &state.y).unwrap();
                energy += 0.5 * (pair.lambda * gap).abs();
            }
        }
        energy
    };
    let [whole, own] = [springs(&large, large.state()), springs(&small, &part)];
    assert!(own > 0.0 && whole > 2.0 * own, "{whole} {own}");
    assert!((large.state().ledger.springs - whole).abs() < 1e-12 * whole);
    assert!((part.ledger.springs - own).abs() < 1e-12 * own, "{} {own}", part.ledger.springs);
    assert!((part.ledger.total() - part.ledger.total_at_start).abs() < 1e-15);
}

/// Both sides of strips pressed together by springs are active; as constraints they would be
/// dependent.
#[test]
fn multipliers_start_from_a_run_with_springs() {
    let folder = tempfile::tempdir().unwrap();
    let strips = |law: &str, initial: &str| {
        let strip = |name: &str, y: [f64; 2], cells: u32| {
            format!(
                "[[body]]\nname = \"{name}\"\nmaterial = \"soft\"\nelement = \"T6\"\nmesh = {{ shape = \"rectangle\", \
                 min = [0.0, {:?}], max = [1.0, {:?}], cells = [{cells}, 4] }}\n",
                y[0], y[1]
            )
        };
        format!(
            "title = \"strips\"\ndimension = 2\n[[material]]\nname = \"soft\"\nlaw = \"linear-elastic\"\ndensity = 1.0\n\
             young = 100.0\npoisson = 0.0\n{}{}[[support]]\non = [\"lower.bottom\"]\nfix = [\"y\"]\n[[support]]\n\
             on = [\"lower.left\", \"upper.left\"]\nfix = [\"x\"]\n[[load]]\non = [\"upper.top\"]\n\
             traction = [\"0\", \"-1\"]\n[[contact]]\nname = \"joint\"\nsecondary = \"lower.top\"\n\
             primary = \"upper.bottom\"\n{law}\n[time]\nend = 0.1\nstep = 0.01\n\
             scheme = {{ kind = \"chung-hulbert\", rho_inf = 0.0 }}\n{initial}\n",
            strip("lower", [0.0, 1.0], 4),
            strip("upper", [1.0, 2.5], 3)
        )
    };
    let springs = strips("enforcement = \"penalty\"\nstiffness = 10.0", "");
    let initial = initial_state(&springs, &folder.path().join("pressed"));
    let case = case_of(&strips("", &initial), &[""; 0]);
    let mut run = carom_run::Setup::new(&case).start().unwrap();
    run.step().unwrap();
    assert!(run.state().pairs[0].iter().any(|pair| pair.active));
}
