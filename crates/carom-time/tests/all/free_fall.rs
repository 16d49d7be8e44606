//! Free fall is a quadratic in time, which most kernels reproduce to round-off. The errors of the
//! others are stated by their members. A wrong factor of inertia, a shifted weight or a careless
//! increment shows here first.

use carom_time::{ForceRule, Kernel, Oscillator, Scheme};

#[test]
fn free_fall_errs_by_what_the_rules_say_over_thousands_of_steps() {
    const G: f64 = -9.81;
    let fall = Oscillator { mass: 0.25, stiffness: 0.0, force: 0.25 * G };
    let others = [ForceRule::AverageForces, ForceRule::AverageState].map(|forces| {
        let scheme = Scheme::generalized_alpha(-0.2, 0.3, 0.6, 0.9).unwrap().with_forces(forces);
        let exactly: fn(f64) -> f64 = |_| 0.0;
        (exactly, format!("{scheme:?}"), Box::new(scheme) as Box<dyn Kernel>)
    });
    let members = crate::common::all().into_iter().map(|(member, name, kernel)| (member.falls, name, kernel));
    for (falls, name, kernel) in members.chain(others) {
        for dt in [1.875e-3, 1e-4] {
            for (n, [y, v, _]) in
                crate::common::run(&*kernel, fall, dt, 4000, 1.5, 0.3).into_iter().enumerate()
            {
                let t = n as f64 * dt;
                let right = [1.5 + 0.3 * t + 0.5 * G * t * t + falls(n as f64) * G * dt * dt, 0.3 + G * t];
                let (dy, dv) = ((y - right[0]).abs(), (v - right[1]).abs());
                // Relative to the path and to the speed, with one rounding per stage; over the
                // first 400 steps also absolute.
                let (path, stages) = (1.5 + 0.5 * G.abs() * t * t, kernel.stages() as f64);
                let most = if n <= 400 { [2e-12, 1e-11] } else { [f64::INFINITY; 2] };
                assert!(dy < (1e-12 * path * stages).min(most[0]), "{name}, Δt {dt}, step {n}: {dy:e}");
                assert!(
                    dv < (2e-12 * (0.3 + G.abs() * t) * stages).min(most[1]),
                    "{name}, Δt {dt}, step {n}: {dv:e}"
                );
            }
        }
    }
}
