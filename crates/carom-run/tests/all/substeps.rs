//! Steps that create energy are shortened; shortened steps keep the contact laws and resume
//! bitwise.

use std::ops::ControlFlow;

use carom_run::{Attempt, GridReport, Rejected, Setup, Stopped};

use super::common::{BAR, case, finish, restored, simulation};

/// A stiff disc that falls on a plane; a step is 30 times as long as a wave takes to cross a cell.
const DISC: &str = r#"
dimension = 2
[[material]]
name = "steel"
law = "neo-hookean"
density = 1.0
young = 2e4
poisson = 0.3
[[body]]
name = "disc"
material = "steel"
element = "T6"
mesh = { shape = "disc", radius = 0.5, center = [0.0, 0.52], size = 0.2 }
velocity = [0.3, -3.0]
[[contact]]
name = "floor"
secondary = "disc.arc"
primary = { plane = { point = [0.0, 0.0], normal = [0.0, 1.0] } }
[time]
end = 0.4
step = 0.02
scheme = { kind = "newmark", beta = 0.25, gamma = 0.5 }
"#;

#[test]
fn a_step_that_creates_energy_is_shortened_and_resumes_with_the_same_bits() {
    // Without a guard nothing is shortened, and far more is created.
    let free = finish(simulation(DISC, &["time.energy_guard=false"]));
    let ledger = &free.state().ledger;
    assert!(ledger.created.most() > 0.04 * ledger.scale(), "{:e}", ledger.created.most() / ledger.scale());

    let case = case(DISC, &[""; 0]);
    let mut whole = Setup::new(&case).start().unwrap();
    let (mut report, mut middle) = (GridReport::default(), None);
    while !whole.finished() {
        whole.advance(&mut report).unwrap();
        let shortened = |event: &carom_run::LogEvent| {
            matches!(event, carom_run::LogEvent::Rejected { rejected: Rejected::Energy { .. }, .. })
        };
        if middle.is_none() && report.events.iter().any(shortened) {
            middle = Some(postcard::to_stdvec(whole.state()).unwrap());
        }
    }
    let ledger = &whole.state().ledger;
    assert!(ledger.created.most() <= 0.02 * ledger.scale());
    // The impulse turns the disc round.
    assert!(whole.state().impulses[0][1] > 3.0 * 0.25 * std::f64::consts::PI);
    let state = postcard::from_bytes(&middle.expect("a step was shortened")).unwrap();
    let resumed = finish(Setup::new(&case).threads(2).resume(state).unwrap());
    assert_eq!(resumed.state(), whole.state());
}

/// Paoli and Schatzman's law lets a node go behind the wall by a step of its motion and takes it
/// out in the next one. In steps 64 times shorter it must not be thrown out 64 times as fast.
#[test]
fn a_shorter_step_takes_a_node_out_at_the_rate_of_the_longer_one() {
    let sets = [
        "body.bar.mesh={ shape = \"interval\", min = 0.0051, max = 1.0051, cells = 4 }",
        "body.bar.gravity=[0.0]",
        "contact.wall.restitution=0.9",
        "time.scheme={ kind = \"paoli-schatzman\" }",
        "time.end=0.03",
        "time.step=1e-3",
    ];
    let mut long = simulation(BAR, &sets);
    while long.state().y[0] >= 0.0 {
        long.step().unwrap();
    }
    let state = long.state().clone();
    let mut short = simulation(BAR, &[&sets[..5], &["time.step=1.5625e-5"]].concat());
    short.restore(carom_run::State { step: 64 * state.step, ..state }).unwrap();
    let mut fastest = 0.0_f64;
    while short.state().step < 64 * long.state().step + 256 {
        short.step().unwrap();
        fastest = fastest.max(short.state().half_step.velocity[0]);
    }
    assert!(short.state().y[0] > 0.0 && fastest > 0.5 && fastest < 1.2, "{fastest}");
}

#[test]
fn a_step_may_be_allowed_no_bisection_at_any_time() {
    let mut run = simulation(DISC, &[""; 0]);
    let mut stopped = 0;
    while !run.finished() {
        let mut once = restored(simulation(DISC, &[""; 0]), run.state().clone());
        once.limit_bisections(0);
        stopped += u32::from(once.step().is_err());
        run.step().unwrap();
    }
    assert!(stopped < 20);
}

