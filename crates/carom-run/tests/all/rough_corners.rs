//! A body that rests in a rough corner: the node there has more normal and tangential forces than
//! motions. It stays where it is, and both sides bear its weight, however they share it.

use super::common::{finish, simulation};

/// A square in the corner of a floor and a wall.
const SQUARE: &str = r#"
dimension = 2
[[material]]
name = "m"
law = "neo-hookean"
density = 1.0
young = 1e4
poisson = 0.3
[[body]]
name = "b"
material = "m"
element = "Q4"
mass = "lumped"
mesh = { shape = "rectangle", min = [0, 0], max = [0.4, 0.4], cells = [1, 1] }
gravity = [-3, -7]
[[contact]]
name = "floor"
secondary = "b.bottom"
primary = { plane = { point = [0, 0], normal = [0, 1] } }
mu = 0.2
[[contact]]
name = "wall"
secondary = "b.left"
primary = { plane = { point = [0, 0], normal = [1, 0] } }
mu = 0.2
[time]
end = 0.1
step = 1e-3
scheme = { kind = "central-difference" }
energy_guard = false
[output]
fields_every = 0
"#;

/// A box between a floor and a wall, pulled along both by less than their friction.
const BOX: &str = r#"
dimension = 3
[[material]]
name = "m"
law = "neo-hookean"
density = 1.0
young = 1e5
poisson = 0.0
[[body]]
name = "b"
material = "m"
element = "Hex8"
mesh = { shape = "box", min = [0, 0, 0], max = [0.8, 0.4, 0.4], cells = [3, 2, 2] }
gravity = [3, -7, -7]
[[contact]]
name = "floor"
secondary = "b.bottom"
primary = { plane = { point = [0, 0, 0], normal = [0, 0, 1] } }
mu = 0.3
[[contact]]
name = "wall"
secondary = "b.front"
primary = { plane = { point = [0, 0, 0], normal = [0, 1, 0] } }
mu = 0.3
[time]
end = 0.3
step = 0.01
scheme = { kind = "backward-euler" }
energy_guard = false
[output]
fields_every = 0
"#;

#[test]
fn a_square_rests_in_a_rough_corner() {
    for scheme in [
        r#"kind = "central-difference""#,
        r#"kind = "paoli-schatzman""#,
        r#"kind = "moreau-jean", theta = 1.0"#,
        r#"kind = "chung-hulbert", rho_inf = 0.5"#,
    ] {
        for cells in [1, 3] {
            let sets = [
                format!("time.scheme={{ {scheme} }}"),
                format!("body.b.mesh.cells=[{cells}, {cells}]"),
                format!("time.step={:e}", 1e-3 / f64::from(cells)),
            ];
            let sim = finish(simulation(SQUARE, &sets));
            let corner = [sim.state().y[0], sim.state().y[1]];
            assert!(corner.iter().all(|x| x.abs() < 1e-5), "{scheme}: {corner:?}");
            // The weight of 0.16 presses it into the corner, and it rests there but for its waves.
            let impulses = &sim.state().impulses;
            let pressed = [0, 1].map(|i| impulses[0][i] + impulses[1][i]);
            let expected = [3.0, 7.0].map(|g| g * 0.16 * 0.1);
            let close = pressed.iter().zip(expected).all(|(p, e)| (p / e - 1.0).abs() < 0.1);
            assert!(close, "{scheme}, {cells}: {pressed:?} {expected:?}");
        }
    }
}

#[test]
fn a_box_sticks_between_a_floor_and_a_wall() {
    for (scheme, cells) in [
        (r#"kind = "backward-euler""#, "[3, 2, 2]"),
        (r#"kind = "bathe", rho_inf = 0.0"#, "[3, 2, 2]"),
        (r#"kind = "chung-hulbert", rho_inf = 0.5"#, "[3, 2, 2]"),
        (r#"kind = "nonsmooth-generalized-alpha", rho_inf = 0.5"#, "[1, 1, 1]"),
    ] {
        let sets = [format!("time.scheme={{ {scheme} }}"), format!("body.b.mesh.cells={cells}")];
        let sim = finish(simulation(BOX, &sets));
        let impulses = &sim.state().impulses;
        let expected = [-3.0, 7.0, 7.0].map(|g| g * 0.128 * 0.3);
        for i in 0..3 {
            let all = impulses[0][i] + impulses[1][i];
            assert!((all - expected[i]).abs() < 0.02 * expected[1], "{scheme}: {all} {expected:?}");
        }
        let slid = sim.state().y[0];
        assert!(slid.abs() < 1e-4, "{scheme}: {slid}");
    }
}
