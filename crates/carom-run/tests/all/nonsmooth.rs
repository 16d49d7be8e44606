//! Explicit and impulse steppers in the plane: identities that hold to round-off, their order, and
//! the impact of cases/impact.

use carom_run::stability::{SAFETY, stable_step};
use carom_run::{GridReport, State};
use carom_time::{Integrator, Nonsmooth};

use super::common::{DISCS, case, dot, finish, momenta, on_threads, restored, schemes, simulation};

const IMPACT: &str = include_str!("../../../../cases/impact/impact.toml");
const COARSE: [&str; 4] = [
    "body.cylinder.mesh.size=0.25",
    "body.prism.mesh.cells=[4,2]",
    "body.cylinder.mass=lumped",
    "body.prism.mass=lumped",
];

#[test]
fn free_fall_is_that_of_the_scheme() {
    for (scheme, member) in schemes(true) {
        let scheme = format!("time.scheme={scheme}");
        let sim =
            finish(simulation(IMPACT, &[&COARSE[..], &[&scheme, "time.end=0.3", "time.step=3e-4"]].concat()));
        let late = (member.falls)(sim.state().step as f64) * sim.dt() * sim.dt();
        let fallen = 9.81 * (0.5 * sim.state().time * sim.state().time + late);
        for node in sim.model().parts[0].nodes() {
            let error = (sim.state().y[2 * node + 1] - (sim.model().reference[2 * node + 1] - fallen)).abs();
            assert!(error < 1e-12, "{scheme}: {error:e}");
            assert!((sim.state().v[2 * node + 1] + 9.81 * sim.state().time).abs() < 1e-11, "{scheme}");
        }
    }
}

const BLOCK: &str = r#"
title = "A block thrown off its foot"
dimension = 2
[[material]]
name = "rubber"
law = "neo-hookean"
density = 0.25
lambda = 200.0
mu = 15.0
[[body]]
name = "block"
material = "rubber"
element = "T6"
mass = "lumped"
mesh = { shape = "rectangle", min = [0.0, 0.0], max = [1.0, 1.0], cells = [1, 1] }
velocity = [2.0, 1.0]
[[support]]
on = ["block.bottom"]
fix = ["x", "y"]
[time]
end = 0.16
step = 1e-3
scheme = { kind = "hu" }
energy_guard = false
"#;

/// Observed order on smooth motion with large strain, against Chung and Hulbert with ρ∞ = 1 at a
/// step 32 times smaller than the finest here.
#[test]
fn orders_on_smooth_nonlinear_motion_are_those_claimed() {
    let end = |scheme: &str, step: f64| {
        let (scheme, step) = (format!("time.scheme={scheme}"), format!("time.step={step:e}"));
        let sim = finish(simulation(BLOCK, &[&scheme, &step]));
        let state = sim.into_state();
        (state.y, state.v)
    };
    let exact = end("{ kind = \"chung-hulbert\", rho_inf = 1.0 }", 1e-3 / 128.0);
    let moved = exact
        .0
        .iter()
        .zip(&simulation(BLOCK, &[""; 0]).state().y)
        .map(|(a, b)| (a - b).abs())
        .fold(0.0, f64::max);
    assert!(moved > 0.15, "{moved}");
    for (scheme, member) in schemes(true) {
        let error = |step: f64| {
            let (y, v) = end(&scheme, step);
            let of = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| (a - b).powi(2)).sum::<f64>().sqrt();
            [of(&y, &exact.0), of(&v, &exact.1)]
        };
        let (coarse, fine) = (error(1e-3 / 2.0), error(1e-3 / 4.0));
        for k in 0..2 {
            let observed = (coarse[k] / fine[k]).log2();
            assert!(
                (observed - f64::from(member.order)).abs() < 0.15,
                "{scheme}: order {observed} of {}",
                ["y", "v"][k]
            );
        }
    }
}

