//! A bar on a rigid wall: the published comparison of schemes (Doyen, Ern, Piperno 2011; recomputed
//! from the formulas alone), to its digits. (a) one impact at v₀ = −10; (b) bouncing under gravity
//! for three periods.

use carom_mechanics::{LogEvent, Rejected};
use carom_run::{GridReport, Simulation};

use super::common::{BAR as FALLING, schemes, simulation};

const BAR: &str = include_str!("../../../../cases/bar/single.toml");

/// Peak p/300, rms of p/300 − 1 over 0.52 < t < 1.147, E/E₀ and v_cm/10 at the end, and the deepest
/// penetration.
fn figures(sets: &[String]) -> [f64; 5] {
    let mut sim = simulation(BAR, sets);
    let start = sim.state().ledger.total();
    let (mut peak, mut squares, mut samples, mut depth) = (0.0_f64, 0.0, 0, 0.0_f64);
    while !sim.finished() {
        sim.advance(&mut GridReport::default()).unwrap();
        let p = sim.state().contact_forces[0][0] / 300.0;
        peak = peak.max(p);
        depth = depth.max(-sim.state().y[0]);
        if sim.state().time > 0.52 + 1e-9 && sim.state().time < 1.147 - 1e-9 {
            squares += (p - 1.0) * (p - 1.0);
            samples += 1;
        }
    }
    let mut momentum = vec![0.0; sim.state().v.len()];
    sim.model().mass.multiply_into(&sim.state().v, &mut momentum);
    let velocity = momentum.iter().sum::<f64>() / 10.0;
    [peak, (squares / f64::from(samples)).sqrt(), sim.state().ledger.total() / start, velocity / 10.0, depth]
}

/// The bouncing bar: error of the end's position in the third period relative to the drop height,
/// and the energy at the end relative to 500.
fn bounce(sets: &[String]) -> [f64; 2] {
    let sets = [&["body.bar.gravity=[-10.0]".into(), "body.bar.velocity=[0.0]".into()], sets].concat();
    let mut sim = simulation(BAR, &sets);
    let period = 16.0 / 3.0;
    let (mut squares, mut samples) = (0.0, 0);
    while !sim.finished() {
        sim.advance(&mut GridReport::default()).unwrap();
        if sim.state().time > 2.0 * period - 1e-9 {
            let error = sim.state().y[0] - exact_bounce(sim.state().time % period);
            squares += error * error;
            samples += 1;
        }
    }
    [(squares / f64::from(samples)).sqrt() / 5.0, (sim.state().ledger.total() + 500.0) / 500.0]
}

/// Exact position of the bouncing bar's lower end within a period of 16/3: fall, contact, flight
/// with the wave; the second half is the first reversed.
fn exact_bounce(t: f64) -> f64 {
    let (fall, transit) = (1.0, 1.0 / 3.0);
    let t = if t > 8.0 * transit { 16.0 * transit - t } else { t };
    if t < fall {
        5.0 - 5.0 * t * t
    } else if t < fall + 2.0 * transit {
        0.0
    } else {
        let s = t - fall - 2.0 * transit;
        let x = 30.0 * s / 10.0 % 2.0;
        5.0 - 5.0 * (s - fall) * (s - fall) - 10.0 / 9.0 * x * (2.0 - x)
    }
}

/// Check values of the exact solution as printed with it.
#[test]
fn the_exact_bounce_has_the_printed_values() {
    let printed = [
        5.0, 4.4444, 2.7778, 0.0, 0.0, 0.0, 1.6667, 4.4444, 3.8889, 4.4444, 1.6667, 0.0, 0.0, 0.0, 2.7778,
        4.4444, 5.0,
    ];
    for (k, value) in printed.iter().enumerate() {
        assert!((exact_bounce(k as f64 / 3.0 + 1e-12) - value).abs() < 1e-4, "{k}");
    }
}

