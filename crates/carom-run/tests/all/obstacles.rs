//! Rigid obstacles with every scheme, law and enforcement: a floor does not depend on how it is
//! described, and a thrown mass takes the momentum that it loses to the body.

use carom_run::case::Case;
use carom_run::{Rejected, Setup, Simulation, Stopped};

use super::common::{BAR, finish, momenta, schemes, simulation};
use super::rebound::record;

const DISC: &str = r#"
title = "A disc that strikes a floor"
dimension = 2
material = [{ name = "rubber", law = "neo-hookean", density = 0.25, lambda = 20.0, mu = 15.0 }]
[[body]]
name = "disc"
material = "rubber"
element = "T3"
mass = "lumped"
mesh = { shape = "disc", radius = 0.5, center = [0.0, 0.52], size = 0.25 }
velocity = [0.3, -1.5]
[[contact]]
name = "floor"
secondary = "disc.arc"
primary = { plane = { point = [0.0, 0.0], normal = [0.0, 1.0] } }
[time]
end = 0.15
step = 1e-3
energy_guard = false
scheme = { kind = "hu" }
"#;

const FLOORS: [&str; 5] = [
    "{ plane = { point = [0.0, 0.0], normal = [0.0, 1.0] } }",
    "{ polyline = { points = [[1.0, 0.0], [-1.0, 0.0]] } }",
    "{ polyline = { points = [[3.0, 0.0], [0.1, 0.0], [-3.0, 0.0]], radius = 0.1 } }",
    "{ polyline = { points = [[3.0, -2.0], [3.0, 0.0], [-3.0, 0.0], [-3.0, -2.0], [3.0, -2.0]] }, motion = { x = \"2*t\" } }",
    "{ plane = { point = [0.0, 0.0], normal = [0.0, 1.0] }, motion = { x = \"t^2\", rotate = \"0*t\", about = [1.0, -1.0] } }",
];

const LAWS: [&[&str]; 5] = [
    &["persistency=\"project\""],
    &["persistency=\"none\""],
    &["law=\"predictor\""],
    &["enforcement=\"penalty\"", "stiffness=20"],
    &["force=\"end\""],
];

/// Every scheme with every law that it has, as settings of a contact.
fn combinations(contact: &str) -> Vec<Vec<String>> {
    let mut all = Vec::new();
    for (scheme, _) in schemes(false).chain(schemes(true)) {
        for law in LAWS {
            let of_contact = law.iter().map(|set| format!("contact.{contact}.{set}"));
            all.push([format!("time.scheme={scheme}")].into_iter().chain(of_contact).collect());
        }
    }
    all
}

/// The run with its obstacle to its end; none if there is no such combination.
fn run(text: &str, sets: &[String], obstacle: &str) -> Option<Simulation> {
    let mut sets: Vec<&str> = sets.iter().map(String::as_str).collect();
    sets.push("newton.tolerance=1e-13");
    sets.push(obstacle);
    let mut sim = Setup::new(&Case::from_text(text, &sets).ok()?).start().ok()?;
    while !sim.finished() {
        sim.step().ok()?;
    }
    Some(sim)
}

#[test]
fn a_floor_does_not_depend_on_its_description() {
    assert!(same_floors(6) > 6);
}

#[test]
#[ignore = "every combination: .ci/nightly"]
fn a_floor_does_not_depend_on_its_description_in_any_combination() {
    assert!(same_floors(1) > 40);
}

