//! Loads and moving supports against exact solutions: waves, oscillators, equilibria.

use carom::{GridReport, Simulation};

use super::common::{self, case as case_of, finish};

/// A bar of length 1, E = ρ = A = 1, held at the left; the rest is given.
fn bar(rest: &str) -> Simulation {
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

fn body(cells: usize, mass: &str) -> String {
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

const HELD: &str = "[[support]]\nname = \"wall\"\non = [\"bar.left\"]\nfix = [\"x\"]\n";

fn time(end: f64, step: f64, scheme: &str) -> String {
    format!("[time]\nend = {end:?}\nstep = {step:?}\nscheme = {scheme}\n")
}

/// D'Alembert: under a sudden end force F the tip moves at cF/(EA) until the wave returns at 2L/c, then as fast back. The work of a constant force
/// is F times the way, and the trapezoidal rule keeps the energy.
#[test]
fn a_bar_under_a_sudden_end_force_carries_the_exact_wave() {
    let load = "[[load]]\non = [\"bar.right\"]\ntraction = [0.001]\n";
    let scheme = r#"{ kind = "newmark", beta = 0.25, gamma = 0.5 }"#;
    let mut sim = bar(&[&body(400, "lumped"), HELD, load, &time(3.0, 1.25e-3, scheme)].concat());
    let tip = sim.model.dofs() - 1;
    while !sim.finished() {
        sim.advance(&mut GridReport::default()).unwrap();
        let moved = sim.state.y[tip] - 1.0;
        let t = sim.state.time;
        let exact = 1e-3 * if t < 2.0 { t } else { 4.0 - t };
        assert!((moved - exact).abs() < 2e-5, "t = {t}: {moved} against {exact}");
        let ledger = &sim.state.ledger;
        assert!((ledger.external_work - 1e-3 * moved).abs() < 1e-15);
        assert!(ledger.dissipation().abs() < 1e-14, "{:e}", ledger.dissipation());
    }
}

/// One lumped element is the oscillator m ü + k u = F cos ωt with m = ½, k = 1: u = F/(k − mω²) (cos ωt − cos ω₀t) from rest.
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
            (sim.state.y[1] - 1.0 - exact).abs()
        };
        let (coarse, fine) = (error(5e-3), error(2.5e-3));
        assert!(fine < 1e-6 && (coarse / fine).log2() > 1.9, "{scheme}: {coarse:e} {fine:e}");
    }
}

/// One consistent element whose left end moves as u = A(1 − cos ωt): (ρ/3) ü₂ + u₂ = u₁ − (ρ/6) ü₁, with the solution
/// A + C cos ωt − (A + C) cos ω₀t, C = −A (1 + ω²/6)/(1 − ω²/3), ω₀² = 3. The support's velocity and acceleration are the formula's.
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
            let support = "[[support]]\nname = \"base\"\non = [\"bar.left\"]\nmove = { x = \"0.01*(1 - cos(4*t))\" }\n";
            let sim = finish(bar(&[&body(1, "consistent"), support, &time(1.0, step, scheme)].concat()));
            assert!((sim.state.v[0] - a * omega * omega.sin()).abs() < 1e-15, "{}", sim.state.v[0]);
            assert!((sim.state.a[0] - a * omega * omega * omega.cos()).abs() < 1e-14);
            let exact = a + c * omega.cos() - (a + c) * natural.cos();
            ((sim.state.y[1] - 1.0 - exact).abs(), sim.state.ledger.dissipation().abs())
        };
        let (coarse, fine) = (run(5e-3), run(2.5e-3));
        assert!(fine.0 < 1e-6 && (coarse.0 / fine.0).log2() > 1.9, "{scheme}: {coarse:?} {fine:?}");
        // The work of the support is the energy it brings in, with the order of the average F̄: second in the middle of the step.
        let order = if scheme.contains("1.0") { 1.9 } else { 0.9 };
        assert!((coarse.1 / fine.1).log2() > order, "{scheme}: {coarse:?} {fine:?}");
    }
}

