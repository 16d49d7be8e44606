//! The impact of cases/impact, step by step: identities that hold to round-off in every step.

use carom_contact::Rows;
use carom_run::case::Case;
use carom_run::{GridReport, LogEvent, Simulation};

use super::common::{DISCS, case, finish, momenta, schemes, simulation, sums};
use super::ledger::{kept_by_projection, of_alpha};

const IMPACT: &str = include_str!("../../../../cases/impact/impact.toml");
const COARSE: [&str; 2] = ["body.cylinder.mesh.size=0.25", "body.prism.mesh.cells=[4,2]"];

/// Gaps of the pairs at the current positions, recomputed.
fn gaps(sim: &Simulation) -> Rows {
    let mut rows = Rows::new(2);
    for mut pair in sim.state().pairs[0].iter().copied() {
        sim.model().contacts[0].kinematics.measure(&mut pair, &sim.state().y, &mut rows).unwrap();
    }
    rows
}

/// The force of the active pairs on all dofs, from those gaps.
fn contact_force(sim: &Simulation) -> Vec<f64> {
    let mut force = vec![0.0; sim.model().dofs()];
    for (pair, row) in sim.state().pairs[0].iter().zip(gaps(sim).iter()).filter(|(pair, _)| pair.active) {
        row.add_to(pair.lambda, &mut force);
    }
    force
}

#[test]
fn ledger_balance_and_gaps_hold_in_every_step_of_the_impact() {
    ledger_balance_and_gaps_hold(&case(IMPACT, &[""; 0]), 500);
}

/// The same with all kinds of time-dependent and follower loads.
#[test]
fn ledger_balance_and_gaps_hold_under_loads() {
    let loads = r#"load=[
        { on = ["cylinder.arc"], pressure = "0.2*sin(9*t)*(1 + Y)" },
        { on = ["prism.right"], traction = ["-0.3*t", "0.2*sin(5*t)"] },
        { body = "cylinder", body_force = ["0.1*Y*t", "-X"] },
    ]"#;
    let scheme = r#"time.scheme={ kind = "chung-hulbert", rho_inf = 0.5 }"#;
    ledger_balance_and_gaps_hold(
        &case(IMPACT, &[COARSE[0], COARSE[1], &loads.replace('\n', " "), scheme]),
        30,
    );
}

fn ledger_balance_and_gaps_hold(case: &Case, least: usize) {
    let scheme = case.time.scheme.integrator().unwrap().alpha().unwrap();
    let mut sim = carom_run::Setup::new(case).start().unwrap();
    let (mut worst_ledger, mut pairs_in_contact) = (0.0_f64, 0);
    while !sim.finished() {
        let before = sim.state().clone();
        let mut report = GridReport::default();
        sim.advance(&mut report).unwrap();
        assert_eq!(report.rejected, 0);
        let booked = sim.state().ledger.dissipation() - before.ledger.dissipation();
        let mut predicted = of_alpha(sim.model(), &scheme, &before, sim.state(), sim.dt()).unwrap();
        if report.events.iter().any(|event| matches!(event, LogEvent::Projection { .. })) {
            predicted += kept_by_projection(&scheme, &before, sim.state());
        }
        let error = (booked - predicted).abs();
        worst_ledger = worst_ledger.max(error / sim.state().ledger.largest);

        let rows = gaps(&sim);
        assert!(rows.iter().all(|row| row.gap > -2e-12), "step {}: {rows:?}", sim.state().step);
        let pressing = || sim.state().pairs[0].iter().filter(|pair| pair.active);
        pairs_in_contact += pressing().count();
        let size: f64 = pressing().map(|pair| pair.lambda.abs()).sum();
        let lost: f64 = sums(&contact_force(&sim), &sim.state().y).iter().map(|sum| sum.abs()).sum();
        assert!(lost <= 1e-12 * size, "step {}: {lost:e} of {size:e}", sim.state().step);
    }
    assert!(pairs_in_contact > least, "{pairs_in_contact}");
    assert!(worst_ledger < 1e-12, "{worst_ledger:e}");
}

