//! Ties: sides that move as one. Two tied bars are one bar with every scheme; unmatched free bodies
//! keep their momenta as one body does; supports, contact, friction and statics act across a tie.

use std::path::Path;
use std::sync::atomic::AtomicBool;

use carom_record::Source;
use carom_run::{GridReport, Setup, Simulation, recording};

use super::common::{case, dot, finish, momenta, on_threads, schemes, simulation};

/// A bar, or the halves of one, that bounces on a wall.
const BARS: &str = r#"
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
end = 0.6
step = 0.01
energy_guard = false
scheme = { kind = "hu" }
"#;

/// The bar of two halves; `secondary` is one side of the tie.
fn halves(secondary: &str) -> String {
    let primary = if secondary == "bar.right" { "rest.left" } else { "bar.right" };
    let rest = r#"
[[body]]
name = "rest"
material = "steel"
element = "L2"
mass = "lumped"
mesh = { shape = "interval", min = 5.02, max = 10.02, cells = 6 }
velocity = [-1.0]
gravity = [-3.0]
"#;
    let tie = format!("[[tie]]\nname = \"bond\"\nsecondary = {secondary:?}\nprimary = {primary:?}\n");
    let halved = BARS.replace("max = 10.02, cells = 12", "max = 5.02, cells = 6");
    halved.replace("[[contact]]", &format!("{rest}{tie}[[contact]]"))
}

#[test]
fn two_tied_bars_are_one_bar_with_every_scheme() {
    let mut touched = 0;
    for (scheme, _) in schemes(false).chain(schemes(true)) {
        let sets = [format!("time.scheme={scheme}"), "newton.tolerance=1e-13".to_owned()];
        for secondary in ["bar.right", "rest.left"] {
            let [whole, tied] = [BARS.to_owned(), halves(secondary)].map(|text| simulation(&text, &sets));
            let [whole, tied] = [whole, tied].map(finish);
            touched += usize::from(whole.state().impulse()[0] != 0.0);
            for (x, y) in [(&whole.state().y, &tied.state().y), (&whole.state().v, &tied.state().v)] {
                let size = x.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
                let apart = |i: usize, j: usize| (x[i] - y[j]).abs() / size;
                let nodes = (0..7).map(|i| (i, i)).chain((6..13).map(|i| (i, i + 1)));
                let most = nodes.map(|(i, j)| apart(i, j)).fold(0.0, f64::max);
                assert!(most < 1e-10, "{scheme} {secondary}: {most:e}");
            }
            let [a, b] = [&whole, &tied].map(|sim| sim.state().ledger.total());
            assert!((a - b).abs() < 1e-10 * a.abs(), "{scheme}: {a} {b}");
        }
    }
    assert!(touched > 40, "{touched}");
}

/// Two blocks with unmatched meshes that spin and vibrate, tied or, with `tie` empty, one of them.
pub(super) fn blocks(tie: &str) -> String {
    let upper = r#"
[[body]]
name = "upper"
material = "rubber"
element = "T6"
mass = "lumped"
mesh = { shape = "rectangle", min = [0.0, 0.5], max = [1.0, 1.0], cells = [3, 2] }
position = ["1.1*X", "Y"]
velocity = { linear = [0.3, -0.2], angular = 2.0, about = [0.2, 0.1] }
"#;
    let upper = if tie.is_empty() { "" } else { upper };
    format!(
        r#"
dimension = 2
[[material]]
name = "rubber"
law = "neo-hookean"
density = 1.0
lambda = 20.0
mu = 15.0
[[body]]
name = "lower"
material = "rubber"
element = "T6"
mass = "lumped"
mesh = {{ shape = "rectangle", min = [0.0, 0.0], max = [1.0, 0.5], cells = [2, 2] }}
position = ["1.1*X", "Y"]
velocity = {{ linear = [0.3, -0.2], angular = 2.0, about = [0.2, 0.1] }}
{upper}
{tie}
[time]
end = 0.2
step = 2e-3
scheme = {{ kind = "hu" }}
[newton]
tolerance = 1e-14
"#
    )
}

pub(super) const UPPER_TO_LOWER: &str =
    "[[tie]]\nname = \"joint\"\nsecondary = \"upper.bottom\"\nprimary = \"lower.top\"\n";
pub(super) const LOWER_TO_UPPER: &str =
    "[[tie]]\nname = \"joint\"\nsecondary = \"lower.top\"\nprimary = \"upper.bottom\"\n";