/// The two-step rule carries the means of the step before: loads and the support's force, over all steps, are the momentum.
#[test]
fn means_over_two_steps_are_the_change_of_momentum() {
    let rest = "[[support]]\non = [\"bar.left\"]\nmove = { x = \"0.1*(1 - cos(4*t))\" }\n\
                [[load]]\non = [\"bar.right\"]\ntraction = [\"0.02*sin(7*t)\"]\n";
    let dt = 0.01;
    let mut sim = bar(&[&body(5, "consistent"), rest, &time(1.0, dt, r#"{ kind = "bdf2" }"#)].concat());
    let momentum = |sim: &Simulation, v: &[f64]| {
        let mut p = vec![0.0; v.len()];
        sim.model.mass.multiply_into(v, &mut p);
        p.iter().sum::<f64>()
    };
    while !sim.finished() {
        let before = sim.state.v.clone();
        sim.advance(&mut GridReport::default()).unwrap();
        let means = &sim.state.previous.as_ref().unwrap().means;
        let given = dt * means.loads.iter().chain(&means.supports).sum::<f64>();
        // What the support's velocity changes beyond its mean acceleration is its impulse too.
        let mut change: Vec<f64> = sim.state.v.iter().zip(&before).map(|(v, old)| v - old).collect();
        let smooth = momentum(&sim, &change);
        change.fill(0.0);
        change[0] = sim.state.v[0] - before[0] - dt * means.accelerations[0];
        let error = smooth - given - momentum(&sim, &change);
        assert!(error.abs() < 1e-13, "t = {}: {error:e}", sim.state.time);
    }
}

/// With the discrete gradient all that loads and a sudden force bring is in the energies, step by step.
#[test]
fn the_conserving_scheme_balances_loads_that_change() {
    let load = "[[load]]\non = [\"bar.right\"]\ntraction = [\"0.2*sin(9*t)\"]\n";
    // On a linear bar the midpoint rule without contact is the same.
    for scheme in [r#"{ kind = "energy-momentum" }"#, r#"{ kind = "moreau-jean", theta = 0.5 }"#] {
        let mut sim = bar(&[&body(7, "consistent"), HELD, load, &time(2.0, 0.02, scheme)].concat());
        while !sim.finished() {
            sim.advance(&mut GridReport::default()).unwrap();
            assert!(sim.state.ledger.dissipation().abs() < 1e-13, "{:e}", sim.state.ledger.dissipation());
        }
        assert!(sim.state.ledger.external_work.abs() > 1e-4);
    }
}

/// A support that starts with a jerk brings in energy, never takes the run down: nothing is created where its velocity jumps.
#[test]
fn a_velocity_that_jumps_takes_its_impulse_from_the_support() {
    let support = "[[support]]\non = [\"bar.left\"]\nmove = { x = \"0.1*max(0, min(t - 0.2, 0.3))\" }\n";
    let scheme = r#"{ kind = "chung-hulbert", rho_inf = 0.5 }"#;
    let mut sim = bar(&[&body(50, "consistent"), support, &time(1.5, 5e-3, scheme)].concat());
    while !sim.finished() {
        sim.advance(&mut GridReport::default()).unwrap_or_else(|stopped| panic!("{stopped}"));
        let ledger = &sim.state.ledger;
        assert!(ledger.created() <= 0.005 * ledger.largest, "t = {}: {:e}", sim.state.time, ledger.created());
    }
    assert!((sim.state.y[0] - 0.03).abs() < 1e-16 && sim.state.v[0] == 0.0);
}

/// The end of a massless bar follows at once: u(x) = x u(t), force E A u(t).
#[test]
fn without_mass_a_moved_bar_is_in_equilibrium_at_every_time() {
    let support = "[[support]]\nname = \"pull\"\non = [\"bar.right\"]\nmove = { x = \"0.1*t^2\" }\n";
    let rest = [&body(5, "consistent"), HELD, support, &time(1.0, 0.05, r#"{ kind = "newmark", rho_inf = 1.0 }"#)];
    for scheme in [r#"{ kind = "newmark", rho_inf = 1.0 }"#, r#"{ kind = "static" }"#] {
        let mut sim = bar(&rest.concat().replace(rest[3], &time(1.0, 0.05, scheme)));
        if !scheme.contains("static") {
            sim = simulation(&format!("{MASSLESS}{}", rest.concat()));
        }
        while !sim.finished() {
            sim.advance(&mut GridReport::default()).unwrap();
            let u = 0.1 * sim.state.time * sim.state.time;
            for (y, x) in sim.state.y.iter().zip(&sim.model.reference) {
                assert!((y - x - x * u).abs() < 1e-14, "{scheme}");
            }
            assert!((sim.state.f_internal[0] + u).abs() < 1e-13);
            assert!((sim.state.ledger.strain - 0.5 * u * u).abs() < 1e-13);
        }
        // Trapezoids of the work are exact where force and way grow together; the massless balance at the step's end takes the end's force.
        if scheme.contains("static") {
            assert!(sim.state.ledger.dissipation().abs() < 1e-14, "{:e}", sim.state.ledger.dissipation());
            assert!(sim.state.v.iter().chain(&sim.state.a).all(|x| *x == 0.0) && sim.state.ledger.kinetic == 0.0);
        }
    }
}

const MASSLESS: &str = r#"
dimension = 1
[[material]]
name = "unit"
law = "linear-elastic"
density = 0.0
young = 1.0
poisson = 0.0
"#;

/// u(x) = ρg (L x − x²/2)/E, exact at the nodes of linear elements; as a body force and as gravity.
#[test]
fn a_bar_hangs_under_its_own_weight() {
    let time = time(1.0, 0.25, r#"{ kind = "static" }"#);
    let weight = "[[load]]\nname = \"weight\"\nbody = \"bar\"\nbody_force = [\"0.02*t\"]\n";
    let sim = finish(bar(&[&body(8, "consistent"), HELD, weight, &time].concat()));
    let gravity = body(8, "consistent") + "gravity = [0.02]\n";
    let other = finish(bar(&[&gravity, HELD, &time].concat()));
    for sim in [&sim, &other] {
        for (y, x) in sim.state.y.iter().zip(&sim.model.reference) {
            assert!((y - x - 0.02 * (x - 0.5 * x * x)).abs() < 1e-14);
        }
        assert!((sim.state.f_internal[0] - sim.model.gravity[0] - sim.state.f_external[0] + 0.02).abs() < 1e-12 * 0.02);
    }
    // A load that grows with its displacement does the work that becomes strain energy; trapezoids sum it exactly.
    let ledger = &sim.state.ledger;
    assert!((ledger.external_work - ledger.strain).abs() < 1e-15, "{ledger:?}");
}

/// A block under every load at once: the reactions are the applied forces, in the deformed place their moments too (neo-Hookean, pressure follows).
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
    let (model, state) = (&sim.model, &sim.state);
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
    // Reactions miss the loads by Newton's residual: here its tolerance is that of the claim.
    assert!((reaction[0] + load[0]).abs() + (reaction[1] + load[1]).abs() < 1e-12 * size, "{reaction:?} {load:?}");
    assert!((moment + load_moment).abs() < 1e-12 * size);
    // Dead loads by hand: 3 × 2 × ½ on the top and 0.3 × ∫X = 0.3 × 2 × ½ in the volume; the pressure's part follows the sides.
    let mut dead = carom::model::LoadsAt::default();
    let mut force = vec![0.0; model.dofs()];
    model.loads_into(1.0, &model.reference, &mut dead, &mut force).unwrap();
    let total = force.as_chunks::<2>().0.iter().fold([0.0, 0.0], |s, f| [s[0] + f[0], s[1] + f[1]]);
    assert!((total[0] - 3.3).abs() < 1e-13 && (total[1] + 2.0 + 0.5).abs() < 1e-13, "{total:?}");
}

/// A run taken up from its state in the middle ends with the same bits, loads, motions and bisected steps included.
#[test]
fn a_resumed_run_with_loads_and_motions_ends_with_the_same_bits() {
    let text = r#"
dimension = 2
[[material]]
name = "rubber"
law = "neo-hookean"
density = 1.0
lambda = 20.0
mu = 10.0
[[body]]
name = "block"
material = "rubber"
element = "T6"
mesh = { shape = "rectangle", min = [0.0, 0.0], max = [1.0, 1.0], cells = [3, 3] }
velocity = ["0", "0.1*X"]
[[support]]
on = ["block.bottom"]
fix = ["x"]
move = { y = "0.1*sin(3*t)" }
[[load]]
on = ["block.top"]
pressure = "2*sin(7*t)"
[[load]]
on = ["block.right"]
traction = ["0.5*t", 0]
[time]
end = 0.5
step = 0.01
scheme = { kind = "chung-hulbert", rho_inf = 0.5 }
energy_guard = false
"#;
    let case = case_of(text, &[""; 0]);
    for scheme in ["", "state"] {
        let mut case = case.clone();
        if !scheme.is_empty() {
            case.time.scheme.forces = carom_time::ForceRule::AverageState;
        }
        let mut whole = carom::simulation(&case, 1).unwrap();
        let mut kept = None;
        while !whole.finished() {
            if whole.state.step == 23 {
                kept = Some(postcard::to_stdvec(&whole.state).unwrap());
            }
            whole.advance(&mut GridReport::default()).unwrap();
        }
        let state = postcard::from_bytes(&kept.unwrap()).unwrap();
        let resumed = finish(carom::resumed(&case, 2, state).unwrap());
        assert_eq!(resumed.state, whole.state);
    }
}

/// A body that nothing holds is named; one that contact may hold is let, and named once contact does not.
#[test]
fn a_body_held_by_nothing_is_said_by_name() {
    let text = |support: &str, at: f64| {
        format!(
            r#"
dimension = 2
[[material]]
name = "rubber"
law = "neo-hookean"
density = 1.0
lambda = 20.0
mu = 10.0
[[body]]
name = "disc"
material = "rubber"
element = "T6"
mesh = {{ shape = "half-disc", radius = 0.5, center = [0.0, {at:?}], size = 0.125 }}
gravity = [0.0, -0.2]
{support}
[[contact]]
name = "floor"
secondary = "disc.arc"
primary = {{ plane = {{ point = [0.0, 0.0], normal = [0.0, 1.0] }} }}
[time]
end = 1.0
step = 0.5
scheme = {{ kind = "static" }}
"#
        )
    };
    let axis = "[[support]]\non = [\"disc.axis\"]\nfix = [\"x\"]\n";
    let case = case_of(&text("", 0.5), &[""; 0]);
    // Without its contact nothing could ever hold it: the case is wrong.
    let mut alone = case.clone();
    alone.contacts.clear();
    let problems = carom::simulation(&alone, 1).err().unwrap();
    assert!(problems[0].what.starts_with("body \"disc\" is free to"), "{problems:?}");
    // With a gap it falls: said by name, with what to try.
    let stopped = simulation(&text(axis, 0.6)).advance(&mut GridReport::default()).unwrap_err().to_string();
    assert!(stopped.contains("body \"disc\" is free to move along y"), "{stopped}");
    assert!(stopped.contains("`move`"), "{stopped}");
    // Touching, it rests on the floor with its weight.
    let sim = finish(simulation(&text(axis, 0.5)));
    let weight: f64 = sim.model.gravity.iter().skip(1).step_by(2).sum();
    assert!(
        (sim.state.contact_forces[0][1] + weight).abs() < 1e-9 * weight.abs(),
        "{:?} {weight}",
        sim.state.contact_forces
    );
}

/// A block pressed by a moved support springs back from where the press left it: [initial] takes positions and the contact over.
#[test]
fn a_run_begins_where_another_ended() {
    let folder = tempfile::tempdir().unwrap();
    let text = |time: &str, initial: &str, motion: &str| {
        format!(
            r#"
dimension = 2
[[material]]
name = "rubber"
law = "neo-hookean"
density = 1.0
lambda = 20.0
mu = 10.0
[[body]]
name = "block"
material = "rubber"
element = "T6"
mesh = {{ shape = "rectangle", min = [0.0, 0.0], max = [1.0, 1.0], cells = [3, 3] }}
[[support]]
name = "press"
on = ["block.top"]
move = {{ x = 0, y = "{motion}" }}
[[contact]]
name = "floor"
secondary = "block.bottom"
primary = {{ plane = {{ point = [0.0, 0.0], normal = [0.0, 1.0] }} }}
{initial}
{time}
"#
        )
    };
    let statics = text(&time(1.0, 0.25, r#"{ kind = "static" }"#), "", "-0.1*t");
    let case = case_of(&statics, &[""; 0]);
    let source = carom_record::Source { text: statics.clone(), sets: Vec::new() };
    let options = carom::recording::Options { threads: 1 };
    let stop = std::sync::atomic::AtomicBool::new(false);
    let preload = folder.path().join("preload");
    carom::recording::run(&case, source, &preload, options, &mut |_| {}, &stop).unwrap();
    let pressed = finish(carom::simulation(&case, 1).unwrap());

    let initial = format!("[initial]\nfrom = {:?}\n", preload.display().to_string());
    let again = |motion: &str| text(&time(0.1, 1e-3, r#"{ kind = "chung-hulbert", rho_inf = 0.6 }"#), &initial, motion);
    let mut held = simulation(&again("-0.1"));
    assert_eq!(held.state.y, pressed.state.y);
    let force = pressed.state.contact_forces[0][1];
    assert!((held.state.contact_forces[0][1] - force).abs() < 1e-8 * force, "{:?} {force}", held.state.contact_forces);
    // It is in equilibrium: nothing moves.
    for _ in 0..20 {
        held.advance(&mut GridReport::default()).unwrap();
    }
    let moved = held.state.y.iter().zip(&pressed.state.y).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    assert!(moved < 1e-9, "{moved:e}");
    // A support that does not begin there, and another mesh, are refused.
    for (text, told) in [
        (again("0"), "a support would jump at the start"),
        (again("-0.1").replace("cells = [3, 3]", "cells = [3, 4]"), "body \"block\" has another mesh in"),
        (again("-0.1").replace("/preload", "/nowhere"), "cannot be started from"),
    ] {
        let problems = carom::simulation(&case_of(&text, &[""; 0]), 1).err().unwrap();
        assert!(problems[0].what.contains(told), "{problems:?}");
    }
}

/// Under a load that changes, the averaged force of a scheme with α_f ≠ ½ does another work than the load, by (½ − α_f) Σ Δy·ΔF, though nothing is
/// created. Newmark's ¼, ½ keeps K + U − Σ ½(F₀ + F₁)Δy of a linear body to round-off, whatever Δt. The guard stops none of them, from the first step on.
#[test]
fn a_changing_load_creates_nothing() {
    for (load, step) in [("0.1*cos(5*t)", 0.02), ("0.1*sin(3*t)^4", 0.01)] {
        let load = format!("[[load]]\non = [\"bar.right\"]\ntraction = [\"{load}\"]\n");
        let end = |scheme: &str| {
            finish(bar(&[&body(4, "lumped"), HELD, &load, &time(4.0, step, scheme)].concat())).state.ledger
        };
        let ledger = end(r#"{ kind = "newmark", beta = 0.25, gamma = 0.5 }"#);
        assert!((ledger.created() + 0.5 * ledger.open).abs() < 1e-12 * ledger.largest, "{ledger:?}");
        assert!(ledger.open.abs() > 1e-3 * ledger.largest, "{ledger:?}");
        for scheme in
            [r#"{ kind = "hu" }"#, r#"{ kind = "chung-hulbert", rho_inf = 0.6 }"#, r#"{ kind = "hht", alpha = 0.25 }"#]
        {
            let ledger = end(scheme);
            assert!(ledger.created() < ledger.open.abs(), "{scheme}: {ledger:?}");
        }
    }
}
