//! Studies in parts, as processes: what is missing, damaged or wrong, and what the messages advise.

use std::fs::{self, File};
use std::process::{Command, Stdio};

use super::common::{Place, text};

/// A bar of density 1 and stiffness 900 thrown at a wall.
const BAR: &str = r#"
title = "bar"
dimension = 1
material = [{ name = "steel", law = "linear-elastic", density = 1.0, young = 900.0, poisson = 0.0 }]
contact = [{ name = "wall", secondary = "bar.left", primary = { plane = { point = [0.0], normal = [1.0] } } }]
[[body]]
name = "bar"
material = "steel"
element = "L2"
mesh = { shape = "interval", min = 0.1, max = 10.1, cells = 20 }
velocity = [-10.0]
[time]
end = 1.0
step = 0.01
scheme = { kind = "chung-hulbert", rho_inf = 0.6 }
[output]
checkpoint_every = 10
"#;

/// Three arms, of which the last has the fewest steps.
const STUDY: &str = r#"
title = "steps"
case = "bar.toml"
[[arm]]
name = "fine"
set = { "time.step" = 0.005 }
[[arm]]
name = "plain"
[[arm]]
name = "coarse"
set = { "time.step" = 0.02 }
"#;

fn place(name: &str, study: &str) -> Place {
    let place = Place::new(name);
    place.file("bar.toml", BAR).file("s.toml", study);
    place
}

/// Exit code, standard output and standard error.
fn ended(place: &Place, arguments: &[&str]) -> (i32, String, String) {
    let output = place.carom(arguments);
    (output.status.code().unwrap(), text(&output.stdout), text(&output.stderr))
}

fn arms(place: &Place, numbers: &[&str]) {
    for number in numbers {
        assert_eq!(ended(place, &["study", "arm", "st", number]).0, 0, "{number}");
    }
}

#[test]
fn a_directory_that_is_no_study_is_a_wrong_argument() {
    let place = place("no-study", STUDY);
    fs::create_dir(place.0.join("empty")).unwrap();
    for (directory, told) in [("nix", "there is no directory nix"), ("empty", "it has no study.json")] {
        for arguments in [&["study", "arm", directory, "1"][..], &["study", "collect", directory]] {
            let (code, _, stderr) = ended(&place, arguments);
            assert_eq!(code, 2, "{stderr}");
            assert!(stderr.contains(told) && stderr.contains("that `carom study` created"), "{stderr}");
        }
    }
}

/// Steps that are not found yet cannot be found by the processes that compute single runs.
#[cfg(unix)]
#[test]
fn interrupted_planning_says_how_to_go_on() {
    let study = "case = \"bar.toml\"\ndesign = \"matched-cost\"\nset = { \"time.step\" = 1e-6 }\n[[arm]]\nname = \
                 \"a\"\n[[arm]]\nname = \"b\"\nset = { \"time.scheme\" = { kind = \"hu\" } }\n";
    let place = place("planning", study);
    let mut command = place.command(&["study", "plan", "s.toml", "--out", "st", "--settle"]);
    let child = command.stderr(Stdio::piped()).spawn().unwrap();
    while !place.0.join("st/study.json").exists() {
        std::thread::sleep(std::time::Duration::from_millis(10));
    }
    let kill = format!("kill -INT {}", child.id());
    assert!(Command::new("sh").args(["-c", &kill]).status().unwrap().success());
    let done = child.wait_with_output().unwrap();
    let told = text(&done.stderr);
    assert_eq!(done.status.code(), Some(130), "{told}");
    assert!(
        told.contains("remove st and plan the study again") && told.contains("on this machine"),
        "{told}"
    );
}

#[test]
fn advice_can_be_followed() {
    let place = place("advice", STUDY);
    let plan = ["study", "plan", "s.toml", "--out", "st"];
    assert_eq!(ended(&place, &plan).0, 0);
    let (code, _, stderr) = ended(&place, &plan);
    assert!(code == 2 && stderr.contains("name another directory"), "{stderr}");
    assert!(!stderr.contains("omit"), "--out is required: {stderr}");

    place.killed(place.command(&["study", "arm", "st", "1"]), "st/arms/01-fine");
    let lock = File::create(place.0.join("st/arms/01-fine/checkpoint/lock")).unwrap();
    lock.lock().unwrap();
    let (code, _, stderr) = ended(&place, &["study", "arm", "st", "1"]);
    assert!(code == 2 && stderr.contains("is being written by another process; wait for it"), "{stderr}");
    assert!(!stderr.contains("run the case again"), "{stderr}");
    drop(lock);

    let (code, _, stderr) = ended(&place, &["export", "st", "--format", "csv"]);
    assert!(code == 2 && stderr.contains("st is the directory of a study"), "{stderr}");
    assert!(stderr.contains("st/arms"), "{stderr}");
}