/// Largest change of the momenta in a run, relative to the largest, and of the energy booked.
fn drifts(text: &str, scheme: &str) -> [f64; 3] {
    let mut sim = simulation(text, &[format!("time.scheme={scheme}")]);
    let start = momenta(&sim, &sim.state().v);
    let mut most = [0.0_f64; 3];
    while !sim.finished() {
        sim.advance(&mut GridReport::default()).unwrap_or_else(|e| panic!("{scheme}: {e}"));
        let now = momenta(&sim, &sim.state().v);
        let change: [f64; 3] = std::array::from_fn(|i| (now[i] - start[i]).abs());
        most = [most[0].max(change[0]).max(change[1]), most[1].max(change[2]), 0.0];
    }
    let ledger = &sim.state().ledger;
    most[2] = (ledger.external_work.abs() + ledger.contact_work.abs()) / ledger.scale();
    most
}

#[test]
fn unmatched_tied_blocks_keep_their_momenta_as_one_block_does() {
    for (scheme, _) in schemes(false).chain(schemes(true)) {
        let one = drifts(&blocks(""), &scheme);
        for tie in [UPPER_TO_LOWER, LOWER_TO_UPPER] {
            let tied = drifts(&blocks(tie), &scheme);
            assert!(tied[0] < 1e-12, "{scheme}: {tied:?} {one:?}");
            assert!(tied[1] < 1e-12 || tied[1] < 20.0 * one[1], "{scheme}: {tied:?} {one:?}");
            assert_eq!(tied[2], 0.0);
        }
    }
}

/// Energy–momentum keeps the energy of the blocks, and tied sides stay together.
#[test]
fn energy_momentum_keeps_the_energy_of_tied_blocks() {
    let mut sim = simulation(&blocks(UPPER_TO_LOWER), &["time.scheme={ kind = \"energy-momentum\" }"]);
    let before = sim.state().ledger.total();
    while !sim.finished() {
        sim.advance(&mut GridReport::default()).unwrap();
        let (model, state) = (sim.model(), sim.state());
        assert!((state.ledger.total() - before).abs() < 1e-12 * before, "{}", state.ledger.total() - before);
        for values in [&state.y, &state.v] {
            let mut carried = values.clone();
            model.points.carry(&mut carried);
            let most = carried.iter().zip(values).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
            assert!(most < 1e-14, "{most:e}");
        }
    }
    assert!(sim.state().ledger.kinetic < 0.99 * before);
}

/// The reduced mass and tangent of the iterative solver are those of the direct one.
#[test]
fn the_iterative_solver_finds_the_same_motion() {
    for scheme in ["{ kind = \"chung-hulbert\", rho_inf = 0.6 }", "{ kind = \"energy-momentum\" }"] {
        let run = |solver: &str| {
            let sets = [format!("time.scheme={scheme}"), solver.to_owned(), "time.end=0.05".to_owned()];
            finish(simulation(&blocks(UPPER_TO_LOWER), &sets))
        };
        let direct = run("newton.linear=\"direct\"");
        let iterative = run("newton.linear=\"iterative\"");
        let pairs = direct.state().y.iter().zip(&iterative.state().y);
        let most = pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        assert!(most < 1e-11 && most > 0.0, "{scheme}: {most:e}");
    }
}

#[test]
fn threads_and_resuming_change_no_bit() {
    for scheme in [
        "{ kind = \"chung-hulbert\", rho_inf = 0.6 }",
        "{ kind = \"central-difference\" }",
        "{ kind = \"moreau-jean\", theta = 0.5 }",
    ] {
        let sets = [format!("time.scheme={scheme}"), "time.end=0.04".to_owned()];
        let text = blocks(UPPER_TO_LOWER);
        let one = finish(on_threads(&text, &sets, 1));
        let three = finish(on_threads(&text, &sets, 3));
        assert!(one.state() == three.state(), "{scheme}");
        let mut half = on_threads(&text, &sets, 1);
        while half.state().step < 9 {
            half.advance(&mut GridReport::default()).unwrap();
        }
        let state = postcard::from_bytes(&postcard::to_stdvec(half.state()).unwrap()).unwrap();
        let resumed = finish(Setup::new(&case(&text, &sets)).threads(2).resume(state).unwrap());
        assert!(one.state() == resumed.state(), "{scheme}");
    }
}

