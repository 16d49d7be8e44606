//! Yield stress over the equivalent plastic strain α.

use carom_solid::material::{Hardening, Table};

fn laws() -> [Hardening; 3] {
    let table = Table::new(&[[0.0, 2.0], [0.1, 2.5], [0.3, 2.5], [0.6, 4.0]]);
    [
        Hardening::Linear { yield_stress: 2.0, modulus: 3.0 },
        Hardening::Voce { yield_stress: 2.0, modulus: 0.5, rise: 1.5, rate: 12.0 },
        Hardening::Table(table.unwrap()),
    ]
}

/// The flow fulfils its equation, and its integral is the difference of what is stored.
#[test]
fn flow_ends_on_the_yield_stress() {
    for law in laws() {
        for alpha in [0.0, 0.05, 0.1, 0.29, 1.0] {
            assert_eq!(law.flow(alpha, 0.0, 7.0).strain, 0.0, "{law:?} {alpha}");
            for excess in [0.0, 1e-12, 1e-3, 0.4, 3.0, 40.0] {
                let start = law.at(alpha);
                let flow = law.flow(alpha, excess, 7.0);
                let end = law.at(alpha + flow.strain);
                let remainder = excess - 7.0 * flow.strain - (end.stress - start.stress);
                assert!(remainder.abs() < 2e-15 * (4.0 + excess), "{law:?} {alpha} {excess} {remainder:e}");
                let over = start.stress - law.initial();
                let stored = flow.hardening + over * flow.strain;
                assert!((end.stored - start.stored - stored).abs() < 1e-14 * (1.0 + end.stored));
            }
        }
    }
}

/// Yield stress and slope are derivatives, within the segments of a table.
#[test]
fn stress_and_slope_are_derivatives() {
    for law in laws() {
        for alpha in [0.05, 0.2, 0.45, 0.9] {
            let slope = |f: &dyn Fn(f64) -> f64| (f(alpha + 1e-5) - f(alpha - 1e-5)) / 2e-5;
            let over = law.at(alpha).stress - law.initial();
            assert!((slope(&|x| law.at(x).stored) - over).abs() < 1e-8);
            let flow = law.flow(alpha, 1e-10, 7.0);
            assert!((slope(&|x| law.at(x).stress) - flow.slope).abs() < 1e-6, "{law:?} {alpha}");
        }
    }
}

#[test]
fn tables_that_fall_are_none() {
    for points in [
        &[][..],
        &[[0.1, 1.0]],
        &[[0.0, 0.0]],
        &[[0.0, 1.0], [0.0, 2.0]],
        &[[0.0, 2.0], [0.1, 1.0]],
        &[[0.0, 1.0], [0.1, f64::NAN]],
    ] {
        assert_eq!(Table::new(points), None, "{points:?}");
    }
}
