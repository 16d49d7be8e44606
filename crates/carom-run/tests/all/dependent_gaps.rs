//! Closed gaps that depend on others, or that supports and ties keep closed: without a multiplier
//! of their own they carry no friction, and a mortar side has no more pressures than gaps that can
//! change.

use carom_record::Run;
use carom_run::GridReport;

use super::common::simulation;
use super::rebound::record;
use super::warnings::recorded;

/// Coefficient of friction.
const MU: f64 = 0.21;

/// The largest friction over pressing force in any row of a record, and over the last of them.
fn friction_used(run: &Run) -> [f64; 2] {
    let of_step = |step: u64| {
        let rows = || run.contact.iter().filter(|row| row.step == step);
        let friction: f64 = rows().map(|row| row.traction).sum();
        let pressing: f64 = rows().map(|row| -row.multiplier).sum();
        if pressing > 0.0 { friction.abs() / pressing } else { 0.0 }
    };
    let last = run.contact.last().unwrap().step;
    [(0..=last).map(of_step).fold(0.0, f64::max), of_step(last)]
}

/// Two blocks beside each other that a tie joins. Their common corner has a gap in both contacts.
const TIED: &str = r#"
dimension = 2
material = [{ name = "m", law = "neo-hookean", density = 1.3, young = 100.0, poisson = 0.3 }]
[[body]]
name = "a"
material = "m"
element = "T6"
mesh = { shape = "rectangle", min = [0.0, 0.0], max = [0.7, 0.4], cells = [3, 2] }
[[body]]
name = "b"
material = "m"
element = "T6"
mesh = { shape = "rectangle", min = [0.7, 0.0], max = [1.5, 0.4], cells = [4, 3] }
[[tie]]
name = "t"
secondary = "b.left"
primary = "a.right"
method = "points"
[[support]]
name = "s"
on = ["a.top", "b.top"]
move = { x = "if(t<1,0,0.08*(t-1))", y = "-0.02*min(t,1)" }
[[contact]]
name = "c1"
secondary = "a.bottom"
primary = { plane = { point = [0.0, 0.0], normal = [0.0, 1.0] } }
mu = 0.21
[[contact]]
name = "c2"
secondary = "b.bottom"
primary = { plane = { point = [0.0, 0.0], normal = [0.0, 1.0] } }
mu = 0.21
[time]
end = 2.0
step = 0.1
scheme = { kind = "static" }
[output]
fields_every = 0
"#;

/// Tied blocks that are pressed on a plane and moved sideways slide where the friction of each of
/// their nodes is μ times its force.
#[test]
fn tied_bodies_slide_at_the_limit_of_friction() {
    for element in ["T3", "T6", "Q4"] {
        let elements = ["a", "b"].map(|body| format!("body.{body}.element={element}"));
        let run = record(TIED, &elements.each_ref().map(String::as_str));
        let [largest, last] = friction_used(&run);
        assert!(largest < MU * (1.0 + 1e-9) && last > MU * (1.0 - 1e-9), "{element}: {largest} {last}");
        let warnings = recorded(TIED, &elements.each_ref().map(String::as_str));
        assert!(warnings.contains(&"dependent-gaps".to_owned()), "{element}");
    }
}

/// A block on a plane, whose left side a roller holds in the direction of the contact.
const GUIDED: &str = r#"
dimension = 2
material = [{ name = "m", law = "neo-hookean", density = 1.3, young = 100.0, poisson = 0.3 }]
[[body]]
name = "a"
material = "m"
element = "T6"
mesh = { shape = "rectangle", min = [0.0, 0.0], max = [1.3, 0.3], cells = [5, 3] }
[[load]]
on = ["a.top"]
traction = ["0.6*min(max(t-1,0),1)", "-2*min(t,1)"]
[[contact]]
name = "c"
secondary = "a.bottom"
primary = { plane = { point = [0.0, 0.0], normal = [0.0, 1.0] } }
mu = 0.21
[[support]]
name = "roller"
on = ["a.left"]
fix = ["y"]
[time]
end = 2.0
step = 0.1
scheme = { kind = "static" }
[output]
fields_every = 0
"#;

