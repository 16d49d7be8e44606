//! Rings, polygons with refined places, and bodies that are put somewhere.

use super::super::*;
use super::{BARS, IMPACT, resolved};

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
        let written = serde_json::to_string(&case).unwrap();
        assert_eq!(serde_json::from_str::<Case>(&written).unwrap(), case);
        // The estimate made before the mesh is good to a factor of three: places refined at a
        // corner have fewer cells.
        let mesh = case.bodies[1].make_mesh(2).unwrap();
        let (cells, nodes) = case.bodies[1].mesh.estimate(mesh.element);
        for (guess, made) in [(cells, mesh.cell_count()), (nodes, mesh.nodes.len())] {
            assert!((0.5..3.0).contains(&(guess / made as f64)), "{guess} for {made}");
        }
    }
}

#[test]
fn bodies_are_put_somewhere() {
    let case = resolved(IMPACT, &["body.cylinder.place={ rotate = 30, shift = [0.0, 1.0] }"]).unwrap();
    let place = case.bodies[0].place.clone().unwrap();
    assert_eq!(place, PlaceSpec { rotate: 30.0, about: vec![0.0; 2], shift: vec![0.0, 1.0] });
    let bar = resolved(BARS, &["body.left.place={ shift = [-0.5] }"]).unwrap();
    assert_eq!(bar.bodies[0].place.as_ref().unwrap().shift, [-0.5]);
    let told = resolved(BARS, &["body.left.place={ rotate = 30 }"]).unwrap_err();
    assert!(told[0].what.contains("cannot be turned"), "{}", told[0]);
}

#[test]
fn nearly_incompressible_t3_are_warned_of() {
    let warned = |sets: &[&str]| resolved(IMPACT, sets).unwrap().warnings();
    let soft = "material.rubber.lambda=100.0";
    assert!(warned(&[]).is_empty());
    assert!(warned(&["body.prism.element=T3", soft]).is_empty());
    let told = warned(&["body.prism.element=T3"]);
    assert!(told.len() == 1 && told[0].contains("\"prism\"") && told[0].contains("0.4651"), "{told:?}");
    assert!(warned(&["body.prism.element=T3", "plane=stress"]).is_empty());
}

#[test]
fn plane_stress_is_of_dimension_two() {
    assert_eq!(resolved(IMPACT, &["plane=stress"]).unwrap().plane, Plane::Stress);
    assert!(resolved(BARS, &["plane=stress"]).unwrap_err()[0].what.contains("needs dimension = 2"));
}