/// Two unmatched cubes in space; `law`: what else the case has.
fn cubes(element: &str, law: &str) -> String {
    format!(
        r#"
dimension = 3
[[material]]
name = "rubber"
law = "neo-hookean"
density = 1.0
lambda = 20.0
mu = 15.0
[[body]]
name = "lower"
material = "rubber"
element = "{element}"
mass = "lumped"
mesh = {{ shape = "box", min = [0.0, 0.0, 0.0], max = [1.0, 1.0, 0.5], cells = [2, 1, 1] }}
position = ["1.1*X", "Y", "Z"]
velocity = {{ linear = [0.3, -0.2, 0.1], angular = [1.0, 2.0, -0.5], about = [0.2, 0.1, 0.0] }}
[[body]]
name = "upper"
material = "rubber"
element = "{element}"
mass = "lumped"
mesh = {{ shape = "box", min = [0.0, 0.0, 0.5], max = [1.0, 1.0, 1.0], cells = [3, 2, 1] }}
position = ["1.1*X", "Y", "Z"]
velocity = {{ linear = [0.3, -0.2, 0.1], angular = [1.0, 2.0, -0.5], about = [0.2, 0.1, 0.0] }}
[[tie]]
name = "joint"
secondary = "upper.bottom"
primary = "lower.top"
{law}
[time]
end = 0.02
step = 1e-3
scheme = {{ kind = "hu" }}
[newton]
tolerance = 1e-14
"#
    )
}

/// Σ y × M v in space, after Σ M v.
fn momenta_in_space(sim: &Simulation) -> [f64; 6] {
    let mut p = vec![0.0; sim.state().v.len()];
    sim.model().mass.multiply_into(&sim.state().v, &mut p);
    let mut sums = [0.0; 6];
    for (y, p) in sim.state().y.chunks_exact(3).zip(p.chunks_exact(3)) {
        for i in 0..3 {
            let (j, k) = ((i + 1) % 3, (i + 2) % 3);
            sums[i] += p[i];
            sums[3 + i] += y[j] * p[k] - y[k] * p[j];
        }
    }
    sums
}

#[test]
fn unmatched_tied_cubes_keep_their_momenta() {
    for element in ["Tet4", "Tet10", "Hex8", "Hex27"] {
        for scheme in ["energy-momentum", "moreau-jean", "central-difference", "chung-hulbert"] {
            let keys = match scheme {
                "moreau-jean" => ", theta = 0.5",
                "chung-hulbert" => ", rho_inf = 0.6",
                _ => "",
            };
            // Lumped masses of higher elements on corners may be zero or negative.
            if scheme == "central-difference" && matches!(element, "Tet10") {
                continue;
            }
            let sets = [format!("time.scheme={{ kind = {scheme:?}{keys} }}")];
            let mut sim = simulation(&cubes(element, ""), &sets);
            let start = momenta_in_space(&sim);
            while !sim.finished() {
                sim.advance(&mut GridReport::default()).unwrap();
            }
            let now = momenta_in_space(&sim);
            let most =
                |range: std::ops::Range<usize>| range.map(|i| (now[i] - start[i]).abs()).fold(0.0, f64::max);
            assert!(most(0..3) < 1e-13, "{element} {scheme}: {:e}", most(0..3));
            let keeps = matches!(scheme, "energy-momentum" | "central-difference");
            assert!(most(3..6) < if keeps { 1e-11 } else { 1e-4 }, "{element} {scheme}: {:e}", most(3..6));
        }
    }
}

/// Blocks in statics, with some supports and loads.
fn pulled(supports: &str) -> String {
    let text = blocks(UPPER_TO_LOWER)
        .replace("velocity = { linear = [0.3, -0.2], angular = 2.0, about = [0.2, 0.1] }\n", "")
        .replace("position = [\"1.1*X\", \"Y\"]\n", "")
        .replace("[time]\nend = 0.2\nstep = 2e-3", "[time]\nend = 1.0\nstep = 0.5")
        .replace("{ kind = \"hu\" }", "{ kind = \"static\" }");
    text.replace("[time]", &format!("{supports}\n[time]"))
}

/// A side is held along one axis, a side of the other body along the other axis: together they hold
/// the pair, which neither holds alone.
#[test]
fn supports_of_both_bodies_hold_a_tied_pair() {
    let supports = "support = [{ name = \"wall\", on = [\"lower.left\"], fix = [\"x\"] }, \
        { name = \"roof\", on = [\"upper.top\"], fix = [\"y\"] }]\n\
        load = [{ on = [\"lower.bottom\"], traction = [0.0, \"-0.4*t\"] }]";
    let text = pulled("").replace("dimension = 2", &format!("dimension = 2\n{supports}"));
    let sim = finish(simulation(&text, &[""; 0]));
    let (model, state) = (sim.model(), sim.state());
    let mut reaction = state.f_internal.clone();
    reaction.iter_mut().zip(&state.f_external).for_each(|(r, f)| *r -= f);
    let force: f64 = model.ties[0].tied[0].iter().map(|node| reaction[2 * node + 1]).sum();
    assert!((force + 0.4).abs() < 1e-11, "{force}");
    let lowest = state.y.iter().skip(1).step_by(2).fold(f64::INFINITY, |least, y| least.min(*y));
    assert!(lowest < -5e-3, "{lowest}");
}

