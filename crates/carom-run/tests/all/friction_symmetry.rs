//! Friction in planes of symmetry: half and quarter models rub like whole ones, and the nodes that
//! supports hold on both sides have none.

use carom_contact::{FrictionState, Pair};
use carom_run::Simulation;

use super::common::{finish, simulation};

const PUNCH: &str = r#"
dimension = 2
material = [
  { name = "soft", law = "neo-hookean", density = 1.0, young = 100.0, poisson = 0.45 },
  { name = "stiff", law = "neo-hookean", density = 1.0, young = 400.0, poisson = 0.2 },
]
contact = [{ name = "c", secondary = "up.bottom", primary = "pad.top", mu = 0.2 }]
support = [
  { name = "ground", on = ["pad.bottom"], fix = ["x", "y"] },
  { name = "head", on = ["up.top"], move = { y = "-0.04*t" } },
]
time = { end = 1.0, step = 1.0, scheme = { kind = "static" } }
[[body]]
name = "up"
material = "soft"
element = "Q4"
mesh = { shape = "rectangle", min = [-0.6, 0.0], max = [0.6, 0.5], cells = [6, 3] }
[[body]]
name = "pad"
material = "stiff"
element = "Q4"
mesh = { shape = "rectangle", min = [-1.0, -0.5], max = [1.0, 0.0], cells = [10, 2] }
"#;

/// Half of a symmetric model has half of its friction: none at the node in the plane of symmetry,
/// which both sides' supports hold.
#[test]
fn a_node_in_a_plane_of_symmetry_has_no_friction() {
    let whole = finish(simulation(PUNCH, &[""; 0]));
    let sets = [
        "body.up.mesh={ shape = \"rectangle\", min = [0.0, 0.0], max = [0.6, 0.5], cells = [3, 3] }",
        "body.pad.mesh={ shape = \"rectangle\", min = [0.0, -0.5], max = [1.0, 0.0], cells = [5, 2] }",
        "support=[{ on = [\"pad.bottom\"], fix = [\"x\", \"y\"] }, { on = [\"up.top\"], move = { y = \"-0.04*t\" } }, { on = [\"up.left\", \"pad.left\"], fix = [\"x\"] }]",
    ];
    for enforcement in ["multiplier", "augmented"] {
        let enforcement = format!("contact.c.enforcement={enforcement}");
        let half = finish(simulation(PUNCH, &[&sets[..], &[enforcement.as_str()]].concat()));
        let rubs = |sim: &Simulation| -> f64 {
            let pairs = sim.state().pairs[0].iter().filter(|pair| pair.active);
            pairs.map(|pair| pair.tangential.traction[0].abs()).sum()
        };
        assert!((2.0 * rubs(&half) / rubs(&whole) - 1.0).abs() < 1e-6, "{} {}", rubs(&half), rubs(&whole));
        let force = [&half, &whole].map(|sim| sim.state().contact_forces[0][1]);
        assert!((2.0 * force[0] / force[1] - 1.0).abs() < 1e-6, "{force:?}");
        let first = &half.state().pairs[0][0];
        assert!(first.active && first.tangential.friction_state == FrictionState::Stick);
        assert!(first.tangential.traction[0].abs() < 1e-9, "{:?}", first.tangential);
    }
}

/// Nor has a node in that plane whose depth mortar contact bounds, although the facet below it
/// leans.
#[test]
fn a_node_in_a_plane_of_symmetry_has_no_friction_with_mortar_contact() {
    let case = |disc: &str, plate: &str, symmetry: &str| {
        format!(
            r#"
            dimension = 2
            contact = [{{ name = "c", secondary = "disc.arc", primary = "plate.top", mu = 0.3, method = "mortar" }}]
            support = [{{ on = ["plate.bottom"], fix = ["x", "y"] }}{symmetry}]
            time = {{ end = 0.003, step = 1e-4, scheme = {{ kind = "chung-hulbert", rho_inf = 0.6 }} }}
            [[material]]
            name = "steel"
            law = "hencky"
            density = 7.85e-6
            young = 210.0
            poisson = 0.3
            plastic = {{ yield = 0.4, hardening = 1.0 }}
            [[material]]
            name = "aluminium"
            law = "neo-hookean"
            density = 2.7e-6
            young = 70.0
            poisson = 0.33
            [[body]]
            name = "disc"
            material = "steel"
            element = "T6"
            mesh = {{ shape = "{disc}", radius = 5.0, center = [0.0, 5.01], size = 0.8 }}
            velocity = [0.0, -20.0]
            [[body]]
            name = "plate"
            material = "aluminium"
            element = "T6"
            mesh = {{ shape = "rectangle", {plate} }}
            "#
        )
    };
    let symmetry = ", { on = [\"disc.axis\", \"plate.left\"], fix = [\"x\"] }";
    let plate = "min = [0.0, -4.0], max = [10.0, 0.0], cells = [20, 8]";
    let half = finish(simulation(&case("half-disc", plate, symmetry), &[""; 0]));
    let lowest = half.state().pairs[0].iter().filter(|pair| {
        let node = half.model().contacts[0].kinematics.secondary()[pair.node];
        pair.active && half.model().reference[2 * node].abs() < 1e-9
    });
    let mut found = 0;
    for pair in lowest {
        assert!(pair.tangential.traction[0].abs() < 1e-12, "{pair:?}");
        found += 1;
    }
    assert!(found > 0);
    let plate = "min = [-10.0, -4.0], max = [10.0, 0.0], cells = [40, 8]";
    let whole = finish(simulation(&case("disc", plate, ""), &[""; 0]));
    // So far, only the lowest node touches.
    let lost = [&half, &whole].map(|sim| sim.state().ledger.friction_work);
    assert!(lost.iter().all(|lost| lost.abs() < 1e-15), "{lost:?}");
}

