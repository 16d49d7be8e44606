//! What a run that stops advises to try fits its case: elements of its bodies, friction of its
//! contacts.

use std::sync::atomic::AtomicBool;

use carom_record::{Manifest, Source, Stop};
use carom_run::recording::run;

use super::common::case;

fn advice(text: &str, sets: &[&str]) -> Vec<String> {
    let folder = tempfile::tempdir().unwrap();
    let directory = folder.path().join("run");
    let given = sets.iter().map(|set| (*set).to_owned()).collect();
    let source = Source { text: text.to_owned(), sets: given, ..Source::default() };
    run(&case(text, sets), source, &directory, 1, &mut |_| {}, &AtomicBool::new(false)).unwrap();
    let stop = Stop::read(&directory, &Manifest::read(&directory).unwrap()).unwrap().unwrap();
    stop.advice.into_iter().map(|advice| advice.what).collect()
}

/// A block is pressed to less than nothing.
#[test]
fn elements_of_the_body_that_is_crushed() {
    let crushed = r#"
dimension = 3
material = [{ name = "m", law = "neo-hookean", density = 1.0, young = 1.0, poisson = 0.3 }]
body = [{ name = "block", material = "m", element = "Tet10", mesh = { shape = "box", min = [0.0, 0.0, 0.0], max = [1.0, 1.0, 1.0], cells = [1, 1, 1] } }]
support = [{ on = ["block.bottom"], fix = ["x", "y", "z"] }, { on = ["block.top"], fix = ["x", "y"], move = { z = "-t*t" } }]
time = { end = 2.0, step = 0.1, scheme = { kind = "bathe", rho_inf = 0.0 } }
"#;
    let lower = |sets: &[&str]| -> Vec<String> {
        advice(crushed, sets).into_iter().filter(|what| what.contains("lower degree")).collect()
    };
    assert_eq!(lower(&[]), ["an element of lower degree (Tet4) there: its cells invert later"]);
    assert!(lower(&["body.block.element=Hex27"])[0].contains("(Hex8)"));
    assert!(lower(&["body.block.element=Tet4"]).is_empty());
    // Plastic flow would be locked in cells of constant strain, which are refused.
    let yields = ["material.m.law=hencky", "material.m.plastic={ yield = 0.01, hardening = 0.1 }"];
    assert!(lower(&yields).is_empty());
    assert!(!advice(crushed, &[]).iter().any(|what| what.contains("load") || what.contains("polygon")));
}

/// A disc without contact falls, although statics has no falling: friction can hold it only where
/// there is some.
#[test]
fn friction_where_there_is_some() {
    let falls = r#"
dimension = 2
material = [{ name = "m", law = "neo-hookean", density = 1.0, young = 100.0, poisson = 0.3 }]
body = [{ name = "disc", material = "m", element = "T3", mesh = { shape = "disc", radius = 0.5, center = [0.0, 0.6], size = 0.25 }, gravity = [0.0, -0.2] }]
contact = [{ name = "floor", secondary = "disc.arc", primary = { plane = { point = [0.0, 0.0], normal = [0.0, 1.0] } } }]
time = { end = 1.0, step = 0.5, scheme = { kind = "static" } }
"#;
    let said = |sets: &[&str]| -> Vec<String> {
        advice(falls, sets).into_iter().filter(|what| what.contains("friction")).collect()
    };
    let to_hold = "of a contact that is to hold it";
    assert_eq!(said(&[]), [format!("friction (`mu`) {to_hold}")]);
    assert_eq!(said(&["contact.floor.mu=0.0"]), [format!("friction (`mu`) {to_hold}")]);
    assert_eq!(said(&["contact.floor.mu=0.2"]), [format!("larger friction (`mu` or `shear`) {to_hold}")]);
}

/// Mortar contact has no fallback, so none is advised.
#[test]
fn nothing_that_the_case_refuses() {
    let pressed = r#"
dimension = 2
material = [{ name = "m", law = "neo-hookean", density = 1.0, young = 1.0, poisson = 0.3 }]
body = [
    { name = "low", material = "m", element = "Q4", mesh = { shape = "rectangle", min = [0.0, 0.0], max = [1.0, 1.0], cells = [2, 2] } },
    { name = "top", material = "m", element = "Q4", mesh = { shape = "rectangle", min = [0.0, 1.0], max = [1.0, 2.0], cells = [3, 2] } },
]
support = [{ on = ["low.bottom"], fix = ["x", "y"] }, { on = ["top.top"], fix = ["x"], move = { y = "-2*t*t" } }]
contact = [{ name = "joint", secondary = "top.bottom", primary = "low.top" }]
time = { end = 2.0, step = 0.1, scheme = { kind = "bathe", rho_inf = 0.0 } }
"#;
    let fallback = |sets: &[&str]| advice(pressed, sets).iter().any(|what| what.contains("another scheme"));
    assert!(fallback(&[]));
    assert!(!fallback(&["contact.joint.method=mortar"]));
}

/// A block is compressed until its cells are too short for the step. A finer mesh would need a
/// shorter one still.
#[test]
fn explicit_steps_that_are_too_long() {
    let pressed = r#"
dimension = 2
material = [{ name = "m", law = "neo-hookean", density = 1.0, young = 1.0, poisson = 0.3 }]
body = [{ name = "block", material = "m", element = "Q4", mass = "lumped", mesh = { shape = "rectangle", min = [0.0, 0.0], max = [1.0, 1.0], cells = [4, 4] } }]
support = [{ on = ["block.bottom"], fix = ["x", "y"] }]
load = [{ on = ["block.top"], pressure = "0.5*t" }]
time = { end = 8.0, step = 0.1, scheme = { kind = "central-difference" } }
"#;
    let said = advice(pressed, &[]);
    assert_eq!(said[0], "a shorter step from the start");
    assert!(
        said.iter().all(|what| !what.contains("finer mesh") || what.contains("shorter by the same factor")),
        "{said:?}"
    );
}