#[test]
fn a_pair_that_supports_leave_free_has_no_equilibrium() {
    let supports = "support = [{ on = [\"lower.left\"], fix = [\"x\"] }]";
    let text = pulled("").replace("dimension = 2", &format!("dimension = 2\n{supports}"));
    let problems = Setup::new(&case(&text, &[""; 0])).build().err().unwrap();
    assert!(format!("{problems:?}").contains("is free to move along y"), "{problems:?}");
}

/// Runs a case into a folder.
fn record(text: &str, directory: &Path) {
    let source = Source { text: text.to_owned(), sets: Vec::new(), ..Source::default() };
    recording::run(&case(text, &[""; 0]), source, directory, 1, &mut |_| {}, &AtomicBool::new(false))
        .unwrap();
}

/// A tied run starts where another one ended, unless that had no tie and the sides moved apart.
#[test]
fn a_tied_run_starts_from_another_one() {
    let folder = tempfile::tempdir().unwrap();
    let (tied, loose) = (folder.path().join("tied"), folder.path().join("loose"));
    let short = blocks(UPPER_TO_LOWER).replace("end = 0.2", "end = 0.02");
    record(&short, &tied);
    record(&short.replace(UPPER_TO_LOWER, ""), &loose);
    let moves = |line: &&str| !line.starts_with("position =") && !line.starts_with("velocity =");
    let resting: Vec<&str> = short.lines().filter(moves).collect();
    let from = |directory: &Path| {
        format!("{}\n[initial]\nfrom = {:?}\n", resting.join("\n"), directory.display().to_string())
    };
    let sim = simulation(&from(&tied), &[""; 0]);
    let ended = finish(simulation(&short, &[""; 0]));
    let apart = sim.state().y.iter().zip(&ended.state().y).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    assert!(apart < 1e-15, "{apart:e}");
    let refused = Setup::new(&case(&from(&loose), &[""; 0])).start().err().unwrap();
    let refused = format!("{refused:?}");
    assert!(refused.contains("the sides of tie `joint` are apart at the end of the run"), "{refused}");
}

/// Four quarters of a square in any order of their ties are one square: the corner that all share
/// is one node. Every tie reports the force that it transmits.
#[test]
fn four_bodies_meet_at_a_corner() {
    let body = |name: &str, x: f64, y: f64, n: usize| {
        format!(
            "[[body]]\nname = {name:?}\nmaterial = \"rubber\"\nelement = \"T6\"\n\
             mesh = {{ shape = \"rectangle\", min = [{x:?}, {y:?}], max = [{:?}, {:?}], cells = [{n}, {n}] }}\n\
             mass = \"lumped\"\nposition = [\"1.05*X\", \"Y\"]\n",
            x + 1.0,
            y + 1.0
        )
    };
    let ties = [
        ("ab", "a.right", "b.left"),
        ("cd", "c.right", "d.left"),
        ("ac", "a.top", "c.bottom"),
        ("bd", "d.bottom", "b.top"),
    ];
    for (cells, matched) in [([2, 2, 2, 2], true), ([2, 3, 3, 2], false)] {
        let bodies: String = [("a", 0.0, 0.0), ("b", 1.0, 0.0), ("c", 0.0, 1.0), ("d", 1.0, 1.0)]
            .iter()
            .zip(cells)
            .map(|((name, x, y), n)| body(name, *x, *y, n))
            .collect();
        let mut ends: Vec<Vec<f64>> = Vec::new();
        for first in 0..4 {
            let table = |k: usize| {
                let (name, secondary, primary) = ties[(first + k) % 4];
                format!("[[tie]]\nname = {name:?}\nsecondary = {secondary:?}\nprimary = {primary:?}\n")
            };
            let ties: String = (0..4).map(table).collect();
            let text = format!(
                "dimension = 2\n[[material]]\nname = \"rubber\"\nlaw = \"neo-hookean\"\ndensity = 1.0\n\
                 lambda = 20.0\nmu = 15.0\n{bodies}{ties}[time]\nend = 0.1\nstep = 2e-3\n\
                 scheme = {{ kind = \"central-difference\" }}\n"
            );
            let sim = finish(simulation(&text, &[""; 0]));
            let (model, state) = (sim.model(), sim.state());
            let corners: Vec<usize> =
                (0..state.y.len() / 2).filter(|&n| model.reference[2 * n..2 * n + 2] == [1.0, 1.0]).collect();
            assert_eq!(corners.len(), 4);
            for corner in &corners[1..] {
                let apart = (0..2).map(|i| (state.y[2 * corner + i] - state.y[2 * corners[0] + i]).abs());
                assert!(apart.fold(0.0, f64::max) < 1e-14);
            }
            // The balance of each body: M a + f_int = the forces of its ties.
            let mut force = vec![0.0; model.dofs()];
            model.mass.multiply_into(&state.a, &mut force);
            force.iter_mut().zip(&state.f_internal).for_each(|(m, f)| *m += f);
            model.points.pass_on(&mut force);
            let mut own = vec![0.0; model.dofs()];
            model.mass.multiply_into(&state.a, &mut own);
            let mut transmitted = vec![[0.0; 2]; 4];
            for tie in &model.ties {
                let of = |nodes: &[usize], i: usize| nodes.iter().map(|n| force[2 * n + i]).sum::<f64>();
                for i in 0..2 {
                    let sum = of(&tie.tied[0], i) - of(&tie.tied[1], i);
                    transmitted[tie.bodies[0]][i] += sum;
                    transmitted[tie.bodies[1]][i] -= sum;
                }
            }
            for (part, transmitted) in model.parts.iter().zip(transmitted) {
                for (i, transmitted) in transmitted.into_iter().enumerate() {
                    let inertia: f64 = part.nodes().map(|n| own[2 * n + i]).sum();
                    assert!((inertia - transmitted).abs() < 1e-9, "{}: {inertia} {transmitted}", part.name);
                }
            }
            ends.push(state.y.clone());
        }
        if matched {
            for end in &ends[1..] {
                let apart = end.iter().zip(&ends[0]).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
                assert!(apart < 1e-10, "{apart:e}");
            }
        }
    }
}

