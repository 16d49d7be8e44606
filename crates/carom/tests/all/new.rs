//! `carom new` as a process: every template is valid, runs and makes a page; nothing is
//! overwritten.

use std::path::Path;
use std::process::{Command, Output};

fn carom(place: &Path, arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_carom")).current_dir(place).args(arguments).output().unwrap()
}

#[test]
fn every_template_is_valid_and_runs() {
    let scratch = tempfile::tempdir().unwrap();
    for template in ["impact-2d", "bar-1d", "impact-3d", "gmsh"] {
        let (folder, case) = (format!("my/{template}"), format!("my/{template}/{template}.toml"));
        let done = carom(scratch.path(), &["new", &folder, "--template", template]);
        let output = String::from_utf8(done.stdout).unwrap();
        assert_eq!(done.status.code(), Some(0), "{}", String::from_utf8_lossy(&done.stderr));
        assert!(output.contains(&format!("carom run {case}")), "{output}");
        let text = std::fs::read_to_string(scratch.path().join(&case)).unwrap();
        assert!(text.starts_with("#:schema ./schema.json\n"));
        let schema = std::fs::read(scratch.path().join(&folder).join("schema.json")).unwrap();
        assert_eq!(serde_json::from_slice::<serde_json::Value>(&schema).unwrap()["title"], "Carom case");

        let (out, step) =
            (format!("run-{template}"), text.lines().find_map(|l| l.strip_prefix("step = ")).unwrap());
        let step: f64 = step.split_whitespace().next().unwrap().parse().unwrap();
        let short = format!("time.end={:?}", 3.0 * step);
        let done = carom(scratch.path(), &["run", &case, "--set", &short, "--out", &out]);
        let said = String::from_utf8_lossy(&done.stderr);
        assert_eq!(done.status.code(), Some(0), "{said}");
        // Three steps are a short run, which the template as it is is not.
        let whole = carom(scratch.path(), &["check", &case]);
        let checked = String::from_utf8_lossy(&whole.stdout);
        assert!(!checked.contains("warning"), "{checked}");
        assert!(scratch.path().join(out).join("report.html").exists());
    }
}

#[test]
fn nothing_is_overwritten() {
    let scratch = tempfile::tempdir().unwrap();
    std::fs::write(scratch.path().join("taken"), "mine").unwrap();
    std::fs::create_dir(scratch.path().join("empty")).unwrap();
    for (name, part) in
        [("taken", "exists already"), ("empty", "exists already"), ("..", "is not a valid folder name")]
    {
        let done = carom(scratch.path(), &["new", name]);
        assert_eq!(done.status.code(), Some(2), "{name}");
        assert!(String::from_utf8(done.stderr).unwrap().contains(part), "{name}");
    }
    assert_eq!(carom(scratch.path(), &["new", "taken/below"]).status.code(), Some(4));
    assert_eq!(std::fs::read_to_string(scratch.path().join("taken")).unwrap(), "mine");
    assert!(std::fs::read_dir(scratch.path().join("empty")).unwrap().next().is_none());
}