/// The contact force for the next step is that of the state's pairs, with gaps and normals
/// recomputed.
#[test]
fn the_contact_force_of_every_state_is_that_of_its_pairs() {
    let mut sim = simulation(include_str!("../../../../cases/impact/whole.toml"), &[""; 0]);
    let mut contacts = 0;
    while sim.state().time < 0.36 {
        sim.advance(&mut GridReport::default()).unwrap();
        contacts += sim.state().pairs[0].iter().filter(|pair| pair.active).count();
        let force = contact_force(&sim);
        let largest = force.iter().fold(0.0_f64, |most, f| most.max(f.abs()));
        let apart = force.iter().zip(&sim.state().f_contact).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        assert!(apart < 1e-12 * (1.0 + largest), "step {}: {apart:e}", sim.state().step);
    }
    assert!(contacts > 100);
}

/// A falling body, y = X − g t²/2 to 1e-12, or with the published deviation of the scheme: detects
/// any factor of inertia (the paper prints a ½).
#[test]
fn free_fall_is_that_of_the_scheme() {
    const AVERAGES: &str = r#"{ kind = "chung-hulbert", rho_inf = 0.9, forces = "average-state" }"#;
    let exact: fn(f64) -> f64 = |_| 0.0;
    let members = schemes(false).map(|(scheme, member)| (scheme, member.falls));
    for (scheme, falls) in members.chain([(AVERAGES.to_owned(), exact)]) {
        for mass in ["consistent", "lumped"] {
            let scheme = format!("time.scheme={scheme}");
            let mass = format!("body.cylinder.mass={mass}");
            let mut sim = simulation(IMPACT, &[COARSE[0], COARSE[1], &scheme, &mass, "time.end=0.15"]);
            while !sim.finished() {
                sim.advance(&mut GridReport::default()).unwrap();
            }
            let late = falls(sim.state().step as f64) * sim.dt() * sim.dt();
            let fallen = 9.81 * (0.5 * sim.state().time * sim.state().time + late);
            for node in sim.model().parts[0].nodes() {
                let [x, y] = [2 * node, 2 * node + 1];
                let error = (sim.state().y[y] - (sim.model().reference[y] - fallen)).abs();
                assert!(error < 1e-12, "{scheme}: {error:e}");
                assert!((sim.state().y[x] - sim.model().reference[x]).abs() < 1e-12);
            }
        }
    }
}

/// Without a rigid plane, dissipation and gravity, momentum about any point and energy of a free
/// disc are conserved by conserving schemes.
#[test]
fn total_momentum_of_two_free_bodies_is_kept_through_contact() {
    let sets = [
        "body.left.mass=consistent",
        "body.right.mass=consistent",
        "contact.strike.force=end",
        "time.step=2e-3",
        "time.scheme={ kind = \"chung-hulbert\", rho_inf = 0.5 }",
    ];
    let mut sim = simulation(DISCS, &sets);
    let mut active = 0;
    while !sim.finished() {
        sim.advance(&mut GridReport::default()).unwrap();
        active = active.max(sim.state().pairs[0].iter().filter(|p| p.active).count());
        let total = momenta(&sim, &sim.state().v);
        assert!(total[0].abs() + total[1].abs() < 1e-11, "step {}: {total:?}", sim.state().step);
    }
    assert!(active >= 3);
}

/// Steps so long that Newton's iterations run out just after a change of pairs: the step is
/// rejected with a reason and bisected.
#[test]
fn giving_up_after_a_change_of_pairs_is_told() {
    let scheme = r#"time.scheme={ kind = "energy-momentum" }"#;
    let step = format!("time.step={:?}", 0.85125 / 83.0);
    let paper = include_str!("../../../../cases/paper/impact.toml");
    let mut sim = simulation(paper, &[scheme, "contact.strike.law=\"predictor\"", &step]);
    let mut rejected = 0;
    while sim.state().time < 0.36 {
        let mut report = GridReport::default();
        sim.advance(&mut report).unwrap();
        rejected += report.rejected;
    }
    assert!(rejected > 0);
}

