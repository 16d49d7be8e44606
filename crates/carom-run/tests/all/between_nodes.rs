//! What presses between nodes has the spring, the limit and the coefficient of its place, wherever
//! it was at the start.

use carom_contact::Rows;
use carom_mechanics::penetration;
use carom_run::Simulation;

use super::common::{finish, simulation};

/// A rigid circle, narrower than a facet, that is carried over a block to x = 2.4, pressed in, and
/// dragged along.
fn circle(from: f64, law: &str) -> String {
    format!(
        r#"
dimension = 2
[[material]]
name = "m"
law = "neo-hookean"
density = 1.0
young = 100.0
poisson = 0.3
[[body]]
name = "b"
material = "m"
element = "Q4"
mesh = {{ shape = "rectangle", min = [0, 0], max = [4, 1], cells = [4, 2] }}
[[support]]
on = ["b.bottom"]
fix = ["x", "y"]
[[contact]]
name = "c"
secondary = "b.top"
primary = {{ circle = {{ center = [{from}, 1.31], radius = 0.3 }}, motion = {{
    x = "({} )*min(t, 1) + 0.1*max(t - 2, 0)",
    y = "-0.02*min(max(t - 1, 0), 1)" }} }}
{law}
[time]
end = 3
step = 0.1
scheme = {{ kind = "static" }}
[output]
fields_every = 0
"#,
        2.4 - from
    )
}

fn force(from: f64, law: &str) -> [f64; 3] {
    finish(simulation(&circle(from, law), &[""; 0])).state().contact_forces[0]
}

#[test]
fn a_circle_presses_with_the_law_of_the_place_where_it_is() {
    for law in [
        "enforcement = \"penalty\"",
        "enforcement = \"penalty\"\nmu = 0.2",
        "mu = \"if(X < 2, 0.1, 0.4)\"",
        "shear = 0.05",
    ] {
        let there = force(2.4, law);
        for from in [0.05, 1.2] {
            let carried = force(from, law);
            let away = (0..2).map(|i| (carried[i] - there[i]).abs()).fold(0.0, f64::max);
            assert!(away < 1e-8 * there[1].abs(), "{law} from {from}: {carried:?} {there:?}");
        }
    }
    // Carried to X = 2.4 and dragged along, the circle slips with the coefficient there, 0.4.
    let [x, y, _] = force(0.05, "mu = \"if(X < 2, 0.1, 0.4)\"");
    assert!((x / y).abs() > 0.3, "{x} {y}");
}

/// Two bars, a sharp edge of one across a sharp edge of the other.
const CROSSED: &str = r#"
dimension = 3
[[material]]
name = "m"
law = "neo-hookean"
density = 1.0
young = 100.0
poisson = 0.3
[[body]]
name = "lower"
material = "m"
element = "Hex8"
mesh = { shape = "box", min = [-1, -0.2, -0.2], max = [1, 0.2, 0.2], cells = [3, 1, 1] }
place = { rotate = { axis = [1, 0, 0], angle = 45 }, shift = [0, 0, -0.282842712474619] }
[[body]]
name = "upper"
material = "m"
element = "Hex8"
mesh = { shape = "box", min = [-0.2, -1, -0.2], max = [0.2, 1, 0.2], cells = [1, 3, 1] }
place = { rotate = { axis = [0, 1, 0], angle = 45 }, shift = [0.1, 0, 0.292842712474619] }
[[support]]
on = ["lower.left", "lower.right"]
fix = ["x", "y", "z"]
[[support]]
on = ["upper.front", "upper.back"]
fix = ["x", "y"]
move = { z = "-0.06*t" }
[[contact]]
name = "c"
secondary = "upper.skin"
primary = "lower.skin"
enforcement = "penalty"
[time]
end = 1
step = 0.1
scheme = { kind = "static" }
[output]
fields_every = 0
"#;

/// Depth of the only closed pair.
fn depth_of_row(sim: &Simulation) -> f64 {
    let kinematics = &sim.model().contacts[0].kinematics;
    let closed: Vec<_> = sim.state().pairs[0].iter().filter(|pair| pair.active).collect();
    assert!(closed.len() == 1 && kinematics.between_nodes(closed[0]).is_some(), "{closed:?}");
    let mut rows = Rows::new(3);
    kinematics.measure(&mut closed[0].clone(), &sim.state().y, &mut rows).unwrap();
    -rows.row(0).gap
}

#[test]
fn edges_on_springs_are_as_deep_as_their_row() {
    let sim = finish(simulation(CROSSED, &[""; 0]));
    let deepest = penetration(sim.model(), sim.state()).all;
    let depth = depth_of_row(&sim);
    assert!(depth > 1e-3 && deepest >= depth * (1.0 - 1e-12), "{deepest} {depth}");
    assert!(deepest < 1.5 * depth, "{deepest} {depth}");
}

/// The edges exchange their roles: the spring is that of either one, so that the force is the same
/// where both bars are.
#[test]
fn the_spring_of_an_edge_does_not_depend_on_its_first_node() {
    let force = |sets: &[&str]| finish(simulation(CROSSED, sets)).state().contact_forces[0][2];
    // Mirrored along the edge of the upper bar, which ends with its other node there.
    let shift = "body.lower.place={ rotate = { axis = [1, 0, 0], angle = 45 }, shift = [0, 0.6, -0.282842712474619] }";
    let mirrored = "body.lower.place={ rotate = { axis = [1, 0, 0], angle = 45 }, shift = [0, -0.6, -0.282842712474619] }";
    let [one, other] = [shift, mirrored].map(|set| force(&[set]));
    assert!(one.abs() > 0.1 && (one / other - 1.0).abs() < 1e-9, "{one} {other}");
}

/// A free circle that slides over the side of a block, on conserving springs that are those of the
/// places where they closed.
#[test]
fn conserving_springs_between_nodes_conserve() {
    let text = r#"
dimension = 2
[[material]]
name = "m"
law = "saint-venant-kirchhoff"
density = 1.0
young = 100.0
poisson = 0.3
[[body]]
name = "b"
material = "m"
element = "Q9"
mesh = { shape = "rectangle", min = [0, 0], max = [4, 1], cells = [4, 1] }
[[support]]
on = ["b.bottom"]
fix = ["x", "y"]
[[contact]]
name = "c"
secondary = "b.top"
primary = { circle = { center = [1.1, 1.302], radius = 0.3 }, mass = 1.0, velocity = [1.0, -0.3] }
enforcement = "penalty"
[time]
end = 0.4
step = 0.005
scheme = { kind = "energy-momentum" }
[newton]
tolerance = 1e-13
[output]
fields_every = 0
"#;
    let sim = simulation(text, &[""; 0]);
    let start = sim.state().ledger.total();
    let sim = finish(sim);
    let ledger = &sim.state().ledger;
    assert!(sim.state().impulses[0][1].abs() > 0.1, "{:?}", sim.state().impulses);
    assert!((ledger.total() / start - 1.0).abs() < 1e-10, "{start} {ledger:?}");
    assert!(ledger.contact_work.abs() < 1e-10 * start, "{ledger:?}");
}
