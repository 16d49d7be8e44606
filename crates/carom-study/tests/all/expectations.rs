//! Expectations of arms and of studies: their outcomes, orders in time, arms with other cases,
//! stopped arms, and errors.

use std::fs;
use std::path::PathBuf;
use std::sync::atomic::AtomicBool;

use carom_record::study::Study;
use carom_run::case::Diagnostic;
use carom_study::{Plan, start};

use crate::common;

/// A bar in free fall, which every scheme of second order integrates exactly up to round-off.
const FALL: &str = r#"
[[body]]
name = "bar"
material = "steel"
element = "L2"
mesh = { shape = "interval", min = 0.0, max = 1.0, cells = 4 }
gravity = [-2.0]
velocity = [1.0]
[time]
end = 0.4
step = 0.01
scheme = { kind = "newmark", beta = 0.25, gamma = 0.5 }
[[probe]]
name = "A"
body = "bar"
at = [1.0]
record = ["ux", "vx"]
[output]
fields_every = 0
"#;

/// One cell fixed at one end: an oscillator of mass ρL/3 and stiffness E/L, ω = √300, with initial
/// velocity 1: u = sin(ωt)/ω.
fn fixed() -> String {
    FALL.replace("gravity = [-2.0]", "")
        .replace("cells = 4", "cells = 1")
        .replace("[time]", "[[support]]\non = [\"bar.left\"]\nfix = [\"x\"]\n[time]")
}

fn folder(study: &str) -> (tempfile::TempDir, PathBuf) {
    common::folder(&[("fall.toml", FALL), ("fixed.toml", &fixed())], study)
}

fn run(study: &str) -> Study {
    let (folder, path) = folder(study);
    let plan = Plan::read(&path).unwrap_or_else(|e| panic!("{e}"));
    start(&plan, &folder.path().join("out"), 2, &mut |_| (), &AtomicBool::new(false)).unwrap().study
}

fn wrong(study: &str) -> Diagnostic {
    common::wrong(folder(study)).swap_remove(0)
}

