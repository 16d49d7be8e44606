//! The analysis against published and measured numbers, and against the kernel itself.

use std::f64::consts::TAU;

use carom_time::{Explained, ForceRule, KINDS, Kernel, Memory, Oscillator, Root, Scheme, Stage, explain};

fn ch(r: f64) -> Scheme {
    Scheme::chung_hulbert(r).unwrap()
}

fn hht_of(r: f64) -> Scheme {
    Scheme::hht((1.0 - r) / (1.0 + r)).unwrap()
}

fn many() -> Vec<Scheme> {
    let rho = [0.0, 0.1, 0.3, 0.6, 0.9, 1.0];
    let mut all: Vec<_> = rho
        .iter()
        .flat_map(|&r| [ch(r), Scheme::wbz(r).unwrap(), Scheme::newmark_damped(r).unwrap()])
        .collect();
    let members = KINDS.iter().flat_map(|kind| kind.members.iter().map(|member| kind.named(member)));
    all.extend(members.filter_map(|name| name.integrator().unwrap().alpha()));
    all.push(hht_of(0.9));
    all.extend([
        Scheme::newmark(1.0 / 6.0, 0.5).unwrap(),
        Scheme::generalized_alpha(-0.2, 0.3, 0.8, 1.1).unwrap(),
    ]);
    all
}

/// ξ(T/10) and PE(T/10), derived independently from the amplification matrices; to half a unit of
/// the last digit.
#[test]
fn damping_and_period_error_are_the_tabulated_ones() {
    let damped = |r| Scheme::newmark_damped(r).unwrap();
    let wbz = |r| Scheme::wbz(r).unwrap();
    let xi = [
        (Scheme::newmark(0.25, 0.5).unwrap(), 0.0, 1e-15),
        (Scheme::hu(), 0.297, 5e-4),
        (damped(0.9), 0.0155, 5e-5),
        (damped(0.6), 0.074, 5e-4),
        (damped(0.1), 0.24, 5e-3),
        (hht_of(0.9), 0.0012, 5e-5),
        (hht_of(0.6), 0.0036, 5e-5),
        (wbz(0.6), 0.0088, 6e-5), // printed cut, not rounded: 0.008851
        (wbz(0.1), 0.042, 5e-4),
        (ch(0.8), 0.0002, 5e-5),
        (ch(0.6), 0.0017, 5e-5),
        (ch(0.1), 0.036, 5e-4),
        (ch(0.0), 0.055, 5e-4),
    ];
    for (scheme, want, tolerance) in xi {
        let got = scheme.principal(TAU / 10.0).unwrap().damping_ratio;
        assert!((got - want).abs() <= tolerance, "{scheme:?}: ξ = {got}, tabulated {want}");
    }
    let pe = [
        (Scheme::newmark(0.25, 0.5).unwrap(), 3.2, 0.05),
        (Scheme::hu(), 12.0, 0.5),
        (hht_of(0.9), 3.6, 0.05),
        (hht_of(0.6), 4.6, 0.05),
        (wbz(0.6), 5.5, 0.05),
        (wbz(0.1), 11.0, 0.5),
        (ch(0.8), 3.4, 0.05),
        (ch(0.0), 12.0, 0.5),
    ];
    for (scheme, percent, tolerance) in pe {
        let got = 100.0 * scheme.principal(TAU / 10.0).unwrap().period_error;
        assert!((got - percent).abs() <= tolerance, "{scheme:?}: PE = {got} %, tabulated {percent}");
    }
}

#[test]
fn spectral_radius_at_infinity_is_the_asked_one() {
    for r in [0.0, 0.1, 0.5, 0.6, 0.8, 0.9, 0.99, 1.0] {
        for scheme in [ch(r), Scheme::wbz(r).unwrap(), Scheme::newmark_damped(r).unwrap()] {
            assert!((scheme.spectral_radius_at_infinity() - r).abs() < 1e-10, "{scheme:?}");
            // The limit is approached as Ω⁻² at best and as Ω^(-2/3) at the triple root of Chung
            // and Hulbert.
            assert!(
                (scheme.spectral_radius(1e6) - r).abs() < 1e-3,
                "{scheme:?}: {}",
                scheme.spectral_radius(1e6)
            );
        }
        if r >= 0.5 {
            assert!((hht_of(r).spectral_radius_at_infinity() - r).abs() < 1e-10);
        }
    }
    // Above 1/3 the root of the averaged force dominates: α/(1 − α).
    assert!((Scheme::hht(0.4).unwrap().spectral_radius_at_infinity() - 2.0 / 3.0).abs() < 1e-14);
    assert_eq!(Scheme::hu().spectral_radius_at_infinity(), 0.0);
}

