//! Newton's coefficient of restitution against wave solutions, in moving frames, and along the
//! normal of a contact with friction.

use std::path::Path;
use std::sync::atomic::AtomicBool;

use carom_record::metrics::{no_rebound, of_rebound, of_run};
use carom_record::{Run, Source};
use carom_run::recording::run;

use super::common::case;

/// A short bar strikes a long one.
const BARS: &str = r#"
dimension = 1
material = [{ name = "m", law = "linear-elastic", density = 1.0, young = 1.0, poisson = 0.0 }]
[[body]]
name = "short"
material = "m"
element = "L2"
mesh = { shape = "interval", min = -1.0, max = 0.0, cells = 50 }
velocity = [0.01]
[[body]]
name = "long"
material = "m"
element = "L2"
mesh = { shape = "interval", min = 0.01, max = 2.01, cells = 100 }
velocity = [0.0]
[[contact]]
name = "hit"
secondary = "short.right"
primary = "long.left"
[time]
end = 8.0
step = 0.02
scheme = { kind = "chung-hulbert", rho_inf = 0.5 }
[output]
fields_every = 0
"#;

pub(super) fn record(text: &str, sets: &[&str]) -> Run {
    let folder = tempfile::tempdir().unwrap();
    record_in(&folder.path().join("run"), text, sets)
}

/// Runs a case into a folder.
pub(super) fn record_in(directory: &Path, text: &str, sets: &[&str]) -> Run {
    let sets_in_source = sets.iter().map(|set| (*set).to_owned()).collect();
    let source = Source { text: text.to_owned(), sets: sets_in_source, ..Source::default() };
    run(&case(text, sets), source, directory, 1, &mut |_| {}, &AtomicBool::new(false)).unwrap();
    Run::open(directory).unwrap()
}

fn restitution(run: &Run) -> Option<f64> {
    value(run, "restitution")
}

fn value(run: &Run, name: &str) -> Option<f64> {
    of_rebound(run).into_iter().find(|metric| metric.name == name).unwrap().value
}

fn of(text: &str, sets: &[&str]) -> f64 {
    restitution(&record(text, sets)).unwrap()
}

/// Of two bars of one impedance the shorter one stops, and the other one gets its momentum: e is
/// the ratio of their lengths (K. L. Johnson, *Contact Mechanics*, 1985, § 11.1).
#[test]
fn the_ratio_of_the_lengths_of_two_bars() {
    let half = of(BARS, &[]);
    assert!((half - 0.5).abs() < 0.01, "{half}");
    let equal = of(BARS, &["body.long.mesh={ shape = \"interval\", min = 0.01, max = 1.01, cells = 50 }"]);
    assert!((equal - 1.0).abs() < 0.03, "{equal}");
    // Whichever is the faster one, and whichever the secondary one.
    let swapped =
        ["contact.hit.secondary=long.left", "contact.hit.primary=short.right", "body.short.velocity=[0.0]"];
    let struck = of(BARS, &[&swapped[..], &["body.long.velocity=[-0.01]"]].concat());
    assert!((struck - half).abs() < 1e-6, "{struck} {half}");
}

/// A frame in which everything moves with another velocity sees the same impact: two free bars, a
/// bar whose end is held, and a rigid wall.
#[test]
fn the_same_in_every_frame() {
    let held = |motion: &str| format!("support=[{{ on = [\"long.right\"], {motion} }}]");
    let end = "time.end=12.0";
    let free = of(BARS, &[]);
    let moving = of(BARS, &["body.short.velocity=[-0.02]", "body.long.velocity=[-0.03]"]);
    assert!((moving - free).abs() < 1e-9, "{moving} {free}");
    let fixed = of(BARS, &[&held("fix = [\"x\"]"), end]);
    let across = of(BARS, &[&held("fix = [\"normal\"]"), end]);
    assert_eq!(across, fixed);
    let motion = held("move = { x = \"-0.03*t\" }");
    let moving = of(BARS, &[&motion, end, "body.short.velocity=[-0.02]", "body.long.velocity=[-0.03]"]);
    assert!((moving - fixed).abs() < 1e-9, "{moving} {fixed}");
    let wall = |velocity: &str| {
        format!("contact.hit.primary={{ plane = {{ point = [0.01], normal = [-1.0] }}{velocity} }}")
    };
    let away = "body.long.mesh={ shape = \"interval\", min = 5.0, max = 7.0, cells = 10 }";
    let fixed = of(BARS, &[&wall(""), away]);
    let motion = wall(", motion = { x = \"-0.03*t\" }");
    let moving = of(BARS, &[&motion, away, "body.short.velocity=[-0.02]"]);
    assert!((moving - fixed).abs() < 1e-9 && (fixed - 1.0).abs() < 0.03, "{moving} {fixed}");
}

