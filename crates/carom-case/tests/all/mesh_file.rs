//! Meshes from files: paths relative to the folder of the case, hashes, and errors reported at the
//! key that names the file.

use carom_case::*;

use super::{resolved_as, stored};

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
    let MeshSpec::File(FileMesh { file, surface, hash, sides, repairs, .. }) = &case.bodies[1].mesh else {
        panic!()
    };
    assert!(file.is_absolute() && file.ends_with("impact.msh"));
    assert_eq!((surface.as_str(), hash.len(), repairs.len()), ("prism", 64, 0));
    assert_eq!(*sides, ["axis", "bottom", "right", "top"]);
    assert!(case.bodies[1].mesh.estimate(carom_solid::Element::T10).1 > 300.0);
    assert_eq!(stored(&case), case);
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
    assert!(problem("body.prism.mesh={ file = \"impact.msh\" }").what.contains("needs `surface`"));
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

const PART: &str = r#"
dimension = 3
material = [{ name = "steel", law = "linear-elastic", density = 7850.0, young = 2.1e11, poisson = 0.3 }]
time = { end = 1e-3, step = 1e-5, scheme = { kind = "newmark", rho_inf = 1 } }

[[body]]
name = "part"
material = "steel"
element = "Hex27"
mesh = { file = "sector_order2.msh", volume = "wedge" }
"#;

/// Reads a case as if it were in the folder of the meshes of `carom-solid`.
fn part(sets: &[&str]) -> Result<Case, Vec<Diagnostic>> {
    resolved_as(concat!(env!("CARGO_MANIFEST_DIR"), "/../carom-solid/tests/msh/part.toml"), PART, sets)
}

const WEDGE: &str = "body.part.mesh={ shape = \"extrusion\", of = { file = \"sector_order2.msh\", \
    surface = \"sector\" }, height = 0.5, layers = 2 }";

/// Quadrilaterals and hexahedra of a file are divided, too; the estimate of their number is exact.
#[test]
fn hexahedra_are_divided() {
    let quadrilaterals = [
        "body.prism.mesh={ file = \"../../crates/carom-solid/tests/msh/quadrangles.msh\", \
        surface = \"prism\" }",
        "body.prism.element=Q4",
    ];
    let plane = |refine: &str| {
        let sets = [&quadrilaterals[..], &[refine]].concat();
        resolved(GMSH, &sets).unwrap_or_else(|p| panic!("{}", p[0])).bodies[1].clone()
    };
    assert_eq!(plane("refine=2").make_mesh(2).unwrap().cell_count(), 4 * 11);
    assert_eq!(plane("refine=3").make_mesh(2).unwrap().cell_count(), 9 * 11);
    for refine in [1_usize, 2, 3] {
        let body = part(&[&format!("refine={refine}")]).unwrap().bodies[0].clone();
        let cells = body.make_mesh(3).unwrap().cell_count();
        assert_eq!((cells, body.mesh.estimate(body.element).0), (24 * refine.pow(3), cells as f64));
    }
}