/// Every scheme conserves momentum through contact. Explicit schemes also conserve the angular
/// momentum of v_{n+½}, since every force at t_n balances at y_n; the ledger's dissipation is as
/// documented.
#[test]
fn two_discs_keep_their_momentum() {
    for (scheme, member) in schemes(true) {
        let mut sim = simulation(DISCS, &[&format!("time.scheme={scheme}")]);
        let explicit = member.rho_inf.is_infinite();
        let size = 1.5 * sim.model().parts.iter().map(|p| p.total_mass).sum::<f64>();
        let (mut active, mut spin) = (0, None);
        while !sim.finished() {
            let before = sim.state().clone();
            sim.advance(&mut GridReport::default()).unwrap();
            let state = &sim.state();
            active = active.max(state.pairs[0].iter().filter(|p| p.active).count());
            let total = momenta(&sim, &state.v);
            assert!(
                total[0].abs() + total[1].abs() < 1e-12 * size,
                "{scheme} step {}: {total:?}",
                state.step
            );
            if explicit && before.step > 0 {
                let now = momenta(&sim, &state.half_step.velocity)[2];
                assert!(
                    (now - *spin.get_or_insert(now)).abs() < 1e-12 * size,
                    "{scheme} step {}: {now}",
                    state.step
                );
                let squares = |s: &State| {
                    let mut force = vec![0.0; s.a.len()];
                    sim.model().mass.multiply_into(&s.a, &mut force);
                    dot(&s.a, &force)
                };
                let moved: Vec<f64> = state.y.iter().zip(&before.y).map(|(a, b)| a - b).collect();
                let mean: Vec<f64> =
                    state.f_internal.iter().zip(&before.f_internal).map(|(a, b)| 0.5 * (a + b)).collect();
                let expected = dot(&moved, &mean)
                    - (state.ledger.strain - before.ledger.strain)
                    - 0.125 * sim.dt() * sim.dt() * (squares(state) - squares(&before));
                let booked = state.ledger.dissipation() - before.ledger.dissipation();
                assert!(
                    (booked - expected).abs() < 1e-12 * state.ledger.largest,
                    "{scheme}: {booked:e} {expected:e}"
                );
            }
            assert!(state.ledger.drift() < 0.02 * state.ledger.largest, "{scheme} {:?}", state.ledger);
        }
        let impulse = sim.state().impulse();
        let left: f64 = sim.model().parts[0]
            .nodes()
            .map(|n| sim.model().mass.row(n).map(|(_, m)| m).sum::<f64>() * sim.state().v[2 * n])
            .sum();
        let gained = left - 1.5 * sim.model().parts[0].total_mass;
        assert!((impulse[0] - gained).abs() < 1e-12 * size, "{scheme}: impulse {impulse:?}, gained {gained}");
        assert!(
            active >= 3 && left < -0.5 * 1.5 * sim.model().parts[0].total_mass,
            "{scheme}: {active} {left}"
        );
    }
}

/// Resumed from the serialised state during contact, and with another number of threads: bitwise
/// equal.
#[test]
fn resuming_in_contact_and_threads_change_no_bit() {
    for (scheme, _) in schemes(true) {
        let made = case(DISCS, &[&format!("time.scheme={scheme}")]).time.scheme.integrator().unwrap();
        let none =
            matches!(made, Integrator::Nonsmooth(Nonsmooth::Explicit(explicit), _) if !explicit.restitution);
        let restitution = if none { "0.0" } else { "0.5" };
        let sets = [
            &format!("time.scheme={scheme}"),
            &format!("contact.strike.restitution={restitution}"),
            "time.end=0.3",
            "time.energy_guard=false",
        ];
        let sets: Vec<&str> = sets.iter().map(|s| &**s).collect();
        let mut whole = simulation(DISCS, &sets);
        let mut bytes = Vec::new();
        while !whole.finished() {
            whole.advance(&mut GridReport::default()).unwrap();
            if bytes.is_empty() && whole.state().pairs[0].iter().filter(|p| p.active).count() >= 2 {
                bytes = postcard::to_stdvec(&whole.state()).unwrap();
            }
        }
        let state: State = postcard::from_bytes(&bytes).unwrap();
        assert!(state.step < whole.state().step);
        let resumed = finish(restored(on_threads(DISCS, &sets, 2), state));
        assert!(resumed.state() == whole.state(), "{scheme}");
    }
}

/// ½(Gv⁻ + Gv⁺)·P, the work of contact, is the energy loss due to e: none with e = 1 if every
/// contact reflects.
#[test]
fn restitution_one_keeps_the_energy_of_moreau_and_jean() {
    let left = |e: &str| {
        let sets = [
            "time.scheme={ kind = \"moreau-jean\", theta = 0.5 }",
            &format!("contact.strike.restitution={e}"),
        ];
        let sim = finish(simulation(DISCS, &sets));
        let ledger = &sim.state().ledger;
        (ledger.total() / ledger.total_at_start, ledger.contact_work / ledger.total_at_start)
    };
    let (inelastic, elastic) = (left("0.0"), left("1.0"));
    assert!(inelastic.1 < -1e-3 && elastic.1.abs() < 1e-10, "{inelastic:?} {elastic:?}");
    assert!((elastic.0 - 1.0).abs() < 0.01);
}

const PRESTRAINED: &str = r#"
dimension = 1
material = [{ name = "m", law = "linear-elastic", density = 1.0, young = 100.0, poisson = 0.0 }]
[[body]]
name = "bar"
material = "m"
element = "L2"
mesh = { shape = "interval", min = 0.0, max = 1.0, cells = 10 }
position = ["0.99*X"]
[[support]]
on = ["bar.right"]
fix = ["x"]
[[contact]]
name = "wall"
secondary = "bar.left"
primary = { plane = { point = [0.0], normal = [1.0] } }
[time]
end = 2.0
step = 0.01
scheme = { kind = "moreau-jean", theta = 0.5 }
"#;