/// Where a support changes the velocity of a body meanwhile, the separation is its work.
#[test]
fn no_restitution_of_a_body_that_a_support_drives() {
    let driven = "support=[{ on = [\"long.right\"], move = { x = \"-0.03*t + 0.001*t^2\" } }]";
    let sets = [driven, "time.end=12.0", "body.short.velocity=[-0.02]", "body.long.velocity=[-0.03]"];
    let run = record(BARS, &sets);
    assert_eq!(restitution(&run), None);
    assert!(no_rebound(&run).unwrap().contains("a support"), "{:?}", no_rebound(&run));
}

/// The force between two bars of one impedance, ρcv/2, lasts from t = 1, and stops the approach of
/// their centres after v/(ρcv/2 (1/m₁ + 1/m₂)) = 4/3, in every frame; that of a rigid wall, ρcv,
/// after 1.
#[test]
fn the_time_at_which_approach_turns_into_separation() {
    let turning = |sets: &[&str]| value(&record(BARS, sets), "turning_time").unwrap();
    let free = turning(&[]);
    assert!((free - (1.0 + 4.0 / 3.0)).abs() < 0.01, "{free}");
    let moving = turning(&["body.short.velocity=[-0.02]", "body.long.velocity=[-0.03]"]);
    assert!((moving - free).abs() < 1e-9, "{moving} {free}");
    let wall =
        "contact.hit.primary={ plane = { point = [0.01], normal = [-1.0] }, motion = { x = \"-0.03*t\" } }";
    let away = "body.long.mesh={ shape = \"interval\", min = 5.0, max = 7.0, cells = 10 }";
    let moving = turning(&[wall, away, "body.short.velocity=[-0.02]"]);
    assert!((moving - 2.0).abs() < 0.01, "{moving}");
}

/// With a motion that depends on the place, or where the striker strikes two bodies of different
/// velocities, it is not one number.
#[test]
fn not_defined_without_one_relative_velocity() {
    let twisted = "support=[{ on = [\"long.right\"], move = { x = \"0*X*t\" } }]";
    assert_eq!(restitution(&record(BARS, &[twisted])), None);
    assert_eq!(restitution(&record(BARS, &["time.end=0.4"])), None, "no contact");
    assert_eq!(restitution(&record(BARS, &["time.end=2.0"])), None, "in contact");
}

/// A disc strikes a rough plane obliquely: the impulse has a part along the plane, the coefficient
/// is that of the velocities across it.
#[test]
fn along_the_normal_in_spite_of_friction() {
    let disc = r#"
dimension = 2
material = [{ name = "m", law = "neo-hookean", density = 1.0, young = 1.0, poisson = 0.3 }]
body = [{ name = "disc", material = "m", element = "T6", mesh = { shape = "disc", radius = 0.5, center = [0.0, 0.51], size = 0.25 }, velocity = [0.1, -0.1] }]
contact = [{ name = "floor", secondary = "disc.arc", primary = { plane = { point = [0.0, 0.0], normal = [0.0, 1.0] } }, mu = 0.3 }]
time = { end = 4.0, step = 0.02, scheme = { kind = "chung-hulbert", rho_inf = 0.5 } }
output = { fields_every = 0 }
"#;
    let run = record(disc, &[]);
    let velocity = |axis: &str| run.column(&format!("disc.velocity_{axis}")).unwrap();
    let first = 0;
    let last = run.times().len() - 1;
    let across = -velocity("y")[last] / velocity("y")[first];
    let rubbed = (velocity("x")[first] - velocity("x")[last]) / 0.1;
    assert!(rubbed > 0.1, "{rubbed}");
    let found = restitution(&run).unwrap();
    assert!((found - across).abs() < 1e-4, "{found} {across}");
}

