//! Frozen tangents, with and without their accelerations, and the full tangent give the same
//! history.

use carom_run::{GridReport, Simulation, State};

use super::common::simulation;

/// The last state of a coarse impact, and the contact force of every step.
fn history(set: &str) -> (State, Vec<[f64; 3]>) {
    let text = include_str!("../../../../cases/impact/impact.toml");
    let coarse = ["body.cylinder.mesh.size=0.2", "body.prism.mesh.cells=[4,2]"];
    let mut sim = simulation(text, &[&coarse[..], &[set]].concat());
    let mut forces = Vec::new();
    while !sim.finished() {
        sim.advance(&mut GridReport::default()).unwrap();
        forces.push(sim.state().contact_forces[0]);
    }
    (sim.into_state(), forces)
}

/// Largest difference.
fn apart(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}

#[test]
fn kept_and_full_tangents_with_and_without_mixing_lead_to_the_same_history() {
    let (full, wanted) = history("newton.tangent=full");
    let largest = wanted.iter().map(|f| f[1].abs()).fold(0.0, f64::max);
    assert!(largest > 1.0);
    for other in ["newton.mixing=4", "newton.mixing=0"] {
        let (frozen, forces) = history(other);
        let force = apart(forces.as_flattened(), wanted.as_flattened()) / largest;
        let place = apart(&frozen.y, &full.y);
        assert!(force < 1e-6 && place < 1e-8, "{other}: force {force:e}, place {place:e}");
        assert_eq!(frozen.step, full.step);
    }
}

/// A case with factors large enough for single precision.
fn large(set: &str) -> Simulation {
    let sim = simulation(include_str!("../../../../cases/perf/disc-19k.toml"), &[set]);
    assert!(sim.model().free.len() > 10_000);
    sim
}

/// Contact forces of the next steps.
fn forces(sim: &mut Simulation, steps: usize) -> Vec<[f64; 3]> {
    let mut advance = || {
        sim.advance(&mut GridReport::default()).unwrap();
        sim.state().contact_forces[0]
    };
    (0..steps).map(|_| advance()).collect()
}

/// Single precision of a large factor does not affect the accuracy of the motion, including the
/// first steps of contact; a resumed run recomputes the same factor.
#[test]
fn factors_of_single_precision_lead_to_the_same_history_and_are_made_again() {
    let mut sim = large("newton.tangent=frozen");
    let mut single = forces(&mut sim, 10);
    let mut resumed = large("newton.tangent=frozen");
    resumed.restore(sim.state().clone()).unwrap();
    let last = forces(&mut sim, 4);
    assert_eq!(forces(&mut resumed, 4), last);
    assert_eq!(resumed.state(), sim.state());
    single.extend(last);
    let double = forces(&mut large("newton.tangent=frozen-double"), 14);
    let largest = double.iter().map(|f| f[1].abs()).fold(0.0, f64::max);
    assert!(largest > 1.0, "{largest}");
    // Not bitwise equal: one of the two is of single precision.
    let apart = apart(single.as_flattened(), double.as_flattened());
    assert!(apart > 0.0 && apart < 1e-8 * largest, "{apart:e} of {largest}");
}