/// A block that flies against a side without mass keeps its velocity: the side follows it.
#[test]
fn a_massless_side_stops_nobody() {
    let text = |secondary: &str, primary: &str| {
        format!(
            r#"
dimension = 2
[[material]]
name = "block"
law = "linear-elastic"
density = 500.0
young = 1e7
poisson = 0.0
[[material]]
name = "spring"
law = "linear-elastic"
density = 0.0
young = 4e3
poisson = 0.0
[[body]]
name = "block"
material = "block"
element = "Q4"
mesh = {{ shape = "rectangle", min = [0.05, 0.0], max = [1.05, 1.0], cells = [1, 1] }}
velocity = [-1.0, 0.0]
[[body]]
name = "spring"
material = "spring"
element = "Q4"
mesh = {{ shape = "rectangle", min = [-1.0, 0.0], max = [0.0, 1.0], cells = [1, 1] }}
[[support]]
on = ["spring.left"]
fix = ["x", "y"]
[[support]]
on = ["spring.bottom", "spring.top"]
fix = ["y"]
[[contact]]
name = "push"
secondary = "{secondary}"
primary = "{primary}"
[time]
end = 0.3
step = 2e-3
scheme = {{ kind = "bathe", rho_inf = 0.5 }}
"#
        )
    };
    for (secondary, primary) in [("spring.right", "block.left"), ("block.left", "spring.right")] {
        let sim = finish(simulation(&text(secondary, primary), &[] as &[&str]));
        let ledger = &sim.state().ledger;
        let total = ledger.kinetic + ledger.strain;
        // ½ m v² = 250.
        assert!((total - 250.0).abs() < 1e-5, "{secondary}: {total}");
    }
}

/// A plane that is drawn down under a rebounding ball: where a node closes anew, a force that kept
/// its gap closed would pull. It had pulled with 48, and the step after it took −0.34 from the
/// impulse without any node in contact.
#[test]
fn a_contact_that_begins_while_bodies_part_does_not_pull() {
    let text = r#"
dimension = 2
[[material]]
name = "rubber"
law = "neo-hookean"
density = 0.009
lambda = 20.0
mu = 1.5
[[body]]
name = "block"
material = "rubber"
element = "T3"
mesh = { shape = "rectangle", min = [0.0, 0.0], max = [40.0, 40.0], cells = [2, 2] }
[[body]]
name = "ball"
material = "rubber"
element = "T6"
mesh = { shape = "disc", radius = 16.0, center = [20.0, 57.0], size = 8.0 }
velocity = [0.0, -40.0]
[[support]]
on = ["block.bottom"]
fix = ["x", "y"]
[[support]]
on = ["block.top"]
fix = ["x"]
move = { y = "-40*t*t" }
[[contact]]
name = "floor"
secondary = "ball.arc"
primary = "block.top"
[time]
end = 0.5
step = 0.02
scheme = { kind = "bathe", rho_inf = 0.0 }
energy_guard = false
"#;
    for scheme in ["bathe\", rho_inf = 0.0", "chung-hulbert\", rho_inf = 0.5", "energy-momentum\""] {
        let mut sim = simulation(text, &[format!("time.scheme={{ kind = \"{scheme} }}")]);
        let (mut let_go, mut before) = (0, 0.0);
        while !sim.finished() {
            sim.step().unwrap();
            let state = sim.state();
            for pair in state.pairs[0].iter().filter(|pair| pair.active) {
                assert!(pair.lambda <= 0.0, "{scheme}: {} {pair:?}", state.time);
                let_go += usize::from(pair.lambda == 0.0);
            }
            // The plane stays level, so what acts on the ball points upwards.
            assert!(state.impulses[0][1] >= before, "{scheme}: {} {before}", state.impulses[0][1]);
            before = state.impulses[0][1];
        }
        // Multipliers of energy–momentum are means over the step.
        assert_eq!(let_go == 0, scheme.starts_with("energy"), "{scheme}");
    }
}

/// The work of a rigid wall of constant speed is its impulse times that speed: also that of the
/// impulses where contact begins and where energy is returned. (With schemes that carry momentum in
/// accelerations, the impulse has a part of theirs.)
#[test]
fn the_work_of_a_wall_of_constant_speed_is_its_impulse_times_that() {
    let wall = include_str!("../../../../cases/obstacle/moving-wall.toml");
    let midpoint = "time.scheme={ kind = \"energy-momentum\" }";
    let bathe = "time.scheme={ kind = \"bathe\", rho_inf = 0.5 }";
    let projects = "contact.wall.persistency=project";
    let returns = "contact.wall.restitution=0.6";
    for sets in [&[projects, midpoint][..], &[projects, bathe], &[projects, midpoint, returns]] {
        let sim = finish(simulation(wall, sets));
        let state = sim.state();
        let work = 10.0 * state.impulses[0][0];
        let apart = (state.ledger.external_work / work - 1.0).abs();
        assert!(work > 1000.0 && apart < 1e-11, "{sets:?}: {work} {apart:e}");
    }
}
