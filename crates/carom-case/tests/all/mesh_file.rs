//! Meshes from files: paths relative to the folder of the case, hashes, and errors reported at the
//! key that names the file.

use carom_case::*;

use super::resolved_as;

const GMSH: &str = include_str!("../../../../cases/gmsh/gmsh.toml");

/// Reads a case as if it were in the folder of its meshes.
fn resolved(text: &str, sets: &[&str]) -> Result<Case, Vec<Diagnostic>> {
    resolved_as(concat!(env!("CARGO_MANIFEST_DIR"), "/../../cases/gmsh/gmsh.toml"), text, sets)
}

fn problem(set: &str) -> Diagnostic {
    let mut problems = resolved(GMSH, &[set]).expect_err(set);
    assert_eq!(problems.len(), 1, "{problems:#?}");
    problems.remove(0)
}

#[test]
fn the_shipped_case_stores_its_meshes() {
    let case = resolved(GMSH, &[]).unwrap();
    let MeshSpec::File { file, surface, hash, sides, repairs, .. } = &case.bodies[1].mesh else { panic!() };
    assert!(file.is_absolute() && file.ends_with("impact.msh"));
    assert_eq!((surface.as_str(), hash.len(), repairs.len()), ("prism", 64, 0));
    assert_eq!(*sides, ["axis", "bottom", "right", "top"]);
    assert!(case.bodies[1].mesh.estimate(carom_solid::Element::T10).1 > 300.0);
    let back: Case = serde_json::from_str(&serde_json::to_string(&case).unwrap()).unwrap();
    assert_eq!(back, case);
    assert_eq!(case.bodies[1].mesh.verify(), Ok(()));
}

/// With `refine = 2` every triangle of the file becomes four; half a cell is no part.
#[test]
fn a_mesh_is_divided() {
    let cells = |sets: &[&str]| resolved(GMSH, sets).unwrap().bodies[1].make_mesh(2).unwrap().cell_count();
    assert_eq!(cells(&["refine=2"]), 4 * cells(&[]));
    let fraction = problem("refine=1.5");
    assert!(fraction.what.contains("not an integer") && fraction.help.contains("refine = 2"), "{fraction}");
}

#[test]
fn errors_are_reported_at_their_key() {
    let missing = problem("body.prism.mesh.file=nowhere.msh");
    assert!(
        missing.what.contains("\"nowhere.msh\" cannot be read") && missing.why.contains("there is no file")
    );
    assert!(problem("body.prism.mesh.file=../gmsh").why.contains("is not a regular file"));
    assert!(problem("body.prism.mesh.file=gmsh.toml").what.contains("this is not a Gmsh mesh"));
    let name = problem("body.prism.mesh.surface=prisma");
    assert!(name.what.contains("\"prisma\"") && name.why.contains("cylinder, prism"), "{name}");
    assert!(problem("body.prism.element=T6").help.contains("element = \"T10\""));
    let side = problem("contact.strike.primary=prism.tob");
    assert!(side.help.contains("`prism.top`"), "{side}");
    assert!(problem("body.prism.mesh={ file = \"impact.msh\" }").what.contains("no `surface`"));
    assert!(problem("body.prism.mesh={ surface = \"prism\" }").help.contains("or give `file`"));
    let both = problem("body.prism.mesh={ file = \"impact.msh\", surface = \"prism\", shape = \"disc\" }");
    assert!(both.what.contains("unknown key `shape` in mesh from a file"), "{both}");
}

#[test]
fn a_changed_mesh_is_noticed() {
    let folder = std::env::temp_dir().join(format!("carom-mesh-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    let copy = folder.join("copy.msh");
    let original = concat!(env!("CARGO_MANIFEST_DIR"), "/../../cases/gmsh/impact.msh");
    std::fs::copy(original, &copy).unwrap();
    let case = resolved(GMSH, &[&format!("body.prism.mesh.file={}", copy.display())]).unwrap();
    assert!(case.bodies[1].make_mesh(2).is_ok());
    let mut text = std::fs::read_to_string(&copy).unwrap();
    text.push('\n');
    std::fs::write(&copy, text).unwrap();
    let why = case.bodies[1].mesh.verify().unwrap_err().to_string();
    assert!(why.contains("copy.msh has changed"), "{why}");
    assert!(case.bodies[1].make_mesh(2).unwrap_err().to_string().contains("has changed"));
    std::fs::remove_dir_all(&folder).unwrap();
    assert!(case.bodies[1].mesh.verify().unwrap_err().to_string().contains("there is no file"));
}
