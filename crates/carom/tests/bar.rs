//! A bar on a rigid wall: the published side-by-side table of schemes (Doyen, Ern, Piperno 2011; recomputed from the formulas alone), to its digits.

#![allow(clippy::unwrap_used)]

use carom::case::{Document, read};
use carom::{GridReport, Simulation};

/// Peak p/300, rms of p/300 − 1 over 0.52 < t < 1.147, E/E₀ and v_cm/10 at t = 2.
fn figures(scheme: &str) -> [f64; 4] {
    let text = include_str!("../../../cases/bar/single.toml");
    let document = Document::parse("single.toml", text, &[format!("time.scheme={scheme}")]).unwrap();
    let case = read(&document).unwrap_or_else(|p| panic!("{}", document.diagnose_all(&p)));
    let mut sim = Simulation::<1>::new(&case, 1).unwrap();
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

#[test]
fn every_scheme_of_the_family_reproduces_the_table() {
    // (scheme, printed figures, one unit of their last digit)
    let rows = [
        (r#"{ kind = "newmark", beta = 0.25, gamma = 0.5 }"#, [3.48, 1.45, 10.9, 1.026], [0.01, 0.01, 0.1, 0.001]),
        (r#"{ kind = "hu" }"#, [1.04, 0.113, 0.811, 0.887], [0.01, 0.001, 0.001, 0.001]),
        (r#"{ kind = "chung-hulbert", rho_inf = 0.6 }"#, [2.16, 0.083, 0.985, 0.985], [0.01, 0.001, 0.001, 0.001]),
        (r#"{ kind = "chung-hulbert", rho_inf = 0.1 }"#, [1.66, 0.018, 0.966, 0.974], [0.01, 0.001, 0.001, 0.001]),
        (r#"{ kind = "hht", alpha = 0.25 }"#, [2.09, 0.018, 0.982, 0.984], [0.01, 0.001, 0.001, 0.001]),
    ];
    for (scheme, printed, digit) in rows {
        let got = figures(scheme);
        for k in 0..4 {
            assert!((got[k] - printed[k]).abs() <= 0.6 * digit[k], "{scheme}: {got:?}, printed {printed:?}");
        }
    }
}
