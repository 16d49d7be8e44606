//! Free flight of a soft body that spins, strains and rings: what the discrete gradient keeps to round-off, and what other schemes do not.

#![allow(clippy::unwrap_used)]

use carom::case::{Document, read};
use carom::{GridReport, Simulation};

const FLIGHT: &str = r#"
title = "flight"
dimension = 2
[[material]]
name = "rubber"
law = "neo-hookean"
density = 0.25
lambda = 20.0
mu = 15.0
[[body]]
name = "ruler"
material = "rubber"
element = "T6"
mesh = { shape = "rectangle", min = [0.0, 0.0], max = [2.0, 0.5], cells = [8, 2] }
[time]
end = 2.0
step = 1e-2
scheme = { kind = "energy-momentum" }
energy_guard = false
"#;

fn flight(sets: &[&str]) -> Simulation<2> {
    let sets: Vec<String> = sets.iter().map(ToString::to_string).collect();
    let document = Document::parse("flight.toml", FLIGHT, &sets).unwrap();
    let case = read(&document).unwrap_or_else(|p| panic!("{}", document.diagnose_all(&p)));
    let mut sim = Simulation::<2>::new(&case, 1).unwrap();
    // Spin about the centre, and a pull along x that stretches by tens of per cent.
    for node in sim.model.parts[0].nodes() {
        let [x, y] = [sim.model.reference[2 * node] - 1.0, sim.model.reference[2 * node + 1] - 0.25];
        (sim.state.v[2 * node], sim.state.v[2 * node + 1]) = (1.0 + 4.0 * x - 3.0 * y, 0.5 + 3.0 * x);
    }
    sim.state.ledger.kinetic = sim.model.kinetic(&sim.state.v);
    sim.state.ledger.total_at_start = sim.state.ledger.total();
    sim
}

/// Momentum and moment of momentum.
fn momenta(sim: &Simulation<2>) -> [f64; 3] {
    let mut p = vec![0.0; sim.state.v.len()];
    sim.model.mass.multiply_into(&sim.state.v, &mut p);
    let pairs = p.as_chunks::<2>().0.iter().zip(sim.state.y.as_chunks::<2>().0);
    pairs.fold([0.0; 3], |s, (p, y)| [s[0] + p[0], s[1] + p[1], s[2] + y[0] * p[1] - y[1] * p[0]])
}

/// Largest relative change of the energy and of each momentum, least J, mean Newton iterations.
fn drift(sets: &[&str]) -> (f64, [f64; 3], f64, f64) {
    let mut sim = flight(sets);
    let (start, energy) = (momenta(&sim), sim.state.ledger.total());
    let (mut worst, mut lost, mut least, mut newton) = (0.0_f64, [0.0_f64; 3], 1.0_f64, 0);
    while !sim.finished() {
        let mut report = GridReport::default();
        sim.advance(&mut report).unwrap();
        assert_eq!(report.rejected, 0);
        newton += report.newton;
        worst = worst.max((sim.state.ledger.total() / energy - 1.0).abs());
        for (lost, (now, start)) in lost.iter_mut().zip(momenta(&sim).into_iter().zip(start)) {
            *lost = lost.max((now / start - 1.0).abs());
        }
        least = least.min(sim.model.min_det_f(&sim.state.y));
    }
    (worst, lost, least, f64::from(newton) / sim.steps as f64)
}

#[test]
fn energy_and_momenta_of_a_free_flight_are_kept_to_round_off() {
    // What is left of the residual does work: exact as far as Newton's method goes.
    for (law, tolerance, kept) in
        [("neo-hookean", "1e-9", 1e-9), ("neo-hookean", "1e-12", 2e-12), ("saint-venant-kirchhoff", "1e-12", 2e-12)]
    {
        let sets = [format!("material.rubber.law=\"{law}\""), format!("newton.tolerance={tolerance}")];
        let (energy, momenta, least, newton) = drift(&sets.each_ref().map(String::as_str));
        assert!(newton < 10.0, "{law}: {newton} iterations a step");
        assert!(energy < kept, "{law}: {energy:e}");
        assert!(momenta.iter().all(|lost| *lost < kept), "{law}: {momenta:?}");
        assert!(least < 0.9);
    }
    // Averaged states at ρ∞ = 1 are the plain midpoint rule: momenta, but not energy.
    let (energy, momenta, ..) =
        drift(&[r#"time.scheme={ kind = "chung-hulbert", rho_inf = 1.0, forces = "average-state" }"#]);
    assert!(energy > 1e-4 && momenta.iter().all(|lost| *lost < 1e-8), "{energy:e} {momenta:?}");
}
