//! Studies of a bar that falls on a plane: rows, failure, stop and resume, errors in study files.

use std::fs;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};

use carom_record::Status;
use carom_record::study::checks::fingerprint;
use carom_run::case::Diagnostic;
use carom_study::{Event, Plan, resume, start};

use crate::common;

pub(crate) const CASE: &str = r#"
[[body]]
name = "bar"
material = "steel"
element = "L2"
mesh = { shape = "interval", min = 0.05, max = 1.05, cells = 10 }
velocity = [-1.0]
[[contact]]
name = "wall"
secondary = "bar.left"
primary = { plane = { point = [0.0], normal = [1.0] } }
[time]
end = 0.4
step = 0.01
scheme = { kind = "chung-hulbert", rho_inf = 0.5 }
[[probe]]
name = "A"
body = "bar"
at = [1.05]
record = ["ux"]
[output]
fields_every = 0
"#;

/// A folder with the case and a study of it.
fn folder(study: &str) -> (tempfile::TempDir, PathBuf) {
    common::folder(&[("bar.toml", CASE)], &format!("case = \"bar.toml\"\n{study}"))
}

fn wrong(study: &str) -> Vec<Diagnostic> {
    common::wrong(folder(study))
}

const THREE: &str = r#"
[[arm]]
name = "damped"
[[arm]]
name = "guarded"
set = { "time.scheme" = { kind = "newmark", beta = 0.25, gamma = 0.5 }, "contact.wall.persistency" = "none", "time.energy_guard" = 1e-13 }
[grid]
"time.step" = [0.005]
"time.scheme" = [{ kind = "hu" }]
[[claim]]
text = "Hu dissipates more"
compare = 'energy_lost of "time.step=0.005, time.scheme=hu" > energy_lost of "damped"'
[[claim]]
text = "The trapezoidal rule keeps its energy"
compare = 'energy_lost of "guarded" < 1e-6'
"#;

/// A guard that no shortened step satisfies stops the run in which nodes begin to touch more often.
#[test]
fn a_failed_arm_names_the_arms_of_its_method_that_finished() {
    let trapezoidal = r#""time.scheme" = { kind = "newmark", beta = 0.25, gamma = 0.5 }, "contact.wall.persistency" = "none", "time.energy_guard" = 1e-7"#;
    let arm = |name: &str, set: &str| format!("[[arm]]\nname = \"{name}\"\nset = {{ {set} }}\n");
    let step = |step: &str| format!("{trapezoidal}, \"time.step\" = {step}");
    let free = trapezoidal.replace("1e-7", "false");
    let arms = [
        arm("fine", &step("0.005")),
        arm("coarse", &step("0.01")),
        arm("damped", "\"time.step\" = 0.02"),
        arm("free", &format!("{free}, \"time.step\" = 0.02")),
    ];
    let (folder, path) = folder(&arms.concat());
    let directory = folder.path().join("study");
    let plan = Plan::read(&path).unwrap();
    let study = start(&plan, &directory, 1, &mut |_| {}, &AtomicBool::new(false)).unwrap().study;
    let known = "the same method finished with a longer step: \"coarse\"";
    assert_eq!(study.finished_alike(0).as_deref(), Some(known));
    assert!(study.finished_alike(1).is_none() && study.finished_alike(2).is_none());
    // The free arm created 3 % of energy.
    assert_eq!([0, 1, 2, 3].map(|arm| study.rows[arm].is_unsound()), [true, false, false, true]);
}

