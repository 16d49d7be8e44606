//! Friction on an obstacle that accelerates along its surface, in the frame of the case and in that
//! of the obstacle, in which an inertia force acts.

use super::rebound::record;

/// A block that is pressed on a plane.
const BLOCK: &str = r#"
dimension = 2
[[material]]
name = "m"
law = "saint-venant-kirchhoff"
density = 1.0
young = 2000.0
poisson = 0.3
[[body]]
name = "b"
material = "m"
element = "Q4"
mesh = { shape = "rectangle", min = [0.0, 0.0], max = [0.4, 0.2], cells = [4, 2] }
[[contact]]
name = "c"
secondary = "b.bottom"
primary = { plane = { point = [0.0, 0.0], normal = [0.0, 1.0] } }
mu = 0.5
[time]
end = 0.2
step = 0.005
scheme = { kind = "chung-hulbert", rho_inf = 0.5 }
[output]
fields_every = 0
"#;

/// Newton's equations in a frame with the acceleration a have the force −ρa: contact forces, their
/// impulses and the strain energy are the same in both frames. The block sticks, or slips and
/// sticks.
#[test]
fn a_belt_that_accelerates_is_a_belt_at_rest_with_an_inertia_force() {
    for scheme in ["chung-hulbert\", rho_inf = 0.5", "bathe\", rho_inf = 0.0", "energy-momentum\""] {
        for velocity in [0.0, -0.5] {
            let scheme = format!("time.scheme={{ kind = \"{scheme} }}");
            let velocity = format!("body.b.velocity=[{velocity:?}, 0.0]");
            let plane = "contact.c.primary={ plane = { point = [0.0, 0.0], normal = [0.0, 1.0] }, motion = { x = \"t^2\" } }";
            let moving = record(BLOCK, &[&scheme, &velocity, "body.b.gravity=[0.0, -10.0]", plane]);
            let still = record(BLOCK, &[&scheme, &velocity, "body.b.gravity=[-2.0, -10.0]"]);
            for name in ["contact_force_x", "contact_force_y", "contact_impulse_x", "strain"] {
                let [one, other] = [&moving, &still].map(|run| run.column(name).unwrap());
                let largest = other.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
                for (row, (a, b)) in one.iter().zip(other).enumerate() {
                    assert!((a - b).abs() < 1e-8 * largest, "{scheme} {velocity} {name} row {row}: {a} {b}");
                }
            }
        }
    }
}

/// A block that sticks to a belt with the acceleration 0.3 t has the reaction m a, also with a
/// scheme of two steps, although nodes begin to stick in every few steps.
#[test]
fn a_block_that_sticks_has_the_acceleration_of_the_belt() {
    let sets = [
        "body.b.mesh={ shape = \"rectangle\", min = [0.0, 0.0], max = [1.0, 0.3], cells = [3, 1] }",
        "body.b.gravity=[0.0, -2.0]",
        "material.m.young=20000.0",
        "contact.c.mu=0.3",
        "contact.c.primary={ plane = { point = [0.0, 0.0], normal = [0.0, 1.0] }, motion = { x = \"0.05*t^3\" } }",
        "time.end=1.0",
        "time.step=0.01",
        "time.scheme={ kind = \"bdf2\" }",
    ];
    let run = record(BLOCK, &[&sets[..], &["body.b.element=Q9"]].concat());
    let forces = run.column("contact_force_x").unwrap();
    // After the start, in which the block settles.
    for (row, force) in forces.iter().enumerate().skip(40) {
        let exact = 0.3 * (0.3 * 0.01 * row as f64);
        assert!((force / exact - 1.0).abs() < 1e-6, "row {row}: {force} {exact}");
    }
}
