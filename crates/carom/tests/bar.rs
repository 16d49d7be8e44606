//! A bar on a rigid wall: the published side-by-side table of schemes (Doyen, Ern, Piperno 2011; recomputed from the formulas alone), to its digits.
//! (a) one impact at v₀ = −10; (b) bouncing under gravity for three periods.

#![allow(clippy::unwrap_used)]

use carom::case::{Document, read};
use carom::{GridReport, Simulation};

fn simulation(sets: &[String]) -> Simulation<1> {
    let text = include_str!("../../../cases/bar/single.toml");
    let document = Document::parse("single.toml", text, sets).unwrap_or_else(|e| panic!("{e}"));
    let case = read(&document).unwrap_or_else(|p| panic!("{}", document.diagnose_all(&p)));
    Simulation::<1>::new(&case, 1).unwrap_or_else(|p| panic!("{}", document.diagnose_all(&p)))
}

/// Peak p/300, rms of p/300 − 1 over 0.52 < t < 1.147, E/E₀ and v_cm/10 at t = 2.
fn single(sets: &[String]) -> [f64; 4] {
    let mut sim = simulation(sets);
    let start = sim.state.ledger.total();
    let (mut peak, mut squares, mut samples) = (0.0_f64, 0.0, 0);
    while !sim.finished() {
        sim.advance(&mut GridReport::default()).unwrap();
        let p = sim.state.contact_forces[0][0] / 300.0;
        peak = peak.max(p);
        if sim.state.time > 0.52 + 1e-9 && sim.state.time < 1.147 - 1e-9 {
            squares += (p - 1.0) * (p - 1.0);
            samples += 1;
        }
    }
    let mut momentum = vec![0.0; sim.state.v.len()];
    sim.model.mass.multiply_into(&sim.state.v, &mut momentum);
    let velocity = momentum.iter().sum::<f64>() / 10.0;
    [peak, (squares / f64::from(samples)).sqrt(), sim.state.ledger.total() / start, velocity / 10.0]
}

/// Exact height of the lower end at time `t` of the bouncing bar (theory: d'Alembert's solution in closed form).
fn height(t: f64) -> f64 {
    let (period, wave) = (16.0 / 3.0, 1.0 / 3.0);
    let t = t % period;
    let t = t.min(period - t);
    let (first, second) = (5.0 / 3.0, 11.0 / 3.0);
    if t <= 1.0 {
        5.0 - 5.0 * t * t
    } else if t <= first || t >= second {
        0.0
    } else {
        let x = ((t - first) / wave) % 2.0;
        let s = t - first - 1.0;
        5.0 - 5.0 * s * s - 10.0 * wave * wave * x * (2.0 - x)
    }
}

/// Error of the lower end in the third period over h₀, and E/E₀ after it.
fn bouncing(sets: &[String]) -> [f64; 2] {
    let gravity = ["body.bar.velocity=[0.0]", "body.bar.gravity=[-10.0]", "time.end=16.0"].map(String::from);
    let mut sim = simulation(&[sets, &gravity].concat());
    let (mut squares, mut samples) = (0.0, 0);
    while !sim.finished() {
        sim.advance(&mut GridReport::default()).unwrap();
        if sim.state.time >= 32.0 / 3.0 - 1e-9 {
            squares += (sim.state.y[0] - height(sim.state.time)).powi(2);
            samples += 1;
        }
    }
    [(squares / f64::from(samples)).sqrt() / 5.0, (sim.state.ledger.total() + 500.0) / 500.0]
}

/// One row: what sets it apart from the case, printed figures of (a) and of (b), each with one unit of its last digit.
struct Row(&'static [&'static str], [(f64, f64); 4], [(f64, f64); 2]);

fn check(rows: &[Row]) {
    for Row(sets, a, b) in rows {
        let text: Vec<String> = sets.iter().map(ToString::to_string).collect();
        let got: Vec<f64> = single(&text).into_iter().chain(bouncing(&text)).collect();
        for (k, (printed, digit)) in a.iter().chain(b).enumerate() {
            assert!((got[k] - printed).abs() <= 0.6 * digit, "{sets:?}, figure {k}: {got:.5?}, printed {printed}");
        }
    }
}

#[test]
fn exact_heights_are_the_tabulated_ones() {
    let table =
        [5.0, 4.4444, 2.7778, 0.0, 0.0, 0.0, 1.6667, 4.4444, 3.8889, 4.4444, 1.6667, 0.0, 0.0, 0.0, 2.7778, 4.4444];
    for (k, want) in table.into_iter().enumerate() {
        assert!((height(k as f64 / 3.0) - want).abs() < 1e-4, "{k}");
    }
}

