//! Symmetric impacts on meshes whose nodes meet joints of facets: whole models move as their
//! halves, and not sideways. Neither round-off nor the numbers of facets decide.

use carom_run::GridReport;

use super::common::{finish, simulation};

/// The half of a block that strikes a pad whose joints lie below its nodes, and the whole, have the
/// same force.
#[test]
fn a_whole_model_is_twice_its_half() {
    let case = |scheme: &str, up: &str, pad: &str, symmetry: &str| {
        format!(
            r#"
            dimension = 2
            material = [{{ name = "m", law = "neo-hookean", density = 1.5, young = 200.0, poisson = 0.35 }}]
            contact = [{{ name = "c", secondary = "up.bottom", primary = "pad.top" }}]
            support = [{{ on = ["pad.bottom"], fix = ["x", "y"] }}{symmetry}]
            time = {{ end = 0.1, step = 0.005, scheme = {scheme} }}
            [[body]]
            name = "up"
            material = "m"
            element = "Q9"
            mesh = {{ shape = "rectangle", {up} }}
            velocity = [0.0, -1.0]
            [[body]]
            name = "pad"
            material = "m"
            element = "Q9"
            mesh = {{ shape = "rectangle", {pad} }}
            "#
        )
    };
    let symmetry = ", { on = [\"up.left\", \"pad.left\"], fix = [\"x\"] }";
    for scheme in ["{ kind = \"energy-momentum\" }", "{ kind = \"moreau-jean\", theta = 0.5 }"] {
        let half = case(
            scheme,
            "min = [0.0, 0.0], max = [0.6, 0.5], cells = [3, 3]",
            "min = [0.0, -0.52], max = [1.0, -0.02], cells = [5, 3]",
            symmetry,
        );
        let whole = case(
            scheme,
            "min = [-0.6, 0.0], max = [0.6, 0.5], cells = [6, 3]",
            "min = [-1.0, -0.52], max = [1.0, -0.02], cells = [10, 3]",
            "",
        );
        let mut runs = [half, whole].map(|case| simulation(&case, &[""; 0]));
        let mut most: f64 = 0.0;
        while !runs[0].finished() {
            runs.iter_mut().for_each(|sim| sim.advance(&mut GridReport::default()).unwrap());
            let [half, whole] = runs.each_ref().map(|sim| sim.state().impulses[0][1]);
            most = most.max(half.abs());
            assert!((2.0 * half - whole).abs() <= 1e-8 * most, "{scheme}: {half} {whole}");
        }
        assert!(most > 0.1);
    }
}

/// A cuboid that falls flat on a wider one does not move sideways, although nodes of either lie
/// over joints of the other, and slide along them from one to the next.
#[test]
fn a_flat_drop_stays_on_its_axis() {
    let case = |material: &str, contact: &str, time: &str, mass: &str| {
        format!(
            r#"
            dimension = 3
            material = [{{ name = "m", law = "neo-hookean", density = 1.0, {material} }}]
            contact = [{{ name = "c", {contact} }}]
            support = [{{ on = ["pedestal.bottom"], fix = ["x", "y", "z"] }}]
            time = {{ {time} }}
            [[body]]
            name = "block"
            material = "m"
            element = "Hex8"
            mesh = {{ shape = "box", min = [-0.25, -0.25, 0.005], max = [0.25, 0.25, 0.255], cells = [4, 4, 2] }}
            velocity = [0.0, 0.0, -0.5]
            mass = "{mass}"
            [[body]]
            name = "pedestal"
            material = "m"
            element = "Hex8"
            mesh = {{ shape = "box", min = [-0.375, -0.375, -0.25], max = [0.375, 0.375, 0.0], cells = [6, 6, 2] }}
            mass = "{mass}"
            "#
        )
    };
    let implicit = case(
        "young = 1000.0, poisson = 0.3",
        "between = \"all\"",
        "end = 0.065, step = 0.0013, scheme = { kind = \"energy-momentum\" }",
        "consistent",
    );
    let explicit = case(
        "young = 800.0, poisson = 0.35",
        "secondary = \"pedestal.skin\", primary = \"block.skin\"",
        "end = 0.06612, step = 0.00087, scheme = { kind = \"central-difference\" }",
        "lumped",
    );
    for case in [implicit, explicit] {
        let sim = finish(simulation(&case, &[""; 0]));
        let block = sim.model().parts[0].nodes();
        let momentum =
            |axis: usize| -> f64 { block.clone().map(|node| sim.state().v[3 * node + axis]).sum() };
        for axis in 0..2 {
            let sideways = momentum(axis).abs() / momentum(2).abs();
            assert!(sideways < 1e-9, "{sideways:e}");
        }
        assert!(sim.state().impulses.iter().any(|impulse| impulse[2].abs() > 0.01));
    }
}

/// A punch with sharp edges, longer than the plate into which it is pressed. Returns the force on
/// the secondary side.
fn punched(plate: &str, punch: &str, planes: &str, contact: &str) -> [f64; 3] {
    let text = format!(
        r#"
dimension = 3
material = [{{ name = "m", law = "neo-hookean", density = 1.0, young = 100.0, poisson = 0.3 }}]
body = [
    {{ name = "plate", material = "m", element = "Hex8", mesh = {{ shape = "box", {plate} }} }},
    {{ name = "punch", material = "m", element = "Hex8", mesh = {{ shape = "box", {punch} }} }},
]
support = [
    {planes}
    {{ on = ["plate.bottom"], fix = ["x", "y", "z"] }},
    {{ on = ["punch.top"], fix = ["x", "y"], move = {{ z = "-0.1*t" }} }},
]
contact = [{{ name = "c", {contact} }}]
time = {{ scheme = {{ kind = "static" }}, step = 0.25, end = 1.0 }}
"#
    );
    finish(simulation(&text, &[""; 0])).state().contact_forces[0]
}

