//! Columns of supports and ties against the momentum of the bodies.

use carom_record::Run;

use super::rebound::{record, record_in};

const DROP: &str = r#"
dimension = 2
material = [{ name = "m", law = "linear-elastic", density = 1.0, young = 100.0, poisson = 0.0 }]
[[body]]
name = "plate"
material = "m"
element = "Q4"
mesh = { shape = "rectangle", min = [0.0, 0.0], max = [1.0, 0.25], cells = [4, 1] }
[[body]]
name = "block"
material = "m"
element = "Q4"
mesh = { shape = "rectangle", min = [0.0, 0.25], max = [1.0, 1.25], cells = [4, 4] }
velocity = [0.0, -1.0]
[[support]]
name = "ground"
on = ["plate.bottom"]
fix = ["x", "y"]
[[contact]]
name = "strike"
secondary = "block.bottom"
primary = "plate.top"
[time]
end = 0.5
step = 1e-3
scheme = { kind = "moreau-jean", theta = 0.5 }
[output]
fields_every = 0
"#;

const SCHEMES: [&str; 2] = [
    "time.scheme={ kind = \"moreau-jean\", theta = 0.5 }",
    "time.scheme={ kind = \"nonsmooth-generalized-alpha\", rho_inf = 0.8 }",
];

fn column<'a>(run: &'a Run, name: &str) -> &'a [f64] {
    run.column(name).unwrap()
}

/// The impulse of a support's reaction equals the change of momentum of the two bodies, for impulse
/// schemes whose accelerations contain the impulses and for those whose accelerations do not.
#[test]
fn reactions_change_the_momentum() {
    for scheme in SCHEMES {
        let run = record(DROP, &[scheme]);
        let reaction: f64 = column(&run, "ground.reaction_y").iter().skip(1).map(|force| 1e-3 * force).sum();
        let momentum = column(&run, "momentum_y");
        let change = momentum[momentum.len() - 1] - momentum[0];
        assert!(change > 1.5 && (reaction / change - 1.0).abs() < 0.02, "{scheme}: {reaction} {change}");
    }
}

/// A block of the weight 2 at rest, also in the row of the start.
#[test]
fn the_reaction_of_a_body_at_rest_is_its_weight() {
    let folder = tempfile::tempdir().unwrap();
    let rest = folder.path().join("rest");
    let heavy = ["body.block.velocity=[0.0, 0.0]", "body.block.gravity=[0.0, -2.0]"];
    let supports = r#"support=[{ name = "ground", on = ["plate.bottom"], fix = ["x", "y"] }, { on = ["block.left"], fix = ["x"] }]"#;
    let statics = r#"time={ end = 1.0, step = 1.0, scheme = { kind = "static" } }"#;
    record_in(&rest, DROP, &[heavy[0], heavy[1], supports, statics]);
    for scheme in SCHEMES {
        let initial = format!("initial.from={rest:?}");
        let run = record(
            DROP,
            &["body.block.gravity=[0.0, -2.0]", "body.block.velocity=[0.0, 0.0]", supports, &initial, scheme],
        );
        for reaction in column(&run, "ground.reaction_y") {
            assert!((reaction - 2.0).abs() < 1e-3, "{scheme}: {reaction}");
        }
    }
}

const TIED: &str = r#"
dimension = 2
material = [{ name = "m", law = "linear-elastic", density = 1.0, young = 100.0, poisson = 0.0 }]
[[body]]
name = "lower"
material = "m"
element = "Q4"
mesh = { shape = "rectangle", min = [0.0, 0.0], max = [1.0, 0.5], cells = [4, 1] }
velocity = [0.0, -1.0]
[[body]]
name = "upper"
material = "m"
element = "Q4"
mesh = { shape = "rectangle", min = [0.0, 0.5], max = [1.0, 1.0], cells = [4, 4] }
velocity = [0.0, -1.0]
[[tie]]
name = "joint"
secondary = "upper.bottom"
primary = "lower.top"
[[contact]]
name = "floor"
secondary = "lower.bottom"
primary = { plane = { point = [0.0, 0.0], normal = [0.0, 1.0] } }
[time]
end = 0.3
step = 1e-3
scheme = { kind = "moreau-jean", theta = 0.5 }
[output]
fields_every = 0
"#;

/// The impulse of a tie's force equals the momentum that the upper body, of the mass 1/2, gains.
#[test]
fn forces_of_ties_change_the_momentum_of_a_body() {
    for scheme in SCHEMES {
        let run = record(TIED, &[scheme]);
        let force: f64 = column(&run, "joint.force_y").iter().skip(1).map(|force| 1e-3 * force).sum();
        let velocity = column(&run, "upper.velocity_y");
        let gained = 0.5 * (velocity[velocity.len() - 1] - velocity[0]);
        assert!(gained > 0.5 && (force / gained - 1.0).abs() < 0.01, "{scheme}: {force} {gained}");
    }
}

/// A block with friction under a dead load, in load steps: the force of the contact and the
/// reaction of the support, which holds nodes in contact, are the load.
#[test]
fn contact_and_supports_bear_the_load_with_friction() {
    const PRESSED: &str = r#"
dimension = 3
material = [{ name = "m", law = "neo-hookean", density = 1e-4, young = 100.0, poisson = 0.3 }]
[[body]]
name = "base"
material = "m"
element = "Hex8"
mesh = { shape = "box", min = [-0.7, -0.6, -0.5], max = [0.7, 0.6, 0.0], cells = [2, 2, 1] }
[[body]]
name = "low"
material = "m"
element = "Hex8"
mesh = { shape = "box", min = [-0.4, -0.3, 0.0], max = [0.4, 0.3, 0.3], cells = [3, 2, 1] }
[[support]]
name = "ground"
on = ["base.bottom", "base.left", "base.right"]
fix = ["x", "y", "z"]
[[contact]]
name = "c"
secondary = "low.bottom"
primary = "base.top"
mu = 1.0
[[load]]
on = ["low.top"]
traction = ["0", "0", "-20*t"]
[time]
end = 1.0
step = 0.25
scheme = { kind = "static" }
[output]
fields_every = 0
"#;
    let run = record(PRESSED, &[]);
    for name in ["contact_force_z", "ground.reaction_z"] {
        for (time, force) in column(&run, "time").iter().zip(column(&run, name)) {
            assert!((force - 9.6 * time).abs() < 1e-8, "{name} at {time}: {force}");
        }
    }
}
