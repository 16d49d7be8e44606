//! Iteration in place of factors: the same history, to the tolerance of Newton's method, with the
//! same bits on any number of threads and after an interruption; and its errors.

use carom_run::case::{Document, read};
use carom_run::{GridReport, Setup, Simulation, State};

use super::common::{case, finish, on_threads, simulation};

/// A block in space, pulled down by its side and pressed by a pressure that follows.
const BLOCK: &str = r#"
dimension = 3
material = [{ name = "rubber", law = "neo-hookean", density = 0.25, lambda = 200.0, mu = 15.0 }]
body = [{ name = "block", material = "rubber", element = "Tet10", mesh = { shape = "box", min = [0.0, 0.0, 0.0], max = [1.0, 1.0, 1.0], cells = [3, 3, 3] }, velocity = ["0.5*Z*sin(2*Y)", "0", "-3*Z"] }]
support = [{ on = ["block.bottom"], fix = ["x", "y", "z"] }]
load = [{ on = ["block.top"], pressure = "5*sin(20*t)" }]
time = { scheme = { kind = "chung-hulbert", rho_inf = 0.5 }, step = 2e-3, end = 0.02 }
"#;

/// The last state, and the contact force of every step.
fn history(text: &str, sets: &[&str], linear: &str) -> (State, Vec<[f64; 3]>) {
    let linear = format!("newton.linear={linear}");
    let mut sim = simulation(text, &[sets, &[&linear]].concat());
    assert_eq!(sim.linear_iterations().is_some(), linear.ends_with("iterative"));
    let mut forces = Vec::new();
    while !sim.finished() {
        sim.advance(&mut GridReport::default()).unwrap();
        forces.extend(sim.state().contact_forces.iter().copied());
    }
    (sim.into_state(), forces)
}

/// Largest difference.
fn apart(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}

/// With multipliers and springs, symmetric tangents and those of a discrete gradient; the contact
/// begins and is projected within the run.
#[test]
fn an_impact_in_the_plane_has_the_same_history() {
    let text = include_str!("../../../../cases/impact/impact.toml");
    let coarse = [
        "body.cylinder.mesh.size=0.25",
        "body.cylinder.mesh.center=[0.0, 0.51]",
        "body.cylinder.velocity=[0, -3]",
        "body.prism.mesh.cells=[4,2]",
        "probe.A.at=[0.0, 1.01]",
        "time.end=0.075",
        // Springs chatter, which magnifies what a solver leaves.
        "newton.tolerance=1e-12",
    ];
    for more in [
        &[][..],
        &["contact.strike.enforcement=penalty"],
        &["time.scheme={ kind = \"energy-momentum\" }", "contact.strike.enforcement=penalty"],
        &["time.scheme={ kind = \"energy-momentum\" }"],
    ] {
        let sets = [&coarse[..], more].concat();
        let (direct, wanted) = history(text, &sets, "direct");
        let (iterative, forces) = history(text, &sets, "iterative");
        let largest = wanted.iter().map(|f| f[1].abs()).fold(0.0, f64::max);
        assert!(largest > 1.0);
        let force = apart(forces.as_flattened(), wanted.as_flattened()) / largest;
        let place = apart(&iterative.y, &direct.y);
        assert!(force < 1e-6 && place < 1e-8, "{more:?}: force {force:e}, place {place:e}");
    }
}

#[test]
fn a_block_in_space_has_the_same_history() {
    for scheme in ["{ kind = \"chung-hulbert\", rho_inf = 0.5 }", "{ kind = \"bathe\", rho_inf = 0.0 }"] {
        let sets = [&format!("time.scheme={scheme}")[..]];
        let (direct, _) = history(BLOCK, &sets, "direct");
        let (iterative, _) = history(BLOCK, &sets, "iterative");
        let (place, speed) = (apart(&iterative.y, &direct.y), apart(&iterative.v, &direct.v));
        assert!(place < 1e-10 && speed < 1e-7, "{scheme}: place {place:e}, velocity {speed:e}");
    }
}

#[test]
fn statics_in_space_has_the_same_equilibrium() {
    let sets = ["time.scheme={ kind = \"static\" }", "time.step=0.01", "body.block.velocity=[0, 0, 0]"];
    let (direct, _) = history(BLOCK, &sets, "direct");
    let (iterative, _) = history(BLOCK, &sets, "iterative");
    let place = apart(&iterative.y, &direct.y);
    assert!(place < 1e-9 && apart(&direct.y, &simulation(BLOCK, &sets).state().y) > 1e-3, "{place:e}");
}

#[test]
fn iterations_have_the_same_bits_with_any_number_of_threads_and_after_an_interruption() {
    let iterative = ["newton.linear=iterative"];
    let of = |threads: usize| -> Simulation { on_threads(BLOCK, &iterative, threads) };
    let one = finish(of(1));
    for threads in [2, 3] {
        assert_eq!(finish(of(threads)).state(), one.state(), "{threads} threads");
    }
    let (mut begun, mut resumed) = (of(1), of(1));
    (0..4).for_each(|_| begun.advance(&mut GridReport::default()).unwrap());
    resumed.restore(begun.state().clone()).unwrap();
    assert_eq!(finish(resumed).state(), one.state());
}

#[test]
fn a_beam_too_slender_for_iteration_says_so() {
    let sets = [
        "dimension=2",
        "body.block.element=Q4",
        "body.block.mesh={ shape = \"rectangle\", min = [0.0, 0.0], max = [1.0, 1e-4], cells = [800, 1] }",
        "body.block.velocity=[0, 0]",
        "support=[{ on = [\"block.left\"], fix = [\"x\", \"y\"] }]",
        "load=[{ on = [\"block.top\"], traction = [0.0, -1e-12] }]",
        "time.scheme={ kind = \"static\" }",
        "time.step=0.02",
        "newton.linear=iterative",
    ];
    let mut sim = Setup::new(&case(BLOCK, &sets)).start().unwrap();
    sim.limit_bisections(0);
    let stopped = sim.advance(&mut GridReport::default()).unwrap_err().to_string();
    assert!(stopped.contains("conjugate gradients do not converge"), "{stopped}");
}

#[test]
fn what_iteration_cannot_solve_is_refused_with_its_key() {
    let impact = include_str!("../../../../cases/impact/impact.toml");
    for (set, part) in [
        ("contact.strike.mu=0.3", "has friction"),
        ("time.scheme={ kind = \"moreau-jean\", theta = 0.5 }", "the steps of moreau-jean"),
        ("newton.tangent=frozen-double", "newton.tangent"),
    ] {
        let sets = [set.to_owned(), "newton.linear=iterative".to_owned()];
        let document = Document::parse("case.toml", impact, &sets).unwrap();
        let message = document.diagnose_all(&read(&document).unwrap_err()).to_string();
        let at_key = message.contains("newton.linear=iterative") || message.contains(part);
        assert!(message.contains("does not solve") && at_key, "{set}: {message}");
        assert!(message.contains(part), "{set}: {message}");
    }
}
