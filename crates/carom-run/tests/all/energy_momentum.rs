//! Free flight of a spinning, straining and vibrating soft body: quantities that the discrete
//! gradient conserves to round-off, and other schemes do not. Contact forces are means over a step.

use carom_run::{GridReport, Simulation};

use super::common::{change, momenta, simulation};

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

fn flight(sets: &[&str]) -> Simulation {
    let mut sim = simulation(FLIGHT, sets);
    // Rotation about the centre, and a stretch along x of tens of per cent.
    let mut v = sim.state().v.clone();
    for (v, place) in v.chunks_mut(2).zip(sim.model().reference.chunks(2)) {
        let [x, y] = [place[0] - 1.0, place[1] - 0.25];
        v.copy_from_slice(&[1.0 + 4.0 * x - 3.0 * y, 0.5 + 3.0 * x]);
    }
    let kinetic = sim.model().kinetic(&v);
    change(&mut sim, |state| {
        state.v = v;
        state.ledger.kinetic = kinetic;
        state.ledger.total_at_start = state.ledger.total();
    });
    sim
}

/// Largest relative change of the energy and of each momentum, least J, mean Newton iterations.
fn drift(sets: &[&str]) -> (f64, [f64; 3], f64, f64) {
    let mut sim = flight(sets);
    let (start, energy) = (momenta(&sim, &sim.state().v), sim.state().ledger.total());
    let (mut worst, mut lost, mut least, mut newton) = (0.0_f64, [0.0_f64; 3], 1.0_f64, 0);
    while !sim.finished() {
        let mut report = GridReport::default();
        sim.advance(&mut report).unwrap();
        assert_eq!(report.rejected, 0);
        newton += report.newton;
        worst = worst.max((sim.state().ledger.total() / energy - 1.0).abs());
        for (lost, (now, start)) in lost.iter_mut().zip(momenta(&sim, &sim.state().v).into_iter().zip(start))
        {
            *lost = lost.max((now / start - 1.0).abs());
        }
        least = least.min(sim.model().min_det_f(&sim.state().y, &[]));
    }
    (worst, lost, least, f64::from(newton) / sim.steps() as f64)
}

#[test]
fn energy_and_momenta_of_a_free_flight_are_kept_to_round_off() {
    // The remaining residual does work: exact to the tolerance of Newton's method.
    for (law, tolerance, bound) in [
        ("neo-hookean", "1e-9", 1e-9),
        ("neo-hookean", "1e-12", 2e-12),
        ("saint-venant-kirchhoff", "1e-12", 2e-12),
    ] {
        let sets = [format!("material.rubber.law=\"{law}\""), format!("newton.tolerance={tolerance}")];
        let (energy, momenta, least, newton) = drift(&sets.each_ref().map(String::as_str));
        assert!(newton < 10.0, "{law}: {newton} iterations a step");
        assert!(energy < bound, "{law}: {energy:e}");
        assert!(momenta.iter().all(|lost| *lost < bound), "{law}: {momenta:?}");
        assert!(least < 0.9);
    }
    // Averaged states at ρ∞ = 1 are the plain midpoint rule: it conserves momenta, but not energy.
    let (energy, momenta, ..) =
        drift(&[r#"time.scheme={ kind = "chung-hulbert", rho_inf = 1.0, forces = "average-state" }"#]);
    assert!(energy > 1e-4 && momenta.iter().all(|lost| *lost < 1e-8), "{energy:e} {momenta:?}");
}

/// A block at rest on a plane, and another one that falls beside it from a height.
fn beside(height: f64) -> String {
    format!(
        r#"
dimension = 2
material = [{{ name = "m", law = "saint-venant-kirchhoff", density = 1.0, young = 1e6, poisson = 0.3 }}]
[[body]]
name = "rests"
material = "m"
element = "Q4"
mesh = {{ shape = "rectangle", min = [0.0, 0.0], max = [1.0, 1.0], cells = [2, 2] }}
gravity = [0.0, -10.0]
[[body]]
name = "falls"
material = "m"
element = "Q4"
mesh = {{ shape = "rectangle", min = [5.0, {height:?}], max = [6.0, {:?}], cells = [2, 2] }}
gravity = [0.0, -10.0]
[[contact]]
name = "of-rest"
secondary = "rests.bottom"
primary = {{ plane = {{ point = [0.0, 0.0], normal = [0.0, 1.0] }} }}
[[contact]]
name = "of-fall"
secondary = "falls.bottom"
primary = {{ plane = {{ point = [0.0, 0.0], normal = [0.0, 1.0] }} }}
[time]
end = 0.14
step = 2e-3
scheme = {{ kind = "energy-momentum" }}
"#,
        height + 1.0
    )
}

/// The force of a contact is the mean over each step, M dv/dt, also in one in which velocities are
/// projected elsewhere.
#[test]
fn forces_of_a_contact_do_not_depend_on_another_body_that_lands() {
    let mut alone = simulation(&beside(50.0), &[""; 0]);
    let mut joined = simulation(&beside(0.05), &[""; 0]);
    let mut meets = false;
    while !joined.finished() {
        let before = momenta(&alone, &alone.state().v)[1];
        let [apart, together] = [&mut alone, &mut joined].map(|sim| {
            sim.advance(&mut GridReport::default()).unwrap();
            sim.state().contact_forces[0][1]
        });
        assert!((together - apart).abs() < 1e-6 * 10.0, "{together} {apart}");
        let change = (momenta(&alone, &alone.state().v)[1] - before) / 2e-3;
        assert!((apart - change - 20.0).abs() < 1e-6 * 10.0, "{apart} {change}");
        meets |= joined.state().contact_forces[1][1] > 0.0;
    }
    assert!(meets);
}