#[test]
fn roots_have_the_matrix_s_invariants() {
    for scheme in many() {
        for omega_dt in [0.05, 0.3, 1.0, 3.0, 20.0, 500.0] {
            let a = scheme.amplification(omega_dt);
            let minor = |i: usize, j: usize| a[i][i] * a[j][j] - a[i][j] * a[j][i];
            let determinant = a[0][0] * minor(1, 2) - a[0][1] * (a[1][0] * a[2][2] - a[1][2] * a[2][0])
                + a[0][2] * (a[1][0] * a[2][1] - a[1][1] * a[2][0]);
            let want = [a[0][0] + a[1][1] + a[2][2], minor(0, 1) + minor(0, 2) + minor(1, 2), determinant];
            let z = scheme.roots(omega_dt);
            let times =
                |a: Root, b: Root| Root { re: a.re * b.re - a.im * b.im, im: a.re * b.im + a.im * b.re };
            let pairs = times(z[0], z[1]).re + times(z[0], z[2]).re + times(z[1], z[2]).re;
            let got = [z[0].re + z[1].re + z[2].re, pairs, times(times(z[0], z[1]), z[2]).re];
            let scale = a.iter().flatten().fold(1.0, |m: f64, x| m.max(x.abs()));
            for (got, want) in got.iter().zip(want) {
                assert!((got - want).abs() < 1e-12 * scale, "{scheme:?} at {omega_dt}: {got} for {want}");
            }
        }
    }
}

#[test]
fn the_kernel_amplifies_as_the_matrix_says() {
    for scheme in many() {
        for rule in [ForceRule::AverageForces, ForceRule::AverageState] {
            for omega_dt in [0.1, 1.0, 7.0, 100.0] {
                let (dt, mass) = (0.125, 3.0);
                let omega = omega_dt / dt;
                let oscillator = Oscillator { mass, stiffness: mass * omega * omega, force: 0.0 };
                let matrix = scheme.amplification(omega_dt);
                for column in 0..3 {
                    let mut start = [0.0; 3];
                    start[column] = [1.0, 1.0 / dt, 1.0 / (dt * dt)][column];
                    let [u, v, a] =
                        oscillator.step(&scheme.with_forces(rule), dt, start, &mut Stage::default());
                    for (row, got) in [u, dt * v, dt * dt * a].into_iter().enumerate() {
                        let (want, size) =
                            (matrix[row][column], matrix[row].iter().fold(1.0f64, |m, x| m.max(x.abs())));
                        assert!(
                            (got - want).abs() < 1e-12 * size,
                            "{scheme:?} Ω {omega_dt} ({row}, {column}): {got} for {want}"
                        );
                    }
                }
            }
        }
    }
}

/// Book, "Three facts that explain the paper", 2: on a constrained dof both eigenvalues are −ρ∞,
/// whatever the step.
#[test]
fn a_constrained_dof_sees_minus_rho_inf() {
    for r in [0.1, 0.6, 0.9] {
        for scheme in [ch(r), Scheme::wbz(r).unwrap(), Scheme::newmark_damped(r).unwrap(), hht_of(r.max(0.5))]
        {
            let rho = scheme.spectral_radius_at_infinity();
            let [[a, b], [c, d]] = scheme.constrained_map();
            assert!(
                (a + d + 2.0 * rho).abs() < 1e-12 && (a * d - b * c - rho * rho).abs() < 1e-12,
                "{scheme:?}"
            );
            for root in scheme.constrained_roots() {
                assert!((root.re + rho).abs() < 1e-12 && root.im == 0.0, "{scheme:?}: {root:?}");
            }
            let constraint = scheme.alpha_f / (1.0 - scheme.alpha_f);
            assert!(constraint <= rho + 1e-15);
        }
        assert!((ch(r).alpha_f / (1.0 - ch(r).alpha_f) - r).abs() < 1e-15);
    }
}