/// (a) and (b) of the table for schemes with their own contact law. The largest penetration of (a)
/// is 0 for the position law, otherwise as printed.
#[test]
fn explicit_and_impulse_schemes_reproduce_the_table() {
    let implicit = |scheme: &str, end: &str| vec![format!("time.scheme={scheme}"), format!("time.end={end}")];
    let explicit = |scheme: &str, end: &str| {
        let more = ["body.bar.mass=lumped".to_owned(), "time.step=0.003".to_owned()];
        [implicit(scheme, end), more.to_vec()].concat()
    };
    let theta = |theta: &str| format!("{{ kind = \"moreau-jean\", theta = {theta} }}");
    let nsga = "{ kind = \"nonsmooth-generalized-alpha\", rho_inf = 0.1 }";
    let cd = "{ kind = \"central-difference\" }";
    let ps = "{ kind = \"paoli-schatzman\" }";
    let elastic = vec!["contact.wall.restitution=1.0".to_owned()];
    // Printed figures of (a) and one unit of their last digits; settings for (a) and for (b);
    // printed figures of (b) and their units.
    let rows = [
        (
            "Moreau θ=1",
            implicit(&theta("1.0"), "2.0"),
            [1.07, 0.104, 0.811, 0.887, 0.031],
            [0.01, 0.001, 0.001, 0.001, 0.001],
            implicit(&theta("1.0"), "16.0"),
            [0.58, -0.0002],
            [0.01, 0.0001],
        ),
        (
            "Moreau θ=1/2",
            implicit(&theta("0.5"), "2.0"),
            [1.08, 0.002, 0.994, 0.986, 0.017],
            [0.01, 0.001, 0.001, 0.001, 0.001],
            implicit(&theta("0.5"), "16.0"),
            [0.16, 0.979],
            [0.01, 0.001],
        ),
        (
            "NSGA .1",
            implicit(nsga, "2.0"),
            [1.00, 0.011, 0.969, 0.977, 0.036],
            [0.01, 0.001, 0.001, 0.001, 0.001],
            implicit(nsga, "16.0"),
            [0.32, 0.847],
            [0.01, 0.001],
        ),
        (
            "CD",
            explicit(cd, "1.998"),
            [1.04, 0.0006, 0.994, 0.991, 0.0],
            [0.01, 0.0001, 0.001, 0.001, 1e-11],
            explicit(cd, "15.999"),
            [0.11, 0.981],
            [0.01, 0.001],
        ),
        (
            "P-S e=0",
            explicit(ps, "1.998"),
            [1.04, 0.0006, 0.994, 0.991, 0.0],
            [0.01, 0.0001, 0.001, 0.001, 1e-11],
            explicit(ps, "15.999"),
            [0.11, 0.981],
            [0.01, 0.001],
        ),
        (
            "P-S e=1",
            [explicit(ps, "1.998"), elastic.clone()].concat(),
            [1.59, 0.460, 2.01, 0.998, 0.020],
            [0.01, 0.001, 0.01, 0.001, 0.001],
            [explicit(ps, "15.996"), elastic].concat(),
            [0.018, 8.4],
            [0.001, 0.1],
        ),
    ];
    for (name, a, printed_a, digit_a, b, printed_b, digit_b) in rows {
        let (got_a, got_b) = (figures(&a), bounce(&b));
        for k in 0..5 {
            let near = (got_a[k] - printed_a[k]).abs() <= 0.6 * digit_a[k];
            assert!(near, "{name} (a): {got_a:?}, printed {printed_a:?}");
        }
        for k in 0..2 {
            let near = (got_b[k] - printed_b[k]).abs() <= 0.6 * digit_b[k];
            assert!(near, "{name} (b): {got_b:?}, printed {printed_b:?}");
        }
    }
}

/// Paoli and Schatzman with e = 1: the energy alternates from step to step between the two figures
/// of the table.
#[test]
fn energy_alternates_where_positions_are_reflected() {
    let sets = |end: &str| {
        let scheme = "time.scheme={ kind = \"paoli-schatzman\" }";
        let end = format!("time.end={end}");
        [scheme, "body.bar.mass=lumped", "time.step=0.003", "contact.wall.restitution=1.0", &end]
            .map(str::to_owned)
    };
    for (ends, printed, digit) in
        [(["1.998", "1.995"], [2.01, 2.92], 0.01), (["15.996", "15.999"], [8.4, 12.9], 0.1)]
    {
        for (end, printed) in ends.into_iter().zip(printed) {
            let got = if digit < 0.1 { figures(&sets(end))[2] } else { bounce(&sets(end))[1] };
            assert!((got - printed).abs() <= 0.6 * digit, "t = {end}: {got}, printed {printed}");
        }
    }
}

