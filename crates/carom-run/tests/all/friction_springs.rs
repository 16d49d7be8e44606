//! Friction of nodes on springs: they stick elastically, at first touch too, and go on to slip.

use carom_run::GridReport;

use super::common::{finish, momenta, simulation};
use super::friction::{SCHEMES, SPRINGS, block, lost};

/// A soft disc and a stiff one on stiff springs that stick by first touch: a slip that reverses in
/// an iterate sticks before it slips backwards, and the momentum of the stiff disc need not be
/// known to more digits than the gap of a spring. The step was bisected until it was too short.
#[test]
fn springs_stick_at_first_touch() {
    let mut sim = simulation(TOUCH, &[""; 0]);
    let before = momenta(&sim, &sim.state().v);
    let mut report = GridReport::default();
    while !sim.finished() {
        sim.advance(&mut report).unwrap();
    }
    let after = momenta(&sim, &sim.state().v);
    for i in 0..2 {
        assert!((after[i] - before[i]).abs() < 1e-13, "{before:?} {after:?}");
    }
    assert!(lost(&sim) < 0.0 && sim.state().pairs[0].iter().any(|pair| pair.active));
    assert!(report.rejected < 30, "{}", report.rejected);
}

const TOUCH: &str = r#"
title = "A stiff disc touches a soft one"
dimension = 2
[[material]]
name = "soft"
law = "neo-hookean"
density = 1.0
young = 100.0
poisson = 0.3
[[material]]
name = "stiff"
law = "neo-hookean"
density = 1.0
young = 49444.0
poisson = 0.45
[[body]]
name = "lower"
material = "soft"
element = "T6"
mesh = { shape = "disc", radius = 0.54675, center = [0.0, 0.55175], size = 0.18225 }
[[body]]
name = "upper"
material = "stiff"
element = "T6"
mesh = { shape = "disc", radius = 0.21246, center = [0.43425, 1.1806], size = 0.053114 }
velocity = [-0.48938, -0.63053]
[[contact]]
name = "strike"
secondary = "lower.arc"
primary = "upper.arc"
enforcement = "penalty"
stiffness = 16.584
mu = 1.0
[time]
end = 0.02
step = 0.02
scheme = { kind = "bathe", rho_inf = 0.6 }
"#;

/// J_T = μ_d J_N of a block that slides on springs, also where it moves in a step by less than a
/// spring stretches between the tractions of slip and of stick.
#[test]
fn a_node_on_a_spring_goes_on_to_slip_against_the_dynamic_coefficient() {
    for decay in ["", "decay = 1e3"] {
        let contact = format!("mu = 0.3\nmu_dynamic = 0.1\n{decay}\n{SPRINGS}");
        for (velocity, step) in [(1.0, 2e-4), (0.5, 1e-5)] {
            let sets = [
                format!("body.block.velocity=[{velocity}, 0.0]"),
                format!("time.step={step}"),
                "time.end=0.02".into(),
            ];
            let sim = finish(simulation(&block(&contact, SCHEMES[0]), &sets));
            let [along, normal, _] = sim.state().impulse();
            assert!((-along / normal - 0.1).abs() < 1e-3, "{decay} {step}: {along} {normal}");
        }
    }
}

/// Nodes on springs stick, and little is lost; the springs have the energy Σ q²/2k.
#[test]
fn a_node_on_a_spring_sticks_elastically() {
    let with = "mu = 0.9\nenforcement = \"penalty\"\nstiffness = 1.0\nstick_stiffness = 0.5";
    let sim = finish(simulation(&block(with, SCHEMES[0]), &["body.block.velocity=[1e-4, 0.0]"]));
    let ledger = &sim.state().ledger;
    assert!(ledger.rubbed.stick_time > 0.9 * ledger.rubbed.contact_time, "{:?}", ledger.rubbed);
    // The block falls on its springs, so that nodes bounce and slip then.
    assert!(ledger.friction_work <= 0.0, "{ledger:?}");
    assert!(ledger.stick_springs > 0.0 && ledger.stick_springs < ledger.springs);
    let springs = sim.model().contacts[0].springs.as_ref().unwrap();
    let stiffness = |node: usize| springs.factors[1] * springs.diagonal.of_rows[node];
    let closed = sim.state().pairs[0].iter().filter(|pair| pair.active);
    let energy: f64 =
        closed.map(|pair| 0.5 * pair.tangential.traction[0].powi(2) / stiffness(pair.node)).sum();
    assert!((ledger.stick_springs / energy - 1.0).abs() < 1e-12, "{energy} {ledger:?}");
}