#[test]
fn rows_failures_and_claims() {
    let (folder, path) = folder(THREE);
    let plan = Plan::read(&path).unwrap();
    let directory = folder.path().join("runs/study");
    let mut ended = 0;
    let mut count = |e: &Event| ended += usize::from(matches!(e, Event::Ended(..)));
    let outcome = start(&plan, &directory, 2, &mut count, &AtomicBool::new(false)).unwrap();
    assert!(!outcome.interrupted);
    assert_eq!(ended, 3);
    let rows = &outcome.study.rows;
    assert_eq!(
        rows.iter().map(|r| r.status.unwrap()).collect::<Vec<_>>(),
        [Status::Finished, Status::Failed, Status::Finished]
    );
    assert!(rows[1].reason.is_some() && rows[1].metrics.is_empty());
    assert_eq!(rows[0].value("steps"), Some(40.0));
    assert_eq!(rows[2].value("steps"), Some(80.0));
    assert!(rows[0].value("A.ux:min").unwrap() < -0.05);
    let words: Vec<_> = outcome.study.verdicts.iter().map(carom_record::study::Verdict::word).collect();
    assert_eq!(words, ["confirmed", "undecided"]);

    let table = fs::read_to_string(directory.join("study.csv")).unwrap();
    assert!(table.starts_with("arm,status,reason,contact_start,"));
    assert_eq!(table.lines().count(), 4);
    assert!(table.lines().nth(2).unwrap().starts_with("guarded,failed,"));
    let tidy = fs::read_to_string(directory.join("study_tidy.csv")).unwrap();
    assert!(tidy.contains("damped,steps,40.0,\n"));
    // Measured times are in one of the tables only.
    assert!(tidy.contains("damped,wall_time,") && !table.contains("wall_time"));
    assert!(fs::read_to_string(directory.join("claims.csv")).unwrap().contains("confirmed"));
    // Nothing is computed twice, and nothing is overwritten.
    let mut done_before = 0;
    resume(
        &directory,
        1,
        &mut |e| done_before += usize::from(matches!(e, Event::AlreadyDone(_))),
        &AtomicBool::new(false),
    )
    .unwrap();
    assert_eq!(done_before, 3);
    assert!(start(&plan, &directory, 1, &mut |_| (), &AtomicBool::new(false)).is_err());
}

fn histories(directory: &Path) -> Vec<Vec<u8>> {
    let manifest = carom_record::study::StudyManifest::read(directory).unwrap();
    manifest
        .arms
        .iter()
        .map(|arm| fs::read(directory.join(&arm.directory).join("history.csv")).unwrap())
        .collect()
}

/// A study that is stopped within an arm, with another arm not started, and whose input files are
/// removed, ends with the same bytes.
#[test]
fn resumes_where_it_was_stopped() {
    let (folder, path) = folder(THREE);
    let plan = Plan::read(&path).unwrap();
    let (whole, parts) = (folder.path().join("whole"), folder.path().join("parts"));
    start(&plan, &whole, 1, &mut |_| (), &AtomicBool::new(false)).unwrap();

    let stop = AtomicBool::new(false);
    let mut halt = |e: &Event| {
        if matches!(e, Event::Progress(2, p) if p.step >= 1) {
            stop.store(true, Ordering::Relaxed);
        }
    };
    let outcome = start(&plan, &parts, 1, &mut halt, &stop).unwrap();
    assert!(outcome.interrupted);
    assert_eq!(outcome.study.manifest.status, Status::Stopped);
    fs::remove_file(&path).unwrap();
    fs::remove_file(folder.path().join("bar.toml")).unwrap();
    let outcome = resume(&parts, 2, &mut |_| (), &AtomicBool::new(false)).unwrap();
    assert!(!outcome.interrupted);
    assert_eq!(histories(&parts), histories(&whole));
}