/// A laminate of two strips side by side falls on a floor, or on another body: the lower ends of
/// the tie are nodes in contact.
fn laminate(below: &str, friction: &str) -> String {
    let body = |name: &str, x: f64, n: usize| {
        format!(
            "[[body]]\nname = {name:?}\nmaterial = \"rubber\"\nelement = \"T6\"\nmass = \"lumped\"\n\
             mesh = {{ shape = \"rectangle\", min = [{x:?}, 0.0], max = [{:?}, 1.0], cells = [2, {n}] }}\n\
             velocity = [0.3, -1.0]\n",
            x + 0.5
        )
    };
    let (other, primary) = if below == "floor" {
        (String::new(), "{ plane = { point = [0.0, -0.01], normal = [0.0, 1.0] } }".to_owned())
    } else {
        let block = "[[body]]\nname = \"block\"\nmaterial = \"rubber\"\nelement = \"T6\"\nmass = \"lumped\"\n\
            mesh = { shape = \"rectangle\", min = [-0.5, -0.51], max = [1.5, -0.01], cells = [5, 2] }\n";
        (block.to_owned(), "\"block.top\"".to_owned())
    };
    let contact = |name: &str, body: &str| {
        format!(
            "[[contact]]\nname = {name:?}\nsecondary = \"{body}.bottom\"\nprimary = {primary}\n{friction}"
        )
    };
    format!(
        "dimension = 2\n[[material]]\nname = \"rubber\"\nlaw = \"neo-hookean\"\ndensity = 1.0\n\
         lambda = 20.0\nmu = 15.0\n{}{}{other}\
         [[tie]]\nname = \"glue\"\nsecondary = \"right.left\"\nprimary = \"left.right\"\n{}{}\
         [time]\nend = 0.1\nstep = 2e-3\nscheme = {{ kind = \"hu\" }}\n[newton]\ntolerance = 1e-13\n",
        body("left", 0.0, 4),
        body("right", 0.5, 5),
        contact("one", "left"),
        contact("two", "right"),
    )
}

