//! Rings, polygons with local refinement, and placed bodies.

use super::{BARS, IMPACT, resolved, stored};
use carom_case::*;

const POLYGON: &str = "body.prism.mesh={ shape = \"polygon\", points = [[0, 0], [0, -1], [1, -0.5]], size = 0.2, refine = [{ near = [0, 0], size = 0.05 }] }";

#[test]
fn shapes_are_resolved_and_survive_json() {
    let ring =
        "body.prism.mesh={ shape = \"ring\", inner = 0.4, outer = 0.5, center = [0, -0.5], size = 0.1 }";
    for (mesh, sides) in [(ring, &["inner", "outer"][..]), (POLYGON, &["side1", "side2", "side3"])] {
        let sides_named = format!("support=[{{ on = [\"prism.{}\"], fix = [\"x\"] }}]", sides[1]);
        let primary = format!("contact.strike.primary=prism.{}", sides[0]);
        let probes = "probe=[{ name = \"A\", at = [0.0, 1.5], body = \"cylinder\", record = [\"uy\"] }]";
        let case = resolved(
            IMPACT,
            &[mesh, &sides_named, &primary, probes, "expect=[{ what = \"last A.uy\", at_most = 1 }]"],
        );
        let case = case.unwrap_or_else(|p| panic!("{}", p[0]));
        assert_eq!(case.bodies[1].mesh.sides(), sides);
        assert_eq!(stored(&case), case);
        // The estimate is good to a factor of three: a region refined at a corner has fewer cells.
        let mesh = case.bodies[1].make_mesh(2).unwrap();
        let (cells, nodes) = case.bodies[1].mesh.estimate(mesh.element);
        for (estimate, actual) in [(cells, mesh.cell_count()), (nodes, mesh.nodes.len())] {
            assert!((0.5..3.0).contains(&(estimate / actual as f64)), "{estimate} for {actual}");
        }
    }
}

#[test]
fn bodies_are_placed() {
    let case = resolved(IMPACT, &["body.cylinder.place={ rotate = 30, shift = [0.0, 1.0] }"]).unwrap();
    let place = case.bodies[0].place.clone().unwrap();
    assert_eq!(
        place,
        PlaceSpec { rotate: 30.0, axis: Vec::new(), about: vec![0.0; 2], shift: vec![0.0, 1.0] }
    );
    let bar = resolved(BARS, &["body.left.place={ shift = [-0.5] }"]).unwrap();
    assert_eq!(bar.bodies[0].place.as_ref().unwrap().shift, [-0.5]);
    let problems = resolved(BARS, &["body.left.place={ rotate = 30 }"]).unwrap_err();
    assert!(problems[0].what.contains("cannot be rotated"), "{}", problems[0]);
}

#[test]
fn plane_stress_needs_dimension_two() {
    assert_eq!(resolved(IMPACT, &["plane=stress"]).unwrap().plane, Plane::Stress);
    assert!(resolved(BARS, &["plane=stress"]).unwrap_err()[0].what.contains("needs dimension = 2"));
}

const SOLID: &str = r#"
dimension = 3
material = [{ name = "steel", law = "linear-elastic", density = 7850.0, young = 2.1e11, poisson = 0.3 }]
time = { end = 1e-3, step = 1e-5, scheme = { kind = "newmark", rho_inf = 1 } }

[[body]]
name = "part"
material = "steel"
element = "Tet10"
mesh = { shape = "ball", radius = 1.0, center = [0, 0, 0], size = 0.5 }
"#;

/// The sides that a case names are those of the mesh, and the estimate is near its size.
#[test]
fn solids_are_resolved_and_survive_json() {
    let tube = "shape = \"tube\", inner = 0.5, outer = 1, height = 2, center = [0, 0, 0], size = 0.25";
    for (mesh, sides) in [
        ("shape = \"ball\", radius = 1, center = [0, 0, 1], size = 0.3".to_owned(), &["sphere"][..]),
        (
            "shape = \"cylinder\", radius = 1, height = 1, center = [0, 0, 1], axis = [1, 1, 0], size = 0.3"
                .to_owned(),
            &["bottom", "side", "top"],
        ),
        (
            format!("{tube}, axis = \"y\", symmetry = [\"x\"]"),
            &["bottom", "inner", "outer", "plane_x", "top"],
        ),
        (format!("{tube}, symmetry = [\"z\"]"), &["inner", "outer", "plane_z", "top"]),
        (
            "shape = \"box\", min = [0, 0, 0], max = [2, 1, 1], size = 0.2, symmetry = [\"x\", \"z\"]"
                .to_owned(),
            &["back", "front", "plane_x", "plane_z", "right", "top"],
        ),
    ] {
        for element in ["Tet4", "Tet20", "Hex27"] {
            let sets = [format!("body.part.mesh={{ {mesh} }}"), format!("body.part.element={element}")];
            let case = resolved(SOLID, &[&sets[0], &sets[1]]).unwrap_or_else(|p| panic!("{}", p[0]));
            let body = &case.bodies[0];
            let mut named = body.mesh.sides();
            named.sort();
            assert_eq!(named, sides);
            let mesh = body.make_mesh(3).unwrap();
            assert_eq!(mesh.sides.into_keys().collect::<Vec<_>>(), sides);
            let (cells, nodes) = body.mesh.estimate(mesh.element);
            assert_eq!(cells, mesh.cells.len() as f64 / mesh.element.nodes() as f64);
            let ratio = nodes / mesh.nodes.len() as f64;
            assert!((0.5..2.0).contains(&ratio), "{element} {named:?}: {ratio}");
            assert_eq!(stored(&case), case);
        }
    }
    let oblique = format!("body.part.mesh={{ {tube}, axis = [1, 1, 0], symmetry = [\"z\"] }}");
    let problems = resolved(SOLID, &[&oblique]).unwrap_err();
    assert!(problems[0].to_string().contains("axis = \"z\""), "{}", problems[0]);
}

