//! Rigid surfaces from files: what is stored of them, and errors at the key that is wrong; motion
//! and shapes of obstacles in space.

use carom_case::*;

use super::{resolved_as, stored};

const FALL: &str = r#"
dimension = 3
material = [{ name = "rubber", law = "neo-hookean", density = 1.0, lambda = 20.0, mu = 10.0 }]
body = [{ name = "ball", material = "rubber", element = "Tet4", mesh = { shape = "ball", radius = 0.5, center = [0.0, 0.0, 0.6], size = 0.4 } }]
contact = [{ name = "floor", secondary = "ball.sphere", primary = { PRIMARY } }]
time = { scheme = { kind = "hu" }, step = 1e-3, end = 0.1 }
"#;

/// A file with this content and the case that names it.
fn with(name: &str, content: &[u8], rest: &str) -> Result<Case, Vec<Diagnostic>> {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join(name), content).unwrap();
    let case = folder.path().join("case.toml").display().to_string();
    let text = FALL.replace("PRIMARY", &format!("surface = {{ file = \"{name}\"{rest} }}"));
    resolved_as(&case, &text, &[])
}

fn problem(found: Result<Case, Vec<Diagnostic>>) -> String {
    let problems = found.expect_err("a problem");
    assert_eq!(problems.len(), 1, "{problems:#?}");
    problems[0].to_string()
}

/// Triangles as a text in STL.
fn stl(triangles: &[[[i32; 3]; 3]]) -> Vec<u8> {
    let corner = |x: &[i32; 3]| format!("vertex {} {} {}\n", x[0], x[1], x[2]);
    let facet = |triangle: &[[i32; 3]; 3]| {
        let corners: String = triangle.iter().map(corner).collect();
        format!("facet normal 0 0 0\nouter loop\n{corners}endloop\nendfacet\n")
    };
    format!("solid part\n{}endsolid part\n", triangles.iter().map(facet).collect::<String>()).into_bytes()
}

const MSH: &str = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n1\n2 7 \"tool\"\n$EndPhysicalNames\n$Nodes\n4\n1 0 0 0\n2 1 0 0\n3 1 1 0\n4 0 1 0\n$EndNodes\n$Elements\n2\n1 2 2 7 1 1 2 3\n2 2 2 7 1 1 3 4\n$EndElements\n";

#[test]
fn a_surface_is_read_from_both_formats() {
    let [a, b, c, d] = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]];
    let square = stl(&[[a, b, c], [a, c, d]]);
    for case in [
        with("part.stl", &square, ""),
        with("part.msh", MSH.as_bytes(), ", group = \"tool\""),
        with("part.msh", MSH.as_bytes(), ", scale = 2.0"),
    ] {
        let case = case.unwrap();
        let PrimarySpec::Surface(surface) = &case.contacts[0].primary else { panic!() };
        assert!(surface.file.is_absolute() && !surface.reverse);
        assert_eq!((surface.triangles, surface.rim, surface.hash.len()), (2, 4, 64));
        assert_eq!(stored(&case), case);
        // Its folder is gone.
        assert!(surface.triangles().unwrap_err().to_string().contains("there is no file"));
    }
}

#[test]
fn errors_of_surfaces_are_reported_at_their_key() {
    let [a, b, c, d] = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]];
    let square = stl(&[[a, b, c], [a, c, d]]);
    for (name, content, rest, words) in [
        (
            "part.stl",
            stl(&[[a, b, c], [a, d, c]]),
            "",
            &["triangles 1 and 2 are oriented in opposite ways"][..],
        ),
        ("part.stl", stl(&[[a, b, b]]), "", &["triangle 1 has no area", "one outside"]),
        (
            "part.stl",
            b"solid x\nfacet".to_vec(),
            "",
            &["it ends early: line 2 is the last one", "save it again"],
        ),
        ("part.stl", square, ", group = \"tool\"", &["has no groups"]),
        ("part.msh", MSH.into(), ", group = \"toll\"", &["the physical surfaces are: tool"]),
        (
            "part.msh",
            MSH.replace("1 2 2 7 1 1 2 3", "1 3 2 7 1 1 2 3 4").into(),
            "",
            &["cell 1 of the surface is a quadrangle", "Recombine"],
        ),
    ] {
        let message = problem(with(name, &content, rest));
        assert!(words.iter().all(|word| message.contains(word)), "{words:?} not in\n{message}");
    }
}

#[test]
fn obstacles_in_space_say_what_they_lack() {
    let read = |primary: &str| resolved_as("a/case.toml", &FALL.replace("PRIMARY", primary), &[]);
    let cylinder = "cylinder = { point = [0, 0, -1], axis = [0, 1, 0], radius = 0.9 }";
    assert!(read(&format!("{cylinder}, motion = {{ z = \"0.1*t\" }}")).is_ok());
    for (primary, words) in [
        (cylinder.replace("[0, 1, 0]", "[0, 0, 0]"), "the axis is zero"),
        (cylinder.replace("0.9", "0"), "`radius` must be a number > 0"),
        (
            format!("{cylinder}, sphere = {{ center = [0, 0, -1], radius = 0.9 }}"),
            "this one has sphere, cylinder",
        ),
        ("circle = { center = [0, 0, -1], radius = 0.9 }".to_owned(), "a circle needs dimension = 2"),
        ("surface = { file = \"nowhere.stl\" }".to_owned(), "the surface \"nowhere.stl\" cannot be read"),
    ] {
        let message = problem(read(&primary));
        assert!(message.contains(words), "{words} not in\n{message}");
    }
}
