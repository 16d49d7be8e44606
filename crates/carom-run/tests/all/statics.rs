//! Load steps without inertia: exact equilibria, stable and unstable, and unconstrained bodies.

use carom_run::{GridReport, LogEvent};

use super::common::{case as case_of, finish, simulation};
use super::loads::{HELD, bar, body, time};

/// The end of a massless bar follows instantly: u(x) = x u(t), force E A u(t).
#[test]
fn without_mass_a_moved_bar_is_in_equilibrium_at_every_time() {
    let support = "[[support]]\nname = \"pull\"\non = [\"bar.right\"]\nmove = { x = \"0.1*t^2\" }\n";
    let tables =
        [&body(5, "consistent"), HELD, support, &time(1.0, 0.05, r#"{ kind = "newmark", rho_inf = 1.0 }"#)];
    for scheme in [r#"{ kind = "newmark", rho_inf = 1.0 }"#, r#"{ kind = "static" }"#] {
        let mut sim = bar(&tables.concat().replace(tables[3], &time(1.0, 0.05, scheme)));
        if !scheme.contains("static") {
            sim = simulation(&format!("{MASSLESS}{}", tables.concat()), &[""; 0]);
        }
        while !sim.finished() {
            sim.advance(&mut GridReport::default()).unwrap();
            let u = 0.1 * sim.state().time * sim.state().time;
            for (y, x) in sim.state().y.iter().zip(&sim.model().reference) {
                assert!((y - x - x * u).abs() < 1e-14, "{scheme}");
            }
            assert!((sim.state().f_internal[0] + u).abs() < 1e-13);
            assert!((sim.state().ledger.strain - 0.5 * u * u).abs() < 1e-13);
        }
        // The trapezoidal rule is exact where force and displacement are proportional; the massless
        // balance at the step's end uses the end's force.
        if scheme.contains("static") {
            assert!(sim.state().ledger.dissipation().abs() < 1e-14, "{:e}", sim.state().ledger.dissipation());
            assert!(
                sim.state().v.iter().chain(&sim.state().a).all(|x| *x == 0.0)
                    && sim.state().ledger.kinetic == 0.0
            );
        }
    }
}

const MASSLESS: &str = r#"
dimension = 1
[[material]]
name = "unit"
law = "linear-elastic"
density = 0.0
young = 1.0
poisson = 0.0
"#;

/// u(x) = ρg (L x − x²/2)/E, exact at the nodes of linear elements; as body force and as gravity.
#[test]
fn a_bar_hangs_under_its_own_weight() {
    let time = time(1.0, 0.25, r#"{ kind = "static" }"#);
    let weight = "[[load]]\nname = \"weight\"\nbody = \"bar\"\nbody_force = [\"0.02*t\"]\n";
    let sim = finish(bar(&[&body(8, "consistent"), HELD, weight, &time].concat()));
    let gravity = body(8, "consistent") + "gravity = [0.02]\n";
    let other = finish(bar(&[&gravity, HELD, &time].concat()));
    for sim in [&sim, &other] {
        for (y, x) in sim.state().y.iter().zip(&sim.model().reference) {
            assert!((y - x - 0.02 * (x - 0.5 * x * x)).abs() < 1e-14);
        }
        assert!(
            (sim.state().f_internal[0] - sim.model().gravity[0] - sim.state().f_external[0] + 0.02).abs()
                < 1e-12 * 0.02
        );
    }
    // The work of a load proportional to its displacement becomes strain energy; the trapezoidal
    // rule is exact.
    let ledger = &sim.state().ledger;
    assert!((ledger.external_work - ledger.strain).abs() < 1e-15, "{ledger:?}");
}

/// An unconstrained body is reported by name; one that contact can constrain is accepted, and
/// reported if contact does not.
#[test]
fn an_unconstrained_body_is_named() {
    let text = |support: &str, at: f64| {
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
name = "disc"
material = "rubber"
element = "T6"
mesh = {{ shape = "half-disc", radius = 0.5, center = [0.0, {at:?}], size = 0.125 }}
gravity = [0.0, -0.2]
{support}
[[contact]]
name = "floor"
secondary = "disc.arc"
primary = {{ plane = {{ point = [0.0, 0.0], normal = [0.0, 1.0] }} }}
[time]
end = 1.0
step = 0.5
scheme = {{ kind = "static" }}
"#
        )
    };
    let axis = "[[support]]\non = [\"disc.axis\"]\nfix = [\"x\"]\n";
    let case = case_of(&text("", 0.5), &[""; 0]);
    // Without its contact nothing can constrain it: the case is invalid.
    let mut alone = case.clone();
    alone.contacts.clear();
    let problems = carom_run::Setup::new(&alone).start().err().unwrap();
    assert!(problems[0].what.starts_with("body \"disc\" is free to"), "{problems:?}");
    // With a gap it falls: reported by name, with a suggestion.
    let stopped =
        simulation(&text(axis, 0.6), &[""; 0]).advance(&mut GridReport::default()).unwrap_err().to_string();
    assert!(stopped.contains("body \"disc\" is free to move along y"), "{stopped}");
    assert!(stopped.contains("a support that moves"), "{stopped}");
    // In contact, it rests on the floor with its weight, also on springs.
    for springs in [&[][..], &["contact.floor.enforcement=penalty"]] {
        let sim = finish(simulation(&text(axis, 0.5), springs));
        let weight: f64 = sim.model().gravity.iter().skip(1).step_by(2).sum();
        assert!(
            (sim.state().contact_forces[0][1] + weight).abs() < 1e-9 * weight.abs(),
            "{:?} {weight}",
            sim.state().contact_forces
        );
    }
}

/// A strut compressed by a fifth, far beyond its buckling loads: the straight equilibrium is
/// unstable in several directions and the tangent indefinite, but exact: P₂₂ of homogeneous plane
/// strain with P₁₁ = 0, neo-Hookean Ψ = Λ/2 ln²J + μ/2 (I₁ − 3) − μ ln J.
#[test]
fn a_straight_strut_stays_in_its_unstable_equilibrium() {
    let text = r#"
dimension = 2
[[material]]
name = "rubber"
law = "neo-hookean"
density = 1.0
lambda = 20.0
mu = 10.0
[[body]]
name = "strut"
material = "rubber"
element = "T6"
mesh = { shape = "polygon", points = [[0.0, 0.0], [1.0, 0.0], [1.0, 12.0], [0.0, 12.0], [0.0, 0.5]], size = 0.5 }
[[support]]
on = ["strut.side1"]
fix = ["y"]
[[support]]
on = ["strut.side5"]
fix = ["x"]
[[support]]
name = "press"
on = ["strut.side3"]
move = { y = "-2.4*t" }
[time]
end = 1.0
step = 0.125
scheme = { kind = "static" }
"#;
    let p11 = |a: f64| 10.0 * (a - 1.0 / a) + 20.0 * (a * 0.8).ln() / a;
    let (mut low, mut high) = (0.9, 1.3);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if p11(middle) < 0.0 { low = middle } else { high = middle }
    }
    let force = (10.0 * (0.8 - 1.0 / 0.8) + 20.0 * (low * 0.8).ln() / 0.8).abs();
    let sim = finish(simulation(text, &[""; 0]));
    let top = sim.model().reference.as_chunks::<2>().0.iter().zip(sim.state().f_internal.as_chunks::<2>().0);
    let pushed: f64 = top.filter(|(x, _)| x[1] == 12.0).map(|(_, f)| f[1]).sum();
    assert!((pushed + force).abs() < 1e-9 * force, "{pushed} {force}");
    for (y, x) in sim.state().y.as_chunks::<2>().0.iter().zip(sim.model().reference.as_chunks::<2>().0) {
        assert!((y[0] - low * x[0]).abs() < 1e-9 && (y[1] - 0.8 * x[1]).abs() < 1e-9, "{x:?} {y:?}");
    }
}

/// Two blocks, tied on top of each other, that rest on a plane under a pressure: a contact of one
/// of them holds both, whichever the tie moves.
#[test]
fn a_body_that_is_tied_to_one_in_contact_is_held() {
    let text = r#"
dimension = 2
material = [{ name = "m", law = "neo-hookean", density = 1.0, young = 300.0, poisson = 0.3 }]
[[body]]
name = "low"
material = "m"
element = "T6"
mesh = { shape = "rectangle", min = [0.0, 0.0], max = [1.0, 0.5], cells = [4, 2] }
[[body]]
name = "high"
material = "m"
element = "T6"
mesh = { shape = "rectangle", min = [0.0, 0.5], max = [1.0, 1.0], cells = [4, 2] }
[[support]]
on = ["low.left", "high.left"]
fix = ["x"]
[[load]]
on = ["high.top"]
pressure = "2*t"
[[contact]]
name = "floor"
secondary = "low.bottom"
primary = { plane = { point = [0.0, 0.0], normal = [0.0, 1.0] } }
[[tie]]
name = "glue"
secondary = "high.bottom"
primary = "low.top"
[time]
end = 1.0
step = 0.25
scheme = { kind = "static" }
"#;
    for sets in [&[""; 0][..], &[r#"tie.glue.secondary="low.top""#, r#"tie.glue.primary="high.bottom""#]] {
        let sim = finish(simulation(text, sets));
        // The pressure follows the deformed top, which is wider.
        let model = sim.model();
        let top = &model.parts[1].body.mesh();
        let corner = |x: f64| {
            let node = top.nodes.iter().position(|at| at == [x, 1.0]).unwrap() + model.parts[1].first_node;
            sim.state().y[2 * node]
        };
        let weight = 2.0 * (corner(1.0) - corner(0.0));
        let force = sim.state().contact_forces[0][1];
        assert!((force / weight - 1.0).abs() < 1e-8, "{force} {weight}");
    }
}

/// A block on springs of any stiffness: a gap is a difference of positions, and its round-off times
/// the stiffness is a force that no correction removes.
#[test]
fn stiff_springs_settle_to_the_round_off_of_their_gaps() {
    let text = r#"
dimension = 2
material = [{ name = "m", law = "linear-elastic", density = 0.0, young = 1e7, poisson = 0.0 }]
support = [{ on = ["b.bottom"], fix = ["x", "y"] }]
time = { end = 1.0, step = 0.25, scheme = { kind = "static" } }
[[body]]
name = "b"
material = "m"
element = "Q4"
mesh = { shape = "rectangle", min = [-0.5, 0.0], max = [0.5, 0.5], cells = [4, 2] }
[[contact]]
name = "k"
enforcement = "penalty"
secondary = "b.top"
primary = { plane = { point = [0.0, 0.5], normal = [0.0, -1.0] }, motion = { y = "-0.005*t" } }
"#;
    for stiffness in [1e2, 1e4, 1e6] {
        let end = finish(simulation(text, &[format!("contact.k.stiffness={stiffness:e}")]));
        // Springs of 2 E/h per stiffness, h half of the height, in line with the block.
        let exact = 1e5 * 2.0 * stiffness / (1.0 + 2.0 * stiffness);
        // The gap, 0.005/(1 + 2 stiffness), is known to 1e-16.
        let known = 1e-9 + 1e-13 * stiffness;
        let force = end.state().contact_forces[0][1];
        assert!((force.abs() / exact - 1.0).abs() < known, "{stiffness:e}: {force} {exact}");
    }
}

/// A block that presses on a plate without a support below: both are named, not the block alone.
#[test]
fn bodies_that_are_free_together_are_named_together() {
    const FLOATS: &str = r#"
dimension = 2
material = [{ name = "m", law = "neo-hookean", density = 1.0, young = 100.0, poisson = 0.3 }]
body = [
    { name = "block", material = "m", element = "Q4", mesh = { shape = "rectangle", min = [0.0, 0.0], max = [0.5, 0.5], cells = [2, 2] }, gravity = [0.0, -1.0] },
    { name = "plate", material = "m", element = "Q4", mesh = { shape = "rectangle", min = [0.0, -0.3], max = [1.0, 0.0], cells = [4, 1] } },
]
support = [{ on = ["block.left", "plate.left"], fix = ["x"] }]
contact = [{ name = "foot", secondary = "block.bottom", primary = "plate.top" }]
time = { scheme = { kind = "static" }, step = 1.0, end = 1.0 }
"#;
    let stopped = simulation(FLOATS, &[""; 0]).advance(&mut GridReport::default()).unwrap_err().to_string();
    assert!(stopped.contains("bodies \"block\", \"plate\" are together free to move along y"), "{stopped}");
    assert!(stopped.contains("Add a support to one of them"), "{stopped}");
}

/// A column, clamped at its foot, under a load that grows to three times Euler's, π²EI/(4 L²): from
/// a third of it on, straight equilibria are unstable. With its head held too, eight times Euler's
/// load is needed.
#[test]
fn a_straight_column_above_eulers_load_is_said_to_be_unstable() {
    let column = r#"
dimension = 2
plane = "stress"
thickness = 0.5
material = [{ name = "m", law = "saint-venant-kirchhoff", density = 1.0, young = 1000.0, poisson = 0.3 }]
body = [{ name = "b", material = "m", element = "Q9", mesh = { shape = "rectangle", min = [0.0, 0.0], max = [1.0, 20.0], cells = [2, 20] } }]
support = [{ on = ["b.bottom"], fix = ["x", "y"] }]
load = [{ on = ["b.top"], traction = ["0", "-1.5421256876702123*t"] }]
time = { scheme = { kind = "static" }, step = 0.05, end = 1.0 }
"#;
    let first_unstable = |sets: &[&str]| {
        let mut sim = simulation(column, sets);
        let mut report = GridReport::default();
        while !sim.finished() {
            sim.advance(&mut report).unwrap();
        }
        report.events.iter().find_map(|event| match event {
            LogEvent::Unstable { time } => Some(*time),
            _ => None,
        })
    };
    assert!(first_unstable(&[]).is_some_and(|time| (time - 0.35).abs() < 1e-9));
    let held = r#"support=[{ on = ["b.bottom"], fix = ["x", "y"] }, { on = ["b.top"], fix = ["x"] }]"#;
    assert_eq!(first_unstable(&[held]), None);
    // Pressure turns with the top: the column is stable far above Euler's load, and the tangent,
    // which is not symmetric, does not tell.
    let follows = r#"load=[{ on = ["b.top"], pressure = "1.5421256876702123*t" }]"#;
    assert_eq!(first_unstable(&[follows]), None);
}

/// A block that only contact holds up is stable: a motion that opens no gap needs energy.
#[test]
fn a_block_that_rests_on_an_obstacle_is_stable() {
    let block = r#"
dimension = 2
material = [{ name = "m", law = "neo-hookean", density = 1.0, young = 100.0, poisson = 0.3 }]
body = [{ name = "b", material = "m", element = "Q4", mesh = { shape = "rectangle", min = [0.0, 0.0], max = [1.0, 1.0], cells = [4, 4] }, gravity = ["0", "-9.81*t"] }]
support = [{ on = ["b.left"], fix = ["x"] }]
contact = [{ name = "floor", secondary = "b.bottom", primary = { plane = { point = [0.0, 0.0], normal = [0.0, 1.0] } } }]
time = { scheme = { kind = "static" }, step = 0.25, end = 1.0 }
"#;
    let mut sim = simulation(block, &[""; 0]);
    let mut report = GridReport::default();
    while !sim.finished() {
        sim.advance(&mut report).unwrap();
    }
    assert!((sim.state().contact_forces[0][1].abs() - 9.81).abs() < 1e-9);
    assert!(!report.events.iter().any(|event| matches!(event, LogEvent::Unstable { .. })));
}
