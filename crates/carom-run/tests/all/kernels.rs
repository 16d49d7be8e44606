//! Kernels in the real stepper: their maps, orders, recorded impulse and memory.

use carom_run::{GridReport, Means, Previous, State};
use carom_time::map;

use super::common::{case, change, finish, restored, schemes, simulation};

/// A spring of one cell, its left end fixed.
const SPRING: &str = r#"
dimension = 1
[[material]]
name = "steel"
law = "linear-elastic"
density = 4.0
young = 50.0
poisson = 0.0
[[body]]
name = "bar"
material = "steel"
element = "L2"
mesh = { shape = "interval", min = 0.0, max = 1.0, cells = 1 }
mass = "lumped"
[[support]]
on = ["bar.left"]
fix = ["x"]
[time]
end = 1.0
step = 0.125
scheme = { kind = "hu" }
energy_guard = false
"#;

/// One dof in the solver reproduces every entry of the analysis' amplification matrix, hence every
/// invariant.
#[test]
fn one_dof_is_amplified_as_the_analysis_says() {
    let (dt, mass, stiffness) = (0.125, 2.0, 50.0_f64);
    let omega_dt = dt * (stiffness / mass).sqrt();
    for (scheme, _) in schemes(false) {
        let scheme = format!("time.scheme={scheme}");
        let kernel = case(SPRING, &[&scheme]).time.scheme.kernel().unwrap();
        let want = map::amplification(&*kernel, omega_dt);
        for column in 0..want.len() {
            let mut sim = simulation(SPRING, &[&scheme]);
            let mut unit = [0.0; 5];
            unit[column] = 1e-3;
            let [u, v, a, d, w] = unit;
            change(&mut sim, |state| {
                (state.y[1], state.v[1], state.a[1]) = (1.0 + u, v / dt, a / (dt * dt));
                state.f_internal = vec![-stiffness * u, stiffness * u];
                state.previous = Some(Previous {
                    dt,
                    increment: vec![0.0, d],
                    velocity: vec![0.0, w / dt],
                    means: Means::new(2, 0),
                });
            });
            sim.advance(&mut GridReport::default()).unwrap();
            let now = [sim.state().y[1] - 1.0, dt * sim.state().v[1], dt * dt * sim.state().a[1]];
            for row in 0..3 {
                let error = now[row] / 1e-3 - want[row][column];
                assert!(error.abs() < 1e-10, "{scheme} ({row}, {column}): {error:e}");
            }
        }
    }
}

/// A neo-Hookean bar vibrating by tens of per cent: order by two bisections of the step.
#[test]
fn the_observed_order_on_a_nonlinear_oscillation_is_the_claimed_one() {
    for (scheme, member) in schemes(false) {
        // Backward Euler reaches its asymptotic range late.
        let [step, until] = if member.order == 1 { [1.25e-4, 0.25] } else { [2e-3, 1.0] };
        let end = |step: f64| {
            let sets = [
                format!("time.scheme={scheme}"),
                format!("time.step={step:?}"),
                format!("time.end={until:?}"),
                "material.steel.law=\"neo-hookean\"".into(),
                "body.bar.mesh.cells=3".into(),
                "newton.tolerance=1e-12".into(),
            ];
            let mut sim = simulation(SPRING, &sets.each_ref().map(String::as_str));
            change(&mut sim, |state| (0..4).for_each(|node| state.v[node] = 1.5 * node as f64 / 3.0));
            finish(sim).into_state()
        };
        let [coarse, middle, fine] = [step, 0.5 * step, 0.25 * step].map(end);
        let away = |a: &State, b: &State| {
            a.y.iter().zip(&b.y).chain(a.v.iter().zip(&b.v)).map(|(x, y)| (x - y).abs()).fold(0.0, f64::max)
        };
        let observed = (away(&coarse, &middle) / away(&middle, &fine)).log2();
        assert!((observed - f64::from(member.order)).abs() < 0.1, "{scheme}: {observed:.3}");
    }
}

const BAR: &str = include_str!("../../../../cases/bar/single.toml");

/// The recorded impulse is the momentum from the wall: the quadrature is that of the velocity
/// update, stage by stage.
#[test]
fn the_booked_impulse_is_the_change_of_momentum() {
    for sets in [
        [r#"time.scheme={ kind = "backward-euler" }"#, "contact.wall.active_set=\"within\""],
        [r#"time.scheme={ kind = "bdf2" }"#, "contact.wall.active_set=\"within\""],
        [r#"time.scheme={ kind = "bdf2" }"#, "contact.wall.persistency=\"project\""],
        [r#"time.scheme={ kind = "bathe", rho_inf = 0.4 }"#, "contact.wall.persistency=\"project\""],
        [r#"time.scheme={ kind = "tr-bdf2" }"#, "contact.wall.active_set=\"within\""],
        [r#"time.scheme={ kind = "energy-momentum" }"#, "contact.wall.law=\"predictor\""],
        [r#"time.scheme={ kind = "energy-momentum" }"#, "contact.wall.enforcement=\"penalty\""],
    ] {
        let sim = simulation(BAR, &sets);
        let momentum = |state: &State| {
            let mut p = vec![0.0; state.v.len()];
            sim.model().mass.multiply_into(&state.v, &mut p);
            p.iter().sum::<f64>()
        };
        let start = momentum(sim.state());
        let end = finish(simulation(BAR, &sets)).into_state();
        let error = momentum(&end) - start - end.impulse()[0];
        assert!(
            end.impulse()[0] > 150.0 && error.abs() < 1e-7,
            "{sets:?}: {error:e} of {}",
            end.impulse()[0]
        );
    }
}

/// A conserving penalty loses nothing according to the ledger; the predictor's loss is recorded as
/// contact work.
#[test]
fn what_contact_laws_cost_is_booked_as_contact_work() {
    const CONSERVING: &str = r#"time.scheme={ kind = "energy-momentum" }"#;
    let penalty =
        finish(simulation(BAR, &[CONSERVING, "contact.wall.enforcement=\"penalty\""])).into_state().ledger;
    assert!(penalty.contact_work.abs() < 1e-7 && penalty.dissipation().abs() < 1e-7, "{penalty:?}");
    let predictor =
        finish(simulation(BAR, &[CONSERVING, "contact.wall.law=\"predictor\""])).into_state().ledger;
    assert!(predictor.contact_work < -1.0 && predictor.dissipation().abs() < 1e-7, "{predictor:?}");
}

/// A checkpoint during contact contains the memory of a two-step scheme and of a conserving
/// penalty.
#[test]
fn a_checkpoint_holds_the_memory_of_schemes_and_springs() {
    for sets in [
        [r#"time.scheme={ kind = "bdf2" }"#, "time.end=0.8"],
        [r#"time.scheme={ kind = "bathe", rho_inf = 0.4 }"#, "time.end=0.8"],
        [r#"time.scheme={ kind = "energy-momentum" }"#, "contact.wall.enforcement=\"penalty\""],
    ] {
        let mut sim = simulation(BAR, &sets);
        for _ in 0..190 {
            sim.advance(&mut GridReport::default()).unwrap();
        }
        assert!(sim.state().pairs[0].iter().any(|p| p.active));
        let bytes = postcard::to_stdvec(&sim.state()).unwrap();
        let straight = finish(sim).into_state();
        let resumed =
            finish(restored(simulation(BAR, &sets), postcard::from_bytes(&bytes).unwrap())).into_state();
        assert_eq!(straight, resumed, "{sets:?}");
    }
}