#[test]
fn a_laminate_falls_on_a_floor_and_on_another_body() {
    let kinds = [
        "{ kind = \"chung-hulbert\", rho_inf = 0.6 }",
        "{ kind = \"energy-momentum\" }",
        "{ kind = \"hu\" }",
        "{ kind = \"central-difference\" }",
        "{ kind = \"moreau-jean\", theta = 0.5 }",
        "{ kind = \"nonsmooth-generalized-alpha\", rho_inf = 0.8 }",
    ];
    for scheme in kinds {
        for below in ["floor", "block"] {
            for friction in ["", "mu = 0.3\n"] {
                let sets = [format!("time.scheme={scheme}"), "time.energy_guard=false".to_owned()];
                let mut sim = simulation(&laminate(below, friction), &sets);
                let start = momenta(&sim, &sim.state().v);
                let factor =
                    case(&laminate(below, friction), &sets).time.scheme.kernel().map_or(0.0, |k| k.carried());
                while !sim.finished() {
                    sim.advance(&mut GridReport::default())
                        .unwrap_or_else(|e| panic!("{scheme} {below} {friction}: {e}"));
                }
                let (model, state) = (sim.model(), sim.state());
                let given: [f64; 2] =
                    std::array::from_fn(|i| state.impulses.iter().map(|impulse| impulse[i]).sum());
                assert!(given[1] > 0.1, "{scheme} {below} {friction}: {given:?}");
                let dt = state.carried.dt().unwrap_or(sim.dt());
                let total: Vec<f64> =
                    state.v.iter().zip(&state.a).map(|(v, a)| v + factor * dt * a).collect();
                let now = momenta(&sim, &total);
                let given = if below == "floor" { given } else { [0.0; 2] };
                for i in 0..2 {
                    let missing = now[i] - start[i] - given[i];
                    assert!(missing.abs() < 1e-11, "{scheme} {below} {friction}: {missing:e}");
                }
                if friction.is_empty() {
                    assert!((now[0] - start[0]).abs() < 1e-11);
                } else if below == "floor" {
                    assert!(now[0] < start[0] - 0.01 * start[0].abs(), "{scheme}: {now:?}");
                }
                let mut carried = state.y.clone();
                model.points.carry(&mut carried);
                assert!(carried == state.y);
            }
        }
    }
}

/// A plane of symmetry and a moving support cross a tie: both sides have them. With meshes that
/// match the tied blocks are one block, in what supports and ledger say as well, on a support and
/// where they fall on a floor while the other support accelerates.
#[test]
fn supports_cross_a_tie() {
    let sides = |names: &[&str], side: &str| -> String {
        names.iter().map(|name| format!("\"{name}.{side}\"")).collect::<Vec<_>>().join(", ")
    };
    let floors = ["support", "contact"];
    let kinds = ["static", "chung-hulbert", "energy-momentum", "bathe", "backward-euler", "hu"];
    for (kind, below) in kinds.iter().flat_map(|kind| floors.map(|below| (*kind, below))) {
        if kind == "static" && below == "contact" {
            continue;
        }
        let floor = if below == "support" {
            "[[support]]\nname = \"floor\"\non = [\"lower.bottom\"]\nfix = [\"y\"]\n"
        } else {
            "[[contact]]\nname = \"floor\"\nsecondary = \"lower.bottom\"\n\
             primary = { plane = { point = [0.0, -0.02], normal = [0.0, 1.0] } }\n"
        };
        let keys = if matches!(kind, "chung-hulbert" | "bathe") { ", rho_inf = 0.6" } else { "" };
        let run = |names: &[&str], cells: [usize; 2]| {
            let top = names[names.len() - 1];
            let mut text = format!(
                "dimension = 2\n[[material]]\nname = \"rubber\"\nlaw = \"neo-hookean\"\ndensity = 1.0\n\
                 lambda = 20.0\nmu = 15.0\n\
                 [[support]]\nname = \"wall\"\non = [{}]\nfix = [\"x\"]\n\
                 {floor}\
                 [[support]]\nname = \"grip\"\non = [{}]\nmove = {{ x = \"0.1*sin(3*t)\" }}\n\
                 [[load]]\non = [\"{top}.top\"]\npressure = \"0.5*t\"\n\
                 [time]\nend = 1.0\nstep = 0.05\nscheme = {{ kind = \"{kind}\"{keys} }}\n\
                 [newton]\ntolerance = 1e-13\n",
                sides(names, "left"),
                sides(names, "right")
            );
            let ends = if names.len() == 1 { vec![(0.0, 1.0)] } else { vec![(0.0, 0.5), (0.5, 1.0)] };
            for ((name, (low, high)), n) in names.iter().zip(ends).zip(cells) {
                let body = format!(
                    "[[body]]\nname = \"{name}\"\nmaterial = \"rubber\"\nelement = \"Q4\"\n\
                     gravity = [0.0, -1.0]\nmesh = {{ shape = \"rectangle\", min = [0.0, {low:?}], \
                     max = [1.0, {high:?}], cells = [{n}, {}] }}\n",
                    if names.len() == 1 { 4 } else { 2 }
                );
                text += &body;
            }
            if names.len() == 2 {
                text += UPPER_TO_LOWER;
            }
            finish(simulation(&text, &[""; 0]))
        };
        let one = run(&["lower"], [3, 0]);
        let tied = run(&["lower", "upper"], [3, 3]);
        let ledgers = [&one, &tied].map(|sim| sim.state().ledger.clone());
        let [a, b] = ledgers.map(|l| [l.kinetic, l.strain, l.external_work, l.dissipation(), l.potential]);
        for (a, b) in a.iter().zip(&b) {
            assert!((a - b).abs() < 1e-10, "{kind}: {a} {b}");
        }
        assert!(a[2].abs() > 1e-3, "{kind}: {a:?}");
        assert!(below == "support" || one.state().impulse()[1] > 0.1, "{kind}");
        let unmatched = run(&["lower", "upper"], [2, 3]);
        for sim in [tied, unmatched] {
            let (model, state) = (sim.model(), sim.state());
            let moved = 1.0 + 0.1 * 3.0_f64.sin();
            for node in 0..state.y.len() / 2 {
                let x = model.reference[2 * node];
                if x == 0.0 || x == 1.0 {
                    let place = if x == 0.0 { 0.0 } else { moved };
                    assert!((state.y[2 * node] - place).abs() < 1e-14, "{kind}: {}", state.y[2 * node]);
                    assert!(model.fixed[2 * node]);
                }
            }
        }
    }
}

