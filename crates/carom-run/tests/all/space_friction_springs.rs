//! Friction of nodes on springs in space: the plane is a slice of it, no direction is special, and
//! the springs turn with the bodies.

use carom_contact::{FrictionState, length};
use carom_run::{GridReport, Simulation};

use super::common::{finish, simulation, turned};
use super::space::apart;
use super::space_contact::{BALL, IMPACT, momenta, slab, turned_impact};
use super::space_friction::{SCHEMES, of};

/// The impact of slabs of one cell across, whose nodes at both ends share a spring of the plane.
const BRICKS: [&str; 4] = [
    "body.upper.element=\"Hex8\"",
    "body.lower.element=\"Hex8\"",
    "body.upper.mesh={ shape = \"box\", min = [0.55, 0.01, 0.0], max = [2.55, 1.01, 1.0], cells = [3, 2, 1] }",
    "body.lower.mesh={ shape = \"box\", min = [0.0, -1.0, 0.0], max = [4.0, 0.0, 1.0], cells = [6, 2, 1] }",
];

const FLAT: [&str; 3] = [
    "body.upper.element=\"Q4\"",
    "body.lower.element=\"Q4\"",
    "body.lower.mesh={ shape = \"rectangle\", min = [0.0, -1.0], max = [4.0, 0.0], cells = [6, 2] }",
];

/// The same impact on springs, against a body and against a rigid plane.
#[test]
fn an_impact_of_slabs_on_springs_is_that_of_the_plane() {
    for (scheme, rigid) in [(SCHEMES[0], false), (SCHEMES[1], false), (SCHEMES[2], true)] {
        let run = |stiffness: f64, in_space: bool| {
            let side = if in_space { ["front", "back"] } else { ["bottom", "top"] };
            let rest = if in_space { ", 0.0" } else { "" };
            let primary = if rigid {
                format!("{{ plane = {{ point = [0.0, 0.0{rest}], normal = [0.02, 1.0{rest}] }} }}")
            } else {
                format!("\"lower.{}\"", side[1])
            };
            let contact = format!(
                "contact=[{{ name = \"strike\", secondary = \"upper.{}\", primary = {primary}, mu = 0.3, enforcement = \"penalty\", stiffness = {stiffness:?} }}]",
                side[0]
            );
            let sets = of(scheme, "0.3");
            let sets: Vec<&str> =
                sets.iter().map(String::as_str).filter(|set| !set.contains("mu=")).collect();
            let mut sets = if in_space { slab(&sets) } else { sets.into_iter().map(str::to_owned).collect() };
            sets.extend(if in_space { &BRICKS[..] } else { &FLAT[..] }.iter().map(ToString::to_string));
            sets.push(contact);
            simulation(IMPACT, &sets)
        };
        let springs = |sim: &Simulation| -> f64 {
            let contact = &sim.model().contacts[0];
            let springs = contact.springs.as_ref().unwrap();
            let nodes = contact.kinematics.nodes();
            springs.factors[1] * springs.diagonal.of_rows[..nodes].iter().sum::<f64>()
        };
        let (plane, trial) = (run(5.0, false), run(5.0, true));
        let ratio = springs(&plane) / springs(&trial);
        let (plane, space) = (finish(plane), finish(run(5.0 * ratio, true)));
        let closed = |sim: &Simulation| sim.state().pairs[0].iter().filter(|pair| pair.active).count();
        assert!(closed(&plane) > 2 && closed(&space) == 2 * closed(&plane), "{scheme}");
        let worst = apart(&plane, &space);
        assert!(worst < 1e-8, "{scheme}: {worst:e}");
        let [a, b] = [&plane, &space].map(|sim| &sim.state().ledger);
        for (a, b) in [(a.friction_work, b.friction_work), (a.stick_springs, b.stick_springs)] {
            assert!(a != 0.0 && (b / a - 1.0).abs() < 1e-5, "{scheme}: {a} {b}");
        }
    }
}

