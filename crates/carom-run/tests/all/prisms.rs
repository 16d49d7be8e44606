//! Bars are prisms without lateral contraction: the impacts of the side-by-side table of schemes
//! (Doyen, Ern, Piperno 2011) and of two bars, with one hexahedron across in the place of L2 cells,
//! have the motions, forces and energies of the bars at every step.

use super::common::simulation;
use carom_run::{GridReport, Simulation};

const SINGLE: &str = include_str!("../../../../cases/bar/single.toml");
const BOUNCING: &str = include_str!("../../../../cases/bar/bouncing.toml");
const TWO: &str = include_str!("../../../../cases/bar/two-bars.toml");
const UNEQUAL: &str = include_str!("../../../../cases/bar/unequal-bars.toml");

/// Cells of a bar: a quarter of those of the cases, and steps of their Courant number.
const CELLS: usize = 25;
const STEP: &str = "time.step=0.013333333333333332";

/// Settings that make a prism of a body between two ends.
fn prism(body: &str, ends: [f64; 2], width: f64) -> [String; 2] {
    let [left, right] = ends;
    [
        format!("body.{body}.element=\"Hex8\""),
        format!(
            "body.{body}.mesh={{ shape = \"box\", min = [{left:?}, 0.0, 0.0], max = [{right:?}, {width:?}, {width:?}], cells = [{CELLS}, 1, 1] }}"
        ),
    ]
}

/// The largest differences of positions, forces and energies of a bar and of its prism, over the
/// length of a bar, the largest force and the largest energy, over all steps.
fn apart(text: &str, bar: &[&str], solid: &[String]) -> [f64; 3] {
    let coarse = ["bar", "left", "right"].into_iter().filter(|body| text.contains(&format!("\"{body}\"")));
    let coarse = coarse.map(|body| format!("body.{body}.mesh.cells={CELLS}"));
    let bar = [coarse.collect(), bar.iter().map(|set| (*set).to_owned()).collect::<Vec<_>>()].concat();
    let mut pair = [simulation(text, &bar), simulation(text, solid)];
    let (mut worst, mut largest) = ([0.0_f64; 3], [10.0, 0.0_f64, 0.0_f64]);
    // The node of the bar at each node of the prism, body by body: they touch.
    let mut spots = Vec::new();
    for (bar, solid) in pair[0].model().parts.iter().zip(&pair[1].model().parts) {
        let [line, space] = [0, 1].map(|k| &pair[k].model().reference);
        for node in solid.nodes() {
            let at = |k: &usize| (line[*k] - space[3 * node]).abs() < 1e-9;
            spots.push((bar.nodes().find(at).unwrap(), node));
        }
    }
    let of = |sim: &Simulation| {
        let ledger = &sim.state().ledger;
        [sim.state().contact_forces[0][0], ledger.strain, ledger.kinetic, ledger.total()]
    };
    while !pair[0].finished() {
        pair.iter_mut().for_each(|sim| {
            sim.advance(&mut GridReport::default()).unwrap();
        });
        let [bar, solid] = &pair;
        let (y, z) = (&bar.state().y, solid.state().y.as_chunks::<3>().0);
        for &(here, there) in &spots {
            worst[0] = worst[0].max((y[here] - z[there][0]).abs());
        }
        let (here, there) = (of(bar), of(solid));
        for (i, (a, b)) in here.iter().zip(there).enumerate() {
            let i = i.min(1) + 1;
            worst[i] = worst[i].max((a - b).abs());
            largest[i] = largest[i].max(a.abs());
        }
    }
    assert!(largest[1] > 0.0, "no contact");
    std::array::from_fn(|i| worst[i] / largest[i])
}

/// A bar on a wall, and its prism of section one, with the settings of a scheme.
fn on_wall(text: &str, scheme: &[&str], stiffness: f64) -> [f64; 3] {
    let wall = "contact.wall.primary={ plane = { point = [0.0, 0.0, 0.0], normal = [1.0, 0.0, 0.0] } }";
    let moves = if text == SINGLE { "velocity=[-10.0, 0.0, 0.0]" } else { "gravity=[-10.0, 0.0, 0.0]" };
    let mut solid = vec!["dimension=3".to_owned(), wall.to_owned(), format!("body.bar.{moves}")];
    solid.extend(prism("bar", [5.0, 15.0], 1.0));
    solid.push("probe.bottom.at=[5.0, 0.0, 0.0]".to_owned());
    solid.push("exact={}".to_owned());
    let scheme = [&[STEP], scheme].concat();
    let own = scheme.iter().map(|set| match set.split_once("stiffness=") {
        Some((key, value)) => {
            format!("{key}stiffness={:?}", value.parse::<f64>().unwrap() * stiffness)
        }
        None => (*set).to_owned(),
    });
    solid.extend(own);
    apart(text, &scheme, &solid)
}

