//! Contacts that go on from another run: under other names, at other places.

use super::common::{finish, simulation};
use super::loads::time;
use super::restart::initial_state;

/// A block whose upper and right sides are held, with these contacts.
fn block(contacts: &str, time: &str, initial: &str) -> String {
    format!(
        r#"
dimension = 2
material = [{{ name = "m", law = "neo-hookean", density = 1.0, young = 300.0, poisson = 0.3 }}]
[[body]]
name = "block"
material = "m"
element = "T6"
mesh = {{ shape = "rectangle", min = [0.0, 0.0], max = [0.6, 0.5], cells = [4, 3] }}
[[support]]
on = ["block.top"]
fix = ["y"]
[[support]]
on = ["block.right"]
fix = ["x"]
{contacts}
{time}
{initial}
"#
    )
}

/// A block that a moving plane has pressed stays as it is where a plane that rests there goes on,
/// whatever the name of the contact; and so it does with an augmented Lagrangian.
#[test]
fn a_contact_goes_on_at_another_place() {
    let folder = tempfile::tempdir().unwrap();
    let plane = |name: &str, at: &str, motion: &str| {
        format!(
            "[[contact]]\nsecondary = \"block.bottom\"\nmu = 0.3\nname = \"{name}\"\nprimary = {{ plane = {{ point = {at}, normal = [0.0, 1.0] }}{motion} }}"
        )
    };
    let press = plane("press", "[0.0, 0.0]", ", motion = { x = \"0.004*t\", y = \"0.02*t\" }");
    let load = block(&press, &time(1.0, 0.1, r#"{ kind = "static" }"#), "");
    let initial = initial_state(&load, &folder.path().join("pressed"));
    let pressed = finish(simulation(&load, &[""; 0]));
    let force = pressed.state().contact_forces[0];
    let rests = plane("floor", "[0.5, 0.02]", "");
    for enforcement in ["multiplier", "augmented"] {
        for scheme in [
            r#"{ kind = "newmark", beta = 0.25, gamma = 0.5 }"#,
            r#"{ kind = "bathe", rho_inf = 0.5 }"#,
            r#"{ kind = "energy-momentum" }"#,
        ] {
            let contact = format!("{rests}\nenforcement = \"{enforcement}\"");
            let mut run = simulation(&block(&contact, &time(0.1, 0.01, scheme), &initial), &[""; 0]);
            for _ in 0..5 {
                let now = run.state().contact_forces[0];
                let apart = (now[0] - force[0]).hypot(now[1] - force[1]);
                assert!(apart < 1e-6 * force[1], "{enforcement} {scheme}: {now:?} {force:?}");
                run.step().unwrap();
            }
        }
    }
}

/// Two planes press a corner of a block. Where both have other names and have moved, each goes on
/// with its own pairs.
#[test]
fn contacts_go_on_under_other_names() {
    let folder = tempfile::tempdir().unwrap();
    let plane = |name: &str, at: &str, normal: &str, motion: &str| {
        let primary = format!("{{ plane = {{ point = {at}, normal = {normal} }}{motion} }}");
        format!("[[contact]]\nname = \"{name}\"\nsecondary = \"block.skin\"\nprimary = {primary}\n")
    };
    let presses = [
        plane("floor", "[0.0, 0.0]", "[0.0, 1.0]", ", motion = { y = \"0.02*t\" }"),
        plane("wall", "[0.0, 0.0]", "[1.0, 0.0]", ", motion = { x = \"0.01*t\" }"),
    ];
    let load = block(&presses.concat(), &time(1.0, 0.1, r#"{ kind = "static" }"#), "");
    let initial = initial_state(&load, &folder.path().join("pressed"));
    let pressed = finish(simulation(&load, &[""; 0]));
    let [floor, wall] = pressed.state().contact_forces[..] else { panic!() };
    assert!(floor[1] > 1.0 && wall[0] > 1.0, "{floor:?} {wall:?}");
    let rests = [plane("a", "[0.01, 0.0]", "[1.0, 0.0]", ""), plane("b", "[0.0, 0.02]", "[0.0, 1.0]", "")];
    let scheme = r#"{ kind = "newmark", beta = 0.25, gamma = 0.5 }"#;
    let mut run = simulation(&block(&rests.concat(), &time(0.1, 0.01, scheme), &initial), &[""; 0]);
    for _ in 0..3 {
        let [now_wall, now_floor] = run.state().contact_forces[..] else { panic!() };
        assert!((now_wall[0] - wall[0]).abs() < 1e-6 * wall[0], "{now_wall:?} {wall:?}");
        assert!((now_floor[1] - floor[1]).abs() < 1e-6 * floor[1], "{now_floor:?} {floor:?}");
        run.step().unwrap();
    }
}
