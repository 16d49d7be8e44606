//! Warnings about waves and velocities: each against a run, or against a wave solution.

use carom_record::{Run, metrics};

use super::rebound::record;
use super::warnings::found;

/// A bar with c = 1 and L = 1 strikes a wall: the force 0.01 lasts 2L/c = 2.
const WALL: &str = r#"
dimension = 1
material = [{ name = "m", law = "linear-elastic", density = 1.0, young = 1.0, poisson = 0.0 }]
body = [{ name = "bar", material = "m", element = "L2", mesh = { shape = "interval", min = 0.01, max = 1.01, cells = 50 }, velocity = [-0.01] }]
contact = [{ name = "hit", secondary = "bar.left", primary = { plane = { point = [0.0], normal = [1.0] } } }]
output = { fields_every = 0 }
time = { end = 8.0, step = 0.02, scheme = { kind = "chung-hulbert", rho_inf = 0.8 } }
"#;

/// A stiff and heavy bar, which waves cross in 0.006, strikes a soft one that is held, with c = 1
/// and L = 1.
const ON_SOFT: &str = r#"
dimension = 1
material = [
    { name = "soft", law = "linear-elastic", density = 1.0, young = 1.0, poisson = 0.0 },
    { name = "stiff", law = "linear-elastic", density = 10.0, young = 3e5, poisson = 0.0 },
]
body = [
    { name = "striker", material = "stiff", element = "L2", mesh = { shape = "interval", min = 0.01, max = 1.01, cells = 50 }, velocity = [-0.01] },
    { name = "pad", material = "soft", element = "L2", mesh = { shape = "interval", min = -1.0, max = 0.0, cells = 50 } },
]
support = [{ on = ["pad.left"], fix = ["x"] }]
contact = [{ name = "hit", secondary = "striker.left", primary = "pad.right" }]
output = { fields_every = 0 }
time = { end = 25.0, step = 0.02, scheme = { kind = "chung-hulbert", rho_inf = 0.8 } }
"#;

const EULER: &str = "time.scheme={ kind = \"backward-euler\" }";

/// The warnings `long-step` of a run.
fn long_steps(run: &Run) -> Vec<String> {
    let warnings = run.manifest.warnings.iter().filter(|warning| warning.id == "long-step");
    warnings.map(|warning| format!("{}: {}", warning.place, warning.what)).collect()
}

/// Its claim, by runs with a tenth of the step: the largest mean force changes by more than a fifth
/// where the warning is given, and by less where it is not.
#[test]
fn a_step_in_which_a_wave_crosses_the_softer_body() {
    let cases = [
        (WALL, 2.0, "", Some("bar")),
        (WALL, 2.0, EULER, Some("bar")),
        (WALL, 0.5, "", None),
        (WALL, 0.5, EULER, None),
        (ON_SOFT, 2.5, "", Some("pad")),
        (ON_SOFT, 2.5, EULER, Some("pad")),
        (ON_SOFT, 0.25, "", None),
        (ON_SOFT, 0.25, EULER, None),
    ];
    for (text, step, scheme, warned) in cases {
        let run_with = |step: f64| {
            let step = format!("time.step={step}");
            let sets = [step.as_str(), scheme];
            record(text, if scheme.is_empty() { &sets[..1] } else { &sets })
        };
        let force = |run: &Run| {
            let all = metrics::all(&run.history);
            all.into_iter().find(|metric| metric.name == "peak_mean_force").unwrap().value.unwrap()
        };
        let [run, finer] = [step, 0.1 * step].map(run_with);
        let change = (force(&run) / force(&finer) - 1.0).abs();
        let given = long_steps(&run);
        assert_eq!(change > 0.2, warned.is_some(), "Δt = {step} {scheme}: {change}");
        assert_eq!(given.len(), usize::from(warned.is_some()), "Δt = {step} {scheme}: {given:?}");
        if let Some(body) = warned {
            let crossing = format!(
                "body \"{body}\": a pressure wave crosses its 1.00 m in 1.00 s, {} of a step",
                [(2.0, "0.500"), (2.5, "0.400")].into_iter().find(|(of, _)| *of == step).unwrap().1
            );
            assert!(given[0].starts_with(&crossing), "{given:?}");
        }
    }
}

/// Statics, and a press: inertia plays no part, however long the step is.
#[test]
fn steps_of_a_press_are_not_too_long() {
    let pressed = r#"
dimension = 1
material = [{ name = "m", law = "linear-elastic", density = 1e-6, young = 1.0, poisson = 0.0 }]
body = [{ name = "bar", material = "m", element = "L2", mesh = { shape = "interval", min = 0.01, max = 1.01, cells = 50 } }]
support = [{ on = ["bar.right"], move = { x = "-0.1*t^2" } }]
contact = [{ name = "hit", secondary = "bar.left", primary = { plane = { point = [0.0], normal = [1.0] } } }]
time = { end = 1.0, step = 0.05, scheme = { kind = "backward-euler" } }
"#;
    let run = record(pressed, &[]);
    assert!(run.column("active").unwrap().last() == Some(&1.0) && long_steps(&run).is_empty());
}