/// Figures of (a) without the penetration.
fn single(sets: &[String]) -> [f64; 4] {
    let [peak, rms, energy, velocity, _] = figures(sets);
    [peak, rms, energy, velocity]
}

/// (b) to the end of the third period.
fn bouncing(sets: &[String]) -> [f64; 2] {
    bounce(&[sets, &["time.end=16.0".to_owned()]].concat())
}

/// One row: its settings, printed figures of (a) and of (b), each with one unit of its last digit.
struct Row(&'static [&'static str], [(f64, f64); 4], [(f64, f64); 2]);

fn check(rows: &[Row]) {
    for Row(sets, a, b) in rows {
        let text: Vec<String> = sets.iter().map(ToString::to_string).collect();
        let got: Vec<f64> = single(&text).into_iter().chain(bouncing(&text)).collect();
        for (k, (printed, digit)) in a.iter().chain(b).enumerate() {
            assert!(
                (got[k] - printed).abs() <= 0.6 * digit,
                "{sets:?}, figure {k}: {got:.5?}, printed {printed}"
            );
        }
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

/// Kane's elasticity at the midpoint of the step and contact force at its end, with projection of
/// the predictor.
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
    // Total, centre and second moment preserved by the least change of all nodes: published are the
    // peak and energy of (a), and both figures of (b).
    check(&[Row(
        &[TRAPEZOIDAL, "body.bar.mass=\"redistributed\""],
        [(1.09, 0.01), (0.0, f64::INFINITY), (1.0003, 0.003), (0.0, f64::INFINITY)],
        [(0.05, 0.01), (0.997, 0.003)],
    )]);
}

/// A bar that departs from the wall for ever, at a thousand times the Courant step: its positions
/// grow to hundreds of its lengths, the balance is known to fewer digits, and no step is rejected.
#[test]
fn a_bar_far_from_the_origin_converges() {
    for scheme in [
        "{ kind = \"newmark\", rho_inf = 1 }",
        "{ kind = \"chung-hulbert\", rho_inf = 0.1 }",
        "{ kind = \"bathe\", rho_inf = 0 }",
        "{ kind = \"energy-momentum\" }",
    ] {
        let scheme = format!("time.scheme={scheme}");
        let sets = [scheme.as_str(), "time.step=3.3333333333333335", "time.end=333.33333333333337"];
        let mut sim = simulation(BAR, &sets);
        while !sim.finished() {
            let report = sim.step().unwrap();
            assert_eq!(report.rejected, 0, "{scheme} {:?}", report.events);
        }
        assert!(sim.state().y[0] > 300.0, "{scheme}");
    }
}

/// A bar that bounces at a hundred and a thousand times the Courant step: whatever rejects a step
/// says so. Its message had shown both measures below what is allowed.
#[test]
fn a_rejected_step_says_which_measure_is_too_large() {
    let mut rejections = 0;
    for scheme in [
        "{ kind = \"newmark\", rho_inf = 1 }",
        "{ kind = \"chung-hulbert\", rho_inf = 0.1 }",
        "{ kind = \"bathe\", rho_inf = 0 }",
        "{ kind = \"energy-momentum\" }",
        "{ kind = \"moreau-jean\", theta = 0.5 }",
    ] {
        for step in ["0.33333333333333335", "3.3333333333333335"] {
            let sets = [
                format!("time.scheme={scheme}"),
                format!("time.step={step}"),
                "time.end=66.66666666666667".into(),
                "time.energy_guard=false".into(),
                "body.bar.gravity=[-10.0]".into(),
            ];
            let mut sim = simulation(BAR, &sets);
            while !sim.finished() {
                let mut report = GridReport::default();
                let ended = sim.advance(&mut report).is_err();
                for event in &report.events {
                    let LogEvent::Rejected { rejected, .. } = event else { continue };
                    rejections += 1;
                    assert!(explains(rejected), "{scheme} {step}: {rejected}");
                }
                if ended {
                    break;
                }
            }
        }
    }
    assert!(rejections > 0);
}

/// Whether a measure of Newton's method is too large, or contacts were still changing.
fn explains(rejected: &Rejected) -> bool {
    let Rejected::NoConvergence { step, residual, gap, unbalanced, changing, .. } = rejected else {
        return true;
    };
    let gap = gap.unwrap_or([0.0; 2]);
    *unbalanced || *changing || [*step, *residual, gap].iter().any(|[found, allowed]| found > allowed)
}

/// What created energy is allowed is the work of loads, supports and obstacles that change over a
/// step. Contact that rings against a fixed wall has no part in it: all that it creates is seen.
#[test]
fn ringing_contact_hides_nothing_that_it_creates() {
    let mut largest = 0.0_f64;
    for (scheme, _) in schemes(false) {
        let mut sim = simulation(BAR, &[format!("time.scheme={scheme}")]);
        let energy = |sim: &Simulation| sim.state().ledger.total() - sim.state().ledger.external_work;
        let (mut lowest, mut most) = (energy(&sim), 0.0_f64);
        while !sim.finished() {
            sim.step().unwrap();
            most = most.max(energy(&sim) - lowest);
            lowest = lowest.min(energy(&sim));
        }
        let ledger = &sim.state().ledger;
        assert_eq!(ledger.unbooked, 0.0, "{scheme}");
        assert!((ledger.created.most() - most).abs() <= 1e-12 * ledger.scale(), "{scheme}: {most}");
        largest = largest.max(most / ledger.scale());
    }
    assert!(largest > 0.5, "no scheme rings: {largest}");
}

/// Wherever in a step a gap closes, a composite rule creates no energy, and the impulse of the wall
/// is the change of momentum. The step is not bisected here.
#[test]
fn a_gap_that_closes_at_any_time_of_a_composite_step_creates_no_energy() {
    let schemes = ["tr-bdf2\"", "bathe\", rho_inf = 0.5", "bathe\", rho_inf = 1.0"];
    for (scheme, mass) in schemes.iter().flat_map(|scheme| [(scheme, "lumped"), (scheme, "consistent")]) {
        for passed in [0.0, 1e-6, 0.05, 0.1, 0.2, 0.3, 0.5, 0.8] {
            let gap = 0.02 * (2.0 + passed);
            let mesh = format!("{{ shape = \"interval\", min = {gap}, max = {}, cells = 12 }}", gap + 10.0);
            let sets = [
                format!("time.scheme={{ kind = \"{scheme} }}"),
                format!("body.bar.mesh={mesh}"),
                format!("body.bar.mass=\"{mass}\""),
                "body.bar.gravity=[0.0]".to_owned(),
                "time.step=0.02".to_owned(),
                "time.end=1.0".to_owned(),
            ];
            let mut sim = simulation(FALLING, &sets);
            let momentum = |sim: &Simulation| {
                let mut momentum = vec![0.0; sim.state().v.len()];
                sim.model().mass.multiply_into(&sim.state().v, &mut momentum);
                momentum.iter().sum::<f64>()
            };
            let before = momentum(&sim);
            while !sim.finished() {
                sim.step().unwrap();
            }
            let ledger = &sim.state().ledger;
            let created = ledger.created.most() / ledger.scale();
            assert!(created < 1e-3, "{scheme}, {mass}, {passed}: {created}");
            let missing = momentum(&sim) - before - sim.state().impulse()[0];
            assert!(missing.abs() < 1e-12 * before.abs(), "{scheme}, {mass}, {passed}: {missing}");
            assert!(sim.state().impulse()[0] > 0.5 * before.abs());
        }
    }
}

/// A bar at rest has no residual: its steps need one solve each, or two.
#[test]
fn a_bar_at_rest_costs_next_to_nothing() {
    let rest = [
        "body.bar.velocity=[0.0]",
        "body.bar.gravity=[0.0]",
        "time.scheme={ kind = \"newmark\", beta = 0.25, gamma = 0.5 }",
    ];
    let mut sim = simulation(BAR, &rest);
    let start = sim.state().y.clone();
    for _ in 0..20 {
        let report = sim.step().unwrap();
        assert!((1..=2).contains(&report.newton), "{}", report.newton);
    }
    assert_eq!(sim.state().y, start);
}