/// On springs.
const SPRINGS: [&str; 2] = ["contact.strike.enforcement=\"penalty\"", "contact.strike.stiffness=5.0"];

#[test]
fn a_turned_impact_on_springs_is_the_same() {
    let sets: Vec<String> =
        of(SCHEMES[0], "0.2").into_iter().chain(SPRINGS.map(ToString::to_string)).collect();
    let (still, worst) = turned_impact(&sets, "axis = [2.0, 3.0, 6.0], angle = 50.0", turned);
    assert!(still.state().ledger.friction_work < 0.0 && still.state().ledger.stick_springs > 0.0);
    assert!(worst < 1e-9, "{worst:e}");
}

/// Momentum is conserved, |q| ≤ μ|λ|, and the energy of the springs is Σ q²/2k.
#[test]
fn springs_in_space_obey_the_law_and_keep_the_balance() {
    for mu in [0.05, 0.2, 0.8] {
        let sets: Vec<String> =
            of(SCHEMES[0], &mu.to_string()).into_iter().chain(SPRINGS.map(ToString::to_string)).collect();
        let mut sim = simulation(BALL, &sets);
        let before = momenta(&sim);
        let (mut sticks, mut slips) = (0, 0);
        while !sim.finished() {
            sim.advance(&mut GridReport::default()).unwrap();
            let state = sim.state();
            let springs = sim.model().contacts[0].springs.as_ref().unwrap();
            let mut energy = 0.0;
            for pair in state.pairs[0].iter().filter(|pair| pair.active) {
                let (q, cone) = (length(pair.tangential.traction), mu * -pair.lambda);
                let is_stick = pair.tangential.friction_state == FrictionState::Stick;
                *(if is_stick { &mut sticks } else { &mut slips }) += 1;
                assert!(q <= cone * (1.0 + 1e-12), "{mu}: {pair:?}");
                assert!(is_stick || q >= cone * (1.0 - 1e-12), "{mu}: {pair:?}");
                energy += 0.5 * q * q / (springs.factors[1] * springs.diagonal.of_rows[pair.node]);
            }
            let stored = state.ledger.stick_springs;
            assert!((stored - energy).abs() <= 1e-12 * stored, "{mu}: {stored} {energy}");
        }
        assert!((mu > 0.5 || slips > 5) && (mu < 0.1 || sticks > 5), "{mu}: {sticks} {slips}");
        let after = momenta(&sim);
        assert!((0..3).all(|i| (after[i] - before[i]).abs() < 1e-12), "{mu}: {before:?} {after:?}");
        assert!(sim.state().ledger.friction_work < 0.0, "{mu}");
    }
}