#[test]
fn wrong_arms_are_shown_in_the_study_file() {
    let found = wrong("[[arm]]\nname = \"a\"\nset = { \"time.schem\" = 1, \"body.bra.element\" = \"L3\" }\n");
    assert!(found[0].file.ends_with("study.toml"));
    assert_eq!((found[0].line, found[0].quoted.starts_with("set =")), (4, true));
    // A key that names nothing is marked itself, not its value.
    for (study, line, column) in [
        ("[[arm]]\nname = \"a\"\nset = { \"body.bra.element\" = \"L3\" }\n", 4, 9),
        ("[grid]\n\"body.bra.element\" = [\"L2\", \"L3\"]\n", 3, 1),
    ] {
        let found = wrong(study);
        assert_eq!((found[0].line, found[0].column, found[0].length), (line, column, 18), "{found:?}");
    }
    // A step that does not divide the end is reported at the arm, not in the case.
    let found = wrong("[[arm]]\nname = \"a\"\nset = { \"time.step\" = 0.03 }\n");
    assert_eq!((found.len(), found[0].line), (1, 2), "{found:?}");
    assert!(found[0].why.contains("arm \"a\""));
    let found = wrong("[grid]\n\"time.step\" = [0.01, -1.0]\n");
    assert_eq!((found[0].line, found[0].column), (3, 22), "{found:?}");
    // A model that cannot be built.
    let found = wrong(
        "[[arm]]\nname = \"a\"\nset = { \"contact.wall.primary\" = { plane = { point = [0.5], normal = [1.0] } } }\n",
    );
    assert!(found[0].file.ends_with("study.toml") && found[0].line > 0, "{found:?}");
}

#[test]
fn wrong_study_files() {
    let first = |study: &str| wrong(study)[0].clone();
    let found = first("[[arm]]\nname = \"a\"\nsett = {}\n");
    assert_eq!((found.line, found.help.as_str()), (4, "did you mean `set`?"));
    assert!(first("reference = \"finest\"\n[[arm]]\nname = \"a\"\n").what.contains("is not an arm"));
    assert!(first("[[arm]]\nname = \"a\"\n[[arm]]\nname = \"a\"\n").what.contains("two arms"));
    assert!(first("").what.contains("no arms"));
    assert!(first("[[arm]]\nname = 3\n").what.contains("`name` must be a string"));
    assert!(first("[grid]\n\"time.step\" = 1e-3\n").what.contains("list"));
    let found = first("[[arm]]\nname = \"a\"\n[[claim]]\ntext = \"t\"\ncompare = 'apex of \"b\" > 1'\n");
    assert_eq!((found.line, found.what.as_str()), (6, "no arm is named \"b\""));
    let (_folder, path) = folder("");
    // Arms may have cases of their own, but the computed reference refines that of the study.
    let own = |reference: &str| {
        let arm = "[[arm]]\nname = \"a\"\ncase = \"bar.toml\"\n";
        fs::write(&path, format!("{reference}{arm}")).unwrap();
        Plan::read(&path)
    };
    assert!(own("").is_ok());
    let message = own("reference = \"fine\"\n").unwrap_err().to_string();
    assert!(message.contains("no `case`") && message.contains("computed reference"), "{message}");
    let (_folder, path) = folder("[[arm]]\nname = \"a\"\n");
    fs::write(&path, "case = \"none.toml\"\n[[arm]]\nname = \"a\"\n").unwrap();
    let message = Plan::read(&path).unwrap_err().to_string();
    assert!(message.contains("study.toml:1:8") && message.contains("none.toml"), "{message}");
}

const OVERLAY: &str = "[[overlay]]\nname = \"gauge\"\nfile = \"gauge.csv\"\ncolumn = \"A.ux\"\n";

fn measured(study: &str) -> (tempfile::TempDir, PathBuf) {
    let (folder, path) = folder(study);
    fs::write(folder.path().join("gauge.csv"), "t,value\n0,0\n0.02,-0.02\n0.04,-0.04\n9,5\n").unwrap();
    (folder, path)
}

/// Before it strikes, the bar moves with its velocity: the data are met. They are in the study, and
/// not in the cases of its arms.
#[test]
fn measured_data_are_compared_with_every_arm() {
    let arms =
        "[[arm]]\nname = \"a\"\n[[arm]]\nname = \"b\"\nset = { \"time.scheme\" = { kind = \"hu\" } }\n";
    let expect = "[[expect]]\nwhat = 'overlay_rms:gauge of \"b\"'\nat_most = 1e-12\n";
    let (folder, path) = measured(&format!("{arms}{OVERLAY}{expect}"));
    let plan = Plan::read(&path).unwrap();
    let directory = folder.path().join("out");
    let study = start(&plan, &directory, 1, &mut |_| (), &AtomicBool::new(false)).unwrap().study;
    for row in &study.rows {
        let value = |name: &str| row.value(name).unwrap();
        assert!(value("overlay_rms:gauge") < 1e-12 && value("overlay_peak:gauge").abs() < 1e-12);
    }
    assert!(study.expectations.len() == 1 && study.expectations[0].pass);
}

