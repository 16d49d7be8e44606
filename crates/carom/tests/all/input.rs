//! Inputs that have no end, that are missing or changed when a run is resumed, and several runs at
//! once.

use std::io::{BufRead, BufReader, Write};
use std::process::{Child, Command, Output, Stdio};
use std::time::{Duration, Instant};

use crate::common::{COARSE, IMPACT, Place, SQUARE, text};

const FLIGHT: &str = "
dimension = 2
material = [{ name = 'm', law = 'neo-hookean', density = 1.0, lambda = 1.0, mu = 1.0 }]
body = [{ name = 'b', material = 'm', element = 'T3', mesh = { file = 'square.msh', surface = 'square' }, velocity = [1.0, 0.0] }]
load = [{ body = 'b', body_force = [0.01, 0.0], table = 'force.csv' }]
time = { end = 30, step = 0.01, scheme = { kind = 'hu' } }
output = { checkpoint_every = 200, fields_every = 100 }
";

fn flight(name: &str) -> Place {
    let place = Place::new(name);
    place.file("case.toml", FLIGHT).file("square.msh", SQUARE).file("force.csv", "t,value\n0,1\n40,2\n");
    place
}

fn spawned(command: &mut Command) -> Child {
    command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap()
}

fn expect(done: &Output, code: i32, parts: &[&str]) {
    let output = text(&done.stderr);
    assert_eq!(done.status.code(), Some(code), "{output}");
    for part in parts {
        assert!(output.contains(part), "{part:?} not in\n{output}");
    }
}

#[test]
fn runs_started_at_once_have_a_directory_each() {
    let place = Place::new("at-once");
    place.file("case.toml", IMPACT);
    let short = [&["run", "case.toml", "--no-report", "--set", "time.end=0.01875"], &COARSE[..]].concat();
    let children: Vec<_> = (0..4).map(|_| spawned(&mut place.command(&short))).collect();
    for child in children {
        expect(&child.wait_with_output().unwrap(), 0, &[]);
    }
    for name in ["case", "case-2", "case-3", "case-4"] {
        assert!(place.0.join("runs").join(name).join("history.csv").is_file(), "{name}");
    }
    // A case with a mistake that only its model shows leaves nothing behind.
    let overlapping = [&short[..], &["--set", "body.cylinder.mesh.center=[0.5, 0.2]"]].concat();
    assert_eq!(place.carom(&overlapping).status.code(), Some(2));
    assert!(!place.0.join("runs/case-5").exists());
}

#[test]
fn more_threads_than_help_are_refused() {
    let place = Place::new("threads-limit");
    place.file("case.toml", IMPACT).file("study.toml", "case = \"case.toml\"\n[[arm]]\nname = \"a\"\n");
    for arguments in [
        &["run", "case.toml", "--threads", "100000"][..],
        &["study", "study.toml", "--jobs", "100000"],
        &["verify", "case.toml", "--jobs", "100000"],
    ] {
        expect(&place.carom(arguments), 2, &["100000 is too many", "cores", "omit --"]);
    }
    assert_eq!(place.entries(), ["case.toml", "study.toml"]);
    let short = [&["run", "case.toml", "--no-report", "--set", "time.end=0.01875"], &COARSE[..]].concat();
    expect(&place.carom(&[&short[..], &["--threads", "64"]].concat()), 0, &[]);
}

#[test]
fn inputs_without_an_end_are_refused() {
    let place = flight("endless");
    expect(&place.carom(&["check", "case.toml"]), 0, &[]);
    for (command, what) in [("run", "too large to be a case"), ("check", "too large"), ("study", "too large")]
    {
        expect(&place.carom(&[command, "/dev/zero"]), 2, &[what]);
        expect(&place.carom(&[command, "/dev/urandom"]), 2, &["too large"]);
    }
    for file in ["/dev/zero", "/dev/urandom", "."] {
        place.file("mesh.toml", FLIGHT.replace("square.msh", file));
        expect(&place.carom(&["check", "mesh.toml"]), 2, &["cannot be read", "not a regular file"]);
        place.file("table.toml", FLIGHT.replace("force.csv", file));
        expect(&place.carom(&["check", "table.toml"]), 2, &["cannot be used", "not a regular file"]);
    }
    // A pipe without a writer, too, in place of a mesh or a table.
    assert!(Command::new("mkfifo").arg(place.0.join("pipe")).status().unwrap().success());
    place.file("mesh.toml", FLIGHT.replace("square.msh", "pipe"));
    expect(&place.carom(&["check", "mesh.toml"]), 2, &["not a regular file"]);
    place.file("table.toml", FLIGHT.replace("force.csv", "pipe"));
    expect(&place.carom(&["check", "table.toml"]), 2, &["not a regular file"]);
}