/// A block, sheared against another one or a rigid plane and pressed, turns together with it about
/// the normal of their interface: the stretch of the springs turns with them.
#[test]
fn springs_turn_with_the_bodies() {
    let text = r#"
dimension = 3
material = [{ name = "stiff", law = "saint-venant-kirchhoff", density = 1e-6, young = 1e3, poisson = 0.0 }]
body = [
    { name = "upper", material = "stiff", element = "Hex8", mesh = { shape = "box", min = [-0.4, -0.4, 0.0], max = [0.4, 0.4, 0.5], cells = [1, 1, 1] } },
    { name = "lower", material = "stiff", element = "Hex8", mesh = { shape = "box", min = [-0.5, -0.5, -0.5], max = [0.5, 0.5, 0.0], cells = [1, 1, 1] } },
]
support = [
    { on = ["upper.top"], name = "head", move = { x = "X*(cos(w) - 1) - Y*sin(w) + s*cos(w)", y = "X*sin(w) + Y*(cos(w) - 1) + s*sin(w)", z = "-0.01*min(t, 1)" } },
    { on = ["lower.bottom"], name = "foot", move = { x = "X*(cos(w) - 1) - Y*sin(w)", y = "X*sin(w) + Y*(cos(w) - 1)", z = 0.0 } },
]
contact = [{ name = "strike", secondary = "upper.bottom", primary = "lower.top", mu = 0.9, enforcement = "penalty", stiffness = 1.0 }]
time = { scheme = { kind = "backward-euler" }, step = 0.02, end = 4.0 }
newton = { tolerance = 1e-12 }
"#;
    // Pressed until 1, sheared until 2, and turned by 90° until 4.
    let text = text.replace("(w)", "(max(t - 2, 0)*pi/4)").replace("s*", "0.002*max(0, min(t - 1, 1))*");
    let plane = "{ plane = { point = [0, 0, 0], normal = [0, 0, 1] }, motion = { rotate = \"45*max(t - 2, 0)\", about = [0, 0, -1], axis = [0, 0, 1] } }";
    let on_plane = format!("contact.strike.primary={plane}");
    let lower = "body.lower.mesh.max=[0.5, 0.5, -0.2]";
    for sets in [vec![], vec![on_plane.as_str(), lower]] {
        let mut sim = simulation(&text, &sets);
        let mut at = |time: f64| {
            while sim.state().time < time - 1e-9 {
                sim.advance(&mut GridReport::default()).unwrap();
            }
            sim.state().contact_forces[0]
        };
        let start = at(2.0);
        let end = at(4.0);
        assert!(start[0].abs() > 0.05 * start[2].abs() && start[1].abs() < 1e-9, "{start:?}");
        // From x to y.
        let size = start[0].abs();
        assert!((end[1] - start[0]).abs() < 1e-2 * size && end[0].abs() < 2e-2 * size, "{start:?} {end:?}");
        assert!((end[2] / start[2] - 1.0).abs() < 1e-3, "{start:?} {end:?}");
    }
}

/// A block that two rigid planes hold and shear turns with them about an axis across their normal:
/// seen from the planes, the force stays as it is.
#[test]
fn springs_do_not_turn_about_the_normal_of_an_obstacle_that_tilts() {
    let angle = "(pi*max(t - 1, 0))";
    let shift = |cosine: &str, sine: &str| format!("min(t, 1)*({cosine}*cos{angle} + {sine}*sin{angle})");
    let turns = format!("rotate = \"180/pi*{angle}\", about = [0, 0, 0], axis = [0, 1, 0]");
    let text = format!(
        r#"
dimension = 3
material = [{{ name = "m", law = "saint-venant-kirchhoff", density = 1.0, young = 100.0, poisson = 0.3 }}]
body = [{{ name = "b", material = "m", element = "Hex8", mesh = {{ shape = "box", min = [-0.5, -0.5, 0.0], max = [0.5, 0.5, 1.0], cells = [2, 2, 2] }} }}]
contact = [
    {{ name = "low", secondary = "b.bottom", mu = 5.0, enforcement = "penalty", stick_stiffness = 0.1, primary = {{ plane = {{ point = [0, 0, 0], normal = [0, 0, 1] }}, motion = {{ {turns} }} }} }},
    {{ name = "high", secondary = "b.top", mu = 5.0, enforcement = "penalty", stick_stiffness = 0.1, primary = {{ plane = {{ point = [0, 0, 1], normal = [0, 0, -1] }}, motion = {{ x = "{}", y = "min(t, 1)*0.03", z = "{}", {turns} }} }} }},
]
time = {{ scheme = {{ kind = "static" }}, step = 0.025, end = 2.0 }}
"#,
        shift("0.05", "-0.03"),
        shift("-0.03", "-0.05"),
    );
    let mut sim = simulation(&text, &[""; 0]);
    let mut at = |time: f64| {
        while sim.state().time < time - 1e-9 {
            sim.advance(&mut GridReport::default()).unwrap();
        }
        sim.state().contact_forces[0]
    };
    let start = at(1.0);
    let end = at(2.0);
    // By 180° about y; the error is that of the step.
    let size = start[0].hypot(start[1]);
    let apart = (end[0] + start[0]).hypot(end[1] - start[1]);
    assert!(start[1].abs() > 0.1 * size && apart < 2e-3 * size, "{start:?} {end:?}");
}