const PLATE: &str = "min = [-1, -1, -0.5], max = [1, 1, 0], cells = [4, 4, 2]";

/// Sharp edges that cross hold each other in a quarter model as in the whole one: those that have
/// opened find each other again.
#[test]
fn crossing_edges_of_a_quarter_model_are_those_of_the_whole() {
    let contact = r#"secondary = "punch.skin", primary = "plate.skin""#;
    let punch = "min = [-0.3, -1.3, 0.001], max = [0.3, 1.3, 0.301], cells = [2, 2, 1]";
    let whole = punched(PLATE, punch, "", contact)[2];
    let planes = r#"{ on = ["plate.left", "punch.left"], fix = ["x"] }, { on = ["plate.front", "punch.front"], fix = ["y"] },"#;
    let plate = "min = [0, 0, -0.5], max = [1, 1, 0], cells = [2, 2, 2]";
    let punch = "min = [0, 0, 0.001], max = [0.3, 1.3, 0.301], cells = [1, 1, 1]";
    let quarter = punched(plate, punch, planes, contact)[2];
    assert!(whole > 20.0 && (whole / (4.0 * quarter) - 1.0).abs() < 1e-8, "{whole} {quarter}");
}

/// Faces that touch at the start press straight on each other: nodes under the joint in the middle
/// of the punch have the mean of its facets, whatever iterates do.
#[test]
fn a_symmetric_punch_does_not_press_to_its_side() {
    let contact = r#"secondary = "plate.skin", primary = "punch.skin""#;
    let punch = "min = [-0.3, -1.3, 0], max = [0.3, 1.3, 0.3], cells = [2, 2, 1]";
    let [fx, fy, fz] = punched(PLATE, punch, "", contact);
    assert!(fz < -20.0 && fx.abs() < 1e-9 && fy.abs() < 1e-9, "{fx} {fy} {fz}");
}

/// A node over a joint of facets has one spring, however many facets lie behind it: the quarter of
/// a punch on springs is that of the whole, which does not press to its side.
#[test]
fn springs_over_joints_count_once() {
    let contact = r#"secondary = "punch.bottom", primary = "plate.top", enforcement = "penalty""#;
    let plate = "min = [-0.5, -0.4, -0.3], max = [0.5, 0.4, 0], cells = [4, 4, 2]";
    let punch = "min = [-0.3, -0.2, 0], max = [0.3, 0.2, 0.4], cells = [4, 2, 2]";
    let [fx, fy, whole] = punched(plate, punch, "", contact);
    let planes = r#"{ on = ["plate.left", "punch.left"], fix = ["x"] }, { on = ["plate.front", "punch.front"], fix = ["y"] },"#;
    let plate = "min = [0, 0, -0.3], max = [0.5, 0.4, 0], cells = [2, 2, 2]";
    let punch = "min = [0, 0, 0], max = [0.3, 0.2, 0.4], cells = [2, 1, 2]";
    let quarter = punched(plate, punch, planes, contact)[2];
    assert!(whole > 1.0 && (whole / (4.0 * quarter) - 1.0).abs() < 1e-8, "{whole} {quarter}");
    assert!(fx.abs() < 1e-9 && fy.abs() < 1e-9, "{fx} {fy}");
}

/// Two blocks with meshes that match strike flat: whichever nodes slide over corners of facets, the
/// blocks widen alike in both directions, with impulses, too.
#[test]
fn blocks_with_matching_meshes_widen_alike_by_impulses() {
    let case = r#"
dimension = 3
material = [
  { name = "soft", law = "neo-hookean", density = 1.0, young = 400.0, poisson = 0.3 },
  { name = "stiff", law = "neo-hookean", density = 1.0, young = 1000.0, poisson = 0.3 },
]
support = [{ on = ["low.bottom"], fix = ["x", "y", "z"] }]
contact = [{ name = "c", secondary = "up.bottom", primary = "low.top" }]
time = { end = 0.06, step = 5e-3, scheme = { kind = "moreau-jean", theta = 0.5 } }
[[body]]
name = "low"
material = "soft"
element = "Hex8"
mesh = { shape = "box", min = [-1.0, -1.0, -0.5], max = [1.0, 1.0, 0.0], cells = [4, 4, 1] }
[[body]]
name = "up"
material = "stiff"
element = "Hex8"
mesh = { shape = "box", min = [-0.5, -0.5, 0.0], max = [0.5, 0.5, 0.5], cells = [2, 2, 1] }
velocity = [0.0, 0.0, -1.0]
"#;
    let run = finish(simulation(case, &[""; 0]));
    let reference = &run.model().reference;
    let moved = |dof: usize| run.state().y[dof] - reference[dof];
    let mut largest = 0.0;
    for node in run.model().parts[1].nodes() {
        let [x, y] = [moved(3 * node), moved(3 * node + 1)];
        let along = reference[3 * node];
        let across = reference[3 * node + 1];
        let image = run.model().parts[1]
            .nodes()
            .find(|&other| [across, along, reference[3 * node + 2]] == reference[3 * other..3 * other + 3]);
        let image = image.unwrap();
        largest = f64::max(largest, x.abs());
        let apart = (x - moved(3 * image + 1)).abs().max((y - moved(3 * image)).abs());
        assert!(apart < 1e-9, "node {node}: {apart:e}");
    }
    assert!(largest > 1e-3, "{largest}");
}
