//! `carom mesh` as a process: files are read back unchanged, and nothing is overwritten.

use std::path::PathBuf;
use std::process::{Command, Output};

use carom_record::FieldSet;
use carom_solid::{Element, generate, gmsh};

const CASES: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../cases");

fn mesh(case: &str, out: &std::path::Path) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_carom"));
    command.args(["mesh", &format!("{CASES}/{case}"), "--out"]).arg(out).output().unwrap()
}

fn place(name: &str) -> PathBuf {
    let path = std::env::temp_dir().join(format!("carom-mesh-{}-{name}", std::process::id()));
    std::fs::create_dir_all(&path).unwrap();
    path
}

#[test]
fn meshes_are_written_once_and_read_back() {
    let place = place("once");
    let (msh, vtu) = (place.join("a.msh"), place.join("a.vtu"));
    assert_eq!(mesh("impact/impact.toml", &msh).status.code(), Some(0));
    let bytes = std::fs::read(&msh).unwrap();
    let file = gmsh::read(&bytes).unwrap();
    let prism = generate::rectangle(Element::T10, [0.0, -0.5], [1.0, 0.0], [8, 4]).unwrap();
    assert_eq!(file.body("prism").unwrap(), prism);
    assert_eq!(
        file.body("cylinder").unwrap(),
        generate::half_disc(Element::T10, 0.5, [0.0, 1.0], 0.1).unwrap()
    );

    let again = mesh("impact/impact.toml", &msh);
    assert_eq!(again.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&again.stderr).contains("not overwritten"));
    assert_eq!(std::fs::read(&msh).unwrap(), bytes);

    assert_eq!(mesh("gmsh/gmsh.toml", &vtu).status.code(), Some(0));
    let fields = FieldSet::from_vtu(&std::fs::read(&vtu).unwrap()).unwrap();
    let names: Vec<_> = fields.blocks.iter().map(|b| (b.body.as_str(), b.degree)).collect();
    assert_eq!(names, [("cylinder", 3), ("prism", 3)]);
    std::fs::remove_dir_all(&place).unwrap();
}

/// A square of two triangles; the second one is clockwise.
const SQUARE: &str = "$MeshFormat\n2.2 0 8\n$EndMeshFormat
$PhysicalNames\n1\n2 1 \"square\"\n$EndPhysicalNames
$Nodes\n4\n1 0 0 0\n2 1 0 0\n3 1 1 0\n4 0 1 0\n$EndNodes
$Elements\n2\n1 2 2 1 1 1 2 3\n2 2 2 1 1 1 4 3\n$EndElements\n";

const FALL: &str = "
dimension = 2
material = [{ name = 'm', law = 'neo-hookean', density = 1.0, lambda = 1.0, mu = 1.0 }]
body = [{ name = 'b', material = 'm', element = 'T3', mesh = { file = 'square.msh', surface = 'square' }, velocity = [1.0, 0.0] }]
time = { end = 0.02, step = 0.01, scheme = { kind = 'hu' } }
";

#[test]
fn repairs_are_logged_once() {
    let place = place("repairs");
    std::fs::write(place.join("square.msh"), SQUARE).unwrap();
    std::fs::write(place.join("case.toml"), FALL).unwrap();
    let mut command = Command::new(env!("CARGO_BIN_EXE_carom"));
    let done = command
        .current_dir(&place)
        .args(["run", "case.toml", "--out", "run", "--no-report"])
        .output()
        .unwrap();
    assert_eq!(done.status.code(), Some(0), "{}", String::from_utf8_lossy(&done.stderr));
    let log = std::fs::read_to_string(place.join("run/log.jsonl")).unwrap();
    let events: Vec<serde_json::Value> =
        log.lines().map(|line| serde_json::from_str(line).unwrap()).collect();
    let repairs: Vec<_> = events.iter().filter(|e| e["kind"] == "repair").collect();
    assert_eq!(repairs.len(), 1, "{log}");
    assert_eq!((&repairs[0]["step"], &repairs[0]["body"]), (&0.into(), &"b".into()));
    assert!(repairs[0]["message"].as_str().unwrap().contains("1 of 2 cells were clockwise"), "{log}");
    std::fs::remove_dir_all(&place).unwrap();
}

#[test]
fn what_cannot_be_written_is_reported() {
    let place = place("reported");
    assert_eq!(mesh("impact/impact.toml", &place.join("a.stl")).status.code(), Some(2));
    assert_eq!(mesh("impact/impact.toml", &place.join("no/a.msh")).status.code(), Some(4));
    assert_eq!(mesh("impact/nothing.toml", &place.join("a.msh")).status.code(), Some(2));
    assert_eq!(std::fs::read_dir(&place).unwrap().count(), 0);
    std::fs::remove_dir_all(&place).unwrap();
}
