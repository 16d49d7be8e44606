//! Errors, places, orders and claims of studies against exact solutions: a mass on a spring, u =
//! sin(ωt)/ω at its end, and bars that meet.

use std::sync::atomic::AtomicBool;

use carom_record::metrics::Signal;
use carom_record::study::Study;
use carom_record::study::design::Goal;
use carom_record::{History, Run};
use carom_study::{Plan, start};
use tempfile::TempDir;

use crate::common;

/// ω = 2π; the exact motion is a formula of the case.
fn spring(end: f64, exact: &str) -> String {
    format!(
        r#"
dimension = 1
[[material]]
name = "spring"
law = "linear-elastic"
density = 2.0
young = 39.47841760435743
poisson = 0.0
[[body]]
name = "bar"
material = "spring"
element = "L2"
mass = "lumped"
mesh = {{ shape = "interval", min = 0.0, max = 1.0, cells = 1 }}
velocity = ["X"]
[[support]]
on = ["bar.left"]
fix = ["x"]
[time]
end = {end}
step = 0.01
scheme = {{ kind = "newmark", beta = 0.25, gamma = 0.5 }}
energy_guard = false
[[probe]]
name = "end"
body = "bar"
at = [1.0]
record = ["ux", "vx"]
[output]
fields_every = 0
[newton]
tolerance = 1e-12
[exact]
"end.ux" = "{exact}"
"#
    )
}

const MOTION: &str = "sin(2*pi*t)/(2*pi)";

fn study_of(cases: &[(&str, &str)], text: &str) -> (TempDir, Study) {
    let (folder, path) = common::raw_folder(cases, text);
    let directory = folder.path().join("out");
    let plan = Plan::read(&path).unwrap();
    let study = start(&plan, &directory, 1, &mut |_| {}, &AtomicBool::new(false)).unwrap().study;
    (folder, study)
}

/// Norm of the deviation of the end from its exact motion, sin(ωt)/(fω), evaluated at the rows,
/// over its amplitude.
fn off(study: &Study, arm: usize, omega: f64, f: f64) -> f64 {
    let run = Run::open(&study.directory.join(&study.manifest.arms[arm].directory)).unwrap();
    let history: &History = &run.history;
    let right: Vec<f64> = history.times().iter().map(|t| (omega * t).sin() / (f * omega)).collect();
    let own = Signal::of(history.times(), vec![history.column("end.ux").unwrap()]);
    f * omega * own.distance(&Signal::of(history.times(), vec![&right]), 0.0).unwrap().smooth
}

/// Errors of the arms by the goal of the study.
fn errors(study: &Study) -> Vec<(usize, f64)> {
    let ranked = study.ranking.as_ref().unwrap().levels.iter().flatten();
    ranked.map(|ranked| (ranked.arm, ranked.error)).collect()
}

const ARMS: &str = r#"
case = "case.toml"
goal = "trajectory"
reference = "exact"
design = "matched-step"
steps = [0.02, 0.01]
[[arm]]
name = "Newmark"
[[arm]]
name = "CH"
set = { "time.scheme" = { kind = "chung-hulbert", rho_inf = 0.5 } }
"#;

/// A stiff spring that is shaken for 100 periods, with ω/10 for its mass: u = A sin(ωt). Errors are
/// a hundredth of what straight lines between 8 000 samples are off.
#[test]
fn exact_motion_is_that_at_the_rows() {
    let load = "[[load]]\non = [\"bar.right\"]\ntraction = [\"sin(2*pi*t)\"]\n[time]";
    let case = spring(100.0, "sin(2*pi*t)/(99*4*pi^2)")
        .replace("39.47841760435743", "3947.841760435743")
        .replace("velocity = [\"X\"]", "velocity = [\"X*2*pi/(99*4*pi^2)\"]")
        .replace("[time]", load);
    let (_folder, study) = study_of(&[("case.toml", &case)], ARMS);
    let found = errors(&study);
    assert_eq!(found.len(), 4);
    let largest = found.iter().map(|(_, error)| *error).fold(0.0, f64::max);
    assert!(largest < 2e-4, "{found:?}");
    for (arm, error) in found {
        let known = off(&study, arm, std::f64::consts::TAU, 99.0 * std::f64::consts::TAU);
        assert!((error / known - 1.0).abs() < 1e-3, "{arm}: {error} {known}");
    }
    let verdict = study.recommended().unwrap();
    assert!(errors(&study).iter().all(|(arm, error)| {
        *arm == verdict || *error >= errors(&study).iter().find(|(arm, _)| *arm == verdict).unwrap().1
    }));
}