#[test]
fn a_constrained_dof_rings_as_theory_says() {
    let (dt, v0) = (1e-3, 2.0);
    let free = Oscillator { mass: 1.0, stiffness: 0.0, force: 0.0 };
    let after = |scheme: &Scheme, steps: usize| {
        let mut motion = free.start(0.0, v0);
        for _ in 0..steps {
            motion = free.constrained_step(scheme, dt, motion, &mut Stage::default(), 0.0);
        }
        motion
    };
    // Trapezoidal: v alternates for ever, a grows by 4 v₀/Δt per step. Hu: settled after two steps.
    for steps in 1..=10 {
        let [_, v, a] = after(&Scheme::newmark(0.25, 0.5).unwrap(), steps);
        let sign = if steps % 2 == 0 { 1.0 } else { -1.0 };
        assert!(
            (v - sign * v0).abs() < 1e-12 && (a.abs() - 4.0 * steps as f64 * v0 / dt).abs() < 1e-8,
            "{steps}: {v} {a}"
        );
    }
    let [_, v, a] = after(&Scheme::hu(), 2);
    assert!(v.abs() < 1e-15 && a.abs() < 1e-12, "{v} {a}");
}

/// A mass that hits a wall at v₀: the contact force of eq. (15), λ = −(Σ other terms)/w.contact,
/// from the kernel itself.
#[test]
fn the_ringing_told_is_the_kernel_s() {
    let (dt, v0) = (1e-3, 2.0);
    let free = Oscillator { mass: 1.0, stiffness: 0.0, force: 0.0 };
    let ringing = |r: f64| explain(&ch(r)).constrained.steps.unwrap();
    for r in [0.1, 0.3, 0.6, 0.8] {
        let (mut motion, mut force, mut stage, mut last) = (free.start(0.0, v0), 0.0, Stage::default(), 0);
        for n in 1..500 {
            let next = free.constrained_step(&ch(r), dt, motion, &mut stage, 0.0);
            let (w, b) = (stage.weights, stage.before);
            force = -(w.mass * next[2] + b.mass * motion[2] + b.contact * force) / w.contact;
            if next[2].abs().max(force.abs()) * dt / v0 >= 0.01 {
                last = n;
            }
            motion = next;
        }
        assert_eq!(ringing(r), last + 1, "ρ∞ = {r}");
    }
    // The same place: a few steps at 0.1, 15 to 25 at 0.6.
    assert!(ringing(0.1) <= 6 && (15..=25).contains(&ringing(0.6)));
    assert_eq!(explain(&Scheme::hu()).constrained.steps, Some(2));
}

/// Errors of v and u against cos ωt over one period, under bisection of the step.
#[test]
fn the_measured_order_is_the_algebraic_one() {
    let oscillator = Oscillator { mass: 1.0, stiffness: 1.0, force: 0.0 };
    let error = |scheme: &Scheme, steps: u32| {
        let (dt, mut motion, mut stage) =
            (TAU / f64::from(steps), oscillator.start(1.0, 0.0), Stage::default());
        let mut worst = 0.0f64;
        for n in 1..=steps {
            motion = oscillator.step(scheme, dt, motion, &mut stage);
            let t = f64::from(n) * dt;
            worst = worst.max((motion[0] - t.cos()).abs()).max((motion[1] + t.sin()).abs());
        }
        worst
    };
    for scheme in many() {
        let slope = (error(&scheme, 800) / error(&scheme, 1600)).log2();
        assert!(
            (slope - f64::from(scheme.order())).abs() < 0.05,
            "{scheme:?}: measured {slope}, claimed {}",
            scheme.order()
        );
    }
    assert_eq!(Scheme::generalized_alpha(0.6, 0.5, 0.25, 0.4).unwrap().order(), 0);
}

/// The criterion against a sweep of Ω, for schemes on both sides of every condition.
#[test]
fn a_stability_agrees_with_a_sweep() {
    let values = [-0.3, 0.0, 0.2, 0.45, 0.55];
    for (am, af) in values.iter().flat_map(|&am| values.map(|af| (am, af))) {
        for (beta, gamma) in
            [0.2, 0.3, 0.5, 0.8, 1.1].iter().flat_map(|&b| [0.45, 0.55, 0.7, 0.9, 1.4].map(|g| (b, g)))
        {
            let scheme = Scheme::generalized_alpha(am, af, beta, gamma).unwrap();
            let largest = (-30..60).map(|k| scheme.spectral_radius(1.2f64.powi(k))).fold(0.0, f64::max);
            assert_eq!(scheme.is_a_stable(), largest <= 1.0 + 1e-9, "{scheme:?}: {largest}");
        }
    }
    assert!(many().iter().filter(|s| s.beta >= 0.25).all(Scheme::is_a_stable));
    assert!(!Scheme::newmark(1.0 / 6.0, 0.5).unwrap().is_a_stable());
}