fn warned(text: &str, id: &str, sets: &[&str]) -> Vec<String> {
    found(text, sets).into_iter().filter(|(of, _)| of == id).map(|(_, what)| what).collect()
}

/// A bar whose end moves: ρc = 2, c = 1.
const PUSHED: &str = r#"
dimension = 1
material = [{ name = "m", law = "linear-elastic", density = 2.0, young = 2.0, poisson = 0.0 }]
body = [{ name = "bar", material = "m", element = "L2", mesh = { shape = "interval", min = 0.0, max = 2.0, cells = 100 } }]
support = [{ on = ["bar.left"], move = { x = "0.01*t" } }]
probe = [{ name = "P", body = "bar", at = [0.3], record = ["sigma_xx", "vx"] }]
output = { fields_every = 0 }
time = { end = 1.5, step = 0.02, scheme = { kind = "chung-hulbert", rho_inf = 0.5 } }
"#;

/// The stress behind the front is −ρc times the jump, as in the run.
#[test]
fn a_support_that_starts_at_once() {
    let jump = |sets: &[&str]| warned(PUSHED, "velocity-jump", sets);
    let what = jump(&[]).swap_remove(0);
    let stated = "body \"bar\": a support moves it along x with 0.0100 m/s from the start on, where its initial velocity is 0 m/s: this jump of 0.0100 m/s starts a wave of stress ρc·0.0100 = 0.0200 Pa";
    assert_eq!(what, stated);
    let run = record(PUSHED, &[]);
    let stress = run.column("P.sigma_xx").unwrap();
    let behind = &stress[stress.len() / 2..];
    let mean = behind.iter().sum::<f64>() / behind.len() as f64;
    assert!((mean + 0.02).abs() < 2e-4, "{mean}");
    // Partly, against, and with the motion.
    assert!(jump(&["body.bar.velocity=[0.004]"])[0].contains("jump of 0.00600 m/s"));
    assert!(jump(&["body.bar.velocity=[-0.01]"])[0].contains("jump of 0.0200 m/s"));
    assert!(jump(&["body.bar.velocity=[0.01]"]).is_empty());
    assert!(jump(&["support=[{ on = [\"bar.left\"], move = { x = \"0.01*t^2\" } }]"]).is_empty());
    // A support that holds an end stops it.
    let held = "support=[{ on = [\"bar.left\"], fix = [\"x\"] }]";
    assert!(jump(&[held, "body.bar.velocity=[0.5]"])[0].contains("jump of 0.500 m/s"));
    assert!(jump(&[held]).is_empty());
    assert!(jump(&[held, "body.bar.velocity=[\"0.5*X\"]"]).is_empty(), "it begins at rest there");
    assert!(jump(&["time.scheme={ kind = \"static\" }", "time.step=0.5"]).is_empty());
}

#[test]
fn an_obstacle_that_starts_at_once() {
    let wall = |velocity: &str, place: f64| {
        format!(
            "contact=[{{ name = \"wall\", secondary = \"bar.right\", primary = {{ plane = {{ point = [{place:?}], normal = [-1.0] }}, motion = {{ x = \"{velocity}\" }} }} }}]"
        )
    };
    let jump = |wall: &str, more: &[&str]| {
        warned(PUSHED, "velocity-jump", &[&["support=[]", wall][..], more].concat())
    };
    let stated = "contact \"wall\": its obstacle touches the body and moves into it with 0.0300 m/s relative to it from the start on";
    assert_eq!(jump(&wall("-0.03*t", 2.0), &[]), [stated]);
    assert!(jump(&wall("-0.03*t", 2.1), &[]).is_empty(), "it strikes later");
    assert!(jump(&wall("0.03*t", 2.0), &[]).is_empty(), "it moves away");
    assert!(jump(&wall("-0.03*t", 2.0), &["body.bar.velocity=[-0.03]"]).is_empty());
}

#[test]
fn a_run_that_ends_before_a_wave_has_crossed() {
    let short = |sets: &[&str]| warned(PUSHED, "short-run", sets);
    let stated = "body \"bar\": the run ends at 1.50 s, and a pressure wave needs 2.00 s to cross 2.00 m, twice the body's volume over its surface";
    assert_eq!(short(&[]), [stated]);
    assert!(short(&["time.end=2.02"]).is_empty());
    assert!(short(&["time.scheme={ kind = \"static\" }", "time.step=0.5"]).is_empty());
    // Nothing is felt at the far end of the bar, and something is felt there later.
    let far = "probe=[{ name = \"P\", body = \"bar\", at = [2.0], record = [\"vx\"] }]";
    let velocity = |end: &str| {
        let run = record(PUSHED, &[far, end]);
        run.column("P.vx").unwrap().iter().fold(0.0, |most: f64, v| most.max(v.abs()))
    };
    assert!(velocity("time.end=1.5") < 1e-4 && velocity("time.end=2.4") > 0.01);
}