#[test]
fn every_arm_is_compared_with_its_own_exact_motion() {
    let text = r#"
case = "case.toml"
goal = "trajectory"
reference = "exact"
[[arm]]
name = "soft"
[[arm]]
name = "stiff"
set = { "material.spring.young" = 157.91367041742973, exact = { "end.ux" = "sin(4*pi*t)/(4*pi)" } }
"#;
    let (_folder, study) = study_of(&[("case.toml", &spring(4.0, MOTION))], text);
    for (arm, error) in errors(&study) {
        let known = off(&study, arm, [1.0, 2.0][arm] * std::f64::consts::TAU, 1.0);
        assert!((error / known - 1.0).abs() < 1e-3, "{arm}: {error} {known}");
    }
    assert!(study.standing("end.ux:max").unwrap_err().to_string().contains("different formulas"));
}

#[test]
fn a_formula_that_is_no_number_is_named() {
    let (_folder, study) =
        study_of(&[("case.toml", &spring(4.0, "if(t < 3.9, sin(2*pi*t)/(2*pi), sqrt(3.9-t))"))], ARMS);
    let ranking = study.ranking.unwrap();
    let why = ranking.measure.unwrap_err().to_string();
    assert!(
        ranking.goal == Goal::Trajectory && why.contains("`end.ux` in [exact] is NaN at t = 3.9"),
        "{why}"
    );
}

const ORDERS: &str = r#"
[[expect]]
what = "order"
of = "end.ux"
against = "time.step"
value = 2
tolerance = 0.05
source = "theory"
"#;

/// The formula of a spring that is a tenth too fast stays as far from every step.
#[test]
fn the_order_of_a_number_is_that_of_its_error() {
    let text = |of: &str| {
        let expect = ORDERS.replace("end.ux", of);
        format!(
            "case = \"case.toml\"\nreference = \"exact\"\n[grid]\n\"time.step\" = [0.01, 0.005]\n{expect}"
        )
    };
    let order = |motion: &str, of: &str| {
        let (_folder, study) = study_of(&[("case.toml", &spring(3.9, motion))], &text(of));
        study.expectations[0].got.unwrap()
    };
    for of in ["end.ux", "last end.ux"] {
        assert!((order(MOTION, of) - 2.0).abs() < 0.01, "{of}");
        assert!(order("sin(2.2*pi*t)/(2.2*pi)", of).abs() < 0.05, "{of}");
    }
}

#[test]
fn the_sequence_of_changes_decides_no_order() {
    let arm = |name: &str, set: &str| format!("[[arm]]\nname = \"{name}\"\nset = {{ {set} }}\n");
    let order = |of_reference: &str| {
        let both = "\"newton.tolerance\" = 1e-12, \"time.energy_guard\" = false";
        let arms = [
            arm("coarse", &format!("\"time.step\" = 0.04, {both}")),
            arm("fine", &format!("\"time.step\" = 0.02, {both}")),
            arm("ref", of_reference),
        ];
        let text = format!("case = \"case.toml\"\nreference = \"ref\"\n{}{ORDERS}", arms.concat());
        study_of(&[("case.toml", &spring(4.0, MOTION))], &text).1.expectations[0].got.unwrap()
    };
    let known = order("\"time.step\" = 0.01, \"newton.tolerance\" = 1e-12, \"time.energy_guard\" = false");
    assert!((known - 2.0).abs() < 0.05, "{known}");
    let turned = "\"newton.tolerance\" = 1e-12, \"time.energy_guard\" = false, \"time.step\" = 0.01";
    for other in [turned, "\"time.step\" = 0.01"] {
        assert!((order(other) - known).abs() < 1e-12, "{other}");
    }
}

