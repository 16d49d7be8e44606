//! Contact of explicit steps: nodes of the primary side, bodies that touch at the start, and
//! restitution.

use carom_run::Simulation;

use super::common::{finish, simulation};

/// The largest depth of a run in which a disc, the primary, strikes a coarse block.
fn deepest(step: &str) -> f64 {
    let text = format!(
        r#"
dimension = 2
material = [{{ name = "m", law = "neo-hookean", density = 1.0, young = 100.0, poisson = 0.3 }}]
[[body]]
name = "disc"
material = "m"
element = "T6"
mass = "lumped"
mesh = {{ shape = "disc", radius = 0.5, center = [0.13, 0.52], size = 0.1 }}
velocity = [0.0, -1.0]
[[body]]
name = "block"
material = "m"
element = "T6"
mass = "lumped"
mesh = {{ shape = "rectangle", min = [-1.0, -0.5], max = [1.0, 0.0], cells = [4, 1] }}
[[support]]
on = ["block.bottom"]
fix = ["x", "y"]
[[contact]]
name = "c"
secondary = "block.top"
primary = "disc.arc"
[time]
end = 0.2
step = {step}
scheme = {{ kind = "central-difference" }}
"#
    );
    let mut sim = simulation(&text, &[""; 0]);
    let mut deepest = 0.0_f64;
    while !sim.finished() {
        deepest = deepest.max(sim.step().unwrap().penetration.all);
    }
    deepest
}

/// Nodes of the primary may be a fiftieth of a facet of 0.5 deep, however slowly they approach.
#[test]
fn nodes_of_the_primary_are_held_at_their_depth() {
    for step in ["1e-3", "5e-4"] {
        let deepest = deepest(step);
        assert!((deepest - 0.01).abs() < 1e-5, "{step}: {deepest}");
    }
}

fn bar(cells: usize, gap: &str, contact: &str, scheme: &str, step: &str) -> Simulation {
    let text = format!(
        r#"
dimension = 1
material = [{{ name = "m", law = "saint-venant-kirchhoff", density = 1.0, young = 100.0, poisson = 0.0 }}]
[[body]]
name = "bar"
material = "m"
element = "L2"
mass = "lumped"
mesh = {{ shape = "interval", min = 0.0, max = 1.0, cells = {cells} }}
velocity = [-1.0]
[[contact]]
name = "wall"
secondary = "bar.left"
primary = {{ plane = {{ point = [-{gap}], normal = [1.0] }} }}
{contact}
[time]
end = 0.4
step = {step}
energy_guard = false
scheme = {{ kind = "{scheme}" }}
"#
    );
    simulation(&text, &[""; 0])
}

/// The node that strikes, of mass 0.05, loses its energy, whether it touches at the start or not.
#[test]
fn what_touches_at_the_start_loses_the_energy_of_its_node() {
    for gap in ["0.0", "0.0101"] {
        let ledger = finish(bar(10, gap, "", "central-difference", "1e-4")).state().ledger.clone();
        assert!((ledger.contact_work + 0.025).abs() < 1e-4, "{gap}: {}", ledger.contact_work);
        assert!(ledger.dissipation().abs() < 1e-5, "{gap}: {:e}", ledger.dissipation());
    }
}

/// The node is at rest on average over the step in which it turns: its energy comes back.
#[test]
fn restitution_creates_no_energy() {
    let sim = finish(bar(4, "0.0101", "restitution = 1.0", "paoli-schatzman", "1e-4"));
    let ledger = &sim.state().ledger;
    assert!(ledger.created.most() < 1e-3 * ledger.scale(), "{:e}", ledger.created.most());
    assert!((ledger.total() - 0.5).abs() < 2e-3, "{}", ledger.total());
}

/// A particle that falls on a wall leaves with e times its velocity, wherever in a step it meets
/// the wall; with the energy guard, which the other tests switch off.
#[test]
fn the_rebound_does_not_depend_on_where_in_a_step_it_begins() {
    for case in 0..40 {
        let height = 0.2 + 7e-4 * f64::from(case);
        let restitution = [1.0, 0.8, 0.5][case as usize % 3];
        let text = format!(
            r#"
dimension = 1
material = [{{ name = "m", law = "linear-elastic", density = 2.0, young = 1e-6, poisson = 0.0 }}]
[[body]]
name = "b"
material = "m"
element = "L2"
mesh = {{ shape = "interval", min = {height}, max = 1.2, cells = 1 }}
mass = "lumped"
gravity = [-10.0]
[[support]]
on = ["b.right"]
fix = ["x"]
[[contact]]
name = "w"
secondary = "b.left"
restitution = {restitution}
primary = {{ plane = {{ point = [0.0], normal = [1.0] }} }}
[time]
end = 0.25
step = 5e-4
scheme = {{ kind = "paoli-schatzman" }}
"#
        );
        let sim = finish(simulation(&text, &[""; 0]));
        // Free fall, and free flight from the wall on.
        let strikes = (2.0 * height / 10.0).sqrt();
        let leaves = restitution * 10.0 * strikes;
        let exact = leaves - 10.0 * (0.25 - strikes);
        let error = sim.state().v[0] - exact;
        assert!(error.abs() < 0.02, "{case}: {} {exact}", sim.state().v[0]);
    }
}

/// With long steps the law throws nodes out that lie behind the wall: that energy is created.
#[test]
fn energy_that_the_law_creates_is_seen() {
    let sim = finish(bar(4, "0.0101", "restitution = 1.0", "paoli-schatzman", "0.01"));
    let ledger = &sim.state().ledger;
    assert!(ledger.created.most() > 0.8 * ledger.contact_work, "{ledger:?}");
}

/// Sides that touch as they are, 0.04 apart, press from there on.
#[test]
fn sides_that_touch_at_a_distance_are_found() {
    let text = r#"
dimension = 2
material = [{ name = "m", law = "neo-hookean", density = 1.0, young = 100.0, poisson = 0.3 }]
body = [
    { name = "above", material = "m", element = "Q4", mass = "lumped", mesh = { shape = "rectangle", min = [0.0, 0.04], max = [1.0, 1.04], cells = [4, 4] }, velocity = [0.0, -0.1] },
    { name = "below", material = "m", element = "Q4", mass = "lumped", mesh = { shape = "rectangle", min = [0.0, -1.0], max = [1.0, 0.0], cells = [4, 4] } },
]
support = [{ on = ["below.bottom"], fix = ["x", "y"] }]
[[contact]]
name = "c"
secondary = "above.bottom"
primary = "below.top"
overlap = "touch"
[time]
end = 0.05
step = 1e-3
scheme = { kind = "central-difference" }
"#;
    let mut sim = simulation(text, &[""; 0]);
    for _ in 0..5 {
        sim.step().unwrap();
    }
    assert!(sim.state().contact_forces[0][1] > 0.0);
}