/// A shear of 0.18 of the pressure is held, and one of 0.22 is not, also if a support holds nodes
/// in the direction of the contact.
#[test]
fn a_node_that_a_support_holds_has_no_friction() {
    for method in ["node-to-segment", "mortar"] {
        for element in ["T3", "T6", "Q4"] {
            let sets = [format!("body.a.element={element}"), format!("contact.c.method={method}")];
            let mut sim = simulation(GUIDED, &sets);
            while !sim.finished() && sim.advance(&mut GridReport::default()).is_ok() {}
            let time = sim.state().time;
            assert!(!sim.finished() && (1.55..1.75).contains(&time), "{element} {method}: {time}");
        }
    }
}

/// A block under pressure on a plane, the ends of whose side supports hold: the pressures are
/// symmetric and no larger than where coefficients of the pressure are as many as gaps that can
/// change, and the supports carry a part of the load.
#[test]
fn pressures_on_a_side_with_held_ends_do_not_oscillate() {
    let pressed = GUIDED
        .replace("on = [\"a.left\"]\nfix = [\"y\"]", "on = [\"a.left\", \"a.right\"]\nfix = [\"x\", \"y\"]")
        .replace("mu = 0.21", "method = \"mortar\"");
    let fine = record(&pressed, &["time.end=1.0"]);
    let force = |run: &Run| {
        let last = run.contact.last().unwrap().step;
        run.contact.iter().filter(|row| row.step == last).map(|row| -row.multiplier).sum::<f64>()
    };
    for element in ["T3", "Q4"] {
        let run = record(&pressed, &["time.end=1.0", &format!("body.a.element={element}")]);
        let last = run.contact.last().unwrap().step;
        let pressures: Vec<f64> =
            run.contact.iter().filter(|row| row.step == last).map(|row| row.pressure).collect();
        let most = pressures.iter().fold(0.0_f64, |most, p| most.max(*p));
        assert!(most < 2.3 && most > 2.0, "{element}: {pressures:?}");
        if element == "Q4" {
            for (one, other) in pressures.iter().zip(pressures.iter().rev()) {
                assert!((one - other).abs() < 1e-9, "{pressures:?}");
            }
        }
        assert!((force(&run) / force(&fine) - 1.0).abs() < 0.06, "{element}");
    }
}

/// A support that drags a side along the surface after its corner has stuck does not take the
/// friction from the corner: in full slip all is μ times the load, 0.21 · 2 · 1.3.
#[test]
fn a_support_that_moves_along_the_surface_drags_its_node() {
    let side = "on = [\"a.left\"]\nfix = [\"y\"]";
    let moved = "on = [\"a.left\"]\nmove = { x = \"-0.1*max(t-1,0)\" }";
    let dragged = GUIDED.replace(side, moved).replace("0.6*min(max(t-1,0),1)", "0");
    for method in ["node-to-segment", "mortar"] {
        for scheme in ["kind = \"static\"", "kind = \"backward-euler\""] {
            let sets = [
                format!("contact.c.method={method}"),
                format!("time.scheme={{ {scheme} }}"),
                "material.m.density=1e-4".to_owned(),
                "time.step=0.05".to_owned(),
            ];
            let run = record(&dragged, &sets.each_ref().map(String::as_str));
            let force = run.column("contact_force_x").unwrap().last().unwrap().abs();
            assert!((force / (MU * 2.0 * 1.3) - 1.0).abs() < 2e-3, "{method} {scheme}: {force}");
        }
    }
}

/// Impulses at a place that two contacts share are given to one of them: which one's friction acts
/// there is arbitrary, and is told.
#[test]
fn impulses_at_a_place_of_two_contacts_are_told_of() {
    for scheme in [r#"{ kind = "moreau-jean", theta = 0.5 }"#, r#"{ kind = "central-difference" }"#] {
        let time = format!("time={{ end = 0.05, step = 1e-3, scheme = {scheme} }}");
        let sets = [
            "support=[]",
            "body.a.mass=lumped",
            "body.b.mass=lumped",
            "body.a.gravity=[\"0\", \"-5\"]",
            "body.b.gravity=[\"0\", \"-5\"]",
            "body.a.velocity=[1.0, 0.0]",
            "body.b.velocity=[1.0, 0.0]",
            "contact.c2.mu=0.5",
            time.as_str(),
        ];
        let told = |sets: &[&str]| recorded(TIED, sets).iter().any(|id| id == "dependent-gaps");
        assert!(told(&sets), "{scheme}");
        let one = "contact=[{ name = \"c1\", secondary = \"a.bottom\", primary = { plane = { point = [0.0, 0.0], normal = [0.0, 1.0] } }, mu = 0.21 }]";
        assert!(!told(&[&sets[..7], &[one, time.as_str()]].concat()), "{scheme}");
    }
}