/// A disc thrown on a plane that comes towards it.
const PLANE: &str = r#"
dimension = 2
material = [{ name = "m", law = "neo-hookean", density = 1.0, young = 50.0, poisson = 0.3 }]
[[body]]
name = "disc"
material = "m"
element = "T6"
mesh = { shape = "disc", radius = 0.3, center = [0.1, 0.35], size = 0.15 }
velocity = [0.0, -0.5]
[[contact]]
name = "floor"
secondary = "disc.arc"
primary = { plane = { point = [0, 0], normal = [0, 1] }, motion = { y = "0.5*t" } }
[time]
end = 0.4
step = 0.005
scheme = { kind = "energy-momentum" }
[output]
fields_every = 0
"#;

/// A translation is the same as a rotation about a remote point. In space, where the axis has a
/// length of its own, likewise.
#[test]
fn an_obstacle_that_turns_has_its_velocity_at_the_contact() {
    let turned = r#"contact.floor.primary={ plane = { point = [0, 0], normal = [0, 1] }, motion = { rotate = "0.5*t/1e4*180/pi", about = [-1e4, 0.0] } }"#;
    let expected = record(PLANE, &[]);
    let found = record(PLANE, &[turned]);
    for name in ["restitution", "turning_time"] {
        let [expected, found] = [&expected, &found].map(|run| value(run, name).unwrap());
        assert!((found / expected - 1.0).abs() < 1e-3, "{name}: {found} {expected}");
    }
    let in_space = [
        "dimension=3".to_owned(),
        r#"body.disc.element="Tet4""#.to_owned(),
        r#"body.disc.mesh={ shape = "ball", radius = 0.3, center = [0, 0, 0.35], size = 0.2 }"#.to_owned(),
        "body.disc.velocity=[0, 0, -0.5]".to_owned(),
        r#"contact.floor.secondary="disc.skin""#.to_owned(),
    ];
    let floor = |motion: &str| {
        format!(
            "contact.floor.primary={{ plane = {{ point = [0, 0, 0], normal = [0, 0, 1] }}, motion = {{ {motion} }} }}"
        )
    };
    let [moved, swung] =
        [r#"z = "0.5*t""#, r#"rotate = "-0.5*t/1e4*180/pi", about = [-1e4, 0, 0], axis = [0, 3, 0]"#].map(
            |motion| {
                let mut sets = in_space.to_vec();
                sets.push(floor(motion));
                let sets: Vec<&str> = sets.iter().map(String::as_str).collect();
                of(PLANE, &sets)
            },
        );
    assert!((swung / moved - 1.0).abs() < 1e-3, "{swung} {moved}");
}

/// A body that meets nothing, and moves faster, is no striker.
#[test]
fn a_body_that_flies_past_does_not_strike() {
    let past = r#"body=[
        { name = "past", material = "m", element = "T6", mesh = { shape = "disc", radius = 0.3, center = [9.0, 9.0], size = 0.3 }, velocity = [5.0, 0.0] },
        { name = "disc", material = "m", element = "T6", mesh = { shape = "disc", radius = 0.3, center = [0.1, 0.35], size = 0.15 }, velocity = [0.0, -0.5] },
    ]"#;
    let alone = record(PLANE, &[]);
    let joined = record(PLANE, &[past]);
    for name in ["restitution", "turning_time"] {
        let [alone, joined] = [&alone, &joined].map(|run| value(run, name).unwrap());
        assert!((joined / alone - 1.0).abs() < 1e-9, "{name}: {joined} {alone}");
    }
}

/// A bat that turns about a point which travels, with all else, at V.
#[test]
fn a_bat_strikes_alike_in_every_frame() {
    let seen = |speed: f64| {
        let primary = format!(
            r#"contact.floor.primary={{ polyline = {{ points = [[1, -0.1], [1, 0], [-1, 0], [-1, -0.1]], radius = 0 }}, motion = {{ x = "{speed:?}*t", rotate = "180/pi*t", about = [-0.9, 0] }} }}"#
        );
        let velocity = format!("body.disc.velocity=[{speed:?}, 0]");
        let place = "body.disc.mesh.center=[0.1, 0.32]";
        let run = record(PLANE, &[&primary, &velocity, place, "time.end=0.6"]);
        ["restitution", "turning_time"].map(|name| value(&run, name).unwrap())
    };
    let at_rest = seen(0.0);
    for found in [seen(-3.0), seen(5.0)] {
        let error = found.iter().zip(at_rest).map(|(found, at_rest)| (found / at_rest - 1.0).abs());
        assert!(error.fold(0.0, f64::max) < 1e-8, "{found:?} {at_rest:?}");
    }
}