#[test]
fn values_of_the_case_that_an_arm_states_decide_no_order() {
    let text = format!(
        "case = \"case.toml\"\nreference = \"exact\"\n\
         [[arm]]\nname = \"coarse\"\nset = {{ \"time.step\" = 0.02 }}\n\
         [[arm]]\nname = \"fine\"\nset = {{ \"time.step\" = 0.01, \"newton.tolerance\" = 1e-12 }}\n{ORDERS}"
    );
    let (_folder, study) = study_of(&[("case.toml", &spring(3.9, MOTION))], &text);
    assert!((study.expectations[0].got.unwrap() - 2.0).abs() < 0.01);
}

/// Two bars, each with its own number of cells: arms that differ in both are no refinement of one.
#[test]
fn a_key_of_another_body_makes_another_group() {
    let case = row_of_bars(["right.left", "middle.right"]);
    let text = format!(
        "case = \"case.toml\"\n[grid]\n\"body.left.mesh.cells\" = [10, 20, 40]\n\
         \"body.right.mesh.cells\" = [20, 40]\n{}",
        ORDERS.replace("end.ux", "far.ux").replace("time.step", "body.left.mesh.cells")
    );
    let (_folder, study) = study_of(&[("case.toml", &case)], &text);
    assert_eq!(study.expectations.len(), 2);
    assert!(
        study.expectations.iter().all(|expectation| expectation.got.is_some()),
        "{:?}",
        study.expectations
    );
}

/// Rows a quarter apart say nothing of averages over an eighth.
#[test]
fn averages_need_rows() {
    let text = ARMS.replace("trajectory", "force").replace("exact", "fine").replace("[0.02, 0.01]", "[0.02]");
    let text = format!("window = 0.125\n{text}");
    let case = row_of_bars(["right.left", "middle.right"]);
    let thinned = case.replace("output = { ", "output = { history_every = 13, ");
    let why = |case: &str| {
        let (_folder, study) = study_of(&[("case.toml", case)], &text);
        study.ranking.unwrap().apart.into_iter().map(|apart| apart.why).collect::<Vec<_>>()
    };
    assert!(why(&case).is_empty());
    assert!(why(&thinned).iter().all(|why| why.contains("rows 0.26 apart")) && why(&thinned).len() == 2);
}

/// A bar on a wall, with these units, length, density, modulus and step.
fn bar(units: [&str; 3], length: f64, density: f64, young: f64, step: f64) -> String {
    let [of_length, of_time, of_mass] = units;
    format!(
        r#"
dimension = 1
units = {{ length = "{of_length}", time = "{of_time}", mass = "{of_mass}" }}
material = [{{ name = "m", law = "linear-elastic", density = {density}, young = {young}, poisson = 0.0 }}]
contact = [{{ name = "wall", secondary = "bar.left", primary = {{ plane = {{ point = [0.0], normal = [1.0] }} }} }}]
time = {{ end = {}, step = {step}, scheme = {{ kind = "chung-hulbert", rho_inf = 0.5 }} }}
probe = [{{ name = "tip", body = "bar", at = [{}], record = ["ux"] }}]
output = {{ fields_every = 0 }}
[[body]]
name = "bar"
material = "m"
element = "L2"
mesh = {{ shape = "interval", min = {}, max = {}, cells = 10 }}
velocity = [-1.0]
"#,
        400.0 * step,
        1.01 * length,
        0.01 * length,
        1.01 * length
    )
}

