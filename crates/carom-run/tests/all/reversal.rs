//! The trapezoidal rule is symmetric in time: from a later state with reversed velocities it
//! returns to the initial state.

use carom_run::GridReport;

use super::common::{restored, simulation};

const BLOCK: &str = r#"
title = "A block in free flight"
dimension = 2

[[material]]
name = "rubber"
law = "neo-hookean"
density = 0.25
lambda = 200.0
mu = 15.0

[[body]]
name = "block"
material = "rubber"
element = "T6"
mesh = { shape = "rectangle", min = [0.0, 0.0], max = [2.0, 1.0], cells = [4, 2] }
gravity = [0.0, -9.81]

[time]
end = 0.3
step = 1e-3
scheme = { kind = "newmark", beta = 0.25, gamma = 0.5 }
energy_guard = false                # velocities are set by hand
"#;

#[test]
fn the_trapezoidal_rule_runs_back() {
    let mut there = simulation(BLOCK, &[""; 0]);
    // Stretch and bending of order one: strains of tens of per cent.
    let mut begin = there.state().clone();
    for (x, v) in begin.y.as_chunks::<2>().0.iter().zip(begin.v.as_chunks_mut::<2>().0) {
        *v = [3.0 * x[0] * x[1], 1.0 - 2.0 * x[0] * x[0]];
    }
    there.restore(begin.clone()).unwrap();
    let mut strain = 0.0_f64;
    while !there.finished() {
        there.advance(&mut GridReport::default()).unwrap();
        strain = strain.max(there.state().ledger.strain);
    }
    let mut turned = there.state().clone();
    let displaced = turned.y.iter().zip(&begin.y).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    assert!(displaced > 0.3 && strain > 0.2, "the motion is not small: {displaced}, {strain}");
    turned.step = 0;
    turned.v.iter_mut().for_each(|v| *v = -*v);
    let mut back = restored(simulation(BLOCK, &[""; 0]), turned);
    while !back.finished() {
        back.advance(&mut GridReport::default()).unwrap();
    }
    for (a, b) in back.state().y.iter().zip(&begin.y) {
        assert!((a - b).abs() < 1e-8, "{a} instead of {b}");
    }
    for (a, b) in back.state().v.iter().zip(&begin.v) {
        assert!((a + b).abs() < 1e-6, "{a} instead of {}", -b);
    }
}