#[test]
fn expectations_of_arms() {
    let study = run(r#"
case = "fall.toml"
[[arm]]
name = "up"
expect = [
  { what = "A.ux", formula = "t - t^2", tolerance = 1e-12, source = "free flight" },
  { what = "A.vx", formula = "1 - 2*t", norm = "rms", tolerance = 1e-12, after = 0.1 },
  { what = "last A.ux / last A.vx", value = 1.2, tolerance = 1e-9 },
  { what = "steps", value = 40, tolerance = 0 },
  { what = "A.ux", formula = "t", tolerance = 1e-3, slow = true },
]
[[arm]]
name = "down"
set = { "body.bar.velocity" = [-1.0], "body.bar.gravity" = [2.0] }
[[arm]]
name = "fixed"
case = "fixed.toml"
expect = [{ what = "first A.vx", value = 1, tolerance = 0 }]
[[expect]]
what = 'peak [ A.ux of "up" + A.ux of "down" ]'
at_most = 1e-12
[[expect]]
what = 'difference A.ux of "up" and "down" / ( 2 * max A.ux of "up" )'
value = 1.0
tolerance = 1e-9
[[expect]]
what = 'last A.ux of "up" - last A.ux of "down"'
value = 0.48
tolerance = 1e-9
[[expect]]
what = 'contact_episodes of "up" + stopped of "up"'
value = 0
tolerance = 0
"#);
    let up = &study.rows[0].expectations;
    assert_eq!(up.iter().map(|e| e.pass).collect::<Vec<_>>(), [true, true, true, true, false], "{up:?}");
    assert!((up[4].got.unwrap() - 0.16).abs() < 1e-9 && up[4].slow);
    assert!(study.rows[1].expectations.is_empty());
    assert!(study.rows[2].expectations[0].pass, "{:?}", study.rows[2]);
    assert!(study.expectations.iter().all(|e| e.pass), "{:?}", study.expectations);
    assert_eq!(study.manifest.source.others.keys().collect::<Vec<_>>(), ["fixed.toml"]);
}

/// Free flight is t − t²; data that are 0.01 lower at all times differ by it.
#[test]
fn differences_from_measured_data() {
    let overlay = "[[overlay]]\nname = \"camera\"\nfile = \"m.csv\"\ncolumn = \"A.ux\"\n";
    let measured = format!("{FALL}{overlay}");
    let study = "case = \"measured.toml\"\n[[arm]]\nname = \"a\"\n[[expect]]\nwhat = \
                 'overlay_rms:camera of \"a\"'\nvalue = 0.01\ntolerance = 1e-9\n";
    let (folder, path) = common::folder(&[("measured.toml", &measured)], study);
    let points = [0.1, 0.2, 0.3].map(|t: f64| format!("{t},{}\n", t - t * t - 0.01)).concat();
    fs::write(folder.path().join("m.csv"), format!("t,value\n{points}")).unwrap();
    let plan = Plan::read(&path).unwrap_or_else(|e| panic!("{e}"));
    let out = folder.path().join("out");
    let study = start(&plan, &out, 1, &mut |_| (), &AtomicBool::new(false)).unwrap().study;
    assert!(study.expectations[0].pass, "{:?}", study.expectations);
}

/// The trapezoidal rule has order 2, Newmark's method with γ = 0.6 has order 1: for a column and
/// for a number, with respect to a fine arm and among the arms.
#[test]
fn orders_in_time() {
    let grid = r#"
case = "fixed.toml"
[grid]
"time.scheme" = [{ kind = "newmark", beta = 0.25, gamma = 0.5 }, { kind = "newmark", beta = 0.3025, gamma = 0.6 }]
"time.step" = [0.004, 0.002, 0.001, 0.0005]
[[expect]]
what = "order"
of = "A.ux"
against = "time.step"
where = "0.25 0.5"
value = 2
tolerance = 0.1
[[expect]]
what = "order"
of = "last A.vx + 1"
against = "time.step"
where = "gamma"
value = 2
tolerance = 0.1
"#;
    let study = run(&grid.replace("where = \"gamma\"\n", ""));
    let got: Vec<_> = study.expectations.iter().map(|e| (e.what.as_str(), e.got.unwrap(), e.pass)).collect();
    assert_eq!(got.len(), 3, "{got:?}");
    assert!(got[0].2 && got[1].2 && !got[2].2, "{got:?}");
    assert!((got[2].1 - 1.0).abs() < 0.15, "{got:?}");
    assert!(
        got[2].0.contains("gamma = 0.6") && got[2].0.starts_with("order of last A.vx + 1 in time.step"),
        "{}",
        got[2].0
    );
    // Groups of fewer than three arms are reported, not ignored.
    let study = run(grid);
    assert!(study.expectations[1].why.as_ref().unwrap().contains("no 3 arms that differ only in time.step"));

    let study = run(r#"
case = "fixed.toml"
reference = "fine"
[[arm]]
name = "fine"
set = { "time.step" = 1e-4 }
[grid]
"time.step" = [0.004, 0.002]
[[expect]]
what = "order"
of = "A.ux"
against = "time.step"
value = 2
tolerance = 0.1
"#);
    assert!(study.expectations[0].pass, "{:?}", study.expectations);

    // The error of a reference at half the finest step is half of that arm's: it counts.
    let study = run(r#"
case = "fixed.toml"
reference = "half"
set = { "time.scheme" = { kind = "newmark", beta = 0.3025, gamma = 0.6 } }
[[arm]]
name = "half"
set = { "time.step" = 5e-4 }
[[arm]]
name = "once"
set = { "time.step" = 1e-3 }
[[arm]]
name = "twice"
set = { "time.step" = 2e-3 }
[[expect]]
what = "order"
of = "A.ux"
against = "time.step"
value = 1
tolerance = 0.1
[[expect]]
what = "order"
of = "last A.vx"
against = "time.step"
value = 1
tolerance = 0.15
"#);
    assert!(study.expectations.iter().all(|e| e.pass), "{:?}", study.expectations);
}

/// With respect to the exact motion of the oscillator.
#[test]
fn orders_from_formulas() {
    let study = run(r#"
case = "fixed.toml"
[grid]
"time.scheme" = [{ kind = "newmark", beta = 0.25, gamma = 0.5 }]
"time.step" = [0.004, 0.002]
[[expect]]
what = "order"
of = "A.ux"
against = "time.step"
formula = "sin(sqrt(300)*t)/sqrt(300)"
value = 2
tolerance = 0.05
[[expect]]
what = "order"
of = "last A.ux"
against = "time.step"
exact = 0.03471103492645924
value = 2
tolerance = 0.05
[[expect]]
what = 'max A.ux of "time.scheme=newmark 0.25 0.5, time.step=0.002"'
value = 0.057735
relative = 1e-3
"#);
    for e in &study.expectations {
        assert!(e.pass, "{e:?}");
    }
}

/// The same formula, given in the case.
#[test]
fn orders_from_the_case() {
    let study = r#"
case = "fixed.toml"
reference = "exact"
[[arm]]
name = "one"
set = { "time.step" = 0.004 }
expect = [{ what = "A.ux", formula = "exact", tolerance = 2e-3 }]
[[arm]]
name = "two"
set = { "time.step" = 0.002 }
[[expect]]
what = "order"
of = "A.ux"
against = "time.step"
value = 2
tolerance = 0.05
"#;
    let (folder, path) = folder(study);
    let exact = "[exact]\n\"A.ux\" = \"sin(sqrt(300)*t)/sqrt(300)\"\n";
    fs::write(folder.path().join("fixed.toml"), format!("{}{}{exact}", common::STEEL, fixed())).unwrap();
    let plan = Plan::read(&path).unwrap_or_else(|e| panic!("{e}"));
    let study =
        start(&plan, &folder.path().join("out"), 2, &mut |_| (), &AtomicBool::new(false)).unwrap().study;
    let arm = &study.rows[0].expectations[0];
    assert!(arm.pass && arm.what == "max |A.ux − (exact)|", "{arm:?}");
    assert!(study.expectations[0].pass, "{:?}", study.expectations);
}

#[test]
fn a_stopped_arm_may_be_expected() {
    let study = run(r#"
case = "fixed.toml"
[[arm]]
name = "guarded"
set = { "newton.max_iterations" = 1, "newton.tolerance" = 1e-300 }
expect = [{ what = "stopped", value = 1, tolerance = 0 }, { what = "first A.vx", value = 1, tolerance = 0 }]
[[arm]]
name = "unexpected"
set = { "newton.max_iterations" = 1, "newton.tolerance" = 1e-300 }
expect = [{ what = "first A.vx", value = 1, tolerance = 0 }]
[[arm]]
name = "fine"
expect = [{ what = "stopped", value = 1, tolerance = 0 }]
[[expect]]
what = 'stopped of "guarded" + stopped of "fine"'
value = 1
tolerance = 0
[[expect]]
what = 'last A.ux of "guarded"'
value = 0
tolerance = 1
"#);
    assert!(study.rows[0].expectations.iter().all(|e| e.pass), "{:?}", study.rows[0]);
    assert!(study.rows[1].expectations[0].why.as_ref().unwrap().contains("the run stopped"));
    assert!(!study.rows[2].expectations[0].pass);
    assert!(study.expectations[0].pass);
    assert!(study.expectations[1].why.as_ref().unwrap().contains("arm \"guarded\" stopped"));
}

#[test]
fn wrong_expectations_are_shown_where_they_stand() {
    let arm = |expect: &str| {
        wrong(&format!("case = \"fall.toml\"\n[[arm]]\nname = \"a\"\nexpect = [\n{expect}\n]\n"))
    };
    let found = arm("{ what = \"last A.uz\", at_most = 1 }");
    assert!(found.what.contains("no column `A.uz`") && found.file.ends_with("study.toml"), "{found:?}");
    assert_eq!(found.line, 4);
    let found = arm("{ what = \"A.ux\", formula = \"t +\", at_most = 1 }");
    assert_eq!((found.line, found.column), (5, 32), "{found:?}");
    assert!(arm("{ what = \"last A.ux\" }").what.contains("needs exactly one bound"));
    let of =
        |expect: &str| wrong(&format!("case = \"fall.toml\"\n[[arm]]\nname = \"a\"\n[[expect]]\n{expect}\n"));
    let found = of("what = \"last A.ux\"\nat_most = 1");
    assert!(found.why.contains("names no arm") && found.line == 5, "{found:?}");
    assert!(of("what = 'last A.ux of \"b\"'\nat_most = 1").what.contains("no arm is named \"b\""));
    assert!(of("what = 'last A.uz of \"a\"'\nat_most = 1").what.contains("did you mean `A.ux`"));
    assert!(of("what = \"order\"\nof = \"A.ux\"\nat_most = 1").what.contains("`against`"));
    assert!(
        of("what = \"order\"\nof = \"A.uz\"\nagainst = \"time.step\"\nat_most = 1")
            .what
            .contains("no column")
    );
    let found = of("what = 'overlay_rms:camera of \"a\"'\nat_most = 1");
    assert!(found.what.contains("arm \"a\" has no measured data `camera`"), "{found:?}");
    let found = wrong("[[arm]]\nname = \"a\"\ncase = \"none.toml\"\n");
    assert_eq!((found.line, found.column), (3, 8), "{found:?}");
}
