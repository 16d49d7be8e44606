//! Energy and momentum of single steps, against identities that hold to round-off.

use carom_time::{ForceRule, Kernel, Memory, Oscillator, Scheme, Stage};

/// Krenk 2006, for α_m = α_f = 0: E* = E + (β − γ/2) Δt²/2 m a² changes by the dissipation of the
/// increments and the work of the force.
#[test]
fn newmark_s_energy_balance_is_krenk_s() {
    let (dt, o) = (0.3, Oscillator { mass: 2.0, stiffness: 5.0, force: 1.5 });
    for (beta, gamma) in [(0.25, 0.5), (1.0, 1.5), (0.4, 0.75)] {
        let scheme = Scheme::newmark(beta, gamma).unwrap();
        let b = beta - 0.5 * gamma;
        let star = |m: [f64; 3]| {
            0.5 * (o.mass * m[1] * m[1] + o.stiffness * m[0] * m[0] + b * dt * dt * o.mass * m[2] * m[2])
        };
        let mut motion = o.start(1.0, -0.4);
        for _ in 0..50 {
            let next = o.step(&scheme, dt, motion, &mut Stage::default());
            let (du, da) = (next[0] - motion[0], next[2] - motion[2]);
            let lost = (gamma - 0.5) * (o.stiffness * du * du + b * dt * dt * o.mass * da * da);
            let change = star(next) - star(motion);
            assert!(
                (change - (du * o.force - lost)).abs() < 1e-13,
                "{change} against {}",
                du * o.force - lost
            );
            motion = next;
        }
    }
}

/// The ledger's identity for the whole family: F̄ = (1 − α_f) F_{s+1} + α_f F_s, b̂ = β − γ/2,
/// Δu·F̄_ext − ΔE = (Δu·F̄_int − ΔU) − (γ + α_m − 1) Δu·m Δa + Δt² b̂ Δa·m (a_s + γ Δa).
#[test]
fn the_ledger_s_identity_holds() {
    let (dt, o) = (0.3, Oscillator { mass: 2.0, stiffness: 5.0, force: 1.5 });
    for scheme in [
        Scheme::chung_hulbert(0.1),
        Scheme::chung_hulbert(1.0),
        Scheme::hht(0.2),
        Scheme::wbz(0.0),
        Ok(Scheme::hu()),
    ] {
        let scheme = scheme.unwrap();
        let Scheme { alpha_m, alpha_f, beta, gamma, .. } = scheme;
        let mut motion = o.start(1.0, -0.4);
        for _ in 0..50 {
            let next = o.step(&scheme, dt, motion, &mut Stage::default());
            let (du, da) = (next[0] - motion[0], next[2] - motion[2]);
            let mean = o.stiffness * ((1.0 - alpha_f) * next[0] + alpha_f * motion[0]);
            let strain = 0.5 * o.stiffness * (next[0] * next[0] - motion[0] * motion[0]);
            // Oscillator::energy includes the potential of the force: its change is ΔE − Δu·f.
            let dissipation = o.energy(motion) - o.energy(next);
            let right = (du * mean - strain) - (gamma + alpha_m - 1.0) * du * o.mass * da
                + dt * dt * (beta - 0.5 * gamma) * da * o.mass * (motion[2] + gamma * da);
            assert!((dissipation - right).abs() < 1e-13, "{scheme:?}: {dissipation} against {right}");
            motion = next;
        }
    }
}

#[test]
fn the_trapezoidal_rule_keeps_the_energy_of_linear_motion() {
    let o = Oscillator { mass: 2.0, stiffness: 5.0, force: 1.5 };
    for scheme in [Scheme::newmark(0.25, 0.5), Scheme::chung_hulbert(1.0)] {
        let (mut motion, mut stage) = (o.start(1.0, -0.4), Stage::default());
        let start = o.energy(motion);
        for _ in 0..1000 {
            motion = o.step(&scheme.clone().unwrap(), 0.3, motion, &mut stage);
        }
        assert!((o.energy(motion) - start).abs() < 1e-12, "{}", o.energy(motion) - start);
    }
}

/// A spring pendulum in the plane, force −k(|y| − 1) y/|y|: averaged states at ρ∞ = 1 are the
/// midpoint rule, which conserves angular momentum exactly; averaged forces do not.
#[test]
fn the_midpoint_rule_keeps_the_moment_of_momentum() {
    let drift = |scheme: Scheme| {
        let force = |y: [f64; 2]| {
            let length = y[0].hypot(y[1]);
            y.map(|c| -30.0 * (length - 1.0) * c / length)
        };
        let moment = |y: &[f64], v: &[f64]| y[0] * v[1] - y[1] * v[0];
        let (mut y, mut v) = ([1.2, 0.0], [0.3, 1.0]);
        let mut a = force(y);
        let (start, mut stage, mut worst) = (moment(&y, &v), Stage::default(), 0.0f64);
        for _ in 0..200 {
            scheme.stage_into(0, 0.05, &Memory { states: &[(&y, &v, &a)], before: None }, &mut stage);
            let (w, b, slope) = (stage.weights, stage.before, stage.acceleration.slope);
            let mut d = [0.0; 2];
            // w.mass a(d) + b.mass a_s = w.internal f + b.internal f_s by fixed-point iteration for
            // d.
            for _ in 0..100 {
                let mixed = [0, 1].map(|i| y[i] + (1.0 - stage.average) * d[i]);
                let (now, old) = (force(mixed), force(y));
                d = [0, 1].map(|i| {
                    let inertia = w.internal * now[i] + b.internal * old[i] - b.mass * a[i];
                    (inertia / w.mass - stage.acceleration.at_start[i]) / slope
                });
            }
            let (mut v1, mut a1) = ([0.0; 2], [0.0; 2]);
            stage.velocity.value_into(&d, &mut v1);
            stage.acceleration.value_into(&d, &mut a1);
            (y, v, a) = ([y[0] + d[0], y[1] + d[1]], v1, a1);
            worst = worst.max((moment(&y, &v) - start).abs());
        }
        worst
    };
    let scheme = Scheme::chung_hulbert(1.0).unwrap();
    assert!(drift(scheme.with_forces(ForceRule::AverageState)) < 1e-12);
    assert!(drift(scheme) > 1e-6);
}