/// The stiffness of springs is a multiple of the mean of the tangent's diagonal at a node: E/h of
/// the bar, and of each of four nodes of the hexahedron h × 1 × 1
///
///     [E/h + 2Gh + 2 (Eh + G/h + Gh)]/27,   G = E/2
fn stiffer() -> f64 {
    let (young, h) = (900.0_f64, 10.0 / CELLS as f64);
    let shear = 0.5 * young;
    let own = young / h + 2.0 * shear * h + 2.0 * (young * h + shear / h + shear * h);
    young / h / (4.0 * own / 27.0)
}

const EXPLICIT: [&str; 2] = ["body.bar.mass=lumped", "time.step=0.012"];

/// Not the trapezoidal rule without projection, which multiplies round-off.
#[test]
fn a_prism_on_a_wall_is_the_bar_in_every_scheme_of_the_table() {
    let rows: [&[&str]; 12] = [
        &["time.scheme={ kind = \"hu\" }"],
        &["time.scheme={ kind = \"chung-hulbert\", rho_inf = 0.6 }"],
        &["time.scheme={ kind = \"chung-hulbert\", rho_inf = 0.1 }"],
        &["time.scheme={ kind = \"hht\", alpha = 0.25 }"],
        &["time.scheme={ kind = \"bathe\", rho_inf = 0.0 }"],
        &["time.scheme={ kind = \"moreau-jean\", theta = 1.0 }"],
        &["time.scheme={ kind = \"moreau-jean\", theta = 0.5 }"],
        &["time.scheme={ kind = \"energy-momentum\" }", "contact.wall.law=\"predictor\""],
        &["time.scheme={ kind = \"nonsmooth-generalized-alpha\", rho_inf = 0.1 }"],
        &[
            "time.scheme={ kind = \"energy-momentum\" }",
            "contact.wall.enforcement=\"penalty\"",
            "contact.wall.stiffness=11.11111111111111",
        ],
        &["time.scheme={ kind = \"central-difference\" }", EXPLICIT[0], EXPLICIT[1], "time.end=1.992"],
        &["time.scheme={ kind = \"paoli-schatzman\" }", EXPLICIT[0], EXPLICIT[1], "time.end=1.992"],
    ];
    for row in rows {
        let apart = on_wall(SINGLE, row, stiffer());
        assert!(apart.iter().all(|apart| *apart < 1e-6), "{row:?}: {apart:?}");
    }
}

#[test]
fn a_prism_bounces_like_the_bar() {
    let rows: [&[&str]; 3] = [
        &["time.scheme={ kind = \"chung-hulbert\", rho_inf = 0.1 }", "time.end=4.8"],
        &["time.scheme={ kind = \"moreau-jean\", theta = 0.5 }", "time.end=4.8"],
        &["time.scheme={ kind = \"central-difference\" }", EXPLICIT[0], EXPLICIT[1], "time.end=4.8"],
    ];
    for row in rows {
        let apart = on_wall(BOUNCING, row, 1.0);
        assert!(apart.iter().all(|apart| *apart < 1e-6), "{row:?}: {apart:?}");
    }
}

#[test]
fn two_prisms_collide_like_bars() {
    let cases = [(TWO, 2.0, 10.0, [0.1, -0.1]), (UNEQUAL, 1.0, 20.0, [0.1, -0.1])];
    for (text, width, length, velocities) in cases {
        let mut solid = vec!["dimension=3".to_owned(), "probe.joint.at=[0.0, 0.0, 0.0]".to_owned()];
        if text == TWO {
            solid.push("thickness=1.0".to_owned());
        }
        for (body, ends, v) in
            [("left", [-10.0, 0.0], velocities[0]), ("right", [0.0, length], velocities[1])]
        {
            solid.extend(prism(body, ends, width));
            solid.push(format!("body.{body}.velocity=[{v:?}, 0.0, 0.0]"));
        }
        let apart = apart(text, &[], &solid);
        assert!(apart.iter().all(|apart| *apart < 1e-6), "{apart:?}");
    }
}
