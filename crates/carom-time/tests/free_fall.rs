//! Free fall is a polynomial of degree two in time, which every member of the family reproduces: what remains is round-off.
//! A wrong factor on inertia, a shifted weight or a careless increment shows here first.

#![allow(clippy::unwrap_used)]

use carom_time::{ForceRule, KINDS, Oscillator, Scheme, Stage};

fn family() -> Vec<Scheme> {
    let members = KINDS.iter().flat_map(|kind| kind.members.iter().map(|member| kind.named(member)));
    let named = members.filter_map(|name| name.integrator(ForceRule::AverageForces).unwrap().alpha());
    let averaged = named.chain([Scheme::generalized_alpha(-0.2, 0.3, 0.6, 0.9).unwrap()]);
    averaged.flat_map(|scheme| [scheme, scheme.with_forces(ForceRule::AverageState)]).collect()
}

#[test]
fn free_fall_is_exact_over_thousands_of_steps() {
    const G: f64 = -9.81;
    let fall = Oscillator { mass: 0.25, stiffness: 0.0, force: 0.25 * G };
    for scheme in family() {
        for dt in [1.875e-3, 1e-4] {
            let mut stage = Stage::default();
            let mut motion = fall.start(1.5, 0.3);
            for n in 1..=4000 {
                motion = fall.step(&scheme, dt, motion, &mut stage);
                let t = f64::from(n) * dt;
                let (y, v) = (1.5 + 0.3 * t + 0.5 * G * t * t, 0.3 + G * t);
                // Over the 0.75 s of the impact to 1e-12 absolutely; later relative to the length of the path.
                let path = 1.5 + 0.5 * G.abs() * t * t;
                assert!((motion[0] - y).abs() < 1e-12 * path, "{scheme:?}, Δt {dt}, step {n}: {}", motion[0] - y);
                assert!(
                    (motion[1] - v).abs() < 2e-12 * (0.3 + G.abs() * t),
                    "{scheme:?}, Δt {dt}, step {n}: {}",
                    motion[1] - v
                );
            }
        }
    }
}