/// Steel, in consistent units and in others; c = √((1 − ν)E/((1 + ν)(1 − 2ν)ρ)) = 6000.5 m/s.
#[test]
fn a_speed_of_waves_that_no_solid_has() {
    let steel = |units: &str, young: &str, density: &str| {
        let material = format!(
            "material=[{{ name = \"m\", law = \"linear-elastic\", density = {density}, young = {young}, poisson = 0.3 }}]"
        );
        let units = format!("units={units}");
        warned(PUSHED, "wave-speed", &[&units, &material])
    };
    let tonnes = r#"{ length = "mm", time = "s", mass = "t" }"#;
    assert!(steel(tonnes, "2.1e5", "7.85e-9").is_empty());
    let stated = "material \"m\": the speed of its pressure waves is 6.00 mm/s, 0.00600 m/s";
    assert_eq!(steel(tonnes, "2.1e5", "7850.0"), [stated]);
    assert!(steel(r#"{ length = "mm", time = "ms", mass = "g" }"#, "2.1e5", "7.85e-3").is_empty());
    assert_eq!(steel(r#"{ length = "m", time = "s", mass = "kg" }"#, "2.1e11", "7.85e-9").len(), 1);
    // Labels that are not known, and numbers without declared units.
    assert!(steel(r#"{ length = "span", time = "s", mass = "lb" }"#, "2.1e5", "7850.0").is_empty());
    assert!(warned(PUSHED, "wave-speed", &["material.m.young=1e-9"]).is_empty());
}

/// Against a wall and against another bar; c = √(E/ρ) = 1.
#[test]
fn an_impact_that_no_elastic_body_survives() {
    let fast = |text: &str, sets: &[&str]| warned(text, "fast-impact", sets);
    let stated = "contact \"hit\": its bodies start with a relative velocity of 0.340 m/s, 0.340 times the speed √(E/ρ) = 1.00 m/s of waves in a bar of \"m\"";
    assert_eq!(fast(WALL, &["body.bar.velocity=[-0.34]"]), [stated]);
    assert!(fast(WALL, &["body.bar.velocity=[-0.33]"]).is_empty());
    // A bar that cannot widen carries faster waves than one that can: its modulus is not E.
    assert_eq!(fast(WALL, &["body.bar.velocity=[-0.34]", "material.m.poisson=0.4"]), [stated]);
    let strikes = |striker: &str, pad: &str| {
        let velocities = [("striker", striker), ("pad", pad)];
        let velocities = velocities.map(|(body, v)| format!("body.{body}.velocity=[{v}]"));
        fast(ON_SOFT, &["support=[]", &velocities[0], &velocities[1]])
    };
    let what = strikes("-0.2", "0.2").swap_remove(0);
    assert!(
        what.contains("velocity of 0.400 m/s, 0.400 times") && what.ends_with("in a bar of \"soft\""),
        "{what}"
    );
    assert!(strikes("-0.5", "-0.5").is_empty());
    let receding =
        "contact.hit.primary={ plane = { point = [0.0], normal = [1.0] }, motion = { x = \"-0.5*t\" } }";
    assert!(fast(WALL, &["body.bar.velocity=[-0.6]", receding]).is_empty());
}

/// Right-angled triangles with legs 1 and h: the sine of the smallest angle over that of 60°.
#[test]
fn cells_that_are_nearly_flat() {
    let flat = |height: &str, element: &str| {
        let body = format!(
            "body=[{{ name = \"slab\", material = \"m\", element = \"{element}\", mesh = {{ shape = \"rectangle\", min = [0.0, 0.0], max = [3.0, {height}], cells = [3, 1] }} }}]"
        );
        warned(PUSHED, "flat-cell", &["dimension=2", "support=[]", "probe=[]", &body])
    };
    // 0.05/√1.0025 · 2/√3 = 0.0577; the first cell has the corners (0, 0), (1, 0) and another one.
    let [what] = &flat("0.05", "T3")[..] else { panic!() };
    assert!(
        what.starts_with("body \"slab\": the scaled Jacobian of its cell at (0.")
            && what.ends_with(" m is 0.0577"),
        "{what}"
    );
    assert!(flat("0.1", "T3").is_empty() && flat("0.05", "Q4").is_empty());
    assert_eq!(flat("0.05", "T6").len(), 1);
}