/// The number of combinations, every n-th of all, in which a disc bounces on every floor alike.
fn same_floors(n: usize) -> usize {
    let (mut checked, mut wrong) = (0, Vec::new());
    // Without projection the active set chatters: a plane shifted by 1e-15 makes the same
    // difference.
    let chatters = |sets: &[String]| sets.iter().any(|set| set.contains("\"none\""));
    for sets in combinations("floor").into_iter().filter(|sets| !chatters(sets)).step_by(n) {
        let [first, others @ ..] =
            FLOORS.map(|floor| run(DISC, &sets, &format!("contact.floor.primary={floor}")));
        let Some(first) = first else { continue };
        let impulse = first.state().impulse()[1];
        assert!(impulse > 0.05, "{sets:?}: no contact");
        for (k, other) in others.iter().enumerate() {
            let other = other.as_ref().unwrap_or_else(|| panic!("{sets:?}, floor {}: stopped", k + 1));
            let apart = first.state().v.iter().zip(&other.state().v).map(|(a, b)| (a - b).abs());
            let apart = apart.fold(0.0, f64::max);
            // The floor moves along itself: it does no work.
            let work = other.state().ledger.external_work.abs();
            if apart > 1e-7 || work > 1e-9 {
                wrong.push(format!("{sets:?}, floor {}: {apart:e} {work:e}", k + 1));
            }
        }
        checked += 1;
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    checked
}

#[test]
fn a_thrown_mass_and_a_bar_keep_their_momentum() {
    let mut checked = 0;
    let tool =
        "contact.wall.primary={ plane = { point = [0.0], normal = [1.0] }, mass = 4.0, velocity = [1.5] }";
    for mut sets in combinations("wall") {
        sets.extend(["body.bar.gravity=[0.0]", "time.end=2.0"].map(str::to_owned));
        let Some(sim) = run(BAR, &sets, tool) else { continue };
        let (model, state) = (sim.model(), sim.state());
        let momentum = |v: &[f64]| {
            let mut p = vec![0.0; v.len()];
            model.mass.multiply_into(v, &mut p);
            p.iter().sum::<f64>()
        };
        let (before, now) = (momentum(&model.initial_velocity), momentum(&state.v));
        assert!((before + 4.0).abs() < 1e-12);
        let is_open = state.pairs.iter().flatten().all(|pair| !pair.active);
        assert!(is_open && state.impulse()[0] > 5.0, "{sets:?}: {} {}", is_open, state.impulse()[0]);
        assert!((now - before).abs() < 1e-10, "{sets:?}: {before} {now}");
        checked += 1;
    }
    assert!(checked > 40, "{checked}");
}

/// A block in free fall, fast enough to be past an obstacle after a step.
const FALLING: &str = r#"
dimension = 2
material = [{ name = "m", law = "neo-hookean", density = 1.0, young = 1e4, poisson = 0.3 }]
[[body]]
name = "block"
material = "m"
element = "T3"
mesh = { shape = "rectangle", min = [-0.2, 0.5], max = [0.2, 0.7], cells = [8, 4] }
velocity = [0.0, -10.0]
[[contact]]
name = "rigid"
secondary = "block.skin"
[time]
end = 0.3
step = 0.1
scheme = { kind = "chung-hulbert", rho_inf = 0.5 }
"#;

#[test]
fn a_block_does_not_pass_through_an_obstacle_in_a_long_step() {
    for obstacle in [
        "{ circle = { center = [0.0, 0.0], radius = 0.2 } }",
        "{ polyline = { points = [[-0.5, 0.0], [0.5, 0.0], [0.5, 0.1], [-0.5, 0.1], [-0.5, 0.0]] } }",
    ] {
        let set = format!("contact.rigid.primary={obstacle}");
        let mut sim = Setup::new(&Case::from_text(FALLING, &[set.as_str()]).unwrap()).start().unwrap();
        let rejected: u32 = (0..3).map(|_| sim.step().unwrap().rejected).sum();
        let (model, state) = (sim.model(), sim.state());
        let mut momentum = vec![0.0; model.dofs()];
        model.mass.multiply_into(&state.v, &mut momentum);
        let momentum: f64 = momentum.iter().skip(1).step_by(2).sum();
        // Its mass is 0.08.
        let impulse = state.impulse()[1];
        assert!(rejected > 0 && impulse > 0.8, "{obstacle}: {rejected} steps rejected, {impulse}");
        assert!((impulse - (momentum + 0.8)).abs() < 1e-9, "{impulse} {momentum}");
        // Not one bisection: the node is named that passes.
        let mut sim = Setup::new(&Case::from_text(FALLING, &[set.as_str()]).unwrap()).start().unwrap();
        sim.limit_bisections(0);
        let stopped = sim.step().unwrap_err();
        let Stopped::NoStep { rejected, .. } = stopped else { panic!("{stopped}") };
        assert!(matches!(rejected, Rejected::Passed { .. }), "{rejected}");
        let place = rejected.place();
        assert!(place.contact == Some("rigid") && place.node.is_some(), "{place:?}");
    }
}

/// The centre passes the middle of a facet, whose nodes are 0.125 from it.
#[test]
fn an_obstacle_does_not_pass_between_nodes() {
    for obstacle in [
        "{ circle = { center = [-0.0625, 0.05], radius = 0.04 } }",
        "{ polyline = { points = [[1.0, -1.0], [-0.0625, 0.09], [-1.0, -1.0]] } }",
    ] {
        let sets = [
            "body.block.mesh={ shape = \"rectangle\", min = [-0.5, 0.1], max = [0.5, 1.1], cells = [8, 8] }",
            "time.step=1e-2",
            &format!("contact.rigid.primary={obstacle}"),
        ];
        let mut sim = Setup::new(&Case::from_text(FALLING, &sets).unwrap()).start().unwrap();
        (0..30).for_each(|_| drop(sim.step().unwrap()));
        // The convex part of the obstacle has a row between the nodes: it presses.
        let pressed = sim.state().impulses[0][1];
        assert!(pressed > 0.0, "{obstacle}: {pressed:e}");
    }
}

#[test]
fn a_pair_of_a_piece_that_is_not_there_belongs_to_another_model() {
    let start = |floor: &str| {
        let set = format!("contact.floor.primary={floor}");
        Setup::new(&Case::from_text(DISC, &[set.as_str()]).unwrap()).start().unwrap()
    };
    let mut long = start(FLOORS[2]);
    long.step().unwrap();
    let mut short = start(FLOORS[1]);
    let error = short.restore(long.state().clone()).unwrap_err().to_string();
    assert!(error.contains("node 12 of contact \"floor\" with 12 nodes"), "{error}");
    assert!(start(FLOORS[2]).restore(long.state().clone()).is_ok());
}

/// A block whose lower corner is clamped, and a wall that reaches it at t = 0.1: no force helps.
const CLAMPED: &str = r#"
dimension = 2
material = [{ name = "m", law = "neo-hookean", density = 1.0, young = 1000.0, poisson = 0.3 }]
support = [{ on = ["block.bottom"], fix = ["x", "y"] }]
[[body]]
name = "block"
material = "m"
element = "T6"
mass = "lumped"
mesh = { shape = "rectangle", min = [-1.0, -0.5], max = [1.0, 0.0], cells = [6, 3] }
[[contact]]
name = "wall"
secondary = "block.left"
primary = { plane = { point = [-1.05, 0.0], normal = [1.0, 0.0] }, motion = { x = "0.5*t" } }
[time]
end = 0.2
step = 2e-4
scheme = { kind = "hu" }
"#;

#[test]
fn a_wall_that_reaches_a_clamped_node_is_named() {
    for scheme in [
        r#"{ kind = "chung-hulbert", rho_inf = 0.5 }"#,
        r#"{ kind = "bathe", rho_inf = 0.0 }"#,
        r#"{ kind = "tr-bdf2" }"#,
    ] {
        let set = format!("time.scheme={scheme}");
        let mut sim = Setup::new(&Case::from_text(CLAMPED, &[set.as_str()]).unwrap()).start().unwrap();
        let stopped = loop {
            assert!(!sim.finished(), "{scheme}");
            if let Err(stopped) = sim.step() {
                break stopped;
            }
        };
        let Stopped::NoStep { time, rejected: Rejected::Overconstrained { node, .. }, .. } = stopped else {
            panic!("{scheme}: {stopped}")
        };
        assert_eq!(sim.model().reference[2 * node..2 * node + 2], [-1.0, -0.5], "{scheme}");
        assert!((time - 0.1).abs() < 4e-4, "{scheme}: {time}");
    }
}

/// A body on the solid side of a chain is told how to turn the chain over.
#[test]
fn a_chain_in_the_wrong_order_is_told() {
    let chain = |points: &str| format!("contact.floor.primary={{ polyline = {{ points = {points} }} }}");
    let start = |points: &str| Setup::new(&Case::from_text(DISC, &[&*chain(points)]).unwrap()).start();
    let told = start("[[-1.0, 0.0], [1.0, 0.0]]").err().unwrap().to_string();
    assert!(told.contains("to the left of the polyline") && told.contains("reverse the order"), "{told}");
    assert!(start("[[1.0, 0.0], [-1.0, 0.0]]").is_ok());
}

/// A circle of constant velocity V strikes a disc at rest.
const BAT: &str = r#"
dimension = 2
[[material]]
name = "steel"
law = "neo-hookean"
density = 1.0
young = 1e4
poisson = 0.3
[[body]]
name = "ball"
material = "steel"
element = "T6"
mesh = { shape = "disc", radius = 0.05, center = [0.0, 0.5], size = 0.05 }
[[contact]]
name = "bat"
secondary = "ball.arc"
primary = { circle = { center = [-0.3, 0.5], radius = 0.1 }, motion = { x = "10*t" } }
[time]
end = 0.1
step = 1e-2
scheme = { kind = "chung-hulbert", rho_inf = 0.5 }
"#;

/// The disc leaves with at most twice the velocity of the circle, in steps that resolve nothing: a
/// run stops or has shortened them. The work of a motion that its mean misses vanishes with the
/// contact, and the rise of the energy by it is not taken for creation.
#[test]
fn a_moving_obstacle_lends_no_energy() {
    for scheme in [
        "{ kind = \"chung-hulbert\", rho_inf = 0.5 }",
        "{ kind = \"newmark\", beta = 0.25, gamma = 0.5 }",
        "{ kind = \"bathe\", rho_inf = 0.5 }",
    ] {
        for step in [5e-2, 1e-2, 2e-3] {
            let sets = [format!("time.scheme={scheme}"), format!("time.step={step}")];
            let mut sim = simulation(BAT, &sets.each_ref().map(String::as_str));
            while !sim.finished() {
                sim.step().unwrap_or_else(|stopped| panic!("{scheme} {step}: {stopped}"));
            }
            let (model, state) = (sim.model(), sim.state());
            let speed = momenta(&sim, &state.v)[0] / model.parts[0].total_mass;
            assert!((10.0..20.0 * 1.01).contains(&speed), "{scheme} {step}: {speed}");
            assert!(state.ledger.created.most() <= 0.02 * state.ledger.scale(), "{scheme} {step}");
        }
    }
}

/// A block on a pedestal in whose place a polyline or a box comes, pressed down by 2 %.
const PRESSED: &str = r#"
dimension = 2
material = [{ name = "rubber", law = "neo-hookean", density = 1.5, young = 2000.0, poisson = 0.25 }]
support = [{ name = "top", on = ["block.top"], fix = ["x"], move = { y = "-0.005*t" } }]
[[body]]
name = "block"
material = "rubber"
element = "Q4"
mesh = { shape = "rectangle", min = [-0.5, 0.0], max = [0.5, 0.25], cells = [4, 1] }
[[contact]]
name = "pedestal"
secondary = "block.bottom"
primary = { plane = { point = [0.0, 0.0], normal = [0.0, 1.0] } }
[time]
end = 1.0
step = 0.25
scheme = { kind = "static" }
"#;

/// Force on the nodes of a block at the height 0.25 along y at the end of a run.
fn pressed_with(text: &str, sets: &[String]) -> f64 {
    let sim = finish(simulation(text, sets));
    let model = sim.model();
    let on_top = |node: &usize| model.reference[model.dimension * node + 1] == 0.25;
    let nodes = (0..model.reference.len() / model.dimension).filter(on_top);
    nodes.map(|node| sim.state().f_internal[model.dimension * node + 1]).sum()
}

/// The corners of a pedestal are exactly at nodes, or beside them by up to a thousandth of a facet.
#[test]
fn a_corner_at_a_node_presses_like_one_beside_it() {
    let force = |half_width: f64, element: &str, secondary: &str| {
        let w = half_width;
        let points = format!("[[{w}, -1.0], [{w}, 0.0], [-{w}, 0.0], [-{w}, -1.0]]");
        let sets = [
            format!("body.block.element={element}"),
            format!("contact.pedestal.secondary=block.{secondary}"),
            format!("contact.pedestal.primary={{ polyline = {{ points = {points} }} }}"),
        ];
        pressed_with(PRESSED, &sets)
    };
    for element in ["Q4", "T6"] {
        for secondary in ["bottom", "skin"] {
            let [inside, outside] = [0.2503, 0.2497].map(|w| force(w, element, secondary));
            for half_width in [0.25, 0.25 - 1e-12, 0.25 + 1e-12, 0.2499, 0.2501] {
                let at = force(half_width, element, secondary);
                let mean = 0.5 * (inside + outside);
                let error = (at - mean).abs() / mean.abs();
                assert!(error < 5e-3, "{element} {secondary} {half_width}: {at} {inside} {outside}");
            }
        }
    }
}

/// A cube thrown into a corner, parallel to its walls, in the plane and in space.
const THROWN: [&str; 2] = [
    r#"
dimension = 2
material = [{ name = "m", law = "neo-hookean", density = 1.5, young = 2000.0, poisson = 0.25 }]
body = [{ name = "block", material = "m", element = "Q4", mesh = { shape = "rectangle", min = [0.01, 0.01], max = [0.26, 0.26], cells = [2, 2] }, velocity = [-0.6, -0.6] }]
contact = []
time = { step = 1e-3, end = 0.03, scheme = { kind = "backward-euler" } }
"#,
    r#"
dimension = 3
material = [{ name = "m", law = "neo-hookean", density = 1.5, young = 2000.0, poisson = 0.25 }]
body = [{ name = "block", material = "m", element = "Hex8", mesh = { shape = "box", min = [0.01, 0.01, 0.01], max = [0.26, 0.26, 0.26], cells = [2, 2, 2] }, velocity = [-0.6, -0.6, -0.6] }]
contact = []
time = { step = 1e-3, end = 0.03, scheme = { kind = "backward-euler" } }
"#,
];

/// The inside of a corner of three squares, each of two triangles.
fn inner_corner() -> String {
    let vertex = |p: &[u8; 3]| format!("vertex {} {} {}\n", p[0], p[1], p[2]);
    let square = |a: [u8; 3], b: [u8; 3]| {
        let across = [a[0] + b[0], a[1] + b[1], a[2] + b[2]];
        [[[0; 3], a, across], [[0; 3], across, b]]
    };
    let [x, y, z] = [[1, 0, 0], [0, 1, 0], [0, 0, 1]];
    let triangles = [square(x, y), square(y, z), square(z, x)].concat();
    let facet = |corners: &[[u8; 3]; 3]| {
        let vertices: String = corners.iter().map(vertex).collect();
        format!("facet normal 0 0 0\nouter loop\n{vertices}endloop\nendfacet\n")
    };
    format!("solid corner\n{}endsolid corner\n", triangles.iter().map(facet).collect::<String>())
}

#[test]
fn a_concave_corner_is_that_of_planes() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("corner.stl");
    std::fs::write(&path, inner_corner()).unwrap();
    let contact = |name: usize, primary: &str| {
        format!("{{ name = \"c{name}\", secondary = \"block.skin\", primary = {{ {primary} }} }}")
    };
    let walls = [
        "polyline = { points = [[2.0, 0.0], [0.0, 0.0], [0.0, 2.0]] }".to_owned(),
        format!("surface = {{ file = \"{}\" }}", path.display()),
    ];
    for (text, wall) in THROWN.iter().zip(walls) {
        let dimension = if wall.starts_with("surface") { 3 } else { 2 };
        let plane = |axis: usize| {
            let normal: Vec<f64> = (0..dimension).map(|i| if i == axis { 1.0 } else { 0.0 }).collect();
            contact(axis, &format!("plane = {{ point = {:?}, normal = {normal:?} }}", vec![0.0; dimension]))
        };
        let planes: Vec<String> = (0..dimension).map(plane).collect();
        let [together, apart] = [vec![contact(0, &wall)], planes]
            .map(|contacts| run(text, &[], &format!("contact=[{}]", contacts.join(", "))).unwrap());
        let [a, b] = [&together, &apart].map(|sim| &sim.state().y);
        let most = a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        assert!(most < 1e-12 && together.state().impulse()[1] > 0.01, "{dimension}: {most:e}");
    }
}

