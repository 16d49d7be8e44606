//! The kept and the full tangent lead to the same history.

use carom::{GridReport, State};

use super::common::simulation;

/// The last state of a coarse impact, and the contact force of every step.
fn history(tangent: &str) -> (State, Vec<[f64; 2]>) {
    let text = include_str!("../../../../cases/impact/impact.toml");
    let coarse = ["body.cylinder.mesh.size=0.2", "body.prism.mesh.cells=[4,2]"];
    let mut sim = simulation::<2>(text, &[&coarse[..], &[tangent]].concat());
    let mut forces = Vec::new();
    while !sim.finished() {
        sim.advance(&mut GridReport::default()).unwrap();
        forces.push(sim.state.contact_forces[0]);
    }
    (sim.state, forces)
}

#[test]
fn kept_and_full_tangents_lead_to_the_same_history() {
    let (kept, forces) = history("newton.tangent=kept");
    let (full, wanted) = history("newton.tangent=full");
    let largest = wanted.iter().map(|f| f[1].abs()).fold(0.0, f64::max);
    assert!(largest > 1.0);
    let worst = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    let force = worst(forces.as_flattened(), wanted.as_flattened()) / largest;
    let place = worst(&kept.y, &full.y);
    assert!(force < 1e-6 && place < 1e-8, "force {force:e}, place {place:e}");
    assert_eq!(kept.step, full.step);
}

/// Half of the digits of a large factor cost no digit of the motion, the first steps of contact included.
#[test]
fn factors_of_single_and_double_precision_lead_to_the_same_history() {
    let forces = |tangent: &str| -> Vec<[f64; 2]> {
        let text = include_str!("../../../../cases/perf/disc-19k.toml");
        let mut sim = simulation::<2>(text, &[tangent]);
        assert!(sim.model.free.len() > 10_000);
        let mut advance = || {
            sim.advance(&mut GridReport::default()).unwrap();
            sim.state.contact_forces[0]
        };
        (0..20).map(|_| advance()).collect()
    };
    let (single, double) = (forces("newton.tangent=kept"), forces("newton.tangent=kept-double"));
    let largest = double.iter().map(|f| f[1].abs()).fold(0.0, f64::max);
    let apart = single.as_flattened().iter().zip(double.as_flattened()).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    assert!(largest > 1.0, "{largest}");
    // Not the same bits: one of the two is of single precision.
    assert!(apart > 0.0 && apart < 1e-8 * largest, "{apart:e} of {largest}");
}