#[test]
fn extrusions_are_resolved_and_survive_json() {
    let rectangle = "shape = \"rectangle\", min = [0, 0], max = [2, 1], cells = [4, 2]";
    let ring = "shape = \"ring\", inner = 0.5, outer = 1, center = [0, 0], size = 0.25";
    for (of, element, sides) in [
        (rectangle, "Hex8", &["base", "bottom", "left", "lid", "right", "top"][..]),
        (rectangle, "Tet10", &["base", "bottom", "left", "lid", "right", "top"]),
        (ring, "Tet20", &["bottom", "inner", "outer", "top"]),
    ] {
        let mesh =
            format!("body.part.mesh={{ shape = \"extrusion\", of = {{ {of} }}, height = 0.4, layers = 2 }}");
        let element = format!("body.part.element={element}");
        let case = resolved(SOLID, &[&mesh, &element]).unwrap_or_else(|p| panic!("{}", p[0]));
        let body = &case.bodies[0];
        let mut named = body.mesh.sides();
        named.sort();
        assert_eq!(named, sides);
        let made = body.make_mesh(3).unwrap();
        assert_eq!(made.sides.keys().collect::<Vec<_>>(), sides);
        let (cells, nodes) = body.mesh.estimate(made.element);
        for (estimate, actual) in [(cells, made.cell_count()), (nodes, made.nodes.len())] {
            assert!((0.5..3.0).contains(&(estimate / actual as f64)), "{estimate} for {actual}");
        }
        assert_eq!(stored(&case), case);
    }
    let of =
        |of: &str| format!("body.part.mesh={{ shape = \"extrusion\", of = {of}, height = 1, layers = 3 }}");
    let flat = of("{ shape = \"disc\", radius = 1, center = [0, 0], size = 0.5 }");
    for (sets, text) in [
        (&[&flat[..], "body.part.element=Hex8"][..], "does not fill the extrusion of a \"disc\""),
        (&[&of("{ shape = \"ball\" }")], "`shape` cannot be \"ball\""),
        (&[&of("{ shape = \"disc\", radius = 1, center = [0, 0, 0], size = 0.5 }")], "a list of 2 numbers"),
        (&[&flat, "refine=1.5"], "body[0].mesh.layers = [3] into [4.5]"),
    ] {
        let problems = resolved(SOLID, sets).unwrap_err();
        assert!(problems[0].to_string().contains(text), "{}", problems[0]);
    }
    assert!(resolved(IMPACT, &[&flat.replace("part", "prism")]).is_err());
}

#[test]
fn mean_dilatation_is_for_cells_that_it_helps() {
    let mean = "body.part.volumetric=mean";
    let case = resolved(SOLID, &[mean, "body.part.element=Hex8"]).unwrap_or_else(|p| panic!("{}", p[0]));
    assert_eq!(case.bodies[0].volumetric, Volumetric::Mean);
    for (element, text) in [("Tet4", "changes nothing for Tet4"), ("Tet10", "has no volumetric = \"mean\"")] {
        let problems = resolved(SOLID, &[mean, &format!("body.part.element={element}")]).unwrap_err();
        assert!(problems[0].to_string().contains(text), "{}", problems[0]);
    }
    let sets = ["body.prism.volumetric=mean", "body.prism.element=Q4", "plane=stress"];
    let problems = resolved(IMPACT, &sets).unwrap_err();
    assert!(problems[0].what.contains("no use in plane stress"), "{}", problems[0]);
}

#[test]
fn moments_need_a_name_and_an_arm() {
    let support = |rest: &str| format!("support=[{{ on = [\"part.sphere\"], fix = [\"x\"]{rest} }}]");
    let named = support(", name = \"wall\", moment_about = [0, 0, 1]");
    let case = resolved(SOLID, &[&named]).unwrap_or_else(|p| panic!("{}", p[0]));
    assert_eq!(case.supports[0].moment_about.as_deref(), Some(&[0.0, 0.0, 1.0][..]));
    let problems = resolved(SOLID, &[&support(", moment_about = [0, 0, 1]")]).unwrap_err();
    assert!(problems[0].why.contains("named support"), "{}", problems[0]);
}
