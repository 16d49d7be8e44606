//! Bodies of several materials in one mesh.

use carom_run::model::LoadsAt;
use carom_run::{GridReport, Setup};

use super::common;

const MESH: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../cases/materials/bar.msh");

/// The strip of `cases/materials/bar.geo`, pressed at its left end, with the given keys of the body
/// and the scheme.
fn strip(body: &str, scheme: &str, rest: &str) -> String {
    format!(
        r#"
dimension = 2

[[material]]
name = "one"
law = "neo-hookean"
density = 1.0
lambda = 0.4
mu = 0.3

[[material]]
name = "other"
law = "neo-hookean"
density = 1.0
lambda = 0.4
mu = 0.3

[[body]]
name = "bar"
element = "Q4"
mesh = {{ file = "{MESH}" }}
{body}

[[load]]
on = ["bar.left"]
pressure = "0.02*sin(10*t)"

[time]
end = 0.1
step = 0.005
scheme = {scheme}
{rest}"#
    )
}

/// Positions after every step.
fn positions(text: &str) -> Vec<Vec<f64>> {
    let mut simulation = common::simulation(text, &[""; 0]);
    let mut found = Vec::new();
    while !simulation.finished() {
        simulation.advance(&mut GridReport::default()).unwrap();
        found.push(simulation.state().y.clone());
    }
    found
}

/// A mesh that is divided into groups has the bits of one that is not, whether the groups name one
/// material or two that are equal.
#[test]
fn groups_of_equal_materials_are_no_difference() {
    let mean = "\nvolumetric = \"mean\"";
    for (scheme, more) in [
        (r#"{ kind = "chung-hulbert", rho_inf = 0.8 }"#, ""),
        (r#"{ kind = "chung-hulbert", rho_inf = 0.8 }"#, mean),
        (r#"{ kind = "energy-momentum" }"#, ""),
        (r#"{ kind = "central-difference" }"#, "\nmass = \"lumped\""),
    ] {
        let of = |materials: &str| positions(&strip(&format!("{materials}{more}"), scheme, ""));
        let same = of("materials = { first = \"one\", second = \"one\" }");
        let equal = of("materials = { first = \"one\", second = \"other\" }");
        assert!(same == equal, "{scheme}{more}");
    }
}

/// Groups are the same body as the group of all their cells.
#[test]
fn the_groups_of_a_body_are_its_cells() {
    let text = |mesh: &str, materials: &str| {
        let scheme = r#"{ kind = "newmark", beta = 0.25, gamma = 0.5 }"#;
        let file = concat!(env!("CARGO_MANIFEST_DIR"), "/../../cases/materials/laminate.msh");
        let old = format!("file = \"{MESH}\"");
        let text = strip(materials, scheme, "").replace(&old, &format!("file = \"{file}\"{mesh}"));
        text.replace("Q4", "T3")
    };
    let whole = positions(&text(", surface = \"laminate\"", "material = \"one\""));
    let named =
        positions(&text(", surface = \"laminate\"", "materials = { stiff = \"one\", soft = \"other\" }"));
    let united = positions(&text("", "materials = { stiff = \"one\", soft = \"other\" }"));
    assert!(whole == named && whole == united);
}

/// What is wrong with the set-up of a case.
fn problem(text: &str) -> String {
    let case = common::case(text, &[""; 0]);
    Setup::new(&case).build().err().map_or_else(String::new, |problems| format!("{problems:?}"))
}

#[test]
fn a_stress_where_materials_meet_needs_a_side() {
    let probe = |at: &str, more: &str| {
        let probe = format!(
            "\n[[probe]]\nname = \"A\"\nbody = \"bar\"\nat = {at}\nrecord = [\"ux\", \"sigma_xx\"]\n{more}"
        );
        problem(&strip(
            "materials = { first = \"one\", second = \"other\" }",
            r#"{ kind = "backward-euler" }"#,
            &probe,
        ))
    };
    let none = probe("[1.0, 0.05]", "");
    assert!(none.contains("lies where materials meet") && none.contains("material = "), "{none}");
    assert_eq!(probe("[1.0, 0.05]", "material = \"other\""), "");
    assert_eq!(probe("[0.5, 0.05]", ""), "");
    let far = probe("[0.5, 0.05]", "material = \"other\"");
    assert!(
        far.contains("does not lie in its material") && far.contains("belongs to one, not to other"),
        "{far}"
    );
}

/// A force in one material is the force in its cells.
#[test]
fn a_body_force_of_a_material_acts_in_its_cells() {
    let load = "\n[[load]]\nbody = \"bar\"\nmaterial = \"other\"\nbody_force = [\"2\", \"0\"]\n";
    let text =
        strip("materials = { first = \"one\", second = \"other\" }", r#"{ kind = "backward-euler" }"#, load);
    let simulation = common::simulation(&text, &[""; 0]);
    let model = simulation.model();
    let mut at = LoadsAt::default();
    let mut force = vec![0.0; model.dofs()];
    model.loads_into(0.0, &model.reference, &mut at, &mut force).unwrap();
    let along: f64 = force.iter().step_by(2).sum();
    // 2 in an area of 2 × 0.1.
    assert!((along - 0.4).abs() < 1e-12, "{along}");
}