/// A bar in m and s, and the same in mm and ms. Claims refer to the numbers of each record.
#[test]
fn arms_are_compared_in_the_units_of_the_first_one() {
    let si = bar(["m", "s", "kg"], 0.1, 1000.0, 1e7, 1e-5);
    let mm = bar(["mm", "ms", "g"], 100.0, 1e-3, 10.0, 1e-2);
    let text = r#"
case = "si.toml"
[[arm]]
name = "SI"
[[arm]]
name = "mm"
case = "mm.toml"
[[claim]]
text = "durations"
compare = 'contact_duration of "mm" / 1000 < 1.001 * contact_duration of "SI"'
[[claim]]
text = "displacements"
compare = 'min tip.ux of "mm" / 1000 > 1.001 * min tip.ux of "SI"'
"#;
    let (_folder, study) = study_of(&[("si.toml", &si), ("mm.toml", &mm)], text);
    let of = |arm: usize, metric: &str| study.rows[arm].value(metric).unwrap();
    assert!((of(0, "contact_duration") - of(1, "contact_duration")).abs() < 1e-9);
    assert!((of(0, "tip.ux:min") / of(1, "tip.ux:min") - 1.0).abs() < 1e-6);
    assert!(study.verdicts.iter().all(|verdict| verdict.holds == Some(true)), "{:?}", study.verdicts);
}

/// Three bars in a row; `sides`: secondary and primary side of the second contact.
fn row_of_bars(sides: [&str; 2]) -> String {
    let bar = |name: &str, min: f64, velocity: f64| {
        format!(
            "[[body]]\nname = \"{name}\"\nmaterial = \"m\"\nelement = \"L2\"\nvelocity = [{velocity}]\n\
             mesh = {{ shape = \"interval\", min = {min}, max = {}, cells = 20 }}\n",
            min + 10.0
        )
    };
    let [secondary, primary] = sides;
    format!(
        r#"
dimension = 1
material = [{{ name = "m", law = "linear-elastic", density = 1.0, young = 100.0, poisson = 0.0 }}]
contact = [
    {{ name = "first", secondary = "left.right", primary = "middle.left" }},
    {{ name = "second", secondary = "{secondary}", primary = "{primary}" }},
]
time = {{ end = 4.0, step = 0.02, scheme = {{ kind = "chung-hulbert", rho_inf = 0.5 }}, energy_guard = false }}
probe = [{{ name = "far", body = "right", at = [20.1], record = ["ux"] }}]
output = {{ fields_every = 0 }}
{}{}{}"#,
        bar("left", -10.1, 0.2),
        bar("middle", 0.0, 0.0),
        bar("right", 10.1, -0.15)
    )
}

/// Which side of a contact is secondary decides the sign of its force alone: not the errors of
/// forces, nor a claim on one contact of a member whose sides are swapped.
#[test]
fn forces_of_several_contacts_do_not_depend_on_secondary_sides() {
    let ranked = |sides: [&str; 2]| {
        let text =
            ARMS.replace("trajectory", "force").replace("exact", "fine").replace("[0.02, 0.01]", "[0.02]");
        let (_folder, study) = study_of(&[("case.toml", &row_of_bars(sides))], &text);
        errors(&study)
    };
    let one = ranked(["right.left", "middle.right"]);
    let other = ranked(["middle.right", "right.left"]);
    assert!(one.len() == 2 && one == other, "{one:?} {other:?}");
    let text = r#"
case = "case.toml"
ensemble = { swapped = true }
[[arm]]
name = "CH"
[[arm]]
name = "BE"
set = { "time.scheme" = { kind = "backward-euler" } }
[[claim]]
text = "the left bar is pushed back"
compare = 'min first.force_x of "CH" < -0.5'
"#;
    let (_folder, study) = study_of(&[("case.toml", &row_of_bars(["right.left", "middle.right"]))], text);
    let confirmed = study.verdicts[0].ensemble.as_ref().unwrap();
    assert_eq!((confirmed.count, confirmed.of, confirmed.members), (2, 2, 2));
}