#[test]
fn velocity_overshoot_is_what_the_matrix_does() {
    for scheme in many() {
        let omega_dt = 1e5;
        let a = scheme.amplification(omega_dt);
        let v = a[1][0] - omega_dt * omega_dt * a[1][2];
        assert!((v.abs() / (omega_dt * omega_dt) - scheme.velocity_overshoot()).abs() < 1e-6, "{scheme:?}");
    }
    assert_eq!(Scheme::newmark(0.25, 0.5).unwrap().velocity_overshoot(), 0.0);
}

#[test]
fn the_balance_weights_are_those_of_eq_15() {
    let scheme = ch(0.1);
    let one = [0.0];
    let mut stage = Stage::default();
    scheme.stage_into(0, 0.1, &Memory { states: &[(&one, &one, &one)], before: None }, &mut stage);
    let (w, b) = (stage.weights, stage.before);
    assert_eq!(
        [w.mass, w.internal, w.external, w.contact],
        [1.0 - scheme.alpha_m, 1.0 - scheme.alpha_f, 1.0 - scheme.alpha_f, 1.0 - scheme.alpha_f]
    );
    assert_eq!(
        [b.mass, b.internal, b.external, b.contact],
        [scheme.alpha_m, scheme.alpha_f, scheme.alpha_f, scheme.alpha_f]
    );
    scheme.with_forces(ForceRule::AverageState).stage_into(
        0,
        0.1,
        &Memory { states: &[(&one, &one, &one)], before: None },
        &mut stage,
    );
    let (w, b) = (stage.weights, stage.before);
    assert_eq!(
        [w.internal, w.external, w.contact, stage.average],
        [1.0, 1.0, 1.0 - scheme.alpha_f, scheme.alpha_f]
    );
    assert_eq!([b.internal, b.external, b.contact], [0.0, 0.0, scheme.alpha_f]);
}

/// By hand: with ten linear elements of consistent mass per wavelength, waves of the trapezoidal
/// rule, whose angle per step is 2 atan(Ω/2), are slower than c by the period error less the excess
/// of the element; central differences with lumped masses carry waves exactly at c Δt = h. The
/// trapezoidal rule keeps the energy of a mode, so that it does not overshoot; the first step of
/// Hu's scheme has u = 51/101, a = −100 u, and v = 50 + 1.5 a.
#[test]
fn dispersion_and_overshoot() {
    let trapezoidal = explain(&Scheme::newmark(0.25, 0.5).unwrap());
    let exact = TAU / 10.0;
    let omega = 2.0 * (exact / 2.0).sin() * (3.0 / (2.0 + exact.cos())).sqrt();
    let by_hand = 2.0 * (omega / 2.0).atan() / exact - 1.0;
    assert!((trapezoidal.accuracy[1].dispersion.unwrap() - by_hand).abs() < 1e-9 && by_hand < -0.01);
    assert!(trapezoidal.overshoot.displacement < 1.0 + 1e-9 && trapezoidal.overshoot.velocity < 1.0 + 1e-9);
    let explicit = KINDS.iter().find(|kind| kind.name == "central-difference").unwrap();
    let explicit = explicit.named(&explicit.members[0]).integrator().unwrap().explain();
    let Explained::Nonsmooth(explicit) = explicit else { panic!() };
    assert!(explicit.accuracy.iter().all(|row| row.dispersion.unwrap().abs() < 1e-9));
    // Between impacts Moreau and Jean's scheme with θ = ½ is the trapezoidal rule.
    let moreau = KINDS.iter().find(|kind| kind.name == "moreau-jean").unwrap();
    let mut half = moreau.named(&moreau.members[0]);
    half.parameters = [("theta", 0.5)].into();
    let moreau = half.integrator().unwrap().explain();
    let Explained::Nonsmooth(moreau) = moreau else { panic!() };
    assert!((moreau.accuracy[1].dispersion.unwrap() - by_hand).abs() < 1e-9);
    assert!((explain(&Scheme::hu()).overshoot.velocity - (150.0 * 51.0 / 101.0 - 50.0) / 10.0).abs() < 1e-9);
}