/// Where shorter steps create more, the whole grid step is taken after all, and the next one is
/// tried whole again. So tight a guard stops the run later.
#[test]
fn a_grid_step_that_is_taken_whole_after_all_is_not_remembered_as_bisected() {
    let sets = [
        "time.energy_guard=1e-4",
        "time.step=0.005",
        "time.scheme={ kind = \"chung-hulbert\", rho_inf = 0.9 }",
    ];
    let mut run = simulation(DISC, &sets);
    let (mut returned, dt) = (0, run.dt());
    while !run.finished() {
        let Ok(report) = run.step() else { break };
        let whole = run.state().carried.dt().is_some_and(|last| (last - dt).abs() < 1e-9 * dt);
        if report.rejected > 0 && whole {
            returned += 1;
            assert_eq!(run.state().bisection, carom_run::Bisection::default());
        }
    }
    assert!(returned > 0);
}

/// Between any two trial steps; then the run goes on as if nothing had been.
#[test]
fn a_step_that_is_interrupted_leaves_the_state_of_the_last_grid_time() {
    let mut run = simulation(DISC, &[""; 0]);
    let mut interrupted = 0;
    while interrupted == 0 {
        let before = run.state().clone();
        let mut whole = restored(simulation(DISC, &[""; 0]), before.clone());
        let mut attempts = 0;
        let mut count = |_: &Attempt| {
            attempts += 1;
            ControlFlow::Continue(())
        };
        whole.advance_watched(&mut GridReport::default(), &mut count).unwrap();
        for last in 1..=attempts {
            let mut left = last;
            let mut stop = |_: &Attempt| {
                left -= 1;
                if left == 0 { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
            };
            let stopped = run.advance_watched(&mut GridReport::default(), &mut stop);
            assert_eq!(stopped, Err(Stopped::Interrupted { time: before.time, dt: run.dt() }));
            assert_eq!(run.state(), &before);
            interrupted += 1;
        }
        run.step().unwrap();
        assert_eq!(run.state(), whole.state());
    }
    assert!(interrupted > 2, "{interrupted}");
}

/// Two cylinders that lie across each other, with friction and a step of ten crossings of a cell.
/// The velocities before the projection grow as the step is shortened, up to fifteen times the
/// energy of the bodies, and the guard must not be measured by them: 2.7 % were created that it let
/// pass.
const CYLINDERS: &str = r#"
dimension = 3
material = [
    { name = "stiff", law = "neo-hookean", density = 1.0, young = 1815.1, poisson = 0.3 },
    { name = "soft", law = "neo-hookean", density = 1.0, young = 100.0, poisson = 0.3 },
]
[[body]]
name = "lower"
material = "stiff"
element = "Tet4"
mesh = { shape = "cylinder", radius = 0.29059, height = 0.92323, center = [0.0, 0.0, -0.46162], size = 0.11423 }
place = { rotate = { axis = [0.0, 1.0, 0.0], angle = 90.0 }, shift = [0.0, 0.0, 0.0] }
velocity = [0.0, 0.0, 0.2007]
[[body]]
name = "upper"
material = "soft"
element = "Tet4"
mesh = { shape = "cylinder", radius = 0.32384, height = 1.0453, center = [0.0, 0.0, -0.52266], size = 0.1273 }
place = { rotate = { axis = [0.0, 1.0, 0.0], angle = 90.0 }, shift = [-0.16743, -0.015725, 0.62442] }
velocity = [0.27872, -0.49625, -1.3573]
[[contact]]
name = "strike"
secondary = "upper.skin"
primary = "lower.skin"
mu = 1.0
[time]
end = 0.0672
step = 0.0168
scheme = { kind = "energy-momentum" }
"#;

#[test]
fn velocities_within_a_step_do_not_raise_what_the_guard_allows() {
    let mut sim = simulation(CYLINDERS, &[""; 0]);
    let start = sim.state().ledger.total();
    let mut stopped = None;
    while stopped.is_none() && !sim.finished() {
        stopped = sim.advance(&mut GridReport::default()).err();
        // Nothing is supplied, and the strain at the start is none.
        assert!(sim.state().ledger.scale() < start * (1.0 + 1e-9), "{}", sim.state().ledger.scale());
    }
    if let Some(stopped) = stopped {
        let Stopped::EnergyGuard { scale, share, created, .. } = stopped else { panic!("{stopped}") };
        assert!(scale < start * (1.0 + share) && created > share * scale, "{stopped}");
    }
}
