//! A case rotated and translated as a whole gives the rotated and translated motion: shapes,
//! contact and gravity. So does a body whose initial positions are a rigid motion of its mesh.

use super::common::{case, finish, simulation};

const DROP: &str = r#"
dimension = 2
material = [{ name = "rubber", law = "neo-hookean", density = 1.0, young = 100.0, poisson = 0.3 }]
time = { end = 0.1, step = 2.5e-3, scheme = { kind = "chung-hulbert", rho_inf = 0.5 } }

[[body]]
name = "tube"
material = "rubber"
element = "T6"
mesh = { shape = "ring", inner = 0.3, outer = 0.5, center = [0.05, 0.52], size = 0.2 }
velocity = [0.0, -1.0]
gravity = [0.0, -10.0]

[[body]]
name = "anvil"
material = "rubber"
element = "T3"
mesh = { shape = "polygon", points = [[-1.0, -0.5], [1.0, -0.5], [1.0, 0.0], [-1.0, 0.0]], size = 0.3, refine = [{ near = [0.0, 0.0], radius = 0.2, size = 0.1 }] }

[[support]]
on = ["anvil.side1"]
fix = ["x", "y"]

[[contact]]
name = "strike"
secondary = "tube.outer"
primary = "anvil.side3"
"#;

fn run(sets: &[String]) -> (Vec<[f64; 2]>, usize) {
    let sim = finish(simulation(DROP, sets));
    let active = sim.state().pairs.iter().flatten().filter(|p| p.active).count();
    (sim.state().y.as_chunks::<2>().0.to_vec(), active)
}

#[test]
fn a_turned_and_moved_case_moves_alike() {
    let (y, active) = run(&[]);
    assert!(active > 0);
    for degrees in [90.0, 37.0_f64] {
        let (s, c) = degrees.to_radians().sin_cos();
        let turned = |x: [f64; 2]| [c * x[0] - s * x[1], s * x[0] + c * x[1]];
        let (v, g) = (turned([0.0, -1.0]), turned([0.0, -10.0]));
        let place = format!("{{ rotate = {degrees}, about = [1.0, 2.0], shift = [-3.0, 0.5] }}");
        let (other, _) = run(&[
            format!("body.tube.place={place}"),
            format!("body.anvil.place={place}"),
            format!("body.tube.velocity=[{:e}, {:e}]", v[0], v[1]),
            format!("body.tube.gravity=[{:e}, {:e}]", g[0], g[1]),
        ]);
        let mut worst = 0.0_f64;
        for (here, there) in y.iter().zip(&other) {
            let moved = turned([here[0] - 1.0, here[1] - 2.0]);
            worst = worst.max((moved[0] - 2.0 - there[0]).hypot(moved[1] + 2.5 - there[1]));
        }
        assert!(worst < 1e-12, "{degrees}°: {worst:e}");
    }
}

#[test]
fn positions_that_only_turn_a_body_leave_it_unstrained() {
    let (y, _) =
        run(&["body.tube.place={ rotate = 90.0, about = [0.05, 0.52], shift = [0.0, 0.01] }".into()]);
    let (other, active) = run(&["body.tube.position=[\"0.05 - (Y - 0.52)\", \"0.53 + (X - 0.05)\"]".into()]);
    assert!(active > 0);
    let apart = |(a, b): (&[f64; 2], &[f64; 2])| (a[0] - b[0]).hypot(a[1] - b[1]);
    let worst = y.iter().zip(&other).map(apart).fold(0.0, f64::max);
    assert!(worst < 1e-10, "{worst:e}");
}

#[test]
fn bodies_must_not_overlap_where_they_start() {
    const LOWER: &str = "body.tube.position=[\"X\", \"Y - 0.05\"]";
    let problems = |sets: &[&str]| {
        carom_run::Setup::new(&case(DROP, sets))
            .start()
            .err()
            .unwrap_or_default()
            .iter()
            .map(|p| format!("{}: {}", p.path, p.what))
            .collect::<Vec<_>>()
    };
    assert_eq!(
        problems(&[LOWER]),
        ["contact[0]: the bodies of contact \"strike\" overlap at the start by 0.03 m"]
    );
    assert_eq!(
        problems(&["body.tube.position=[\"X\", \"1.04 - Y\"]"]),
        ["body[0].position: the initial position inverts a cell"]
    );
    // No value at a node of a constrained side.
    assert_eq!(
        problems(&["body.anvil.velocity=[\"1/(X + 1)\", \"0\"]"]),
        ["body[1].velocity: the initial velocity has no finite value"]
    );
    // No overlap with the primary out of the way.
    assert!(problems(&[LOWER, "body.anvil.position=[\"X\", \"1.1*(Y + 0.5) - 0.6\"]"]).is_empty());
}

/// A block of 2 × 1 that is turned by its positions and spins about its centre there: no momentum,
/// and ρ A (2² + 1²)/12 · ω of angular momentum.
#[test]
fn a_body_spins_about_a_point_where_its_positions_are() {
    let text = r#"
dimension = 2
material = [{ name = "rubber", law = "neo-hookean", density = 1.0, young = 100.0, poisson = 0.3 }]
time = { end = 1e-3, step = 1e-3, scheme = { kind = "chung-hulbert", rho_inf = 0.5 } }
[[body]]
name = "block"
material = "rubber"
element = "Q4"
mesh = { shape = "rectangle", min = [0.0, 0.0], max = [2.0, 1.0], cells = [4, 2] }
position = ["3 - Y", "X + 1"]
velocity = { angular = 2.0, about = [2.5, 2.0] }
"#;
    let sim = simulation(text, &[""; 0]);
    let momenta = sim.model().momenta(&sim.state().y, &sim.state().v);
    assert!(momenta.linear.iter().all(|component| component.abs() < 1e-14), "{momenta:?}");
    let exact = 2.0 * 2.0 * (4.0 + 1.0) / 12.0;
    assert!((momenta.angular[2] - exact).abs() < 1e-13, "{momenta:?}");
}