/// The power of the internal forces at tied nodes is that of their carriers, so the explicit
/// scheme's ledger closes as without ties.
#[test]
fn the_explicit_ledger_closes() {
    let mut sim = simulation(&blocks(UPPER_TO_LOWER), &["time.scheme={ kind = \"central-difference\" }"]);
    let (dt, mut before) = (sim.dt(), sim.state().clone());
    let mut first = true;
    while !sim.finished() {
        sim.advance(&mut GridReport::default()).unwrap();
        let (model, now) = (sim.model(), sim.state());
        let moved: Vec<f64> = now.y.iter().zip(&before.y).map(|(a, b)| a - b).collect();
        let mean: Vec<f64> =
            now.f_internal.iter().zip(&before.f_internal).map(|(a, b)| 0.5 * (a + b)).collect();
        let inertia = |a: &[f64]| {
            let mut m = vec![0.0; a.len()];
            model.mass.multiply_into(a, &mut m);
            dot(a, &m)
        };
        let expected = dot(&moved, &mean)
            - (now.ledger.strain - before.ledger.strain)
            - 0.125 * dt * dt * (inertia(&now.a) - inertia(&before.a));
        let booked = now.ledger.dissipation() - before.ledger.dissipation();
        if !std::mem::take(&mut first) {
            assert!((booked - expected).abs() < 1e-12, "{booked:e} {expected:e}");
        }
        before = now.clone();
    }
}

/// A plate bends up against the side of a block that is tied to it: contact elsewhere on the
/// primary side, beside the tie.
#[test]
fn contact_acts_beside_a_tie_on_the_same_side() {
    let body = |name: &str, max: [f64; 2], low: f64, cells: [usize; 2]| {
        format!(
            "[[body]]\nname = {name:?}\nmaterial = \"rubber\"\nelement = \"T6\"\nmass = \"lumped\"\n\
             mesh = {{ shape = \"rectangle\", min = [0.0, {low:?}], max = {max:?}, cells = {cells:?} }}\n"
        )
    };
    let text = format!(
        "dimension = 2\n[[material]]\nname = \"rubber\"\nlaw = \"neo-hookean\"\ndensity = 1.0\n\
         lambda = 20.0\nmu = 15.0\n{}{}{UPPER_TO_LOWER}\
         [[contact]]\nname = \"side\"\nsecondary = \"upper.right\"\nprimary = \"lower.top\"\n\
         [[load]]\non = [\"lower.right\"]\ntraction = [0.0, \"3*t\"]\n\
         [time]\nend = 0.5\nstep = 2e-3\nscheme = {{ kind = \"hu\" }}\n",
        body("lower", [2.0, 0.5], 0.0, [8, 2]),
        body("upper", [1.0, 1.0], 0.5, [5, 3]),
    );
    for scheme in [
        "{ kind = \"chung-hulbert\", rho_inf = 0.6 }",
        "{ kind = \"central-difference\" }",
        "{ kind = \"moreau-jean\", theta = 0.5 }",
    ] {
        let sim = finish(simulation(&text, &[format!("time.scheme={scheme}")]));
        let ledger = &sim.state().ledger;
        assert!(ledger.dissipation().abs() < 2e-3 * ledger.scale(), "{scheme}: {}", ledger.dissipation());
    }
}

