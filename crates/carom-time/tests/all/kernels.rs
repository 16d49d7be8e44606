//! Every member of every kind that is a list of stages, including impulse schemes between impacts:
//! order and ρ∞ against the published values of the table. Then tabulated damping and rational
//! functions of the published rules.

use std::f64::consts::TAU;

use carom_time::schemes::backward_euler::BackwardEuler;
use carom_time::schemes::bathe::Bathe;
use carom_time::schemes::bdf2::Bdf2;
use carom_time::schemes::energy_momentum::EnergyMomentum;
use carom_time::schemes::moreau_jean::MoreauJean;
use carom_time::{Explained, KINDS, Kernel, Member, Oscillator, STATIC, Scheme, map};

use crate::common::{all, run};

#[test]
fn every_kind_has_members_and_names_nothing_twice() {
    for (i, kind) in KINDS.iter().enumerate() {
        assert!(!kind.members.is_empty() || kind.name == STATIC, "{}", kind.name);
        assert!(KINDS[..i].iter().all(|other| other.name != kind.name), "{}", kind.name);
        // Every set of parameters has a member.
        for set in kind.sets.iter().filter(|_| kind.name != STATIC) {
            let keys: Vec<_> = set.iter().map(|parameter| parameter.key).collect();
            let of = |member: &Member| member.parameters.iter().map(|(key, _)| *key).collect::<Vec<_>>();
            assert!(kind.members.iter().any(|member| of(member) == keys), "{}: {keys:?}", kind.name);
        }
    }
}

/// Noh and Bathe 2019, theory: ρ∞ = 0 damps 8.7e-4 and elongates 1.6 % at ten steps per period.
#[test]
fn the_composite_rule_damps_as_tabulated() {
    let at = map::principal(&Bathe::new(0.0).unwrap(), TAU / 10.0).unwrap();
    assert!((at.damping_ratio - 8.7e-4).abs() < 5e-6, "{at:?}");
    assert!((at.period_error - 0.016).abs() < 5e-4, "{at:?}");
}

#[test]
fn order_and_rho_inf_are_the_published_ones() {
    for (member, name, kernel) in all() {
        assert_eq!(map::order(&*kernel), member.order, "{name}");
        // The limit is approached as Ω^(-2/3) at a triple root.
        let far = map::spectral_radius(&*kernel, 1e6);
        assert!((far - member.rho_inf).abs() < 2e-3, "{name}: {far}");
    }
}

/// The output of `explain`, in closed form or by the map of a constrained dof: a double root is
/// resolved to half of the digits.
#[test]
fn what_is_explained_is_what_is_published() {
    for (kind, member) in KINDS.iter().flat_map(|kind| kind.members.iter().map(move |member| (kind, member)))
    {
        let (order, rho_inf) = match kind.named(member).integrator().unwrap().explain() {
            Explained::Stages(explanation) => (explanation.order, explanation.rho_inf),
            Explained::Nonsmooth(explanation) => {
                (explanation.order, explanation.rho_inf.unwrap_or(f64::INFINITY))
            }
        };
        assert_eq!(order, member.order, "{}", kind.named(member));
        let same = rho_inf == member.rho_inf || (rho_inf - member.rho_inf).abs() < 1e-7;
        assert!(same, "{}: {rho_inf}", kind.named(member));
    }
}

/// Errors of u and v against cos ωt over one period, under bisection of the step: this uses only
/// steps of the kernel.
#[test]
fn the_measured_order_is_the_published_one() {
    let oscillator = Oscillator { mass: 1.0, stiffness: 1.0, force: 0.0 };
    for (member, name, kernel) in all() {
        let error = |steps: u32| {
            let dt = TAU / f64::from(steps);
            let path = run(&*kernel, oscillator, dt, steps, 1.0, 0.0);
            let at = |n: usize| {
                (path[n][0] - (n as f64 * dt).cos()).abs().max((path[n][1] + (n as f64 * dt).sin()).abs())
            };
            (0..path.len()).map(at).fold(0.0, f64::max)
        };
        let slope = (error(800) / error(1600)).log2();
        assert!((slope - f64::from(member.order)).abs() < 0.05, "{name}: {slope}");
    }
}