#[test]
fn wrong_measured_data_are_reported() {
    let first = |study: &str| common::wrong(measured(study))[0].clone();
    let arm = "[[arm]]\nname = \"a\"\n";
    let found = first(&format!("{arm}{}", OVERLAY.replace("A.ux", "A.uy")));
    assert!(found.line == 7 && found.what.contains("no column `A.uy`"), "{found:?}");
    assert!(first(&format!("{arm}{OVERLAY}{OVERLAY}")).what.contains("two [[overlay]]"));
    let found = first(&format!("{arm}{}", OVERLAY.replace("gauge.csv", "none.csv")));
    assert!(found.what.contains("cannot be used") && found.help.contains("check the path"), "{found:?}");
    let found = first(&format!("{arm}{}", OVERLAY.replace("file", "files")));
    assert!(found.help.contains("`file`"), "{found:?}");
    let expect = "[[expect]]\nwhat = 'overlay_rms:gouge of \"a\"'\nat_most = 1\n";
    assert!(first(&format!("{arm}{OVERLAY}{expect}")).what.contains("no measured data `gouge`"));
}

/// Every method at every step, and a reference of three runs whose steps and cells are halved, with
/// two checks; the finest step is at most an eighth of the smallest one: 0.4/0.005 · 8 = 640 steps.
#[test]
fn a_design_builds_its_arms_and_ranks_them() {
    let (folder, path) = folder(
        "design = \"matched-step\"\nsteps = [0.01, 0.005]\ngoal = \"energy\"\naccuracy = 0.1\nreference = \"fine\"\n\
         [[arm]]\nname = \"Hu\"\nset = { \"time.scheme\" = { kind = \"hu\" } }\n[[arm]]\nname = \"CH\"\n",
    );
    let plan = Plan::read(&path).unwrap();
    let names: Vec<&str> = plan.manifest.arms.iter().map(|a| a.name.as_str()).collect();
    assert_eq!(
        names,
        [
            "Hu, Δt 1e-2",
            "Hu, Δt 5e-3",
            "CH, Δt 1e-2",
            "CH, Δt 5e-3",
            "fine, 4 Δt, mesh 1",
            "fine, 2 Δt, mesh 2",
            "fine",
            "fine, check of the step",
            "fine, check of the scheme"
        ]
    );
    assert_eq!(
        plan.manifest.arms.iter().map(|a| a.steps).collect::<Vec<_>>(),
        [40, 80, 40, 80, 160, 320, 640, 320, 320]
    );
    let out = folder.path().join("out");
    let study = start(&plan, &out, 2, &mut |_| (), &AtomicBool::new(false)).unwrap().study;
    let ranking = study.ranking.unwrap();
    // Hu's scheme dissipates the vibration after the impact, so it is last at both steps.
    let first: Vec<&str> = ranking.levels.iter().map(|l| study.rows[l[0].arm].name.as_str()).collect();
    assert_eq!(first, ["CH, Δt 1e-2", "CH, Δt 5e-3"]);
    // Two threads, and a stop during contact with a resume, give the same bits; no files remain.
    let checks = study.checks.as_ref().unwrap();
    assert_eq!((checks.arm.as_str(), checks.threads.0), ("Hu, Δt 1e-2", 2));
    assert!(checks.active_pairs == 1 && (1..40).contains(&checks.resumed.0), "{checks:?}");
    assert_eq!((&checks.threads.1, &checks.resumed.1), (&checks.fingerprint, &checks.fingerprint));
    assert_ne!(checks.fingerprint, fingerprint(&out.join(&study.manifest.arms[1].directory)).unwrap());
    assert!(!out.join("checks").exists());
    assert_eq!(ranking.levels[0].len(), 2);
    let verdict = ranking.verdict.unwrap();
    assert_eq!(study.manifest.arms[verdict.arm].role.method.as_deref(), Some("CH"));
    assert!(out.join("ranking.csv").is_file() && out.join("reference.csv").is_file());
    // Without an ensemble the ranking may be due to chance.
    assert_eq!(verdict.confidence.word(), "medium");
    // If the checks cannot be made, the study is still valid; later they are made.
    let (checked, repeated) = (out.join("checks.json"), out.join("checks"));
    let again = || resume(&out, 1, &mut |_| (), &AtomicBool::new(false)).unwrap();
    fs::remove_file(&checked).unwrap();
    fs::write(&repeated, "in the way").unwrap();
    let hindered = again();
    assert!(!hindered.interrupted && hindered.study.checks.is_none() && !checked.exists());
    fs::remove_file(&repeated).unwrap();
    assert_eq!(again().study.checks, study.checks);
}