/// A tie takes what a mesh file, an extruded shape and refined meshes give, and a case that
/// refines.
#[test]
fn refined_meshes_are_tied() {
    for factor in ["1.0", "2.0"] {
        let text =
            format!("refine = {factor}\n{}", blocks(UPPER_TO_LOWER)).replace("end = 0.2", "end = 0.02");
        let sim = finish(simulation(&text, &[""; 0]));
        let count = sim.model().ties[0].tied[0].len();
        assert_eq!(count, if factor == "1.0" { 7 } else { 13 });
    }
}

/// A block slides without friction over the flush joint of two tied ones, along whole boundaries:
/// the tied faces are no walls to it, and it goes on as over one block.
#[test]
fn a_tied_joint_is_no_wall() {
    let slide = |bed: &str, on: &str| {
        let text = format!(
            r#"
dimension = 2
material = [{{ name = "m", law = "neo-hookean", density = 1.0, young = 100.0, poisson = 0.3 }}]
body = [
    {{ name = "slider", material = "m", element = "T6", mesh = {{ shape = "rectangle", min = [-0.7, 0], max = [-0.1, 0.4], cells = [3, 2] }}, velocity = [1, 0], gravity = [0, -3] }},
    {bed}
]
support = [{{ on = [{on}], fix = ["x", "y"] }}]
contact = [{{ name = "k", between = "all" }}]
time = {{ scheme = {{ kind = "chung-hulbert", rho_inf = 0.8 }}, step = 5e-3, end = 0.6 }}
"#
        );
        let sim = finish(simulation(&text, &[""; 0]));
        let nodes = sim.model().parts[0].nodes();
        let count = nodes.len() as f64;
        nodes.map(|node| sim.state().v[2 * node]).sum::<f64>() / count
    };
    let whole = r#"{ name = "A", material = "m", element = "T6", mesh = { shape = "rectangle", min = [-1, -0.5], max = [1, 0], cells = [10, 3] } }"#;
    let halves = r#"{ name = "A", material = "m", element = "T6", mesh = { shape = "rectangle", min = [-1, -0.5], max = [0, 0], cells = [5, 3] } },
    { name = "B", material = "m", element = "T6", mesh = { shape = "rectangle", min = [0, -0.5], max = [1, 0], cells = [5, 3] } },
]
tie = [{ name = "t", secondary = "A.right", primary = "B.left" }"#;
    let over_one = slide(whole, "\"A.bottom\"");
    let over_joint = slide(halves, "\"A.bottom\", \"B.bottom\"");
    assert!((over_one - 1.0).abs() < 0.01, "{over_one}");
    assert!((over_joint - over_one).abs() < 1e-3, "{over_joint} {over_one}");
}

/// A body that ties enclose keeps its boundary, which nothing meets.
#[test]
fn a_body_that_ties_enclose_is_no_obstacle_to_contact_between_all() {
    let text = r#"
dimension = 2
material = [{ name = "m", law = "neo-hookean", density = 1.0, young = 100.0, poisson = 0.3 }]
body = [
    { name = "inner", material = "m", element = "Q4", mesh = { shape = "rectangle", min = [0, 0], max = [1, 1], cells = [2, 2] } },
    { name = "below", material = "m", element = "Q4", mesh = { shape = "rectangle", min = [0, -1], max = [1, 0], cells = [2, 2] } },
    { name = "above", material = "m", element = "Q4", mesh = { shape = "rectangle", min = [0, 1], max = [1, 2], cells = [2, 2] } },
    { name = "left", material = "m", element = "Q4", mesh = { shape = "rectangle", min = [-1, 0], max = [0, 1], cells = [2, 2] } },
    { name = "right", material = "m", element = "Q4", mesh = { shape = "rectangle", min = [1, 0], max = [2, 1], cells = [2, 2] } },
    { name = "striker", material = "m", element = "Q4", mesh = { shape = "rectangle", min = [0, 2.01], max = [1, 3.01], cells = [2, 2] }, velocity = [0, -1] },
]
tie = [
    { name = "a", secondary = "inner.bottom", primary = "below.top" },
    { name = "b", secondary = "inner.top", primary = "above.bottom" },
    { name = "c", secondary = "inner.left", primary = "left.right" },
    { name = "d", secondary = "inner.right", primary = "right.left" },
]
support = [{ on = ["below.bottom"], fix = ["x", "y"] }]
contact = [{ name = "k", between = "all" }]
time = { scheme = { kind = "bathe", rho_inf = 0.8 }, step = 5e-3, end = 0.05 }
"#;
    let sim = finish(simulation(text, &[""; 0]));
    assert!(sim.state().impulses.iter().any(|impulse| impulse[1].abs() > 0.01));
}