/// The extrusion of a plane mesh from a file is the mesh in space that Gmsh extruded, with its
/// sides; it is refined like any other, and its file is remembered.
#[test]
fn a_plane_mesh_is_extruded() {
    for (element, cells) in [("Hex27", 24), ("Hex8", 24)] {
        let order = if element == "Hex8" { 1 } else { 2 };
        let wedge = WEDGE.replace("order2", &format!("order{order}"));
        let element = format!("body.part.element={element}");
        let whole = format!("body.part.mesh={{ file = \"sector_order{order}.msh\", volume = \"wedge\" }}");
        let made = |sets: &[&str]| {
            let case = part(sets).unwrap_or_else(|p| panic!("{}", p[0]));
            assert_eq!(stored(&case), case);
            assert_eq!(case.bodies[0].mesh.verify(), Ok(()));
            let mesh = case.bodies[0].make_mesh(3).unwrap();
            let (cells, nodes) = case.bodies[0].mesh.estimate(mesh.element);
            assert_eq!(cells, mesh.cell_count() as f64);
            assert!((0.8..2.0).contains(&(nodes / mesh.nodes.len() as f64)), "{nodes}");
            let mut sides = case.bodies[0].mesh.sides();
            sides.sort();
            assert_eq!(mesh.sides.keys().cloned().collect::<Vec<_>>(), sides);
            mesh
        };
        let (mesh, of_gmsh) = (made(&[&wedge, &element]), made(&[&whole, &element]));
        assert_eq!((mesh.cell_count(), mesh.nodes.len()), (cells, of_gmsh.nodes.len()));
        assert_eq!(
            mesh.sides.keys().collect::<Vec<_>>(),
            ["bottom", "inner", "outer", "plane_x", "plane_y", "top"]
        );
        assert_eq!(made(&[&wedge, &element, "refine=2"]).cell_count(), 8 * cells);
    }
    let MeshSpec::File(FileMesh { file, .. }) = part(&[WEDGE]).unwrap().bodies[0].mesh.source().clone()
    else {
        panic!()
    };
    assert!(file.is_absolute() && file.ends_with("sector_order2.msh"));
    let triangles =
        WEDGE.replace("sector_order2.msh", "impact_order3_41_binary.msh").replace("\"sector\"", "\"prism\"");
    let body = part(&[&triangles, "body.part.element=Tet20"]).unwrap_or_else(|p| panic!("{}", p[0]));
    assert!(body.bodies[0].make_mesh(3).unwrap().scaled_jacobian().unwrap() > 0.1);
}

#[test]
fn errors_of_extruded_files_are_reported_at_their_key() {
    let problem = |set: &str| {
        let problems = part(&[set]).expect_err(set);
        problems.iter().map(ToString::to_string).collect::<String>()
    };
    let problem_of = |old: &str, new: &str| problem(&WEDGE.replace(old, new));
    for (old, new, texts) in [
        ("sector_order2", "nowhere", ["\"nowhere.msh\" cannot be read", "there is no file"]),
        ("\"sector\"", "\"part\"", ["no physical surface \"part\"", "sector"]),
        (
            "order2",
            "order1",
            ["the extrusion of \"sector\"", "element = \"Hex8\", or set Mesh.ElementOrder = 2"],
        ),
        ("surface", "volume", ["unknown key `volume`", "surface"]),
        (", surface = \"sector\"", "", ["needs `surface`", "surface = \"cylinder\""]),
        ("height = 0.5, ", "", ["needs `height`", "height = 0.2"]),
    ] {
        let problem = problem_of(old, new);
        assert!(texts.iter().all(|text| problem.contains(text)), "{old} {new}: {problem}");
    }
    let wrong = problem_of(
        "sector_order2.msh\", surface = \"sector\"",
        "impact_order2_41_ascii.msh\", surface = \"prism\"",
    );
    assert!(
        wrong.contains("mesh it with quadrilaterals") && wrong.contains("element = \"Tet10\""),
        "{wrong}"
    );
    let sets = [WEDGE, "refine=1.5"];
    let fraction = part(&sets).unwrap_err().remove(0).to_string();
    assert!(fraction.contains("body[0].mesh.of comes from a file"), "{fraction}");
}

/// Two squares of triangles, conforming along x = 1: the surfaces 8 and 9, the curve 7 there.
const SQUARES: &str = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n\
    $Nodes\n6\n1 0 0 0\n2 1 0 0\n3 1 1 0\n4 0 1 0\n5 2 0 0\n6 2 1 0\n$EndNodes\n$Elements\n5\n\
    1 1 2 7 1 2 3\n2 2 2 8 1 1 2 3\n3 2 2 8 1 1 3 4\n4 2 2 9 1 2 5 6\n5 2 2 9 1 2 6 3\n$EndElements\n";