/// Meshes of 1 and 2 times the cells with steps in the same ratio; every arm for two phases on two
/// meshes, the reference for two phases only.
#[test]
fn a_reference_refines_its_mesh_and_an_ensemble_repeats_every_arm() {
    let (folder, path) = folder(
        "goal = \"energy\"\nreference = \"fine\"\n[fine]\nrefine = 2\nmesh = [1, 2]\n\
         [ensemble]\nphases = 2\nmesh = [1, 2]\n[[arm]]\nname = \"Hu\"\nset = { \"time.scheme\" = { kind = \"hu\" } }\n\
         [[arm]]\nname = \"CH\"\n[[claim]]\ntext = \"t\"\ncompare = 'energy_lost of \"Hu\" > energy_lost of \"CH\"'\n\
         [[claim]]\ntext = \"u\"\ncompare = 'energy_lost of \"Hu\" > energy_lost of \"fine\"'\n",
    );
    let plan = Plan::read(&path).unwrap();
    let arms = &plan.manifest.arms;
    let fine: Vec<(&str, u64, f64)> =
        arms[2..].iter().map(|a| (a.name.as_str(), a.steps, a.case["refine"].as_f64().unwrap())).collect();
    let checks = [("fine, check of the step", 40, 2.0), ("fine, check of the scheme", 40, 2.0)];
    assert_eq!(fine[..2], [("fine, 2 Δt, mesh 1", 40, 1.0), ("fine", 80, 2.0)]);
    assert_eq!(fine[2..], checks);
    let members: Vec<&str> = plan.manifest.members.iter().map(|m| m.name.as_str()).collect();
    assert_eq!(members[..3], ["Hu (phase 0.5)", "Hu (mesh 2)", "Hu (mesh 2, phase 0.5)"]);
    assert_eq!(members[6..], ["fine, 2 Δt, mesh 1 (phase 0.5)", "fine (phase 0.5)"]);
    // With a phase, the first and the last step are parts of one.
    assert_eq!((plan.manifest.members[0].steps, plan.manifest.members[1].steps), (41, 40));
    let out = folder.path().join("out");
    let study = start(&plan, &out, 2, &mut |_| (), &AtomicBool::new(false)).unwrap().study;
    let confirmed = study.verdicts[0].ensemble.as_ref().unwrap();
    assert_eq!((confirmed.count, confirmed.of), (4, 4));
    // A claim may name the computed reference.
    assert_eq!(study.verdicts[1].right, study.rows[3].value("energy_lost"));
    let reference = study.reference.as_ref().unwrap();
    assert!(reference.refines_mesh() && reference.what.contains("2 members"));
    assert_eq!(study.spread(0, "energy_lost").unwrap().count(), 4);
    let text = fs::read_to_string(out.join("ensemble.csv")).unwrap();
    assert!(text.starts_with("arm,metric,unit,members,median,low,high\n"));
    // Resumed, nothing is computed again, and the tables are the same.
    let again = resume(&out, 1, &mut |_| (), &AtomicBool::new(false)).unwrap().study;
    assert_eq!(again.members, study.members);
}