type Complex = (f64, f64);

fn div(a: Complex, b: Complex) -> Complex {
    let n = b.0 * b.0 + b.1 * b.1;
    ((a.0 * b.0 + a.1 * b.1) / n, (a.1 * b.0 - a.0 * b.1) / n)
}

/// Stability functions of the rules on y' = iω y, from textbooks: backward Euler 1/(1 − z),
/// midpoint (1 + z/2)/(1 − z/2), θ-method (1 + (1 − θ)z)/(1 − θz), TR-BDF2 (Hosea and Shampine
/// 1996).
#[test]
fn principal_roots_are_the_textbook_stability_functions() {
    for omega_dt in [0.05, 0.3, 1.0, 2.0] {
        let z = (0.0, omega_dt);
        let g = 2.0 - 2f64.sqrt();
        let trapezoidal = div((1.0, 0.5 * g * z.1), (1.0, -0.5 * g * z.1));
        let (a, b) = (1.0 / (g * (2.0 - g)), (1.0 - g) * (1.0 - g) / (g * (2.0 - g)));
        let tr_bdf2 = div((a * trapezoidal.0 - b, a * trapezoidal.1), (1.0, -(1.0 - g) / (2.0 - g) * z.1));
        let bdf2: Complex = {
            // (3 r² − 4 r + 1)/2 = z r²: the root that is 1 at z = 0.
            let p = (3.0, -2.0 * z.1);
            // √(4 − 3 + 2z), the root with a positive real part.
            let d: Complex = (1.0, 2.0 * z.1);
            let m = d.0.hypot(d.1);
            let root = ((0.5 * (m + d.0)).sqrt(), (0.5 * (m - d.0)).sqrt());
            div((2.0 + root.0, root.1), p)
        };
        let cases: [(&dyn Kernel, Complex); 5] = [
            (&BackwardEuler, div((1.0, 0.0), (1.0, -z.1))),
            (&EnergyMomentum, div((1.0, 0.5 * z.1), (1.0, -0.5 * z.1))),
            (&Bathe::new(0.0).unwrap(), tr_bdf2),
            (&Bdf2, bdf2),
            (&MoreauJean::new(0.7).unwrap(), div((1.0, 0.3 * z.1), (1.0, -0.7 * z.1))),
        ];
        for (kernel, want) in cases {
            let got = map::principal(kernel, omega_dt).unwrap();
            let (modulus, angle) = (want.0.hypot(want.1), want.1.atan2(want.0));
            assert!(
                (got.modulus - modulus).abs() < 1e-9,
                "{kernel:?} at {omega_dt}: {} for {modulus}",
                got.modulus
            );
            assert!((omega_dt / (1.0 + got.period_error) - angle).abs() < 1e-9, "{kernel:?} at {omega_dt}");
        }
    }
}

/// The numeric map of a member of the α family equals its closed-form matrix.
#[test]
fn the_numeric_map_is_the_closed_one_where_there_is_one() {
    for scheme in [Scheme::chung_hulbert(0.3).unwrap(), Scheme::hu(), Scheme::hht(0.2).unwrap()] {
        for omega_dt in [0.1, 1.0, 7.0] {
            let (got, want) = (map::amplification(&scheme, omega_dt), scheme.amplification(omega_dt));
            for i in 0..3 {
                for j in 0..3 {
                    assert!((got[i][j] - want[i][j]).abs() < 1e-12 * (1.0 + want[i][j].abs()), "{scheme:?}");
                }
            }
            let (a, b) = (map::principal(&scheme, omega_dt).unwrap(), scheme.principal(omega_dt).unwrap());
            assert!(
                (a.damping_ratio - b.damping_ratio).abs() < 1e-6
                    && (a.period_error - b.period_error).abs() < 1e-6
            );
        }
    }
}
