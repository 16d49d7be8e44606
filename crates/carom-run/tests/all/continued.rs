//! Contacts that go on from another run: under other names, at other places.

use carom_run::Setup;

use super::common::{case, finish, simulation};
use super::loads::time;
use super::restart::initial_state;
use super::space_obstacles::{grid, stl};

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

/// A block in space whose lower side is held, under a plate of triangles.
fn under_plate(side: &str, file: &str, rest: &str) -> String {
    format!(
        r#"
dimension = 3
material = [{{ name = "m", law = "neo-hookean", density = 1.0, young = 200.0, poisson = 0.3 }}]
[[body]]
name = "block"
material = "m"
element = "Hex8"
mesh = {{ shape = "box", min = [0.0, 0.0, 0.0], max = [1.0, 0.9, 0.5], cells = [3, 3, 2] }}
[[support]]
on = ["block.bottom"]
fix = ["x", "y", "z"]
[[contact]]
name = "press"
secondary = "{side}"
mu = 0.3
primary = {{ surface = {{ file = {file:?}, reverse = true }}{rest}
"#
    )
}

/// A block that a plate of triangles has pressed stays as it is under the same plate, read where it
/// has moved to, also where the contact names another side of the block.
#[test]
fn a_contact_goes_on_below_a_surface_at_another_place() {
    let folder = tempfile::tempdir().unwrap();
    let file = |name: &str, height: f64| {
        let path = folder.path().join(name);
        std::fs::write(&path, stl(&grid(2.0, 3, |_, _| height))).unwrap();
        path.display().to_string()
    };
    let motion = ", motion = { x = \"0.002*t\", z = \"-0.05*t\" } }\n";
    let above = file("above.stl", 0.5);
    let load = under_plate("block.top", &above, motion) + &time(1.0, 0.1, r#"{ kind = "static" }"#);
    let initial = initial_state(&load, &folder.path().join("pressed"));
    let force = finish(simulation(&load, &[""; 0])).state().contact_forces[0];
    assert!(force[2] < -10.0, "{force:?}");
    let below = file("below.stl", 0.45);
    for side in ["block.top", "block.skin"] {
        let scheme = time(0.05, 0.01, r#"{ kind = "newmark", beta = 0.25, gamma = 0.5 }"#);
        let mut run = simulation(&(under_plate(side, &below, " }\n") + &scheme + &initial), &[""; 0]);
        for _ in 0..3 {
            let now = run.state().contact_forces[0];
            assert!((now[2] / force[2] - 1.0).abs() < 1e-6, "{side}: {now:?} {force:?}");
            run.step().unwrap();
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

/// A disc in flight beside a free plane.
fn flight(plane: &str, more: &str, initial: &str) -> String {
    let moves = if initial.is_empty() { "velocity = [0.3, -0.4]" } else { "" };
    format!(
        r#"
dimension = 2
material = [{{ name = "m", law = "neo-hookean", density = 1.0, young = 300.0, poisson = 0.3 }}]
[[body]]
name = "disc"
material = "m"
element = "T6"
mesh = {{ shape = "disc", radius = 0.5, center = [0.0, 0.6], size = 0.25 }}
{moves}
[[contact]]
name = "plane"
secondary = "disc.arc"
primary = {{ plane = {{ point = [0.0, {plane}], normal = [0.0, 1.0] }}, mass = 0.3{more} }}
[time]
end = 0.1
step = 0.01
scheme = {{ kind = "newmark", beta = 0.25, gamma = 0.5 }}
{initial}
"#
    )
}

/// A free obstacle goes on where it was, with the velocity that it had.
#[test]
fn a_free_obstacle_goes_on() {
    let folder = tempfile::tempdir().unwrap();
    let first = flight("-3.0", ", velocity = [0.0, 0.5]", "");
    let initial = initial_state(&first, &folder.path().join("first"));
    let before = finish(simulation(&first, &[""; 0]));
    let after = simulation(&flight("-3.0", "", &initial), &[""; 0]);
    let obstacle = before.model().parts[1].first_node * 2;
    assert!((before.state().y[obstacle + 1] + 2.95).abs() < 1e-9);
    for (was, is) in [(&before.state().y, &after.state().y), (&before.state().v, &after.state().v)] {
        assert_eq!(was, is);
    }
    assert!((before.state().ledger.kinetic - after.state().ledger.kinetic).abs() < 1e-12);
    let given = case(&flight("-3.0", ", velocity = [0.0, 0.5]", &initial), &[""; 0]);
    let Err(problems) = Setup::new(&given).start() else { panic!("the velocity is given twice") };
    assert!(format!("{problems:?}").contains("it goes on from the other run"), "{problems:?}");
}

/// A plane that the other run did not have may not stand in the body.
#[test]
fn a_start_inside_an_obstacle_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let first = flight("-3.0", "", "");
    let initial = initial_state(&first, &folder.path().join("first"));
    let inside = case(&flight("0.08", "", &initial), &[""; 0]);
    let Err(problems) = Setup::new(&inside).start() else { panic!("it overlaps") };
    assert!(format!("{problems:?}").contains("overlap at the start"), "{problems:?}");
    simulation(&flight("0.05", "", &initial), &[""; 0]);
}

/// A block that was pulled until it yielded, and on which support lets go, springs back as one
/// whose grip eases off by a traction: elastically.
#[test]
fn a_yielded_block_springs_back() {
    let folder = tempfile::tempdir().unwrap();
    let block = |grip: &str, end: f64, initial: &str| {
        let block = r#"
dimension = 2
plane = "strain"
[[material]]
name = "m"
law = "hencky"
density = 1.0
young = 200.0
poisson = 0.3
plastic = { yield = 2.0, hardening = 10.0 }
[[body]]
name = "b"
material = "m"
element = "T6"
mesh = { shape = "rectangle", min = [0.0, 0.0], max = [1.0, 1.0], cells = [2, 2] }
[[support]]
on = ["b.left"]
fix = ["x"]
[[support]]
on = ["b.bottom"]
fix = ["y"]
"#;
        format!("{block}{grip}{}{initial}", time(end, 0.5, r#"{ kind = "static" }"#))
    };
    let pull = block("[[support]]\non = [\"b.right\"]\nmove = { x = \"0.05*t\" }\n", 1.0, "");
    let initial = initial_state(&pull, &folder.path().join("pulled"));
    let pulled = finish(simulation(&pull, &[""; 0]));
    let right: Vec<usize> = (0..pulled.model().dofs())
        .step_by(2)
        .filter(|&dof| (pulled.model().reference[dof] - 1.0).abs() < 1e-12)
        .collect();
    let grip: f64 = right.iter().map(|&dof| pulled.state().f_internal[dof]).sum();
    let let_go = finish(simulation(&block("", 1.0, &initial), &[""; 0]));
    let eased = format!("[[load]]\non = [\"b.right\"]\ntraction = [\"{grip:?}*(1-t)\", \"0\"]\n");
    let eased = finish(simulation(&block(&eased, 1.0, &initial), &[""; 0]));
    for (one, other) in let_go.state().y.iter().zip(&eased.state().y) {
        assert!((one - other).abs() < 1e-9, "{one} {other}");
    }
    let [before, now] = [&pulled, &let_go].map(|run| run.state().materials.past(0.0).memory);
    assert!(before.iter().zip(now).all(|(before, now)| (before - now).abs() < 1e-12), "{now:?}");
    let spring = right.iter().map(|&dof| pulled.state().y[dof] - let_go.state().y[dof]).fold(0.0, f64::max);
    assert!(spring > 0.01, "{spring}");
}

/// Mortar contact with an obstacle that stands where it has moved to goes on, as deep as it was.
#[test]
fn mortar_contact_goes_on_where_its_obstacle_has_moved() {
    let folder = tempfile::tempdir().unwrap();
    let circle = |at: &str, motion: &str, end: f64, initial: &str| {
        let obstacle = format!("primary = {{ circle = {{ center = {at}, radius = 1.0 }}{motion} }}");
        let contact = format!(
            "[[contact]]\nname = \"c\"\nsecondary = \"block.bottom\"\nmethod = \"mortar\"\n{obstacle}"
        );
        block(&contact, &time(end, 0.1, r#"{ kind = "static" }"#), initial)
    };
    let first = circle("[0.0, -1.0]", ", motion = { y = \"0.05*t\" }", 1.0, "");
    let initial = initial_state(&first, &folder.path().join("first"));
    let pressed = finish(simulation(&first, &[""; 0]));
    let goes_on = finish(simulation(&circle("[0.0, -0.95]", "", 0.2, &initial), &[""; 0]));
    let [before, now] = [&pressed, &goes_on].map(|run| run.state().contact_forces[0][1]);
    assert!((now / before - 1.0).abs() < 1e-6, "{before} {now}");
}

/// A state in other units is refused.
#[test]
fn a_state_in_other_units_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let units = |time: &str| format!("units = {{ length = \"mm\", time = \"{time}\", mass = \"g\" }}\n");
    let first = format!("{}{}", units("s"), flight("-3.0", "", ""));
    let initial = initial_state(&first, &folder.path().join("first"));
    let other = case(&format!("{}{}", units("ms"), flight("-3.0", "", &initial)), &[""; 0]);
    let Err(problems) = Setup::new(&other).start() else { panic!("milliseconds are not seconds") };
    assert!(format!("{problems:?}").contains("it has mm, s, g, the case mm, ms, g"), "{problems:?}");
    simulation(&format!("{}{}", units("s"), flight("-3.0", "", &initial)), &[""; 0]);
}