/// The impact law and the mesh vary in the members of every arm that does not set them itself, and
/// in those of the reference, whose interval contains what they change.
#[test]
fn an_ensemble_varies_the_impact_law() {
    let study = |sets: &str| {
        let (folder, path) = folder(&format!(
            "goal = \"force\"\nreference = \"fine\"\n[fine]\nrefine = 2\nmesh = [1, 2]\n[ensemble]\nphases = 2\n{sets}\
             [[arm]]\nname = \"CH\"\n[[arm]]\nname = \"none\"\nset = {{ \"contact.wall.persistency\" = \"none\" }}\n"
        ));
        let plan = Plan::read(&path).unwrap();
        let run = start(&plan, &folder.path().join("out"), 2, &mut |_| (), &AtomicBool::new(false));
        (plan, run.unwrap().study)
    };
    let (_, alone) = study("");
    let (plan, varied) = study("sets = [{ \"contact.wall.persistency\" = \"none\" }]\n");
    let members: Vec<&str> = plan.manifest.members.iter().map(|m| m.name.as_str()).collect();
    let other = "contact.wall.persistency=\"none\"";
    assert_eq!(
        members[..3],
        ["CH (phase 0.5)", &format!("CH ({other})"), &format!("CH ({other}, phase 0.5)")]
    );
    assert_eq!(members[3..5], ["none (phase 0.5)", "fine, 2 Δt, mesh 1 (phase 0.5)"]);
    assert_eq!(members.len(), 10);
    // Both laws are in the reference: its interval reaches the values of the law left out before.
    let [alone, varied] = [&alone, &varied].map(|study| study.reference.as_ref().unwrap());
    let [alone, varied] = [alone, varied].map(|reference| reference.estimate("peak_force").unwrap());
    assert!(varied.uncertainty > alone.uncertainty, "{varied:?} {alone:?}");
}

#[test]
fn wrong_ensembles_are_reported() {
    let first = |table: &str| wrong(&format!("[[arm]]\nname = \"a\"\n[ensemble]\n{table}\n"))[0].clone();
    assert!(first("phases = 101").what.contains("an integer from 1 to 100"));
    assert!(first("mesh = [2, 3]").why.contains("are members, on the given mesh"));
    assert!(first("mesh = [1, 1]").what.contains("do not increase"));
    assert!(first("phases = 1").help.contains("phases = 5"));
    assert_eq!(first("phase = 5").help, "did you mean `phases`?");
    let found = first("phases = 2\nswapped = true");
    assert!(found.line == 6 && found.why.contains("not a side and a rigid primary"), "{found:?}");
    assert!(first("sets = [{}]").what.contains("one of the changes is empty"));
    assert!(first("sets = [{ \"contact.wall.persistencies\" = \"none\" }]").help.contains("persistency"));
}

/// Two methods of similar cost: the second starts at twice the step of the case, and matched cost
/// determines its step.
#[test]
fn matched_cost_settles_and_resumes_at_the_same_steps() {
    let (folder, path) = folder(
        "design = \"matched-cost\"\ngoal = \"energy\"\n[[arm]]\nname = \"CH\"\n[[arm]]\nname = \"Hu\"\n\
         set = { \"time.scheme\" = { kind = \"hu\" }, \"time.step\" = 0.02 }\n",
    );
    let plan = Plan::read(&path).unwrap();
    let out = folder.path().join("out");
    let study = start(&plan, &out, 1, &mut |_| (), &AtomicBool::new(false)).unwrap().study;
    let steps =
        |study: &carom_record::study::Study| study.manifest.arms.iter().map(|a| a.steps).collect::<Vec<_>>();
    let settled = steps(&study);
    assert!(study.rows.iter().all(|r| r.status == Some(Status::Finished)));
    let pilot: serde_json::Value =
        serde_json::from_slice(&fs::read(out.join("pilots/02-hu/pilot.json")).unwrap()).unwrap();
    let trials = pilot["trials"].as_array().unwrap();
    assert_eq!(trials[0]["steps"], 20);
    assert_eq!(trials[pilot["settled"].as_u64().unwrap() as usize]["steps"], settled[1]);
    // Resumed from the pilot record: the same steps.
    let again = resume(&out, 1, &mut |_| (), &AtomicBool::new(false)).unwrap().study;
    assert_eq!(steps(&again), settled);
    assert!(
        (again.manifest.arms[1].case["time"]["step"].as_f64().unwrap() - 0.4 / settled[1] as f64).abs()
            < 1e-15
    );
}