#[test]
fn every_scheme_of_the_family_reproduces_the_table() {
    check(&[
        Row(
            &[r#"time.scheme={ kind = "hu" }"#],
            [(1.04, 0.01), (0.113, 0.001), (0.811, 0.001), (0.887, 0.001)],
            [(0.58, 0.01), (0.001, 0.001)],
        ),
        Row(
            &[r#"time.scheme={ kind = "chung-hulbert", rho_inf = 0.6 }"#],
            [(2.16, 0.01), (0.083, 0.001), (0.985, 0.001), (0.985, 0.001)],
            [(0.19, 0.01), (0.929, 0.001)],
        ),
        Row(
            &[r#"time.scheme={ kind = "chung-hulbert", rho_inf = 0.1 }"#],
            [(1.66, 0.01), (0.018, 0.001), (0.966, 0.001), (0.974, 0.001)],
            [(0.35, 0.01), (0.841, 0.001)],
        ),
        Row(
            &[r#"time.scheme={ kind = "hht", alpha = 0.25 }"#],
            [(2.09, 0.01), (0.018, 0.001), (0.982, 0.001), (0.984, 0.001)],
            [(0.20, 0.01), (0.920, 0.001)],
        ),
    ]);
    // The trapezoidal rule's (b) is decided by round-off: (a) alone.
    let got = single(&[r#"time.scheme={ kind = "newmark", beta = 0.25, gamma = 0.5 }"#.to_owned()]);
    for (got, (printed, digit)) in got.iter().zip([(3.48, 0.01), (1.45, 0.01), (10.9, 0.1), (1.026, 0.001)]) {
        assert!((got - printed).abs() <= 0.6 * digit, "{got} for {printed}");
    }
}

#[test]
fn the_composite_rule_reproduces_the_table() {
    let a = [(1.52, 0.01), (0.001, 0.001), (0.989, 0.001), (0.993, 0.001)];
    let b = [(0.11, 0.01), (0.953, 0.001)];
    check(&[
        Row(&[r#"time.scheme={ kind = "bathe", rho_inf = 0.0 }"#], a, b),
        Row(&[r#"time.scheme={ kind = "tr-bdf2" }"#], a, b),
    ]);
}

/// Kane's elasticity at the middle of the step and contact force at its end, with the predictor projected.
#[test]
fn contact_stabilised_newmark_reproduces_the_table() {
    const LAW: &str = "contact.wall.law=\"predictor\"";
    const NO: &str = "contact.wall.persistency=\"none\"";
    let a = [(1.15, 0.01), (0.004, 0.001), (0.996, 0.001), (0.984, 0.001)];
    let b = [(0.20, 0.01), (0.974, 0.001)];
    check(&[
        Row(&[LAW, NO, r#"time.scheme={ kind = "energy-momentum" }"#], a, b),
        Row(
            &[
                LAW,
                NO,
                "contact.wall.force=\"end\"",
                r#"time.scheme={ kind = "chung-hulbert", rho_inf = 1.0, forces = "average-state" }"#,
            ],
            a,
            b,
        ),
    ]);
}

/// 1e5 is 100/9 times the stiffness of the end node, E/dx = 9000.
#[test]
fn the_energy_conserving_penalty_reproduces_the_table() {
    check(&[Row(
        &[
            r#"time.scheme={ kind = "energy-momentum" }"#,
            "contact.wall.enforcement=\"penalty\"",
            "contact.wall.stiffness=11.11111111111111",
        ],
        [(1.41, 0.01), (0.283, 0.001), (1.0, 1e-4), (0.988, 0.001)],
        [(0.11, 0.01), (1.0, 1e-4)],
    )]);
}

#[test]
fn redistributed_mass_reproduces_the_table() {
    const TRAPEZOIDAL: &str = r#"time.scheme={ kind = "newmark", beta = 0.25, gamma = 0.5 }"#;
    check(&[Row(
        &[TRAPEZOIDAL, "body.bar.mass=\"redistributed-nearest\""],
        [(1.33, 0.01), (0.005, 0.001), (1.0003, 1e-4), (0.990, 0.001)],
        [(0.11, 0.01), (0.997, 0.001)],
    )]);
    // Total, centre and second moment kept by the least change of all nodes: of (a) the peak and the energy are published, of (b) both, the energies
    // as those of the nearest nodes within .002.
    check(&[Row(
        &[TRAPEZOIDAL, "body.bar.mass=\"redistributed\""],
        [(1.09, 0.01), (0.0, f64::INFINITY), (1.0003, 0.003), (0.0, f64::INFINITY)],
        [(0.05, 0.01), (0.997, 0.003)],
    )]);
}