#[test]
fn a_silent_pipe_is_named_after_two_seconds() {
    let place = flight("silent");
    assert!(Command::new("mkfifo").arg(place.0.join("pipe")).status().unwrap().success());
    for (path, what) in
        [("-", "waiting for a case on standard input"), ("pipe", "waiting for a case on pipe")]
    {
        let began = Instant::now();
        let mut child = spawned(place.command(&["check", path]).stdin(Stdio::piped()));
        let mut line = String::new();
        BufReader::new(child.stderr.take().unwrap()).read_line(&mut line).unwrap();
        assert!(line.contains(what) && began.elapsed() >= Duration::from_secs(2), "{line}");
        let input = child.stdin.take().unwrap();
        if path == "-" {
            (&input).write_all(FLIGHT.as_bytes()).unwrap();
        } else {
            std::fs::write(place.0.join(path), FLIGHT).unwrap();
        }
        drop(input);
        assert!(child.wait().unwrap().success());
    }
    for option in ["--quiet", "--json"] {
        let mut child = spawned(place.command(&["check", "-", option]).stdin(Stdio::piped()));
        std::thread::sleep(Duration::from_millis(2500));
        child.stdin.take().unwrap().write_all(FLIGHT.as_bytes()).unwrap();
        let done = child.wait_with_output().unwrap();
        expect(&done, 0, &[]);
        assert!(done.stderr.is_empty(), "{}", text(&done.stderr));
    }
}

/// The paths of cases start at the folder of a pipe, and at the working directory for standard
/// input.
#[test]
fn a_study_is_read_once_from_a_pipe_or_standard_input() {
    const STUDY: &str = "case = 'case.toml'\nset = { 'time.end' = 0.05 }\n[[arm]]\nname = 'only one'\n";
    let place = flight("study-pipe");
    assert!(Command::new("mkfifo").arg(place.0.join("pipe")).status().unwrap().success());
    for (command, path) in [("check", "pipe"), ("check", "-"), ("study", "pipe"), ("study", "-")] {
        let options = if command == "study" { &["--no-report"][..] } else { &[] };
        let mut child = spawned(place.command(&[&[command, path], options].concat()).stdin(Stdio::piped()));
        let mut input = child.stdin.take().unwrap();
        if path == "-" {
            input.write_all(STUDY.as_bytes()).unwrap();
        } else {
            std::fs::write(place.0.join(path), STUDY).unwrap();
        }
        drop(input);
        let done = child.wait_with_output().unwrap();
        expect(&done, 0, &[]);
        assert!(text(&done.stdout).contains("only one"), "{command} {path}: {}", text(&done.stdout));
    }
    assert!(
        place.0.join("runs/pipe/study.json").is_file() && place.0.join("runs/stdin/study.json").is_file()
    );
}

#[test]
fn a_changed_mesh_or_record_is_named_when_a_run_is_resumed() {
    let place = flight("changed");
    place.killed(place.command(&["run", "case.toml", "--no-report", "--out", "out"]), "out");
    for (bytes, parts) in [
        (
            Some(SQUARE.replace("1 1 0", "1.5 1 0")),
            ["square.msh has changed since the run began", "restore the file"],
        ),
        (None, ["there is no file", "square.msh"]),
    ] {
        match bytes {
            Some(bytes) => drop(place.file("square.msh", bytes)),
            None => std::fs::remove_file(place.0.join("square.msh")).unwrap(),
        }
        expect(&place.carom(&["resume", "out", "--no-report"]), 2, &parts);
    }
    place.file("square.msh", SQUARE);
    let history = std::fs::read_to_string(place.0.join("out/history.csv")).unwrap();
    let altered = |number: usize, from: char, to: &str| {
        let line = history.lines().nth(number).unwrap();
        place.file("out/history.csv", history.replacen(line, &line.replacen(from, to, 1), 1));
        place.carom(&["resume", "out", "--no-report"])
    };
    // Both checkpoints contain the names of the columns; the first one, of step 0, no rows.
    let parts = ["history.csv is damaged", "have changed since step", "run the case again"];
    expect(&altered(0, 't', "T"), 2, &parts);
    let done = altered(1, '0', "1");
    expect(&done, 0, &[]);
    assert!(text(&done.stdout).contains("history.csv is damaged"), "{}", text(&done.stdout));
    let again = std::fs::read_to_string(place.0.join("out/history.csv")).unwrap();
    assert_eq!(again.lines().nth(1), history.lines().nth(1));
}

/// A run keeps what it has read of a table, and its state keeps what it has read of another run: it
/// does not depend on them any more.
#[test]
fn a_resumed_run_needs_neither_its_table_nor_its_initial_run() {
    let place = flight("independent");
    expect(
        &place.carom(&["run", "case.toml", "--no-report", "--set", "time.end=0.5", "--out", "first"]),
        0,
        &[],
    );
    let from =
        ["run", "case.toml", "--set", "initial={ from = 'first' }", "--set", "body.b.velocity=[0.0, 0.0]"];
    expect(&place.carom(&[&from[..], &["--no-report", "--out", "whole"]].concat()), 0, &[]);
    place.killed(place.command(&[&from[..], &["--no-report", "--out", "out"]].concat()), "out");
    place.file("force.csv", "t,value\n0,7\n40,9\n");
    std::fs::remove_dir_all(place.0.join("first")).unwrap();
    expect(&place.carom(&["resume", "out", "--no-report"]), 0, &[]);
    for name in ["history.csv", "log.jsonl", "fields/00003000.vtu"] {
        let read = |run: &str| std::fs::read(place.0.join(run).join(name)).unwrap();
        assert!(read("whole") == read("out"), "{name}");
    }
}
