//! `carom mesh` as a process: files are read back unchanged, and nothing is overwritten.

use std::process::Output;

use carom_record::FieldSet;
use carom_solid::{Element, generate, gmsh};

use crate::common::{Place, SQUARE};

const CASES: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../cases");

fn mesh(place: &Place, case: &str, out: &str) -> Output {
    place.carom(&["mesh", &format!("{CASES}/{case}"), "--out", out])
}

#[test]
fn meshes_are_written_once_and_read_back() {
    let place = Place::new("mesh-once");
    let (msh, vtu) = ("a.msh", "a.vtu");
    assert_eq!(mesh(&place, "impact/impact.toml", msh).status.code(), Some(0));
    let bytes = std::fs::read(place.0.join(msh)).unwrap();
    let file = gmsh::read(&bytes).unwrap();
    let prism = generate::rectangle(Element::T10, [0.0, -0.5], [1.0, 0.0], [8, 4]).unwrap();
    assert_eq!(file.body("prism").unwrap(), prism);
    assert_eq!(
        file.body("cylinder").unwrap(),
        generate::half_disc(Element::T10, 0.5, [0.0, 1.0], 0.1).unwrap()
    );

    let again = mesh(&place, "impact/impact.toml", msh);
    assert_eq!(again.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&again.stderr).contains("not overwritten"));
    assert_eq!(std::fs::read(place.0.join(msh)).unwrap(), bytes);

    assert_eq!(mesh(&place, "gmsh/gmsh.toml", vtu).status.code(), Some(0));
    let fields = FieldSet::from_vtu(&std::fs::read(place.0.join(vtu)).unwrap()).unwrap();
    let names: Vec<_> = fields.blocks.iter().map(|b| (b.body.as_str(), b.degree)).collect();
    assert_eq!(names, [("cylinder", 3), ("prism", 3)]);
}

/// A square of two triangles; the second one is clockwise.
fn clockwise() -> String {
    SQUARE.replace("2 2 2 1 1 1 3 4", "2 2 2 1 1 1 4 3")
}

const FALL: &str = "
dimension = 2
material = [{ name = 'm', law = 'neo-hookean', density = 1.0, lambda = 1.0, mu = 1.0 }]
body = [{ name = 'b', material = 'm', element = 'T3', mesh = { file = 'square.msh', surface = 'square' }, velocity = [1.0, 0.0] }]
time = { end = 0.02, step = 0.01, scheme = { kind = 'hu' } }
";

#[test]
fn repairs_are_logged_once() {
    let place = Place::new("mesh-repairs");
    place.file("square.msh", clockwise()).file("case.toml", FALL);
    let done = place.carom(&["run", "case.toml", "--out", "run", "--no-report"]);
    assert_eq!(done.status.code(), Some(0), "{}", String::from_utf8_lossy(&done.stderr));
    let log = std::fs::read_to_string(place.0.join("run/log.jsonl")).unwrap();
    let events: Vec<serde_json::Value> =
        log.lines().map(|line| serde_json::from_str(line).unwrap()).collect();
    let repairs: Vec<_> = events.iter().filter(|e| e["kind"] == "repair").collect();
    assert_eq!(repairs.len(), 1, "{log}");
    assert_eq!((&repairs[0]["step"], &repairs[0]["body"]), (&0.into(), &"b".into()));
    assert!(repairs[0]["message"].as_str().unwrap().contains("1 of 2 cells were clockwise"), "{log}");
}

#[test]
fn what_cannot_be_written_is_reported() {
    let place = Place::new("mesh-reported");
    assert_eq!(mesh(&place, "impact/impact.toml", "a.stl").status.code(), Some(2));
    assert_eq!(mesh(&place, "impact/impact.toml", "no/a.msh").status.code(), Some(4));
    assert_eq!(mesh(&place, "impact/nothing.toml", "a.msh").status.code(), Some(2));
    assert_eq!(place.entries().len(), 0);
}