/// A bar compressed by 1 % touches a wall, at rest: the force on it is E/100 for ever. It would be
/// released if a gap of zero were always an open one.
#[test]
fn a_prestrained_body_that_touches_at_rest_stays_there() {
    let mut sim = simulation(PRESTRAINED, &[] as &[&str]);
    let start = sim.state().y.clone();
    while !sim.finished() {
        sim.step().unwrap();
        assert!((sim.state().contact_forces[0][0] - 1.0).abs() < 1e-9, "{:?}", sim.state().contact_forces);
    }
    let moved = sim.state().y.iter().zip(&start).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    assert!(moved < 1e-12, "{moved:e}");
}

/// The stable step of a uniform bar of lumped linear elements is dx/c; that of a mesh lies between
/// the bound by cells and the onset of instability.
#[test]
fn the_stable_step_is_where_central_differences_blow_up() {
    let coarse = case(
        IMPACT,
        &[&COARSE[..], &["time.scheme={ kind = \"central-difference\" }", "time.step=3e-4"]].concat(),
    );
    let sim = carom_run::Setup::new(&coarse).start().unwrap();
    let stable = stable_step(sim.model(), &sim.state().configuration()).unwrap();
    assert!(stable.cell <= stable.power && stable.power < 3.0 * stable.cell, "{stable:?}");
    let step = format!("time.step={:e}", 0.75 / (0.75 / (0.99 * stable.power)).floor());
    let long =
        case(IMPACT, &[&COARSE[..], &["time.scheme={ kind = \"central-difference\" }", &step]].concat());
    let rejected = carom_run::Setup::new(&long).start().err().unwrap();
    assert!(rejected.len() == 1 && rejected[0].path == "time.step", "{rejected:?}");
    let (_, longest) = rejected[0].what.split_once("at most ").unwrap();
    let longest: f64 = longest.split_once(" s").unwrap().0.parse().unwrap();
    let ratio = longest / (SAFETY * stable.power);
    assert!((0.999..=1.0).contains(&ratio), "{rejected:?}");
}

/// A bar that starts compressed to a fifth, P = μ (F − 1/F), has dP/dF = μ (1 + F⁻²), 13 times its
/// stiffness at rest: the stable step of lumped linear elements is h √(ρ/(dP/dF)).
#[test]
fn the_stable_step_is_that_of_the_start() {
    let bar = |step: f64| {
        let text = format!(
            r#"
dimension = 1
[[material]]
name = "m"
law = "neo-hookean"
density = 1.0
young = 1.0
poisson = 0.0
[[body]]
name = "bar"
material = "m"
element = "L2"
mass = "lumped"
mesh = {{ shape = "interval", min = 0.0, max = 1.0, cells = 40 }}
position = ["0.2*X"]
[[support]]
name = "walls"
on = ["bar.left", "bar.right"]
fix = ["x"]
[time]
end = {}
step = {step}
scheme = {{ kind = "central-difference" }}
"#,
            10.0 * step
        );
        case(&text, &[""; 0])
    };
    let stable = 1.0 / 40.0 / 13.0_f64.sqrt();
    let accepted = |share: f64| carom_run::Setup::new(&bar(share * stable)).start().is_ok();
    assert!(accepted(0.99 * SAFETY) && !accepted(1.01 * SAFETY));
}

/// The explicit impact of the paper: indentation and end of contact agree with two unrelated codes.
/// The step is 0.69 of the initial 2/ω_max; the cylinder stiffens in compression, and from about
/// 0.8 of it energy grows until the guard stops the run.
#[test]
fn the_impact_by_central_differences() {
    let lumped = [
        "body.cylinder.mass=lumped",
        "body.prism.mass=lumped",
        "time.scheme={ kind = \"central-difference\" }",
    ];
    let mut sim = simulation(IMPACT, &[&lumped[..], &["time.step=4e-4"]].concat());
    let top = (0..sim.model().dofs() / 2)
        .find(|&n| {
            sim.model().reference[2 * n] == 0.0 && (sim.model().reference[2 * n + 1] - 1.5).abs() < 1e-12
        })
        .unwrap();
    let (mut lowest, mut end, mut created) = (0.0_f64, 0.0, 0.0_f64);
    while !sim.finished() {
        sim.advance(&mut GridReport::default()).unwrap();
        lowest = lowest.min(sim.state().y[2 * top + 1] - 1.5);
        if sim.state().pairs[0].iter().any(|p| p.active) {
            end = sim.state().time;
        }
        created = created.max(sim.state().ledger.drift() / sim.state().ledger.largest);
    }
    assert!((lowest + 0.783).abs() < 0.004, "{lowest}");
    assert!((end - 0.555).abs() < 0.003, "{end}");
    assert!(created < 1e-4, "{created}");
}

