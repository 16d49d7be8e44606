//! `carom mesh` from outside: what it writes is read back the same, and it overwrites nothing.

#![allow(clippy::unwrap_used)]

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
    assert_eq!(file.body("cylinder").unwrap(), generate::half_disc(Element::T10, 0.5, [0.0, 1.0], 0.1).unwrap());

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

#[test]
fn what_cannot_be_written_is_told() {
    let place = place("told");
    assert_eq!(mesh("impact/impact.toml", &place.join("a.stl")).status.code(), Some(2));
    assert_eq!(mesh("impact/impact.toml", &place.join("no/a.msh")).status.code(), Some(4));
    assert_eq!(mesh("impact/nothing.toml", &place.join("a.msh")).status.code(), Some(2));
    assert_eq!(std::fs::read_dir(&place).unwrap().count(), 0);
    std::fs::remove_dir_all(&place).unwrap();
}
