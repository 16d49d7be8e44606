//! The log has the time at which a node met the other side, within the step: exact for bodies in
//! free flight.

use carom_run::{GridReport, LogEvent};

use super::common::{BAR, DISCS, simulation};

const BULLET: &str = include_str!("../../../../cases/ladder/bullet.toml");
const BALL: &str = include_str!("../../../../cases/space/ball.toml");

/// A disc in flight within a rigid circle, or at a rigid plane.
const DISC: &str = r#"
dimension = 2
material = [{ name = "steel", law = "neo-hookean", density = 1.0, young = 2e3, poisson = 0.3 }]
[[body]]
name = "disc"
material = "steel"
element = "T6"
mesh = { shape = "disc", radius = 0.5, center = [0.0, 0.0], size = 0.25 }
velocity = [0.0, -2.0]
[[contact]]
name = "wall"
secondary = "disc.arc"
primary = { plane = { point = [0.0, -0.53], normal = [0.0, 1.0] } }
[time]
end = 0.2
step = 0.01
scheme = { kind = "chung-hulbert", rho_inf = 0.5 }
"#;

/// The time of the first meeting in the log, and the grid step.
fn first_meeting(text: &str, sets: &[&str]) -> (f64, f64) {
    let mut sim = simulation(text, sets);
    while !sim.finished() {
        let mut report = GridReport::default();
        sim.advance(&mut report).unwrap();
        let met = report.events.iter().filter_map(|event| match event {
            LogEvent::ActiveSet { time, active: true, met, .. } => {
                assert!(met.is_none_or(|met| met <= *time), "{event:?}");
                *met
            }
            _ => None,
        });
        if let Some(first) = met.min_by(f64::total_cmp) {
            return (first, sim.dt());
        }
    }
    panic!("nothing met");
}

#[test]
fn the_time_of_first_contact_is_that_of_free_flight() {
    let circle = "contact.wall.primary={ circle = { center = [0.0, 0.2], radius = 0.805, inside = true } }";
    let corner = "contact.wall.primary={ polyline = { points = [[2.0, -0.53], [-2.0, -0.53]] } }";
    let bar = ["body.bar.gravity=[0.0]"];
    for (text, sets, exact) in [
        (BULLET, &[][..], 2.37 / 5.0),
        (BULLET, &["time.scheme={ kind = \"bathe\", rho_inf = 0.0 }"], 2.37 / 5.0),
        (DISC, &["time.scheme={ kind = \"moreau-jean\", theta = 0.5 }", "time.step=0.0125"], 0.015),
        (DISC, &[], 0.015),
        (DISC, &[corner], 0.015),
        (DISC, &[circle], 0.0525),
        (BAR, &bar, 0.02),
        (BALL, &[], 0.01 / 3.0),
    ] {
        let (met, dt) = first_meeting(text, sets);
        assert!((met - exact).abs() < 1e-6 * dt, "{sets:?}: {met:.12} {exact:.12}");
    }
}

/// Two discs that are mirror images meet their sides at times that a shorter step confirms.
#[test]
fn the_time_does_not_depend_on_the_step() {
    let at = |step: &str| first_meeting(DISCS, &[&format!("time.step={step}")]).0;
    let [long, short] = ["8e-3", "1e-3"].map(at);
    assert!((long - short).abs() < 1e-9, "{long:e} {short:e}");
}
