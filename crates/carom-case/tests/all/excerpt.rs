//! The parts of a case that remain when it is reduced.

use carom_case::Excerpt;
use toml_edit::DocumentMut;

const CASE: &str = r#"
title = "three"
material = [{ name = "m", density = 1 }, { name = "unused", density = 2 }]

[[body]]
name = "a"
material = "m"
velocity = [1.0, 0.0]
position = ["X", "Y - 0.01"] # says which depths are kept
mesh = { file = "far/a.msh", surface = "a" }

[[body]] # goes
name = "b"
material = "unused"

[[support]]
on = ["a.left", "b.right"]
fix = ["x"]

[[support]]
on = ["b.left"]
fix = ["x"]

[[contact]]
name = "c"
secondary = "a.top"
primary = "b.top"

[time]
end = 9.0
step = 0.5 # kept

[[expect]]
what = "max a.uy"
"#;

#[test]
fn what_remains_is_complete() {
    let excerpt = Excerpt {
        bodies: vec!["a".into()],
        end: 1.5,
        state: "state.bin".into(),
        meshes: [("a".to_owned(), "a.msh".to_owned())].into(),
        comment: "# reduced".into(),
        ..Excerpt::default()
    };
    let sets = ["body.a.element=T6".to_owned(), "time.scheme={ kind = \"hu\" }".to_owned()];
    let text = excerpt.of(CASE, &sets).unwrap();
    let case: DocumentMut = text.parse().unwrap();
    let body = &case["body"][0];
    assert_eq!(body["element"].as_str(), Some("T6"));
    assert_eq!((body["mesh"]["file"].as_str(), body.get("velocity").is_none()), (Some("a.msh"), true));
    assert!(body.get("position").is_some());
    assert_eq!(case["support"].as_array_of_tables().map(toml_edit::ArrayOfTables::len), Some(1));
    assert_eq!(case["support"][0]["on"].as_array().map(toml_edit::Array::len), Some(1));
    assert_eq!(case["material"].as_array().map(toml_edit::Array::len), Some(1));
    assert!(case.get("contact").is_none() && case.get("expect").is_none());
    assert_eq!(
        (case["time"]["end"].as_float(), case["initial"]["from"].as_str()),
        (Some(1.5), Some("state.bin"))
    );
    assert!(text.starts_with("# reduced\n") && text.contains("# kept") && text.contains("\"hu\""), "{text}");
}

/// Names of tables may be names of keys.
#[test]
fn an_override_of_a_body_named_body() {
    let text = "[[body]]\nname = \"body\"\n[[contact]]\nname = \"contact\"\nbetween = [\"body\", \"gone\"]\n";
    let text = text.to_owned() + "[[contact]]\nname = \"other\"\n[time]\n[output]\n";
    let excerpt = Excerpt {
        bodies: vec!["body".into()],
        contacts: [(0, Some("one".into()))].into(),
        ..Excerpt::default()
    };
    let sets = ["body.body.mesh.size=2".to_owned(), "contact.contact.self=true".to_owned()];
    let case: DocumentMut = excerpt.of(&text, &sets).unwrap().parse().unwrap();
    assert_eq!(case["body"][0]["mesh"]["size"].as_integer(), Some(2));
    let contacts = case["contact"].as_array_of_tables().unwrap();
    let contact = contacts.get(0).unwrap();
    assert_eq!((contacts.len(), contact["self"].as_bool()), (1, Some(true)));
    assert_eq!(contact["name"].as_str(), Some("one"));
    assert_eq!(contact["between"].as_array().map(toml_edit::Array::len), Some(1));
}

/// A tie goes with either of its bodies, and the surface of an obstacle lies beside the case.
#[test]
fn ties_and_surfaces_of_an_excerpt() {
    let text = "[[body]]\nname = \"a\"\n[[body]]\nname = \"b\"\n\
        [[tie]]\nsecondary = \"a.top\"\nprimary = \"b.bottom\"\n\
        [[contact]]\nname = \"gone\"\n[[contact]]\nname = \"press\"\nsecondary = \"a.top\"\n\
        primary = { surface = { file = \"far/away.stl\", scale = 2.0 } }\n[time]\n[output]\n";
    let excerpt = |bodies: &[&str]| Excerpt {
        bodies: bodies.iter().map(|&body| body.to_owned()).collect(),
        contacts: [(1, None)].into(),
        surfaces: [(1, "surface-1.stl".to_owned())].into(),
        ..Excerpt::default()
    };
    for (bodies, ties) in [(&["a", "b"][..], true), (&["a"], false)] {
        let case: DocumentMut = excerpt(bodies).of(text, &[]).unwrap().parse().unwrap();
        assert_eq!(case.get("tie").is_some(), ties);
        let surface = &case["contact"][0]["primary"]["surface"];
        assert_eq!(surface["file"].as_str(), Some("surface-1.stl"));
        assert_eq!(surface["scale"].as_float(), Some(2.0));
    }
}

/// The file of an extrusion is that of its plane mesh.
#[test]
fn the_file_of_an_extrusion_is_beside_the_case() {
    let text = "[[body]]\nname = \"a\"\n[body.mesh]\nshape = \"extrusion\"\nheight = 1.0\nlayers = 1\n\
        of = { file = \"far/away.msh\", surface = \"profile\" }\n[time]\n[output]\n";
    let excerpt = Excerpt {
        bodies: vec!["a".into()],
        meshes: [("a".to_owned(), "a.msh".to_owned())].into(),
        ..Excerpt::default()
    };
    let case: DocumentMut = excerpt.of(text, &[]).unwrap().parse().unwrap();
    let mesh = &case["body"][0]["mesh"];
    assert_eq!((mesh["of"]["file"].as_str(), mesh.get("file").is_none()), (Some("a.msh"), true));
}

/// A number that does not change remains as it is written, in the file or in an override.
#[test]
fn numbers_remain_as_they_are_written() {
    let text = "[[body]]\nname = \"a\"\n[time]\nend = 1.95e-3\nstep = 1e-4\n[output]\n";
    let reduced = |end: f64| {
        let excerpt = Excerpt { bodies: vec!["a".into()], end, ..Excerpt::default() };
        excerpt.of(text, &["time.step=5e-5".to_owned()]).unwrap()
    };
    let whole = reduced(0.00195);
    assert!(whole.contains("\nend = 1.95e-3\n") && whole.contains("\nstep = 5e-5\n"), "{whole}");
    assert!(reduced(0.0019).contains("\nend = 0.0019\n"));
}
