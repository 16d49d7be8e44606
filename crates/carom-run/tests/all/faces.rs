//! Two blocks of one size that meet face to face: their corners and edges meet too, and each is
//! past the end of the other side, over it, or past it again as the blocks bulge. With ν = 0 the
//! impact is that of two bars, which exchange their velocities: J = m Δv, less what neo-Hooke's law
//! and the coarse mesh leave in vibration.

use carom_run::GridReport;

use super::common::simulation;

fn blocks(element: &str, scheme: &str, mass: &str, step: f64) -> String {
    let dimension = match element.as_bytes()[0] {
        b'L' => 1,
        _ if element.starts_with("Tet") || element.starts_with("Hex") => 3,
        _ => 2,
    };
    let vector = |values: [f64; 3]| format!("{:?}", &values[..dimension]);
    let point = |x: f64, y: f64| if dimension == 1 { format!("{x:?}") } else { vector([x, y, y]) };
    let (shape, cells) = [("interval", "8"), ("rectangle", "[8, 3]"), ("box", "[4, 2, 2]")][dimension - 1];
    // Cells with nodes at the middles of their edges have as many along the block.
    let cells = if matches!(element, "Tet10" | "Hex27") { "[2, 1, 1]" } else { cells };
    let body = |name: &str, x: f64, speed: f64| {
        format!(
            r#"
[[body]]
name = "{name}"
material = "m"
element = "{element}"
mesh = {{ shape = "{shape}", min = {}, max = {}, cells = {cells} }}
velocity = {}
mass = "{mass}"
"#,
            point(x, 0.0),
            point(x + 1.0, 0.4),
            vector([speed, 0.0, 0.0]),
        )
    };
    let (one, two) = (body("one", -1.0, 1.0), body("two", 0.01, -0.5));
    format!(
        r#"
dimension = {dimension}
material = [{{ name = "m", law = "neo-hookean", density = 1.0, young = 100.0, poisson = 0.0 }}]
{one}{two}
[[contact]]
name = "faces"
secondary = "one.right"
primary = "two.left"
[time]
end = 0.3
step = {step}
scheme = {scheme}
"#
    )
}

/// Schemes of every family, with the mass and the step that they need.
const SCHEMES: [(&str, &str, f64); 6] = [
    (r#"{ kind = "chung-hulbert", rho_inf = 0.5 }"#, "consistent", 2e-3),
    (r#"{ kind = "hht", alpha = 0.1 }"#, "lumped", 2e-3),
    (r#"{ kind = "bathe", rho_inf = 0.0 }"#, "consistent", 4e-3),
    (r#"{ kind = "energy-momentum" }"#, "consistent", 2e-3),
    (r#"{ kind = "central-difference" }"#, "lumped", 1e-3),
    (r#"{ kind = "moreau-jean", theta = 0.5 }"#, "consistent", 2e-3),
];

/// The impulse of the contact between these sides.
fn exchange(element: &str, (scheme, mass, step): (&str, &str, f64), sides: &[&str]) -> f64 {
    let fine = matches!(element, "L4" | "T10" | "Q9" | "Hex27") && scheme.contains("central");
    let step = if fine { 0.5 * step } else { step };
    let mut sim = simulation(&blocks(element, scheme, mass, step), sides);
    let mut report = GridReport::default();
    while !sim.finished() {
        sim.advance(&mut report).unwrap_or_else(|e| panic!("{element}, {scheme}: {e}"));
    }
    let mass = [1.0, 0.4, 0.16][sim.model().dimension - 1];
    let impulse = -sim.state().impulses[0][0] / (1.5 * mass);
    assert!((0.9..1.0).contains(&impulse), "{element}, {scheme}: J = {impulse} m Δv");
    let (model, state) = (sim.model(), sim.state());
    let mut momentum = vec![0.0; state.v.len()];
    model.mass.multiply_into(&state.v, &mut momentum);
    let along: f64 = momentum.iter().step_by(model.dimension).sum();
    assert!((along - 0.5 * mass).abs() < 1e-12, "{element}, {scheme}: {along:e}");
    impulse
}

/// Whole boundaries, of which the faces beside those that meet are flush, and as near.
const SKINS: [&str; 2] = ["contact.faces.secondary=one.skin", "contact.faces.primary=two.skin"];

fn exchange_in_every_scheme(elements: &[&str]) {
    for element in elements {
        for scheme in SCHEMES {
            exchange(element, scheme, &[]);
        }
    }
}

/// One element after the other in every other scheme, beginning with the next one.
fn exchange_in_turn(elements: &[&str]) {
    for (k, element) in elements.iter().enumerate() {
        for scheme in SCHEMES.into_iter().skip(k % 2).step_by(2) {
            exchange(element, scheme, &[]);
        }
    }
}

fn exchange_between_skins(elements: &[&str], schemes: &[usize]) {
    for element in elements {
        for scheme in schemes.iter().map(|&k| SCHEMES[k]) {
            let [named, whole] = [&[][..], &SKINS].map(|sides| exchange(element, scheme, sides));
            assert!((whole / named - 1.0).abs() < 1e-9, "{element}, {}: {named} {whole}", scheme.0);
        }
    }
}

const PLANE: [&str; 8] = ["L2", "L3", "L4", "T3", "T6", "T10", "Q4", "Q9"];

#[test]
fn flush_boundaries_exchange_them_like_the_sides_that_meet() {
    exchange_between_skins(&["T6", "Q4"], &[0, 4]);
    exchange_between_skins(&["Tet4", "Hex8"], &[0]);
}

#[test]
#[ignore = "other elements and schemes: .ci/nightly"]
fn other_flush_boundaries_exchange_them_like_the_sides_that_meet() {
    exchange_between_skins(&["T3", "Q9"], &[0, 4]);
    exchange_between_skins(&["Tet4", "Hex8"], &[4]);
    // Of the elements that take longest one scheme is enough.
    exchange_between_skins(&["Tet10", "Hex27"], &[0]);
}

#[test]
fn bars_and_plane_blocks_exchange_their_velocities() {
    exchange_in_turn(&PLANE);
}

#[test]
fn solid_blocks_exchange_their_velocities() {
    exchange_in_turn(&["Tet4", "Hex8"]);
}

#[test]
#[ignore = "every element in every scheme: .ci/nightly"]
fn blocks_exchange_their_velocities_in_every_scheme() {
    exchange_in_every_scheme(&PLANE);
    exchange_in_every_scheme(&["Tet4", "Hex8"]);
}

#[test]
fn curved_solids_exchange_their_velocities() {
    exchange("Tet10", SCHEMES[2], &[]);
    exchange("Hex27", SCHEMES[3], &[]);
}

#[test]
#[ignore = "each in the scheme of the other: .ci/nightly"]
fn curved_solids_exchange_their_velocities_in_other_schemes() {
    exchange("Tet10", SCHEMES[3], &[]);
    exchange("Hex27", SCHEMES[2], &[]);
}