/// A stiff rod, at 52° to a rough plane, strikes it with its lower end.
const ROD: &str = r#"
dimension = 2
plane = "strain"
material = [{ name = "stiff", law = "saint-venant-kirchhoff", density = 5.0, young = 1e7, poisson = 0.0 }]
[[body]]
name = "rod"
material = "stiff"
element = "T6"
mesh = { shape = "rectangle", min = [0.0, -0.05], max = [2.0, 0.05], cells = [10, 1] }
place = { rotate = 52.0, about = [0.0, 0.0], shift = [0.0, 0.05] }
velocity = [0.5, -1.0]
[[contact]]
name = "floor"
secondary = "rod.skin"
primary = { plane = { point = [0.0, 0.0], normal = [0.0, 1.0] } }
mu = 0.8
restitution = 1.0
[time]
end = 0.2
step = 0.01
scheme = { kind = "moreau-jean", theta = 1.0 }
"#;

/// Newton's restitution with friction: a rigid rod sticks at the impact, and Newton's law for the
/// normal velocity alone gives it 18.4 % of energy, 0.115 (a 2×2 problem with the inverse masses
/// W_nn = 1 + 3 cos², W_tt = 1 + 3 sin², W_nt = −3 sin cos of its end). The work of friction is
/// positive. The guard rejects that step. Without restitution none is created.
#[test]
fn restitution_with_friction_can_create_energy() {
    let (sin, cos) = 52.0_f64.to_radians().sin_cos();
    let (nn, tt, nt) = (1.0 + 3.0 * cos * cos, 1.0 + 3.0 * sin * sin, -3.0 * sin * cos);
    // Impulses for v_n from −1 to 1, and v_t from 0.5 to 0.
    let determinant = nn * tt - nt * nt;
    let [normal, along] = [(2.0 * tt + 0.5 * nt) / determinant, (-0.5 * nn - 2.0 * nt) / determinant];
    let created = 0.5 * 0.5 * along;
    assert!(along.abs() < 0.8 * normal && (created - 0.184_232_86 * 0.625).abs() < 1e-6, "{created}");

    let guarded = finish(simulation(ROD, &[] as &[&str]));
    let ledger = &guarded.state().ledger;
    assert!(ledger.created() < 0.02 * ledger.scale() && ledger.total() < 0.625, "{ledger:?}");
    let work = |sets: &[&str]| finish(simulation(ROD, sets)).state().ledger.friction_work;
    let found = work(&["time.energy_guard=false"]);
    assert!((found - created).abs() < 0.15 * created, "{found} and {created}");
    let plastic = finish(simulation(ROD, &["contact.floor.restitution=0.0", "time.energy_guard=false"]));
    assert!(plastic.state().ledger.total() < 0.625);
}

/// A sliding block whose friction grows with time: in every step the impulse of friction is that of
/// the coefficient in its middle.
#[test]
fn a_coefficient_that_depends_on_time_is_that_in_the_middle_of_the_step() {
    const SLIDES: &str = r#"
dimension = 2
material = [{ name = "m", law = "neo-hookean", density = 1000.0, young = 1e6, poisson = 0.0 }]
[[body]]
name = "b"
material = "m"
element = "Q4"
mesh = { shape = "rectangle", min = [-1.0, 0.0], max = [1.0, 0.1], cells = [8, 2] }
velocity = [1.0, 0.0]
gravity = [0.0, -10.0]
[[contact]]
name = "f"
secondary = "b.bottom"
mu = "2*t"
primary = { plane = { point = [0.0, 0.0], normal = [0.0, 1.0] } }
[time]
end = 0.2
step = 0.004
scheme = { kind = "hu" }
"#;
    for scheme in [
        "time.scheme={ kind = \"moreau-jean\", theta = 0.5 }",
        "time.scheme={ kind = \"nonsmooth-generalized-alpha\", rho_inf = 0.8 }",
    ] {
        let mut sim = simulation(SLIDES, &[scheme]);
        let mut expected = 0.0;
        while !sim.finished() {
            let before = sim.state().impulse()[1];
            let middle = sim.state().time + 0.002;
            sim.advance(&mut GridReport::default()).unwrap();
            expected -= 2.0 * middle * (sim.state().impulse()[1] - before);
        }
        let found = sim.state().impulse()[0];
        assert!(expected < -20.0 && (found / expected - 1.0).abs() < 1e-9, "{scheme}: {found} {expected}");
    }
}
