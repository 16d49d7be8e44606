//! Rings, polygons with local refinement, and placed bodies.

use super::{BARS, IMPACT, resolved};
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
        let written = serde_json::to_string(&case).unwrap();
        assert_eq!(serde_json::from_str::<Case>(&written).unwrap(), case);
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
    assert_eq!(place, PlaceSpec { rotate: 30.0, about: vec![0.0; 2], shift: vec![0.0, 1.0] });
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
