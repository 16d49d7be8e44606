//! Loads and moving supports against exact solutions: waves, oscillators, equilibria.

use carom_run::case::Case;
use carom_run::{GridReport, Setup, Simulation, State};

use super::common::{self, dot, finish, schemes};

/// A bar of length 1, E = ρ = A = 1, fixed at the left, plus the given text.
pub(crate) fn bar(rest: &str) -> Simulation {
    simulation(&format!(
        r#"
dimension = 1
[[material]]
name = "unit"
law = "linear-elastic"
density = 1.0
young = 1.0
poisson = 0.0
{rest}"#
    ))
}

fn simulation(text: &str) -> Simulation {
    common::simulation(text, &[""; 0])
}

pub(crate) fn body(cells: usize, mass: &str) -> String {
    format!(
        r#"
[[body]]
name = "bar"
material = "unit"
element = "L2"
mass = "{mass}"
mesh = {{ shape = "interval", min = 0.0, max = 1.0, cells = {cells} }}
"#
    )
}

pub(crate) const HELD: &str = "[[support]]\nname = \"wall\"\non = [\"bar.left\"]\nfix = [\"x\"]\n";

pub(crate) fn time(end: f64, step: f64, scheme: &str) -> String {
    format!("[time]\nend = {end:?}\nstep = {step:?}\nscheme = {scheme}\n")
}

/// D'Alembert: under a sudden end force F the tip moves at cF/(EA) until the wave returns at 2L/c,
/// then back at the same speed. The work of a constant force is F times the displacement, and the
/// trapezoidal rule conserves the energy.
#[test]
fn a_bar_under_a_sudden_end_force_carries_the_exact_wave() {
    let load = "[[load]]\non = [\"bar.right\"]\ntraction = [0.001]\n";
    let scheme = r#"{ kind = "newmark", beta = 0.25, gamma = 0.5 }"#;
    let mut sim = bar(&[&body(400, "lumped"), HELD, load, &time(3.0, 1.25e-3, scheme)].concat());
    let tip = sim.model().dofs() - 1;
    while !sim.finished() {
        sim.advance(&mut GridReport::default()).unwrap();
        let moved = sim.state().y[tip] - 1.0;
        let t = sim.state().time;
        let exact = 1e-3 * if t < 2.0 { t } else { 4.0 - t };
        assert!((moved - exact).abs() < 2e-5, "t = {t}: {moved} against {exact}");
        let ledger = &sim.state().ledger;
        assert!((ledger.external_work - 1e-3 * moved).abs() < 1e-15);
        assert!(ledger.dissipation().abs() < 1e-14, "{:e}", ledger.dissipation());
    }
}

/// One lumped element is the oscillator m ü + k u = F cos ωt with m = ½, k = 1: u = F/(k − mω²)
/// (cos ωt − cos ω₀t) from rest.
#[test]
fn an_oscillator_under_a_harmonic_force_is_of_second_order() {
    let omega = 3.0_f64;
    let natural = 2.0_f64.sqrt();
    for scheme in [
        r#"{ kind = "newmark", beta = 0.25, gamma = 0.5 }"#,
        r#"{ kind = "chung-hulbert", rho_inf = 0.2 }"#,
        r#"{ kind = "hht", alpha = 0.2 }"#,
        r#"{ kind = "hht", alpha = 0.2, forces = "average-state" }"#,
        r#"{ kind = "chung-hulbert", rho_inf = 0.6, forces = "average-state" }"#,
        r#"{ kind = "bdf2" }"#,
        r#"{ kind = "tr-bdf2" }"#,
        r#"{ kind = "bathe", rho_inf = 0.3 }"#,
        r#"{ kind = "energy-momentum" }"#,
        r#"{ kind = "central-difference" }"#,
        r#"{ kind = "moreau-jean", theta = 0.5 }"#,
        r#"{ kind = "nonsmooth-generalized-alpha", rho_inf = 0.4 }"#,
    ] {
        let error = |step: f64| {
            let load = "[[load]]\non = [\"bar.right\"]\ntraction = [\"0.01*cos(3*t)\"]\n";
            let sim = finish(bar(&[&body(1, "lumped"), HELD, load, &time(2.0, step, scheme)].concat()));
            let exact = 0.01 / (1.0 - 0.5 * omega * omega) * ((omega * 2.0).cos() - (natural * 2.0).cos());
            (sim.state().y[1] - 1.0 - exact).abs()
        };
        let (coarse, fine) = (error(5e-3), error(2.5e-3));
        assert!(fine < 1e-6 && (coarse / fine).log2() > 1.9, "{scheme}: {coarse:e} {fine:e}");
    }
}

