//! The second method that checks contact: it agrees with a run, and contradicts what is wrong.

use carom_run::{AuditFailure, Simulation, audit, unaudited};

use super::common::{DISCS, finish, simulation};

/// Positions with the left disc moved to the right.
fn moved(sim: &Simulation, by: f64) -> Vec<f64> {
    let mut y = sim.state().y.clone();
    sim.model().parts[0].nodes().for_each(|node| y[2 * node] += by);
    y
}

#[test]
fn the_audit_agrees_with_a_collision() {
    let sim = finish(simulation(DISCS, &["time.step=4e-3"]).audited());
    assert!(sim.state().impulses[0][0] != 0.0);
}

#[test]
fn the_audit_finds_what_was_not_measured_and_what_has_passed() {
    let sim = simulation(DISCS, &[""; 0]);
    let (model, start) = (sim.model(), &sim.state().y);
    let nothing = carom_run::Depths::default();
    assert_eq!(audit(model, start, &moved(&sim, 0.05), nothing), Ok(()));
    // The centres are 1.1 and 0.2 apart: with 0.8 less, the discs overlap by 1 − |(0.3, 0.2)|.
    let found = audit(model, start, &moved(&sim, 0.8), nothing);
    let Err(AuditFailure::Deeper { depth, .. }) = found else { panic!("{found:?}") };
    assert!(depth > 0.01 && depth < 1.0 - f64::hypot(0.3, 0.2) + 0.01, "{depth}");
    let found = audit(model, start, &moved(&sim, 2.5), nothing);
    assert!(matches!(found, Err(AuditFailure::Passed { .. })), "{found:?}");
}

#[test]
fn the_audit_finds_a_passage_that_the_contact_does_not_allow_and_says_what_it_leaves_out() {
    let sim = simulation(DISCS, &[""; 0]);
    let (model, start) = (sim.model(), &sim.state().y);
    // The left disc, s lower, passes below the right one: on the way they overlap by 1 − |0.2 − s|,
    // at most 0.4 of a facet.
    let passed = |s: f64| {
        let mut y = moved(&sim, 2.5);
        model.parts[0].nodes().for_each(|node| y[2 * node + 1] -= s);
        let mut from = start.clone();
        model.parts[0].nodes().for_each(|node| from[2 * node + 1] -= s);
        audit(model, &from, &y, carom_run::Depths::default())
    };
    assert_eq!(passed(1.21), Ok(()));
    let found = passed(1.1);
    let Err(AuditFailure::Passed { depth, .. }) = found else { panic!("{found:?}") };
    assert!(depth > 0.01 && depth < 0.1 + 1e-3, "{depth}");
    let left = unaudited(model);
    assert_eq!(left, ["bodies without a contact between them"]);
    let floor = "contact.strike.primary={ plane = { point = [0.0, -3.0], normal = [0.0, 1.0] } }";
    let left = unaudited(simulation(DISCS, &[floor]).model());
    assert_eq!(left[0], "contact \"strike\" with a rigid obstacle");
}

/// A ball that flies at a plate at a low angle: in a step of 0.1 from t = 0.2 it would enter at the
/// top, leave at the bottom and be past the plate's end.
const SLANTING: &str = include_str!("../../../../cases/space/slanting.toml");
const COARSE: [&str; 3] = ["body.ball.mesh.size=0.025", "time.step=0.0125", "time.end=0.3"];

#[test]
fn in_space_the_audit_agrees_with_a_ball_that_rebounds_and_finds_one_that_has_passed() {
    let curved = ["body.ball.element=Tet10", "body.plate.element=Hex27", "body.plate.mesh.cells=[10,2,1]"];
    for elements in [&[""; 0][..], &curved[..]] {
        let changes = [&COARSE, elements].concat();
        let sim = simulation(SLANTING, &changes);
        let (model, nothing) = (sim.model(), carom_run::Depths::default());
        let at = |time: f64| {
            let mut y = sim.state().y.clone();
            for node in model.parts[0].nodes() {
                y[3 * node] += 9.0 * time;
                y[3 * node + 2] -= 5.0 * time;
            }
            y
        };
        assert_eq!(audit(model, &at(0.1), &at(0.2), nothing), Ok(()));
        let found = audit(model, &at(0.2), &at(0.3), nothing);
        let Err(AuditFailure::Passed { depth, .. }) = found else { panic!("{found:?}") };
        // The plate is 0.01 thick.
        assert!(depth > 0.002 && depth <= 0.005 + 1e-12, "{depth}");
        // At 0.238 its lowest node is 0.02 to 0.05 below the top, and others are within the plate.
        let found = audit(model, &at(0.2), &at(0.238), nothing);
        let Err(AuditFailure::Deeper { depth, .. }) = found else { panic!("{found:?}") };
        assert!(depth > 0.0005 && depth <= 0.005 + 1e-12, "{depth}");
        assert_eq!(unaudited(model), ["edges between their nodes", "bodies without a contact between them"]);
    }
    let sim = finish(simulation(SLANTING, &COARSE).audited());
    assert!(sim.state().impulses[0][2] != 0.0);
}
