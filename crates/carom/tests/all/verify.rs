//! `carom verify` as a process: table, files, exit codes.

use crate::common::{Place, text};

/// A bar in free flight, which the scheme integrates exactly; 20 steps.
const FALL: &str = r#"
title = "Free fall"
dimension = 1
[[material]]
name = "steel"
law = "linear-elastic"
density = 1.0
young = 100.0
poisson = 0.0
[[body]]
name = "bar"
material = "steel"
element = "L2"
mesh = { shape = "interval", min = 0.05, max = 1.05, cells = 2 }
velocity = [-1.0]
[[contact]]
name = "wall"
secondary = "bar.left"
primary = { plane = { point = [0.0], normal = [1.0] } }
[time]
end = 0.2
step = 0.01
scheme = { kind = "chung-hulbert", rho_inf = 0.5 }
[[probe]]
name = "A"
body = "bar"
at = [1.05]
record = ["ux"]
"#;

const FREE: &str = "[[expect]]\nwhat = \"A.ux\"\nformula = \"-t\"\nbefore = 0.05\ntolerance = 1e-9\nsource = \"free flight | exact\"\n";
const MISSED: &str = "[[expect]]\nwhat = \"last A.ux\"\nvalue = 1\ntolerance = 0.1\nslow = true\n";

fn place(name: &str) -> Place {
    let place = Place::new(name);
    for folder in ["cases/flight", "cases/wall"] {
        std::fs::create_dir_all(place.0.join(folder)).unwrap();
    }
    place.file("cases/flight/free.toml", format!("{FALL}{FREE}{MISSED}"));
    // The case of a study, which has no expectations and is not run by itself.
    place.file("cases/wall/base.toml", FALL);
    place.file(
        "cases/wall/study.toml",
        "title = \"Steps\"\ncase = \"base.toml\"\n[grid]\n\"time.step\" = [0.01, 0.005]\n[[arm]]\nname = \"free\"\nset = { \"time.end\" = 0.04 }\n\
         expect = [{ what = \"contact_episodes\", value = 0, tolerance = 0 }]\n\
         [[expect]]\nwhat = 'contact_episodes of \"time.step=0.01\"'\nvalue = 1\ntolerance = 0\n",
    );
    place
}

#[test]
fn fast_cases_are_met_and_written() {
    let place = place("verify-fast");
    let done = place.carom(&["verify", "--fast", "--markdown", "book", "--verbose"]);
    let (output, progress) = (text(&done.stdout), text(&done.stderr));
    assert_eq!(done.status.code(), Some(0), "{output}{progress}");
    assert!(output.contains("flight/free  max |A.ux − (-t)|, t < 0.05"), "{output}");
    assert!(output.contains("2 set-ups, 2 with dynamic contact; 3 expected values, 0 missed"), "{output}");
    assert_eq!(progress.lines().count(), 4, "{progress}");
    let out = place.0.join("runs/verify");
    let table = std::fs::read_to_string(out.join("verify.csv")).unwrap();
    assert_eq!(table.lines().count(), 4);
    assert!(
        table.starts_with(
            "family,case,arm,quantity,expected,got,error,tolerance,source,pass,directory\nflight,free,,"
        ),
        "{table}"
    );
    for file in ["verify.json", "verify.html", "flight/free/history.csv", "wall/study/study.csv"] {
        assert!(out.join(file).is_file(), "{file}");
    }
    assert!(!out.join("flight/free/report.html").exists() && !out.join("flight/free/fields.pvd").exists());
    let page = std::fs::read_to_string(out.join("verify.html")).unwrap();
    assert!(
        page.contains("all 3 expected values of the fast selection are met") && !page.contains("http"),
        "{page}"
    );
    let book = std::fs::read_to_string(place.0.join("book/flight.md")).unwrap();
    assert!(book.contains("free flight \\| exact") && book.lines().count() == 3, "{book}");
}

#[test]
fn a_missed_expectation_is_one() {
    let place = place("verify-missed");
    let done = place.carom(&["verify", "cases/flight", "--csv", "--out", "there", "--report"]);
    assert_eq!(done.status.code(), Some(1));
    let table = text(&done.stdout);
    assert_eq!(table.lines().count(), 3, "{table}");
    assert!(
        table.contains("flight,free,,last A.ux,1 ± 0.1,") && table.contains(",MISSED,flight/free"),
        "{table}"
    );
    assert!(place.0.join("there/flight/free/report.html").is_file());
    let done = place.carom(&["verify", "cases/flight/free.toml", "--json", "--out", "again"]);
    let events = text(&done.stdout);
    assert!(events.lines().all(|line| line.starts_with("{\"event\":")), "{events}");
    assert!(events.lines().last().unwrap().contains("\"missed\":1"), "{events}");
}

#[test]
fn the_first_miss_can_end_it() {
    let place = place("verify-fail-fast");
    let done = place.carom(&["verify", "--fail-fast", "--jobs", "1", "--out", "there"]);
    let output = text(&done.stdout);
    assert_eq!(done.status.code(), Some(1), "{output}");
    assert!(output.contains("stopped at the first miss: 1 of 2 set-ups were not evaluated"), "{output}");
    assert!(
        place.0.join("there/flight/free").is_dir() && !place.0.join("there/wall/study/study.csv").exists()
    );
}

#[test]
fn an_unexpected_stop_is_three_and_an_expected_one_is_none() {
    let place = place("verify-stopped");
    let stops = FALL.replace("[[probe]]", "[newton]\nmax_iterations = 1\ntolerance = 1e-300\n[[probe]]");
    place.file("stops.toml", format!("{stops}{FREE}"));
    let done = place.carom(&["verify", "stops.toml"]);
    assert_eq!(done.status.code(), Some(3), "{}", text(&done.stdout));
    assert!(text(&done.stdout).contains("the run stopped"));
    place.file("stops.toml", format!("{stops}[[expect]]\nwhat = \"stopped\"\nvalue = 1\ntolerance = 0\n"));
    let done = place.carom(&["verify", "stops.toml"]);
    assert_eq!(done.status.code(), Some(0), "{}", text(&done.stdout));
}

#[test]
fn a_wrong_case_is_two_and_nothing_is_written() {
    let place = place("verify-wrong");
    place.file("cases/wall/wrong.toml", format!("{FALL}[[expect]]\nwhat = \"last B.ux\"\nat_most = 1\n"));
    let done = place.carom(&["verify"]);
    assert_eq!(done.status.code(), Some(2));
    assert!(text(&done.stderr).contains("no column `B.ux`"), "{}", text(&done.stderr));
    assert!(!place.0.join("runs").exists());
    std::fs::create_dir_all(place.0.join("none")).unwrap();
    let done = place.carom(&["verify", "none"]);
    assert_eq!(done.status.code(), Some(2));
    assert!(text(&done.stderr).contains("no expectations found"));
}