/// One consistent element whose left end moves as u = A(1 − cos ωt): (ρ/3) ü₂ + u₂ = u₁ − (ρ/6) ü₁,
/// with the solution A + C cos ωt − (A + C) cos ω₀t, C = −A (1 + ω²/6)/(1 − ω²/3), ω₀² = 3.
/// Velocity and acceleration of the support are the formula's.
#[test]
fn a_moved_end_drives_its_neighbour_with_its_inertia() {
    let (a, omega, natural) = (0.01, 4.0_f64, 3.0_f64.sqrt());
    let c = -a * (1.0 + omega * omega / 6.0) / (1.0 - omega * omega / 3.0);
    for scheme in [
        r#"{ kind = "chung-hulbert", rho_inf = 1.0 }"#,
        r#"{ kind = "chung-hulbert", rho_inf = 0.2 }"#,
        r#"{ kind = "bdf2" }"#,
        r#"{ kind = "tr-bdf2" }"#,
        r#"{ kind = "bathe", rho_inf = 0.3 }"#,
        r#"{ kind = "energy-momentum" }"#,
    ] {
        let run = |step: f64| {
            let support =
                "[[support]]\nname = \"base\"\non = [\"bar.left\"]\nmove = { x = \"0.01*(1 - cos(4*t))\" }\n";
            let sim = finish(bar(&[&body(1, "consistent"), support, &time(1.0, step, scheme)].concat()));
            assert!((sim.state().v[0] - a * omega * omega.sin()).abs() < 1e-15, "{}", sim.state().v[0]);
            assert!((sim.state().a[0] - a * omega * omega * omega.cos()).abs() < 1e-14);
            let exact = a + c * omega.cos() - (a + c) * natural.cos();
            ((sim.state().y[1] - 1.0 - exact).abs(), sim.state().ledger.dissipation().abs())
        };
        let (coarse, fine) = (run(5e-3), run(2.5e-3));
        assert!(fine.0 < 1e-6 && (coarse.0 / fine.0).log2() > 1.9, "{scheme}: {coarse:?} {fine:?}");
        // The work of the support equals the energy input, with the order of the average F̄: second
        // at the midpoint of the step.
        let order = if scheme.contains("1.0") { 1.9 } else { 0.9 };
        assert!((coarse.1 / fine.1).log2() > order, "{scheme}: {coarse:?} {fine:?}");
    }
}

