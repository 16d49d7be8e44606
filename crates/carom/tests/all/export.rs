//! `carom export`: names, units and numbers for other programs, and no file that is overwritten.

use std::fs;

use super::common::{Place, text};

/// A bar in free flight, with a comma in a unit and in the name of a probe.
const FLIGHT: &str = r#"
dimension = 1
units = { mass = "kg, net", length = "m", time = "s" }
material = [{ name = "steel", law = "linear-elastic", density = 1.0, young = 900.0, poisson = 0.0 }]
body = [{ name = "bar", material = "steel", element = "L2", mesh = { shape = "interval", min = 0.0, max = 1.0, cells = 4 }, velocity = [2.0] }]
[time]
end = 0.1
step = 0.01
scheme = { kind = "chung-hulbert", rho_inf = 0.6 }
"#;

fn run(name: &str) -> Place {
    let place = Place::new(name);
    place.file("flight.toml", FLIGHT);
    assert!(place.carom(&["run", "flight.toml", "--out", "run", "--no-report"]).status.success());
    place
}

/// Names, units and rows have as many fields, though a unit has a comma.
#[test]
fn units_with_commas_are_quoted() {
    let place = run("quoted");
    let exported = text(&place.carom(&["export", "run", "--format", "csv"]).stdout);
    let lines: Vec<&str> = exported.lines().collect();
    assert_eq!(lines.len(), 2 + 11);
    let commas = |line: &str| line.matches(',').count();
    let units = lines[1].replace("\"kg, net m/s\"", "momentum");
    assert_ne!(units, lines[1], "{units}");
    let quoted = units.split('"').skip(1).step_by(2).map(commas).sum::<usize>();
    assert_eq!([commas(&units) - quoted, commas(lines[2])], [commas(lines[0]); 2]);
}

#[test]
fn no_file_is_overwritten() {
    let place = run("overwritten");
    let history = || fs::read(place.0.join("run/history.csv")).unwrap();
    let before = history();
    let refused = place.carom(&["export", "run", "--format", "csv", "--out", "run/history.csv"]);
    let told = text(&refused.stderr);
    assert!(refused.status.code() == Some(2) && told.contains("exists already"), "{told}");
    assert_eq!(history(), before);
    for _ in 0..2 {
        place.carom(&["export", "run", "--format", "json", "--out", "run.json"]);
    }
    let exported: serde_json::Value =
        serde_json::from_slice(&fs::read(place.0.join("run.json")).unwrap()).unwrap();
    assert_eq!(exported["columns"][1]["name"], "time");
}