/// Two methods and one at the cost of another, in five orders and with other numbers of concurrent
/// runs: the files with the verdict are the same to the last byte.
#[test]
fn verdicts_depend_neither_on_the_order_of_the_arms_nor_on_times() {
    let arms = [
        "[[arm]]\nname = \"CH\"\n",
        "[[arm]]\nname = \"Hu\"\nset = { \"time.scheme\" = { kind = \"hu\" } }\n",
        "[[arm]]\nname = \"Bathe\"\nset = { \"time.scheme\" = { kind = \"bathe\", rho_inf = 0.5 } }\n",
    ];
    let files = |order: [usize; 3], jobs: usize| {
        let (folder, path) = folder(&format!(
            "design = \"matched-cost\"\nsteps = [0.01]\ngoal = \"trajectory\"\nreference = \"fine\"\n[fine]\nrefine = 2\n{}",
            order.map(|i| arms[i]).concat()
        ));
        let out = folder.path().join("out");
        start(&Plan::read(&path).unwrap(), &out, jobs, &mut |_| (), &AtomicBool::new(false)).unwrap();
        ["ranking.csv", "verdict.json", "reference.csv"]
            .map(|name| fs::read_to_string(out.join(name)).unwrap())
    };
    let first = files([0, 1, 2], 1);
    let ranked = first[0].lines().filter(|line| line.starts_with("trajectory,"));
    assert!(ranked.count() == 3 && first[1].contains("\"recommended\""), "{first:?}");
    for (order, jobs) in [([2, 0, 1], 2), ([1, 2, 0], 3), ([2, 1, 0], 1), ([0, 2, 1], 2)] {
        assert_eq!(files(order, jobs), first, "{order:?}");
    }
}

/// Arms at a common step, and one explicit arm at the cost of the first: only its step is
/// determined, and its case has the step that was determined.
#[test]
fn an_arm_matches_cost_where_the_others_match_steps() {
    let (folder, path) = folder(
        "design = \"matched-step\"\nsteps = [0.01]\ngoal = \"energy\"\n[[arm]]\nname = \"CH\"\n[[arm]]\nname = \"Hu\"\n\
         set = { \"time.scheme\" = { kind = \"hu\" } }\n[[arm]]\nname = \"explicit\"\nmatch = \"cost\"\n\
         set = { \"time.scheme\" = { kind = \"central-difference\" }, \"body.bar.mass\" = \"lumped\", \"time.step\" = 0.005 }\n",
    );
    let plan = Plan::read(&path).unwrap();
    assert_eq!(plan.manifest.arms.iter().map(|a| a.steps).collect::<Vec<_>>(), [40, 40, 80]);
    assert_eq!(plan.manifest.arms[2].name, "explicit, cost of Δt 1e-2");
    let out = folder.path().join("out");
    let study = start(&plan, &out, 1, &mut |_| (), &AtomicBool::new(false)).unwrap().study;
    let arms = &study.manifest.arms;
    assert!(study.rows.iter().all(|r| r.status == Some(Status::Finished)));
    assert_eq!(arms.iter().map(|a| study.manifest.by_cost(a)).collect::<Vec<_>>(), [false, false, true]);
    assert!(
        (arms[0].steps, arms[1].steps) == (40, 40)
            && arms[0].role.cost.is_none()
            && arms[2].role.cost.is_some()
    );
    assert_eq!(study.rows[2].value("steps"), Some(arms[2].steps as f64));
    assert!(out.join("pilots/03-explicit-cost-of-dt-1e-2/pilot.json").is_file());
}

