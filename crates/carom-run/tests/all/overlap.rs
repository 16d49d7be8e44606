//! Bodies that overlap at the start: relaxed into an interference fit, or with a gap that is kept.

use carom_run::Setup;

use crate::common::{case, finish, simulation};

const BARS: &str = include_str!("../../../../cases/overlap/bars.toml");
const KEPT: &str = include_str!("../../../../cases/overlap/kept.toml");

/// δ/(L₁/E₁ + L₂/E₂).
const PRESSURE: f64 = 1e-3 / (1.0 / 100.0 + 1.501 / 300.0);

/// Every scheme starts from the same equilibrium, springs from theirs.
#[test]
fn the_pressure_of_a_fit_is_exact_with_every_family() {
    let sets = [
        "time.scheme={ kind = \"hu\" }",
        "time.scheme={ kind = \"energy-momentum\" }",
        "time.scheme={ kind = \"bdf2\" }",
        "time.scheme={ kind = \"static\" }",
        "contact.fit.primary=right.left",
    ];
    for set in sets {
        let start = simulation(BARS, &[set]);
        let force = start.state().contact_forces[0][0];
        assert!((force + PRESSURE).abs() < 1e-9 * PRESSURE, "{set}: {force}");
        let end = finish(start);
        let force = end.state().contact_forces[0][0];
        assert!((force + PRESSURE).abs() < 1e-7 * PRESSURE, "{set}: {force}");
        let ledger = &end.state().ledger;
        assert!(ledger.dissipation().abs() < 1e-12 * ledger.strain, "{set}: {ledger:?}");
    }
    // The spring adds its compliance: it is softer than the multiplier by its compression.
    let spring = simulation(BARS, &["contact.fit.enforcement=penalty"]);
    let force = spring.state().contact_forces[0][0];
    assert!(force < -0.9 * PRESSURE && force > -PRESSURE, "{force}");
}

/// The gap of a node in a rigid obstacle is kept too: nothing moves, and nothing is pushed out.
#[test]
fn an_overlap_with_an_obstacle_is_kept() {
    let sets = [
        "contact.fit.primary={ plane = { point = [0.999], normal = [-1.0] } }",
        "contact.fit.overlap=keep-gap",
    ];
    let end = finish(simulation(BARS, &sets));
    let moved = end.state().y.iter().zip(&end.model().reference).map(|(y, x)| (y - x).abs());
    assert!(moved.fold(0.0, f64::max) < 1e-14);
    let relaxed = simulation(BARS, &[sets[0]]);
    let force = relaxed.state().contact_forces[0][0];
    assert!((force + 0.1).abs() < 1e-9, "E δ/L = 0.1, not {force}");
}

/// Kept gaps are those of the case: a state of the middle continues to the same bits.
#[test]
fn kept_gaps_are_the_same_after_a_resume() {
    let sets = ["time.scheme={ kind = \"chung-hulbert\", rho_inf = 0.5 }", "time.step=0.02"];
    let mut run = simulation(KEPT, &sets);
    for _ in 0..7 {
        run.step().unwrap();
    }
    let mut again = Setup::new(&case(KEPT, &sets)).resume(run.state().clone()).unwrap();
    for _ in 0..20 {
        run.step().unwrap();
        again.step().unwrap();
    }
    assert!(run.state().pairs[0].iter().any(|pair| pair.active));
    assert_eq!(run.state(), again.state());
}

#[test]
fn an_overlap_is_refused_by_default() {
    let refused = Setup::new(&case(BARS, &["contact.fit.overlap=refuse"])).start();
    let problems = refused.err().unwrap();
    assert!(problems[0].what.contains("overlap at the start by 1.000000e-3"), "{problems:?}");
}
