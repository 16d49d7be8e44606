//! A bar that slides without friction over the right-angled corner of a block touches it there
//! alone: the force is along the bar's own normal, and does not slow it.

use super::rebound::record;

/// A bar at an angle to the top face of the block, which is pressed on its corner and moves along
/// itself with the velocity 2.
fn bar(angle: f64, sides: [&str; 2], scheme: &str, cells: usize) -> String {
    let [secondary, primary] = sides;
    let (sin, cos) = angle.to_radians().sin_cos();
    // The gap is 0.01 and closes with the velocity 0.05.
    let shift = [0.01 * sin, 0.01 * cos];
    let velocity = [2.0 * cos - 0.05 * sin, -2.0 * sin - 0.05 * cos];
    let force = [-3.0 * sin, -3.0 * cos];
    format!(
        r#"
dimension = 2
material = [
    {{ name = "soft", law = "neo-hookean", density = 1.0, young = 200.0, poisson = 0.3 }},
    {{ name = "hard", law = "neo-hookean", density = 1.0, young = 2000.0, poisson = 0.3 }},
]
[[body]]
name = "bar"
material = "soft"
element = "Q4"
mass = "lumped"
mesh = {{ shape = "rectangle", min = [-0.97, 0.0], max = [1.03, 0.5], cells = [{cells}, 2] }}
place = {{ rotate = {:?}, about = [0.0, 0.0], shift = {shift:?} }}
velocity = {velocity:?}
[[body]]
name = "block"
material = "hard"
element = "Q4"
mass = "lumped"
mesh = {{ shape = "rectangle", min = [-0.5, -0.5], max = [0.0, 0.0], cells = [1, 1] }}
[[support]]
on = ["block.bottom", "block.left"]
fix = ["x", "y"]
[[load]]
body = "bar"
body_force = {force:?}
[[contact]]
name = "joint"
secondary = "{secondary}.skin"
primary = "{primary}.skin"
[time]
end = 0.3
step = 0.001
scheme = {{ {scheme} }}
[output]
fields_every = 0
"#,
        -angle
    )
}

/// Speed along the bar at the end.
fn sliding(angle: f64, sides: [&str; 2], scheme: &str, cells: usize) -> f64 {
    let run = record(&bar(angle, sides, scheme, cells), &[]);
    let (sin, cos) = angle.to_radians().sin_cos();
    let last = |axis: &str| *run.column(&format!("bar.velocity_{axis}")).unwrap().last().unwrap();
    cos * last("x") - sin * last("y")
}

#[test]
fn a_corner_does_not_hold_the_nodes_that_pass_it() {
    let schemes = [
        "kind = \"chung-hulbert\", rho_inf = 0.5",
        "kind = \"energy-momentum\"",
        "kind = \"moreau-jean\", theta = 0.5",
    ];
    for scheme in schemes {
        for (angle, cells) in [(70.0, 32), (70.0, 16), (80.0, 32), (45.0, 32)] {
            let speed = sliding(angle, ["bar", "block"], scheme, cells);
            let swapped = sliding(angle, ["block", "bar"], scheme, cells);
            assert!((speed - swapped).abs() < 2e-2, "{scheme} {angle} {cells}: {speed} {swapped}");
            assert!((speed - 2.0).abs() < 0.1, "{scheme} {angle} {cells}: {speed}");
        }
    }
}

/// In space the nodes of a straight edge of the block keep the bar out.
#[test]
fn an_edge_does_not_hold_the_nodes_that_pass_it() {
    let (sin, cos) = 70.0_f64.to_radians().sin_cos();
    let in_space = |sides| {
        let [x, y] = [0.01 * sin, 0.01 * cos];
        let [u, v] = [2.0 * cos - 0.05 * sin, -2.0 * sin - 0.05 * cos];
        bar(70.0, sides, "kind = \"chung-hulbert\", rho_inf = 0.5", 16)
            .replace("dimension = 2", "dimension = 3")
            .replace("\"Q4\"", "\"Hex8\"")
            .replace("\"rectangle\"", "\"box\"")
            .replace(
                "min = [-0.97, 0.0], max = [1.03, 0.5], cells = [16, 2]",
                "min = [-0.97, 0.0, 0.0], max = [1.03, 0.5, 0.25], cells = [16, 2, 1]",
            )
            .replace(
                "min = [-0.5, -0.5], max = [0.0, 0.0], cells = [1, 1]",
                "min = [-0.5, -0.5, -0.1], max = [0.0, 0.0, 0.35], cells = [1, 1, 3]",
            )
            .replace(
                "rotate = -70.0, about = [0.0, 0.0]",
                "rotate = { axis = [0.0, 0.0, 1.0], angle = -70.0 }, about = [0.0, 0.0, 0.0]",
            )
            .replace(&format!("shift = [{x:?}, {y:?}]"), &format!("shift = [{x:?}, {y:?}, 0.0]"))
            .replace(&format!("velocity = [{u:?}, {v:?}]"), &format!("velocity = [{u:?}, {v:?}, 0.0]"))
            .replace("block.bottom", "block.front")
            .replace(
                &format!("body_force = [{:?}, {:?}]", -3.0 * sin, -3.0 * cos),
                &format!("body_force = [{:?}, {:?}, 0.0]", -3.0 * sin, -3.0 * cos),
            )
            .replace("fix = [\"x\", \"y\"]", "fix = [\"x\", \"y\", \"z\"]")
            .replace("step = 0.001", "step = 0.002")
    };
    let run = record(&in_space(["bar", "block"]), &[]);
    let last = |axis: &str| *run.column(&format!("bar.velocity_{axis}")).unwrap().last().unwrap();
    let speed = cos * last("x") - sin * last("y");
    assert!((speed - 2.0).abs() < 0.1, "{speed}");
}

/// A wedge of 20° that falls on a block rebounds beside the corner, too, where the block is softer.
#[test]
fn a_sharp_tip_rebounds_beside_a_corner() {
    let wedge = |place: f64| {
        format!(
            r#"
dimension = 2
material = [{{ name = "m", law = "neo-hookean", density = 1.0, young = 2000.0, poisson = 0.3 }}]
[[body]]
name = "wedge"
material = "m"
element = "T3"
mesh = {{ shape = "polygon", points = [[0.0, 0.0], [0.17633, 1.0], [-0.17633, 1.0]], size = 2.0 }}
place = {{ shift = [{place:?}, 0.005] }}
velocity = [0.0, -1.0]
[[body]]
name = "block"
material = "m"
element = "Q4"
mesh = {{ shape = "rectangle", min = [-1.0, -0.5], max = [0.0, 0.0], cells = [2, 1] }}
[[support]]
on = ["block.bottom"]
fix = ["x", "y"]
[[contact]]
name = "joint"
secondary = "wedge.skin"
primary = "block.skin"
[time]
end = 0.05
step = 0.0005
scheme = {{ kind = "chung-hulbert", rho_inf = 0.5 }}
[output]
fields_every = 0
"#
        )
    };
    let rebound = |place| {
        let run = record(&wedge(place), &[]);
        *run.column("wedge.velocity_y").unwrap().last().unwrap()
    };
    let [beside, middle] = [-0.1, -0.4].map(rebound);
    assert!(0.2 < beside && beside < middle, "{beside} {middle}");
}