/// A goal whose columns are not recorded is refused.
#[test]
fn goals_without_what_they_compare_are_reported() {
    let first = |study: &str| wrong(&format!("{study}[[arm]]\nname = \"a\"\n"))[0].clone();
    let found = first("goal = \"stress\"\nreference = \"fine\"\n");
    assert!(found.line == 2 && found.what.contains("goal `stress`"), "{found:?}");
    assert!(found.why.contains("no probe records a stress in the case of \"a\""), "{found:?}");
    assert!(found.help.contains("add a [[probe]]"), "{found:?}");
    assert!(first("goal = \"friction\"\n").why.contains("no contact has friction"));
    let found = first("goal = \"force\"\nreference = \"exact\"\nwindow = 0.01\n");
    assert!(found.line == 3 && found.help.contains("[exact]"), "{found:?}");
}

/// The record of an arm of matched cost was removed: it is computed again at the step that was
/// found.
#[test]
fn a_removed_arm_of_matched_cost_is_computed_again() {
    let (folder, path) = folder(
        "design = \"matched-cost\"\n[[arm]]\nname = \"CH\"\n[[arm]]\nname = \"Hu\"\n\
         set = { \"time.scheme\" = { kind = \"hu\" } }\n",
    );
    let out = folder.path().join("out");
    let study = start(&Plan::read(&path).unwrap(), &out, 1, &mut |_| (), &AtomicBool::new(false)).unwrap();
    let arm = out.join(&study.study.manifest.arms[1].directory);
    let before = fingerprint(&arm).unwrap();
    fs::remove_dir_all(&arm).unwrap();
    resume(&out, 1, &mut |_| (), &AtomicBool::new(false)).unwrap();
    assert_eq!(fingerprint(&arm).unwrap(), before);
}

#[test]
fn wrong_designs_are_reported() {
    let first = |study: &str| wrong(study)[0].clone();
    let found = first("design = \"matched\"\n[[arm]]\nname = \"a\"\n");
    assert_eq!(found.help, "use one of: matched-step, matched-cost");
    assert!(first("steps = [1e-2]\n[[arm]]\nname = \"a\"\n").what.contains("without a design"));
    assert!(
        first("design = \"matched-step\"\nsteps = [0.005, 0.01]\n[[arm]]\nname = \"a\"\n")
            .what
            .contains("do not decrease")
    );
    assert!(
        first("design = \"matched-cost\"\ncost_of = \"b\"\n[[arm]]\nname = \"a\"\n")
            .what
            .contains("no method")
    );
    let found = first("[[arm]]\nname = \"a\"\nmatch = \"cost\"\n");
    assert!(found.line == 4 && found.what.contains("without a design"), "{found:?}");
    let a = "[[arm]]\nname = \"a\"\nmatch = \"cost\"\n[[arm]]\nname = \"b\"\n";
    let found = first(&format!("design = \"matched-step\"\ncost_of = \"a\"\n{a}"));
    assert!(found.line == 6 && found.what.contains("\"a\" cannot match its own cost"), "{found:?}");
    assert!(found.help.contains("`cost_of`"), "{found:?}");
    assert!(
        first("design = \"matched-step\"\n[[arm]]\nname = \"a\"\nmatch = \"step\"\n")
            .what
            .contains("\"step\"")
    );
    assert!(first("goal = \"forces\"\n[[arm]]\nname = \"a\"\n").help.contains("`force`"));
    assert!(first("[fine]\nrefine = 4\n[[arm]]\nname = \"a\"\n").what.contains("not used"));
}