/// Three bars in a row: metrics of the contact force do not depend on which sides are secondary,
/// and those of the impulse, which is that of no body, are not available.
#[test]
fn contacts_of_several_bodies() {
    const ROW: &str = include_str!("../../../../cases/bar/three-bars.toml");
    let swapped = ROW
        .replace("secondary = \"second.right\"", "secondary = \"third.left\"")
        .replace("primary = \"third.left\"", "primary = \"second.right\"");
    let metrics = [ROW, &swapped].map(|text| of_run(&record(text, &[])));
    let both = |name: &str| {
        metrics.each_ref().map(|run| run.iter().find(|metric| metric.name == name).unwrap().value)
    };
    for name in ["peak_force", "force_roughness"] {
        let [one, other] = both(name).map(Option::unwrap);
        assert!((one - other).abs() < 1e-9 * one.abs(), "{name}: {one} {other}");
    }
    // Each contact transfers the force ρ c v/2, with the overshoot of a front that jumps.
    let force = both("peak_force")[0].unwrap();
    assert!((force / 0.05 - 1.0).abs() < 0.4, "{force}");
    for name in ["impulse_x", "peak_mean_force"] {
        assert_eq!(both(name), [None, None], "{name}");
    }
}

/// Two discs that never meet fall on one floor: the restitution of the faster one, and its apex,
/// are those of its own contact, as if it fell alone, while the other one is still in contact.
#[test]
fn the_restitution_of_a_body_is_that_of_its_own_contact() {
    let disc = |name: &str, radius: f64, x: f64, y: f64| {
        format!(
            "[[body]]\nname = \"{name}\"\nmaterial = \"m\"\nelement = \"T6\"\ngravity = [0.0, -10.0]\n\
             mesh = {{ shape = \"disc\", radius = {radius}, center = [{x}, {y}], size = 0.3 }}\n\
             [[contact]]\nname = \"f{name}\"\nsecondary = \"{name}.arc\"\n\
             primary = {{ plane = {{ point = [0.0, 0.0], normal = [0.0, 1.0] }} }}\n"
        )
    };
    let start = "dimension = 2\nmaterial = [{ name = \"m\", law = \"neo-hookean\", density = 1.0, young = 400.0, poisson = 0.3 }]\n";
    let end = "[time]\nend = 1.0\nstep = 2e-3\nscheme = { kind = \"energy-momentum\" }\n[output]\nfields_every = 0\n";
    let first = disc("a", 0.5, 0.0, 1.0);
    let alone = record(&[start, &first, end].concat(), &[]);
    let both = record(&[start, &first, &disc("b", 0.7, 3.0, 1.45), end].concat(), &[]);
    let restitutions = [&alone, &both].map(|run| restitution(run).unwrap());
    assert!((restitutions[0] - restitutions[1]).abs() < 1e-9, "{restitutions:?}");
    let apex = |run: &Run| of_run(run).into_iter().find(|metric| metric.name == "apex").unwrap().value;
    assert!((apex(&alone).unwrap() - apex(&both).unwrap()).abs() < 1e-9);
}

/// A wall that turns back while a bar is on it leaves the bar: that is not the bar's rebound.
#[test]
fn no_restitution_where_an_obstacle_changes_its_velocity() {
    let wall = |motion: &str| {
        format!(
            "contact.hit.primary={{ plane = {{ point = [-1.01], normal = [1.0] }}, motion = {{ x = \"{motion}\" }} }}"
        )
    };
    let sets = ["body.short.velocity=[0.0]", "contact.hit.secondary=short.left", "time.end=4.5"];
    let away = "body.long.mesh={ shape = \"interval\", min = 5.0, max = 7.0, cells = 10 }";
    let steady = record(BARS, &[&wall("0.02*t"), away, sets[0], sets[1], sets[2]]);
    assert!((restitution(&steady).unwrap() - 1.0).abs() < 0.03);
    let turning = wall("if(t < 2.3, 0.02*t, 0.046 - 0.1*(t - 2.3))");
    let run = record(BARS, &[&turning, away, sets[0], sets[1], sets[2]]);
    assert_eq!(restitution(&run), None);
    assert!(no_rebound(&run).unwrap().contains("obstacle"), "{:?}", no_rebound(&run));
}