/// The two-step rule carries the means of the previous step: the impulse of loads and support over
/// all steps equals the momentum.
#[test]
fn means_over_two_steps_are_the_change_of_momentum() {
    let tables = "[[support]]\non = [\"bar.left\"]\nmove = { x = \"0.1*(1 - cos(4*t))\" }\n\
                [[load]]\non = [\"bar.right\"]\ntraction = [\"0.02*sin(7*t)\"]\n";
    let dt = 0.01;
    let mut sim = bar(&[&body(5, "consistent"), tables, &time(1.0, dt, r#"{ kind = "bdf2" }"#)].concat());
    let momentum = |sim: &Simulation, v: &[f64]| {
        let mut p = vec![0.0; v.len()];
        sim.model().mass.multiply_into(v, &mut p);
        p.iter().sum::<f64>()
    };
    while !sim.finished() {
        let before = sim.state().v.clone();
        sim.advance(&mut GridReport::default()).unwrap();
        let means = &sim.state().previous.as_ref().unwrap().means;
        let given = dt * means.loads.iter().chain(&means.supports).sum::<f64>();
        // The support's velocity change beyond its mean acceleration is part of its impulse.
        let mut change: Vec<f64> = sim.state().v.iter().zip(&before).map(|(v, old)| v - old).collect();
        let smooth = momentum(&sim, &change);
        change.fill(0.0);
        change[0] = sim.state().v[0] - before[0] - dt * means.accelerations[0];
        let error = smooth - given - momentum(&sim, &change);
        assert!(error.abs() < 1e-13, "t = {}: {error:e}", sim.state().time);
    }
}

/// With the discrete gradient the work of loads, even sudden ones, equals the change of energy in
/// each step.
#[test]
fn the_conserving_scheme_balances_loads_that_change() {
    let load = "[[load]]\non = [\"bar.right\"]\ntraction = [\"0.2*sin(9*t)\"]\n";
    // On a linear bar without contact the midpoint rule is the same.
    for scheme in [r#"{ kind = "energy-momentum" }"#, r#"{ kind = "moreau-jean", theta = 0.5 }"#] {
        let mut sim = bar(&[&body(7, "consistent"), HELD, load, &time(2.0, 0.02, scheme)].concat());
        while !sim.finished() {
            sim.advance(&mut GridReport::default()).unwrap();
            assert!(sim.state().ledger.dissipation().abs() < 1e-13, "{:e}", sim.state().ledger.dissipation());
        }
        assert!(sim.state().ledger.external_work.abs() > 1e-4);
    }
}

/// A support that starts abruptly supplies energy and does not stop the run: no energy is created
/// where its velocity jumps.
#[test]
fn a_velocity_that_jumps_takes_its_impulse_from_the_support() {
    let support = "[[support]]\non = [\"bar.left\"]\nmove = { x = \"0.1*max(0, min(t - 0.2, 0.3))\" }\n";
    let scheme = r#"{ kind = "chung-hulbert", rho_inf = 0.5 }"#;
    let mut sim = bar(&[&body(50, "consistent"), support, &time(1.5, 5e-3, scheme)].concat());
    while !sim.finished() {
        sim.advance(&mut GridReport::default()).unwrap_or_else(|stopped| panic!("{stopped}"));
        let ledger = &sim.state().ledger;
        assert!(ledger.drift() <= 0.005 * ledger.largest, "t = {}: {:e}", sim.state().time, ledger.drift());
    }
    assert!((sim.state().y[0] - 0.03).abs() < 1e-16 && sim.state().v[0] == 0.0);
}

/// A block under all loads at once: the reactions balance the applied forces, and in the deformed
/// configuration their moments too (neo-Hookean, follower pressure).
#[test]
fn reactions_are_the_applied_loads() {
    let text = r#"
dimension = 2
thickness = 0.5
[[material]]
name = "rubber"
law = "neo-hookean"
density = 1.0
lambda = 200.0
mu = 100.0
[[body]]
name = "block"
material = "rubber"
element = "T6"
mesh = { shape = "rectangle", min = [0.0, 0.0], max = [2.0, 1.0], cells = [4, 2] }
[[support]]
name = "floor"
on = ["block.bottom"]
fix = ["x", "y"]
[[load]]
on = ["block.top"]
traction = ["3*t", "-2*X*t"]
[[load]]
on = ["block.left", "block.right"]
pressure = "5*t*(1 + Y)"
[[load]]
body = "block"
body_force = ["0.3*X*t", "-Y*t"]
[time]
end = 1.0
step = 0.25
scheme = { kind = "static" }
[newton]
tolerance = 1e-13
"#;
    let sim = finish(simulation(text));
    let (model, state) = (&sim.model(), &sim.state());
    let (mut reaction, mut moment, mut size) = ([0.0; 2], 0.0, 0.0);
    let (mut load, mut load_moment) = ([0.0; 2], 0.0);
    for node in 0..model.dofs() / 2 {
        let [x, y] = [state.y[2 * node], state.y[2 * node + 1]];
        let at = |f: &[f64]| [f[2 * node], f[2 * node + 1]];
        let (fi, fe) = (at(&state.f_internal), at(&state.f_external));
        size += fe[0].abs() + fe[1].abs();
        load = [load[0] + fe[0], load[1] + fe[1]];
        load_moment += x * fe[1] - y * fe[0];
        if model.fixed[2 * node] {
            let r = [fi[0] - fe[0], fi[1] - fe[1]];
            reaction = [reaction[0] + r[0], reaction[1] + r[1]];
            moment += x * r[1] - y * r[0];
        }
    }
    // Reactions differ from the loads by Newton's residual: here its tolerance is the bound.
    assert!(
        (reaction[0] + load[0]).abs() + (reaction[1] + load[1]).abs() < 1e-12 * size,
        "{reaction:?} {load:?}"
    );
    assert!((moment + load_moment).abs() < 1e-12 * size);
    // Dead loads by hand: 3 × 2 × ½ on the top and 0.3 × ∫X = 0.3 × 2 × ½ in the volume; the
    // pressure follows the sides.
    let mut dead = carom_run::model::LoadsAt::default();
    let mut force = vec![0.0; model.dofs()];
    model.loads_into(1.0, &model.reference, &mut dead, &mut force).unwrap();
    let total = force.as_chunks::<2>().0.iter().fold([0.0, 0.0], |s, f| [s[0] + f[0], s[1] + f[1]]);
    assert!((total[0] - 3.3).abs() < 1e-13 && (total[1] + 2.0 + 0.5).abs() < 1e-13, "{total:?}");
}

/// Newmark's ¼, ½ conserves K + U − Σ ½(F₀ + F₁)Δy of a linear body under a varying load to
/// round-off for any Δt. The guard stops none of the others, not even in the first step.
#[test]
fn a_changing_load_creates_nothing() {
    for (load, step) in [("0.1*cos(5*t)", 0.02), ("0.1*sin(3*t)^4", 0.01)] {
        let load = format!("[[load]]\non = [\"bar.right\"]\ntraction = [\"{load}\"]\n");
        let end = |scheme: &str| {
            finish(bar(&[&body(4, "lumped"), HELD, &load, &time(4.0, step, scheme)].concat()))
                .into_state()
                .ledger
        };
        let ledger = end(r#"{ kind = "newmark", beta = 0.25, gamma = 0.5 }"#);
        assert!(ledger.drift().abs() < 1e-12 * ledger.largest, "{ledger:?}");
        assert_eq!(ledger.unbooked, 0.0);
        for scheme in [
            r#"{ kind = "hu" }"#,
            r#"{ kind = "chung-hulbert", rho_inf = 0.6 }"#,
            r#"{ kind = "hht", alpha = 0.25 }"#,
        ] {
            let ledger = end(scheme);
            assert!(ledger.drift() < ledger.unbooked.max(0.0), "{scheme}: {ledger:?}");
        }
    }
}

/// With α_m = α_f = 0 the energy H = E + ½ (β − γ/2) Δt² a·Ma of a linear body (Krenk 2006) changes
/// by the work that was not booked and by what the scheme dissipates,
/// −(γ − ½) [Δy·KΔy + (β − γ/2) Δt² Δa·MΔa], in every step: nothing else is created, whichever way
/// the load changes.
#[test]
fn the_energy_of_a_scheme_gains_the_work_that_was_not_booked() {
    let damped = 0.25 * (1.0 + 1.0 / 4.0_f64).powi(2);
    for (scheme, beta, gamma) in [
        (r#"{ kind = "hu" }"#.to_owned(), 1.0, 1.5),
        (r#"{ kind = "newmark", beta = 0.25, gamma = 0.5 }"#.to_owned(), 0.25, 0.5),
        (format!(r#"{{ kind = "newmark", beta = {damped}, gamma = 0.75 }}"#), damped, 0.75),
    ] {
        for load in ["0.1*cos(5*t)", "0.1*sin(3*t)^4"] {
            let (dt, share) = (0.02, beta - 0.5 * gamma);
            let load = format!("[[load]]\non = [\"bar.right\"]\ntraction = [\"{load}\"]\n");
            let mut sim = bar(&[&body(4, "lumped"), HELD, &load, &time(4.0, dt, &scheme)].concat());
            let (mut missed, mut least, mut lent) = (0.0_f64, f64::INFINITY, 0.0_f64);
            while !sim.finished() {
                let before = sim.state().clone();
                assert_eq!(sim.step().unwrap().rejected, 0, "{scheme} {load}");
                let (model, now) = (sim.model(), sim.state());
                let own = |state: &State| {
                    state.ledger.total() - state.ledger.external_work
                        + share * dt * dt * model.kinetic(&state.a)
                };
                let change = |now: &[f64], before: &[f64]| -> Vec<f64> {
                    now.iter().zip(before).map(|(now, before)| now - before).collect()
                };
                let strained = dot(&change(&now.y, &before.y), &change(&now.f_internal, &before.f_internal));
                let shaken = 2.0 * model.kinetic(&change(&now.a, &before.a));
                let lost = (gamma - 0.5) * (strained + share * dt * dt * shaken);
                let unbooked = now.ledger.unbooked - before.ledger.unbooked;
                missed = missed.max((own(now) - own(&before) - unbooked + lost).abs());
                (least, lent) = (least.min(lost), lent.max(now.ledger.unbooked.abs()));
            }
            let scale = sim.state().ledger.scale();
            assert!(missed < 1e-13 * scale, "{scheme} {load}: {missed:e} of {scale:e}");
            assert!(
                least >= -1e-15 * scale && (lent > 1e-4 * scale || gamma == 0.5),
                "{scheme} {load}: {least:e} {lent:e}"
            );
        }
    }
}

/// A load that grows smoothly from rest presses a block on a plane: no scheme of one stage creates
/// energy, and the guard shortens no step, although the first energies are 1e-16 of the last ones.
/// (Composite schemes err at third order: under t⁴ their work misses 1/n² of itself in step n.)
#[test]
fn a_smooth_press_is_not_shortened() {
    let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../cases/order/pressed.toml");
    for (scheme, _) in schemes(false) {
        let case = Case::from_file(&path, &[&format!("time.scheme={scheme}")]).unwrap();
        if case.time.scheme.kernel().is_none_or(|kernel| kernel.stages() > 1) {
            continue;
        }
        let mut sim = Setup::new(&case).start().unwrap();
        while !sim.finished() {
            let report = sim.step().unwrap();
            assert_eq!(report.rejected, 0, "{scheme} at t = {}", sim.state().time);
        }
        let ledger = &sim.state().ledger;
        assert!(ledger.created.most() < 1e-4 * ledger.scale(), "{scheme}: {ledger:?}");
    }
}

/// Gravity that varies is a load without a potential. In each step the force in the balance does
/// the work g M·Δy, from the masses of the model alone, and with it a bar that vibrates by the
/// midpoint or the trapezoidal rule loses no energy.
#[test]
fn the_work_of_gravity_that_varies_closes_the_energy_balance() {
    let g = |t: f64| -0.3 * (3.0 * t).sin();
    let mean = |from: f64, to: f64| 0.5 * (g(from) + g(to));
    let trapezoidal = r#"{ kind = "newmark", beta = 0.25, gamma = 0.5 }"#;
    let schemes: [(&str, &dyn Fn(f64, f64) -> f64); 4] = [
        (r#"{ kind = "chung-hulbert", rho_inf = 1.0 }"#, &mean),
        (r#"{ kind = "energy-momentum" }"#, &|from, to| g(0.5 * (from + to))),
        (trapezoidal, &mean),
        (r#"{ kind = "static" }"#, &mean),
    ];
    for (scheme, force) in schemes {
        let weight = "gravity = [\"-0.3*sin(3*t)\"]\n";
        let text = [&body(20, "consistent"), weight, HELD, &time(5.0, 0.02, scheme)].concat();
        let mut sim = bar(&text);
        assert_eq!(sim.model().gravity, vec![0.0; sim.model().dofs()]);
        let mut masses = vec![0.0; sim.model().dofs()];
        sim.model().mass.multiply_into(&vec![1.0; masses.len()], &mut masses);
        let mut work = 0.0;
        while !sim.finished() {
            let before = sim.state().y.clone();
            let time = sim.state().time;
            sim.advance(&mut GridReport::default()).unwrap();
            let state = sim.state();
            let moved = state.y.iter().zip(&before).zip(&masses).map(|((y, old), m)| m * (y - old));
            work += force(time, state.time) * moved.sum::<f64>();
            let ledger = &state.ledger;
            assert!((ledger.external_work - work).abs() < 1e-14, "{scheme}: {work}");
            let lost = ledger.dissipation();
            assert!(lost.abs() < 1e-14, "{scheme}: {lost:e}");
        }
    }
}

/// A component that is a formula without t is constant, and has a potential.
#[test]
fn a_formula_that_is_a_number_is_constant_gravity() {
    let text = |gravity: &str| {
        let weight = format!("gravity = [{gravity}]\n");
        [&body(4, "lumped"), weight.as_str(), &time(0.5, 0.1, r#"{ kind = "hu" }"#)].concat()
    };
    let [number, formula] = ["-9.81", "\"-9.81\""].map(|gravity| finish(bar(&text(gravity))));
    assert_eq!(number.state(), formula.state());
    assert!(number.state().ledger.potential < -1.0);
}

/// A support of a linear bar begins to move within a step. With consistent masses its impulse acts
/// on its neighbour, too: by the trapezoidal rule nothing is lost or created.
#[test]
fn a_velocity_that_jumps_within_a_step_creates_nothing() {
    let text = r#"
dimension = 1
material = [{ name = "m", law = "linear-elastic", density = 1.0, young = 900.0, poisson = 0.0 }]
[[body]]
name = "bar"
material = "m"
element = "L2"
mesh = { shape = "interval", min = 0.0, max = 10.0, cells = 20 }
[[support]]
name = "end"
on = ["bar.left"]
move = { x = "if(t < 0.5, 0, 20*(t - 0.5))" }
[time]
end = 2.0
step = 8e-3
scheme = { kind = "newmark", beta = 0.25, gamma = 0.5 }
"#;
    let mut sim = common::simulation(text, &[""; 0]);
    while !sim.finished() {
        let report = sim.step().unwrap();
        assert_eq!(report.rejected, 0);
    }
    let ledger = &sim.state().ledger;
    assert!(ledger.external_work > 1000.0);
    assert!(ledger.drift().abs() < 1e-12 * ledger.largest, "{ledger:?}");
}

/// A cell that is shaken, with consistent masses: its motion is of second order, and so is the work
/// of the support. It is not resonant; a damped scheme takes less than a thousandth of the energy.
#[test]
fn a_support_that_shakes_works_to_second_order() {
    let text = r#"
dimension = 1
material = [{ name = "m", law = "linear-elastic", density = 3.0, young = 40.0, poisson = 0.0 }]
body = [{ name = "cell", material = "m", element = "L2", mesh = { shape = "interval", min = 0.0, max = 1.0, cells = 1 } }]
support = [{ name = "end", on = ["cell.left"], move = { x = "0.05*(1 - cos(4.3*t))" } }]
time = { end = 40.0, step = 0.01, scheme = { kind = "chung-hulbert", rho_inf = 0.5 } }
"#;
    let ledger = finish(simulation(text)).into_state().ledger;
    assert!(ledger.dissipation().abs() < 1e-3 * ledger.largest, "{ledger:?}");
}

#[test]
fn a_facet_is_loaded_once() {
    let load = "[[load]]\non = [\"bar.left\", \"bar.right\", \"bar.right\"]\ntraction = [1.0]\n";
    let text = format!(
        "dimension = 1\nmaterial = [{{ name = \"unit\", law = \"linear-elastic\", density = 1.0, young = 1.0, poisson = 0.0 }}]\n{}{load}{}",
        body(2, "lumped"),
        time(1.0, 0.1, r#"{ kind = "bdf2" }"#)
    );
    let problems = Setup::new(&common::case(&text, &[""; 0])).build().err().unwrap();
    assert_eq!(problems[0].path, "load[0].on[2]");
    assert!(problems[0].what.contains("\"bar.right\" is named twice"), "{}", problems[0].what);
}

/// The velocity of a support of a lumped bar in uniform motion jumps where a step ends: its impulse
/// M Δv works at the mean velocity, which the path of the step does not have.
#[test]
fn a_velocity_that_jumps_between_steps_works_at_its_mean() {
    let text = |moved: &str, velocity: f64, scheme: &str| {
        format!(
            r#"
            dimension = 1
            material = [{{ name = "m", law = "linear-elastic", density = 2.0, young = 1.0, poisson = 0.0 }}]
            support = [{{ name = "end", on = ["bar.left"], move = {{ x = "{moved}" }} }}]
            time = {{ end = 1.0, step = 0.1, scheme = {scheme} }}
            [[body]]
            name = "bar"
            material = "m"
            element = "L2"
            mass = "lumped"
            velocity = [{velocity}]
            mesh = {{ shape = "interval", min = 0.0, max = 10.0, cells = 10 }}
            "#
        )
    };
    // The kinetic energy of the supported node, which has half of the mass 2 of its cell.
    let change = 0.5 * 1.0 * 0.2 * 0.2;
    for scheme in [
        r#"{ kind = "backward-euler" }"#,
        r#"{ kind = "newmark", rho_inf = 1.0 }"#,
        r#"{ kind = "bathe", rho_inf = 0.5 }"#,
    ] {
        for (moved, velocity, work) in
            [("if(t < 1, 0.2*t, 0.2)", 0.2, -change), ("if(t < 1, 0, 0.2*(t - 1))", 0.0, change)]
        {
            let sim = finish(simulation(&text(moved, velocity, scheme)));
            let ledger = &sim.state().ledger;
            assert!((ledger.external_work - work).abs() < 1e-12, "{scheme}: {ledger:?}");
            assert!(ledger.dissipation().abs() < 1e-12, "{scheme}: {ledger:?}");
        }
    }
}