/// A state is accepted with its pairs on their facets: none on the extension of one that the node
/// has left, beside its pair with the next. The symmetric punch then does not move sideways.
#[test]
fn pairs_lie_on_their_facets() {
    let sets = ["contact.c.secondary=pad.top", "contact.c.primary=up.bottom"];
    let swapped = finish(simulation(PUNCH, &sets));
    let force = swapped.state().contact_forces[0];
    let of_pair = |pair: &Pair| assert!(!pair.active || pair.xi.abs() < 1.2, "{pair:?}");
    swapped.state().pairs[0].iter().for_each(of_pair);
    assert!(force[0].abs() < 1e-3 * force[1].abs(), "{force:?}");
}

/// The quarter of a block that strikes a rough pad beside the whole: the node on both planes has no
/// friction, those on one have it along the plane.
#[test]
fn a_quarter_in_space_rubs_like_the_whole() {
    let case = |low: [f64; 2], cells: [usize; 2], symmetry: &str| {
        let [up, pad] = low;
        let [of_up, of_pad] = cells;
        format!(
            r#"
            dimension = 3
            material = [{{ name = "m", law = "neo-hookean", density = 1.5, young = 200.0, poisson = 0.35 }}]
            contact = [{{ name = "c", secondary = "up.bottom", primary = "pad.top", mu = 0.3 }}]
            support = [{{ name = "ground", on = ["pad.bottom"], fix = ["x", "y", "z"] }}{symmetry}]
            time = {{ end = 0.1, step = 0.005, scheme = {{ kind = "chung-hulbert", rho_inf = 0.5 }} }}
            [[body]]
            name = "up"
            material = "m"
            element = "Hex8"
            mesh = {{ shape = "box", min = [{up}, {up}, 0.0], max = [0.6, 0.6, 0.4], cells = [{of_up}, {of_up}, 2] }}
            velocity = [0.0, 0.0, -1.0]
            [[body]]
            name = "pad"
            material = "m"
            element = "Hex8"
            mesh = {{ shape = "box", min = [{pad}, {pad}, -0.52], max = [0.9, 0.9, -0.02], cells = [{of_pad}, {of_pad}, 2] }}
            "#
        )
    };
    let symmetry = ", { on = [\"up.left\", \"pad.left\"], fix = [\"x\"] }, { on = [\"up.front\", \"pad.front\"], fix = [\"y\"] }";
    let quarter = finish(simulation(&case([0.0, 0.0], [3, 4], symmetry), &[""; 0]));
    let whole = finish(simulation(&case([-0.6, -0.9], [6, 8], ""), &[""; 0]));
    let of = |sim: &Simulation| [sim.state().contact_forces[0][2], sim.state().ledger.friction_work];
    for (part, all) in of(&quarter).into_iter().zip(of(&whole)) {
        assert!((4.0 * part / all - 1.0).abs() < 1e-6, "{part} {all}");
    }
    let corner = quarter.state().pairs[0].iter().find(|pair| pair.node == 0).unwrap();
    assert!(corner.active && corner.tangential.traction == [0.0; 2], "{corner:?}");
}

/// A node in a plane of symmetry has no friction either where an obstacle moves along that plane.
#[test]
fn half_a_block_below_a_moving_circle_is_half_of_the_whole() {
    let case = r#"
dimension = 2
plane = "strain"
material = [{ name = "m", law = "hencky", density = 1.0, young = 400.0, poisson = 0.3 }]
support = [{ on = ["block.bottom"], fix = ["x", "y"] }, { on = ["block.left"], fix = ["x"] }]
time = { end = 1.0, step = 0.1, scheme = { kind = "static" } }
[[body]]
name = "block"
material = "m"
element = "Q4"
mesh = { shape = "rectangle", min = [0.0, -1.0], max = [2.0, 0.0], cells = [8, 4] }
[[contact]]
name = "c"
secondary = "block.top"
primary = { circle = { center = [0.0, 1.0], radius = 1.0 }, motion = { y = "-0.2*t" } }
method = "mortar"
mu = 0.3
"#;
    let half = finish(simulation(case, &[""; 0]));
    let whole = finish(simulation(
        case,
        &[
            "body.block.mesh={ shape = \"rectangle\", min = [-2.0, -1.0], max = [2.0, 0.0], cells = [16, 4] }",
            "support=[{ on = [\"block.bottom\"], fix = [\"x\", \"y\"] }]",
        ],
    ));
    let force = [&half, &whole].map(|run| run.state().contact_forces[0][1]);
    assert!((2.0 * force[0] / force[1] - 1.0).abs() < 1e-6, "{force:?}");
}