/// The other arms have their rows, the message says what to remove, and after that the arm is
/// computed as at first.
#[test]
fn a_damaged_arm_is_a_row_with_its_reason() {
    let place = place("damaged-arm", STUDY);
    assert_eq!(ended(&place, &["study", "plan", "s.toml", "--out", "st"]).0, 0);
    arms(&place, &["1", "2", "3"]);
    let collect = ["study", "collect", "st", "--no-report"];
    assert_eq!(ended(&place, &collect).0, 0);
    // Without the columns of measured times.
    let table = || -> Vec<Vec<String>> {
        let table = fs::read_to_string(place.0.join("st/study.csv")).unwrap();
        let names: Vec<&str> = table.lines().next().unwrap().split(',').collect();
        let measured = |i: &usize| names.get(*i).is_some_and(|name| ["cpu_time", "wall_time"].contains(name));
        let cells = |line: &str| {
            let cells = line.split(',').enumerate().filter(|(i, _)| !measured(i));
            cells.map(|(_, cell)| cell.to_owned()).collect()
        };
        table.lines().map(cells).collect()
    };
    let whole = table();
    let arm = place.0.join("st/arms/02-plain");
    let cut = |name: &'static str| {
        let arm = &arm;
        move || {
            let bytes = fs::read(arm.join(name)).unwrap();
            fs::write(arm.join(name), &bytes[..bytes.len() / 2]).unwrap();
        }
    };
    let missing = || fs::remove_file(arm.join("history.csv")).unwrap();
    let damages: [(&dyn Fn(), &str); 3] = [
        (&cut("history.csv"), "history.csv is damaged: it has changed since it was written"),
        (&cut("manifest.json"), "manifest.json"),
        (&missing, "history.csv is damaged: it is missing"),
    ];
    for (damage, told) in damages {
        damage();
        let (code, stdout, stderr) = ended(&place, &["study", "collect", "st"]);
        assert_eq!(code, 1, "{stderr}");
        let line = stdout.lines().find(|line| line.starts_with("plain")).unwrap();
        assert!(line.contains(told) && line.contains("remove st/arms/02-plain"), "{line}");
        assert!(stderr.contains("damaged: 2 (plain)") && !stderr.contains("missing"), "{stderr}");
        let found = table();
        assert_eq!([&found[1], &found[3]], [&whole[1], &whole[3]]);
        assert_eq!(found[2][1], "damaged");
        assert!(fs::read_to_string(place.0.join("st/study.html")).unwrap().contains(">damaged"));
        let (code, _, stderr) = ended(&place, &["study", "arm", "st", "2"]);
        assert!(code == 2 && stderr.contains(told), "{stderr}");
        assert!(stderr.contains("remove st/arms/02-plain and compute the arm again"), "{stderr}");
        let (code, ..) = ended(&place, &["resume", "st", "--no-report"]);
        assert!([1, 2].contains(&code), "{code}");
        fs::remove_dir_all(&arm).unwrap();
        arms(&place, &["2"]);
        assert_eq!(ended(&place, &collect).0, 0);
        assert_eq!(table(), whole);
    }
    // A checkpoint is needed only to continue.
    fs::remove_dir_all(arm.join("checkpoint")).unwrap();
    assert_eq!(ended(&place, &collect).0, 0);
}

/// Which arm is repeated does not depend on when the tables are made.
#[test]
fn checks_do_not_depend_on_when_tables_are_made() {
    let place = place("checks", &STUDY.replace("title = \"steps\"", "goal = \"trajectory\""));
    assert_eq!(ended(&place, &["study", "s.toml", "--out", "whole", "--no-report"]).0, 0);
    assert_eq!(ended(&place, &["study", "plan", "s.toml", "--out", "st"]).0, 0);
    let checked = |study: &str| -> serde_json::Value {
        serde_json::from_slice(&fs::read(place.0.join(study).join("checks.json")).unwrap()).unwrap()
    };
    arms(&place, &["1"]);
    assert_eq!(ended(&place, &["study", "collect", "st", "--no-report"]).0, 1);
    assert!(!place.0.join("st/checks.json").exists());
    arms(&place, &["2", "3"]);
    assert_eq!(ended(&place, &["study", "collect", "st", "--no-report"]).0, 0);
    assert_eq!(checked("st")["arm"], "coarse");
    assert_eq!(checked("st"), checked("whole"));
}

#[test]
fn options_of_runs_are_refused_for_studies() {
    let place = place("ignored", STUDY);
    assert_eq!(ended(&place, &["study", "plan", "s.toml", "--out", "st"]).0, 0);
    for option in ["--profile", "--strict"] {
        let (code, _, stderr) = ended(&place, &["resume", "st", option]);
        assert!(code == 2 && stderr.contains(&format!("{option} is an option for runs")), "{stderr}");
    }
    assert!(!place.0.join("st/arms/01-fine").exists());
    assert_eq!(ended(&place, &["run", "bar.toml", "--out", "run", "--no-report"]).0, 0);
    // A run without a page has none when it is resumed.
    assert_eq!(ended(&place, &["resume", "run"]).0, 0);
    assert!(!place.0.join("run/report.html").exists());
}