/// A circle that spins about its centre does no work on what slides on it without friction: neither
/// while a disc stays on it, nor, but for the steps in which it comes and goes, in a bounce.
#[test]
fn a_circle_that_spins_without_friction_does_no_work() {
    let text = |motion: &str, scheme: &str| {
        format!(
            r#"
dimension = 2
material = [{{ name = "m", law = "neo-hookean", density = 1.0, young = 50.0, poisson = 0.3 }}]
[[body]]
name = "disc"
material = "m"
element = "T6"
mesh = {{ shape = "disc", radius = 0.3, center = [0.0, 0.81], size = 0.15 }}
velocity = [0.0, -0.5]
[[contact]]
name = "circle"
secondary = "disc.arc"
primary = {{ circle = {{ center = [0.0, 0.0], radius = 0.5 }}{motion} }}
[time]
end = 0.4
{scheme}
[output]
fields_every = 0
"#
        )
    };
    let spins = r#", motion = { rotate = "500*t", about = [0.0, 0.0] }"#;
    for kind in
        [r#"{ kind = "newmark", beta = 0.25, gamma = 0.5 }"#, r#"{ kind = "chung-hulbert", rho_inf = 0.6 }"#]
    {
        let scheme = format!("step = 0.002\nscheme = {kind}");
        let [spun, rest] = [spins, ""]
            .map(|motion| finish(simulation(&text(motion, &scheme), &[""; 0])).into_state().ledger);
        let works = [spun.external_work, spun.contact_work - rest.contact_work];
        let most = works.into_iter().fold(0.0, |most: f64, work| most.max(work.abs()));
        assert!(most < 2e-3 * rest.total(), "{kind}: {works:?}");
    }
}

/// A disc that falls on a plane under a growing load, and the same seen by an observer who falls
/// with it: nodes close one after the other, and velocities are projected.
#[test]
fn dissipation_does_not_depend_on_the_observer() {
    let text = |velocity: f64, motion: &str, scheme: &str| {
        format!(
            r#"
dimension = 2
material = [{{ name = "m", law = "neo-hookean", density = 1.0, young = 200.0, poisson = 0.3 }}]
load = [{{ body = "disc", body_force = ["0", "-40*max(0, min(t, 0.08 - t))"] }}]
[[body]]
name = "disc"
material = "m"
element = "T6"
mesh = {{ shape = "disc", radius = 0.2, center = [0.0, 0.21], size = 0.1 }}
velocity = [0.0, {velocity}]
[[contact]]
name = "plane"
secondary = "disc.arc"
primary = {{ plane = {{ point = [0.0, 0.0], normal = [0.0, 1.0] }}{motion} }}
[time]
end = 0.15
step = 2e-3
energy_guard = false
{scheme}
[newton]
tolerance = 1e-13
"#
        )
    };
    for kind in [
        r#"{ kind = "chung-hulbert", rho_inf = 0.8 }"#,
        r#"{ kind = "chung-hulbert", rho_inf = 0.0 }"#,
        r#"{ kind = "newmark", beta = 0.25, gamma = 0.5 }"#,
        r#"{ kind = "hu" }"#,
    ] {
        let scheme = format!("scheme = {kind}");
        let [falls, comes] = [(-2.0, ""), (0.0, r#", motion = { y = "2*t" }"#)].map(|(velocity, motion)| {
            let state = finish(simulation(&text(velocity, motion, &scheme), &[""; 0])).into_state();
            [state.ledger.dissipation(), state.ledger.contact_work]
        });
        for (one, other) in falls.into_iter().zip(comes) {
            assert!((one - other).abs() < 1e-9 * falls[0].abs(), "{kind}: {falls:?} {comes:?}");
        }
    }
}

/// A block that slides over the rounded tops of a rough floor, on nodes that meet another piece of
/// it when they close than while they were open.
const RIDGES: &str = r#"
dimension = 2
material = [{ name = "m", law = "neo-hookean", density = 2.0, young = 400.0, poisson = 0.3 }]
[[body]]
name = "block"
material = "m"
element = "T6"
mass = "lumped"
mesh = { shape = "rectangle", min = [-2.0, 0.2], max = [0.0, 0.8], cells = [12, 4] }
velocity = [3.0, -1.0]
gravity = [0.0, -10.0]
[[contact]]
name = "floor"
secondary = "block.bottom"
primary = { polyline = { points = [[4.0, 0.0], [3.2, 0.12], [2.4, 0.0], [1.6, 0.12], [0.8, 0.0], [0.0, 0.12], [-0.8, 0.0], [-1.6, 0.12], [-2.4, 0.0], [-3.2, 0.12], [-4.0, 0.0]], radius = 0.005 } }
[time]
end = 0.3
step = 1e-3
scheme = { kind = "central-difference" }
"#;

#[test]
fn impulses_of_an_explicit_scheme_change_the_momentum() {
    let mut sim = simulation(RIDGES, &[""; 0]);
    let before = momenta(&sim, &sim.state().v);
    let weight = 2.0 * 2.0 * 0.6 * 10.0;
    while !sim.finished() {
        sim.step().unwrap();
        let now = momenta(&sim, &sim.state().v);
        let impulse = sim.state().impulse();
        let pulled = weight * sim.state().time;
        let missing = [now[0] - before[0] - impulse[0], now[1] - before[1] - impulse[1] + pulled];
        assert!(missing.iter().all(|m| m.abs() < 1e-11), "{}: {missing:?}", sim.state().time);
    }
    assert!(sim.state().impulse()[0] < -0.1, "{:?}", sim.state().impulse());
}

/// The power of an obstacle that travels and turns is R·v + M ω with its reaction R and its torque
/// M about the centre of rotation. In space an axis of any direction has a torque along it.
#[test]
fn the_torque_of_an_obstacle_that_turns_does_its_work() {
    let paddle = include_str!("../../../../cases/obstacle/paddle.toml");
    let in_space = r#"
dimension = 3
material = [{ name = "m", law = "neo-hookean", density = 1.0, young = 100.0, poisson = 0.3 }]
[[body]]
name = "b"
material = "m"
element = "Hex8"
mesh = { shape = "box", min = [0.1, -0.2, 0.02], max = [0.5, 0.2, 0.3], cells = [3, 3, 2] }
[[contact]]
name = "paddle"
secondary = "b.bottom"
enforcement = "penalty"
primary = { plane = { point = [0, 0, 0], normal = [0, 0, 1] }, motion = { x = "-0.5*t", rotate = "-180*t", about = [0, 0, -0.1], axis = [0, 1, 0] } }
[time]
end = 0.1
step = 5e-4
scheme = { kind = "newmark", beta = 0.25, gamma = 0.5 }
[output]
fields_every = 0
"#;
    let newmark = "time.scheme={ kind = \"newmark\", beta = 0.25, gamma = 0.5 }";
    let omega = -std::f64::consts::PI;
    for (run, torque) in
        [(record(paddle, &[newmark]), "paddle.moment"), (record(in_space, &[]), "paddle.moment_y")]
    {
        let [time, force, moment, work] =
            ["time", "paddle.reaction_x", torque, "external_work"].map(|name| run.column(name).unwrap());
        let power = |row: usize| -0.5 * force[row] + omega * moment[row];
        let mean = |row: usize| 0.5 * (power(row) + power(row - 1)) * (time[row] - time[row - 1]);
        let done: f64 = (1..time.len()).map(mean).sum();
        let expected = work.last().unwrap();
        assert!(expected.abs() > 1e-3 && (done / expected - 1.0).abs() < 0.02, "{torque}: {done} {expected}");
    }
}

/// Corners of a thin obstacle beside a disc are outside it, and not behind its far side.
#[test]
fn corners_beside_a_body_are_outside() {
    let thin = "contact.floor.primary={ polyline = { points = [[-2.0, -0.2], [2.0, -0.2], [2.0, 0.0], [-2.0, 0.0], [-2.0, -0.2]], radius = 0.05 }, motion = { rotate = \"60*t\", about = [0.0, -0.1] } }";
    let sim = simulation(DISC, &[thin]);
    let kinematics = &sim.model().contacts[0].kinematics;
    let distance = |node: usize| kinematics.signed_distance(node, &sim.state().y).unwrap();
    let least = (0..kinematics.secondary().len()).map(distance).fold(f64::INFINITY, f64::min);
    assert!((least - 0.02).abs() < 1e-9, "{least}");
}

/// The half of a block on a rigid table that reaches past the plane of symmetry: the corners of the
/// table there are not inside the body, and springs carry its weight.
#[test]
fn a_table_may_reach_past_a_plane_of_symmetry() {
    let text = r#"
        dimension = 2
        material = [{ name = "m", law = "neo-hookean", density = 1.0, young = 1e4, poisson = 0.0 }]
        support = [{ on = ["b.left"], fix = ["x"] }]
        time = { end = 1.0, step = 1.0, scheme = { kind = "static" } }
        [[body]]
        name = "b"
        material = "m"
        element = "Q4"
        mesh = { shape = "rectangle", min = [0.0, 0.0], max = [2.0, 0.5], cells = [8, 2] }
        gravity = [0.0, -10.0]
        [[contact]]
        name = "table"
        secondary = "b.bottom"
        primary = { polyline = { points = [[-3.0, -1.0], [5.0, -1.0], [5.0, 0.0], [-3.0, 0.0], [-3.0, -1.0]] } }
        enforcement = "penalty"
    "#;
    let end = finish(simulation(text, &[""; 0]));
    let force = end.state().contact_forces[0][1];
    assert!((force.abs() - 10.0).abs() < 1e-8, "{force}");
}