/// Two bodies of a file; `rest`: what follows them.
fn squares(mesh: &str, rest: &str, sets: &[&str]) -> Result<Case, String> {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("squares.msh"), mesh).unwrap();
    let case = folder.path().join("case.toml").display().to_string();
    let body = |name: &str, group: &str| {
        format!(
            "[[body]]\nname = \"{name}\"\nmaterial = \"m\"\nelement = \"T3\"\nmesh = {{ file = \"squares.msh\", surface = \"{group}\" }}\n"
        )
    };
    let head = "dimension = 2\nmaterial = [{ name = \"m\", law = \"neo-hookean\", density = 1.0, young = 1.0, poisson = 0.3 }]\n\
        time = { scheme = { kind = \"hu\" }, step = 1e-3, end = 0.1 }\n";
    let text = [head, &body("left", "8"), &body("right", "9"), rest].concat();
    resolved_as(&case, &text, sets).map_err(|problems| {
        assert_eq!(problems.len(), 1, "{problems:#?}");
        problems[0].to_string()
    })
}

/// Bodies of one mesh with a common facet and no contact are refused, with the remedy.
#[test]
fn bodies_of_one_mesh_are_one_body_or_in_contact() {
    let problem = squares(SQUARES, "", &[]).unwrap_err();
    for words in [
        "bodies `left` and `right` have 2 nodes of squares.msh in common, from [1.0, 0.0] to [1.0, 1.0], and no contact",
        "every body has nodes of its own",
        "at the edge between them",
        "put the cells of both into one physical surface",
        "secondary = \"left.7\" and primary = \"right.7\"",
    ] {
        assert!(problem.contains(words), "{words}: {problem}");
    }
    let contact = "[[contact]]\nname = \"joint\"\nsecondary = \"left.7\"\nprimary = \"right.7\"\n";
    assert!(squares(SQUARES, contact, &[]).is_ok());
    assert!(squares(SQUARES, "[[contact]]\nname = \"all\"\nbetween = \"all\"\n", &[]).is_ok());
    assert!(squares(SQUARES, contact, &["contact.joint.primary=left.7"]).is_err());
    assert!(squares(SQUARES, "", &["body.right.place.shift=[0.5, 0.0]"]).is_ok());
    // Nodes of their own at the same places.
    let own = SQUARES.replace("6 2 1 0\n", "6 2 1 0\n7 1 0 0\n8 1 1 0\n").replace("$Nodes\n6", "$Nodes\n8");
    let own = own.replace("9 1 2 5 6", "9 1 7 5 6").replace("9 1 2 6 3", "9 1 7 6 8");
    assert!(squares(&own, "", &[]).is_ok());
    // A corner is no joint.
    let corner = own.replace("9 1 7 5 6", "9 1 2 5 6").replace("9 1 7 6 8", "9 1 2 6 8");
    assert!(squares(&corner, "", &[]).is_ok());
    let without = SQUARES.replace("$Elements\n5\n1 1 2 7 1 2 3\n", "$Elements\n4\n");
    let problem = squares(&without, "", &[]).unwrap_err();
    assert!(problem.contains("left.SIDE") && problem.contains("SIDE is a physical curve there"), "{problem}");
}

/// A mesh without sides, and a side all of whose edges lie inside the body.
#[test]
fn sides_that_a_mesh_lacks() {
    let shift = "body.right.place.shift=[0.5, 0.0]";
    let support = "[[support]]\non = [\"left.bottom\"]\nfix = [\"x\"]\n";
    let without = SQUARES.replace("$Elements\n5\n1 1 2 7 1 2 3\n", "$Elements\n4\n");
    let problem = squares(&without, support, &[shift]).unwrap_err();
    for words in [
        "body `left` has no side `bottom`",
        "no physical group of its file has a part of its boundary",
        "Physical Curve(\"bottom\") = {1};",
        "or write `left.skin`, its whole boundary",
    ] {
        assert!(problem.contains(words), "{words}: {problem}");
    }
    let inner = SQUARES.replace("1 1 2 7 1 2 3", "1 1 2 7 1 1 3");
    let problem = squares(&inner, &support.replace("bottom", "7"), &[shift]).unwrap_err();
    assert!(problem.contains("1 of 1 edges of the physical curve \"7\" lie inside the body"), "{problem}");
}
