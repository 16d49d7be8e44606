//! The binary as a process: exit codes, messages, and that a wrong case writes no files.

use std::io::Write;
use std::process::Stdio;

use crate::common::{COARSE, IMPACT, Place, text};

#[test]
fn wrong_cases_report_the_place_and_write_nothing() {
    let wrong: Vec<(&str, Vec<u8>, &[&str])> = vec![
        (
            "key",
            IMPACT.replace("density", "densty").into(),
            &["unknown key `densty`", "case.toml:11:1", "`density`?"],
        ),
        (
            "side",
            IMPACT.replace("prism.top", "prism.topp").into(),
            &["no side `topp`", "case.toml:39:11", "prism.top`?"],
        ),
        (
            "type",
            IMPACT.replace("density = 0.25", "density = \"heavy\"").into(),
            &["`density` must be a number", "case.toml:11:11"],
        ),
        ("negative", IMPACT.replace("density = ", "density = -").into(), &["not -0.25", "case.toml:11:11"]),
        (
            "radius",
            IMPACT.replace("rho_inf = 0.6", "rho_inf = 1.2").into(),
            &["in [0, 1], not 1.2", "case.toml:44:46"],
        ),
        ("nan", IMPACT.replace("1.875e-3", "nan").into(), &["`step` is NaN", "case.toml:43:8"]),
        ("empty", Vec::new(), &["the case is empty", "case.toml"]),
        ("binary", b"\x7fELF\x02\xff\xfe".to_vec(), &["not text", "byte 6", "UTF-8"]),
        ("syntax", IMPACT.replace("dimension = 2", "dimension 2").into(), &["not TOML", "case.toml:5:"]),
        ("scheme", IMPACT.replace("chung-hulbert", "chung-hulbart").into(), &["`chung-hulbert`?"]),
        (
            "dimension",
            IMPACT.replace("dimension = 2", "dimension = 1").into(),
            &["dimension 2", "dimension = 1"],
        ),
    ];
    // A lack of memory is no mistake of the case.
    let vast = IMPACT.replace("[8, 4]", "[10000000000, 1]").into_bytes();
    let vast: (_, _, &[&str]) = ("memory", vast, &["too large for the memory", "GiB"]);
    let cases = wrong.into_iter().map(|case| (2, case)).chain([(4, vast)]);
    for (code, (name, bytes, parts)) in cases {
        let place = Place::new(name);
        place.file("case.toml", bytes);
        for arguments in [
            &["run", "case.toml"][..],
            &["run", "case.toml", "--out", "out"],
            &["run", "case.toml", "--json"],
            &["check", "case.toml"],
        ] {
            let done = place.carom(arguments);
            let output = text(&done.stderr);
            assert_eq!(done.status.code(), Some(code), "{name}: {output}");
            if arguments.contains(&"--json") {
                let event: serde_json::Value = serde_json::from_slice(&done.stdout).unwrap();
                assert_eq!((&event["event"], &event["exit"]), (&"error".into(), &code.into()), "{name}");
                let what = event["errors"][0]["what"].as_str().unwrap();
                assert!(output.contains(what), "{name}: {what:?} not in\n{output}");
            } else {
                assert!(done.stdout.is_empty(), "{name}");
            }
            for part in parts {
                assert!(output.contains(part), "{name}: {part:?} not in\n{output}");
            }
            assert!(!output.contains('\u{1b}'), "no colour in a pipe");
            assert_eq!(place.entries(), ["case.toml"], "{name}");
        }
    }
}

#[test]
fn a_study_is_checked_as_a_study_and_not_run_as_a_case() {
    let place = Place::new("study-as-case");
    let arms = "[[arm]]\nname = \"as it is\"\n[[arm]]\nname = \"Hu\"\nset = { \"time.scheme\" = { kind = \"hu\" } }\n";
    place
        .file("case.toml", IMPACT)
        .file("study.toml", format!("title = \"Two\"\ncase = \"case.toml\"\n{arms}"));
    let done = place.carom(&["check", "study.toml"]);
    let output = text(&done.stdout);
    assert_eq!(done.status.code(), Some(0), "{}", text(&done.stderr));
    assert!(output.contains("Two (2 runs of case.toml)") && output.contains("Hu: hu, order 1"), "{output}");
    let json = place.carom(&["check", "study.toml", "--json"]);
    assert!(text(&json.stdout).contains("\"event\":\"check\""));
    for (arguments, parts) in [
        (&["run", "study.toml"][..], &["this is a study, not a case", "study.toml:2:1", "carom study"][..]),
        (&["check", "study.toml", "--set", "time.step=1"], &["--set cannot be used with a study"]),
    ] {
        let done = place.carom(arguments);
        let output = text(&done.stderr);
        assert_eq!(done.status.code(), Some(2), "{output}");
        assert!(parts.iter().all(|part| output.contains(part)), "{output}");
    }
    assert_eq!(place.entries(), ["case.toml", "study.toml"]);
}

#[test]
fn warnings_of_a_study_are_listed_once_with_their_arms() {
    let place = Place::new("study-warnings");
    let short = "\"time.end\" = 1.875e-2, \"output.fields_every\" = 0";
    let arms = format!(
        "[[arm]]\nname = \"as it is\"\nset = {{ {short} }}\n[[arm]]\nname = \"Hu\"\nset = {{ \"time.scheme\" = {{ kind = \"hu\" }}, {short} }}\n\
         [[arm]]\nname = \"coarse\"\nset = {{ \"body.cylinder.mesh.size\" = 0.25, {short} }}\n"
    );
    let impact = IMPACT.replace("record = [\"uy\"]", "record = [\"uy\", \"sigma_yy\"]");
    place.file("case.toml", impact).file("study.toml", format!("case = \"case.toml\"\n{arms}"));
    let check = place.carom(&["check", "study.toml"]);
    let study = place.carom(&["study", "study.toml", "--out", "s", "--no-report"]);
    for (output, start) in [(text(&check.stdout), "  warning  "), (text(&study.stderr), "warning: ")] {
        let lines: Vec<_> = output.lines().filter_map(|line| line.strip_prefix(start)).collect();
        let of = |id: &str| {
            let mut found = lines.iter().filter(|line| line.ends_with(id));
            (found.next().unwrap_or_else(|| panic!("{id} not in\n{output}")), found.count())
        };
        let ((shared, again), (coarse, twice)) = (of("(unmatched-pressure)"), of("(coarse-secondary)"));
        assert!(shared.starts_with("all arms: contact ") && again == 0, "{output}");
        assert!(coarse.starts_with("\"coarse\": contact ") && twice == 0, "{output}");
    }
    let json = text(&place.carom(&["check", "study.toml", "--json"]).stdout);
    assert!(json.contains("\"arms\":[\"as it is\",\"Hu\",\"coarse\"]"), "{json}");
    let quiet = place.carom(&["study", "study.toml", "--out", "q", "--no-report", "--quiet"]);
    assert_eq!((text(&quiet.stdout), text(&quiet.stderr)), (String::new(), String::new()));
}

#[test]
fn files_that_cannot_be_read() {
    let place = Place::new("files");
    for (name, part) in [("none.toml", "no such file"), (".", "this is a directory")] {
        let done = place.carom(&["run", name]);
        assert_eq!(done.status.code(), Some(2));
        assert!(text(&done.stderr).contains(part));
    }
    assert!(place.entries().is_empty());
}

#[test]
fn format_of_a_diagnostic() {
    let place = Place::new("shown");
    place.file("case.toml", IMPACT.replace("prism.top", "prism.topp"));
    let output = text(&place.carom(&["check", "case.toml"]).stderr);
    let expected = "\
error: body `prism` has no side `topp`
  --> case.toml:39:11
   |
39 | primary = \"prism.topp\"
   |           ^^^^^^^^^^^^
   |
   = why: its mesh has the sides: prism.bottom, prism.right, prism.top, prism.left
   = try: did you mean `prism.top`?
";
    assert_eq!(output, expected);
}

#[test]
fn arguments_are_checked() {
    let place = Place::new("arguments");
    place.file("case.toml", IMPACT);
    std::fs::create_dir(place.0.join("old")).unwrap();
    let wrong: &[(&[&str], &str)] = &[
        (&["run", "case.toml", "--out", "old"], "old exists already"),
        (&["run", "case.toml", "--threads", "0"], "invalid value '0'"),
        (&["run", "case.toml", "--threads", "5000"], "--threads 5000 is too many"),
        (&["run", "case.toml", "--set", "time.step"], "there is no `=`"),
        (&["run", "case.toml", "--set", "time.scheme.rho_inf=1.2"], "--set:1:21"),
        (&["run"], "<CASE>"),
        (&["rnu", "case.toml"], "unrecognized subcommand"),
        (&["resume", "old"], "old is not the directory of a run"),
        (&["report", "nowhere"], "there is no directory nowhere"),
        (&["explain", "bathe"], "scheme \"bathe\" needs `rho_inf`"),
        (&["explain", "hht", "alpha=-0.1"], "did you mean `alpha = 0.1`?"),
        (&["explain", "wbz", "rho=0.5"], "unknown key `rho`"),
        (&["explain", "bathee"], "did you mean `bathe`?"),
        (&["explain", "contact.enforcment"], "did you mean `contact.enforcement`?"),
        (&["explain", "persistancy"], "did you mean `persistency`?"),
    ];
    for (arguments, part) in wrong {
        let done = place.carom(arguments);
        let output = text(&done.stderr);
        assert_eq!(done.status.code(), Some(2), "{arguments:?}: {output}");
        assert!(output.contains(part), "{arguments:?}: {part:?} not in\n{output}");
        assert!(done.stdout.is_empty());
    }
    assert_eq!(place.entries(), ["case.toml", "old"]);
    assert!(std::fs::read_dir(place.0.join("old")).unwrap().next().is_none());
}

#[test]
fn a_study_is_resumed_with_its_own_options() {
    let place = Place::new("study");
    place.file("case.toml", IMPACT);
    let arm = "[[arm]]\nname = \"short\"\nset = { \"time.end\" = 1.875e-2, \"output.fields_every\" = 0 }\n";
    place.file("study.toml", format!("case = \"case.toml\"\n{arm}"));
    let code = |arguments: &[&str], expected: i32| {
        let done = place.carom(arguments);
        assert_eq!(done.status.code(), Some(expected), "{arguments:?}: {}", text(&done.stderr));
        text(&done.stdout) + &text(&done.stderr)
    };
    assert!(code(&["study", "study.toml", "--out", "s", "--no-report"], 0).contains("short"));
    assert!(
        code(&["resume", "s", "--threads", "2"], 2)
            .contains("--threads is an option for runs, but s is a study")
    );
    assert!(code(&["resume", "s", "--profile"], 2).contains("--profile is an option for runs"));
    assert!(!place.0.join("s/study.html").exists() && place.0.join("s/study.csv").exists());
    assert!(code(&["resume", "s", "--jobs", "1"], 0).contains("study.html"));
    assert!(
        code(&["resume", "s/arms/01-short", "--jobs", "1"], 2).contains("--jobs is an option for studies")
    );
}

#[test]
fn check_prints_the_case() {
    let place = Place::new("check");
    place.file("case.toml", IMPACT);
    let done = place.carom(&["check", "case.toml", "--set", "body.cylinder.element=T6"]);
    let output = text(&done.stdout);
    assert_eq!((done.status.code(), done.stderr.len()), (Some(0), 0));
    for part in ["Cylinder falling on a prism", "T6 of rubber", "cylinder.arc against prism.top", "400 steps"]
    {
        assert!(output.contains(part), "{part:?} not in\n{output}");
    }
    assert!(output.contains("a pressure wave crosses the smallest body in"), "{output}");
    let scheme = "time.scheme={ kind = \"static\" }";
    let output = text(&place.carom(&["check", "case.toml", "--set", scheme]).stdout);
    assert!(output.contains("400 steps") && !output.contains("wave"), "{output}");
    let done = place.carom(&["check", "case.toml", "--json", "--set", "preset=paper"]);
    let output: serde_json::Value = serde_json::from_slice(&done.stdout).unwrap();
    assert_eq!(output["case"]["contacts"][0]["persistency"], "none");
    assert_eq!(output["case"]["time"]["scheme"]["rho_inf"], 0.6);
    assert_eq!(place.entries(), ["case.toml"]);
}

#[test]
fn explain_and_schema_and_help() {
    let place = Place::new("explain");
    let output = |arguments: &[&str]| {
        let done = place.carom(arguments);
        assert_eq!(done.status.code(), Some(0), "{arguments:?}");
        text(&done.stdout)
    };
    assert!(output(&["explain"]).contains("hu"));
    assert!(output(&["explain", "chung-hulbert", "rho_inf=0.1"]).contains("order 2"));
    let hu: serde_json::Value = serde_json::from_str(&output(&["explain", "hu", "--json"])).unwrap();
    assert_eq!((&hu["scheme"]["beta"], &hu["order"]), (&1.0.into(), &1.into()));
    let tolerance = output(&["explain", "newton.tolerance"]);
    assert!(tolerance.contains("a number in (0, 1)") && tolerance.contains("[newton]"), "{tolerance}");
    // In the table of a contact with this name, too, and without the table.
    let enforcement = output(&["explain", "contact.enforcement"]);
    assert!(enforcement.contains("multiplier\n      ") && enforcement.contains("default\n  \"multiplier\""));
    assert_eq!(output(&["explain", "contact.strike.enforcement"]), enforcement);
    assert_eq!(output(&["explain", "enforcement"]), enforcement);
    let between: serde_json::Value =
        serde_json::from_str(&output(&["explain", "secondary", "--json"])).unwrap();
    assert_eq!(between["keys"][0]["unless"], "between");
    assert!(output(&["explain", "time.scheme.rho_inf"]).contains("scheme \"bathe\""));
    assert!(output(&["explain", "arm.set"]).contains("[[arm]]"));
    assert!(output(&["explain", "mesh.size"]).contains("body.mesh.size"));
    assert!(output(&["explain", "A.uy:roughness"]).contains("roughness   metric"));
    assert!(output(&["explain", "flat-cell"]).contains("flat-cell   warning"));
    // A key and a metric.
    let both = output(&["explain", "restitution"]);
    assert!(both.contains("contact.restitution") && both.contains("restitution   metric"), "{both}");
    let schema: serde_json::Value = serde_json::from_str(&output(&["schema"])).unwrap();
    assert_eq!(schema["$schema"], "https://json-schema.org/draft/2020-12/schema");
    for command in
        ["run", "resume", "study", "verify", "check", "explain", "mesh", "new", "report", "schema", "man"]
    {
        assert!(output(&[command, "--help"]).contains("Example"), "{command}");
    }
    assert!(output(&["--help"]).contains("Exit codes"));
    assert!(place.entries().is_empty());
}

/// The case in the README is valid.
#[test]
fn the_case_of_the_readme() {
    let readme = include_str!("../../../../README.md");
    let case = readme.split("```toml\n").nth(1).and_then(|rest| rest.split("```").next()).unwrap();
    let place = Place::new("readme");
    place.file("case.toml", case);
    let done = place.carom(&["check", "case.toml"]);
    assert_eq!((done.status.code(), text(&done.stderr)), (Some(0), String::new()));
}

/// A case from a pipe is run like one from a file, and a stream that is too long is an error.
#[test]
fn a_case_from_standard_input() {
    let place = Place::new("stdin");
    let fed = |arguments: &[&str], bytes: &[u8]| {
        let mut child = place
            .command(arguments)
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        // The reader may stop before the end.
        let _ = child.stdin.take().unwrap().write_all(bytes);
        child.wait_with_output().unwrap()
    };
    let done = fed(&["check", "-", "--set", "body.cylinder.element=T6"], IMPACT.as_bytes());
    assert_eq!(done.status.code(), Some(0), "{}", text(&done.stderr));
    assert!(text(&done.stdout).contains("T6 of rubber"));
    let done = fed(&["check", "-"], IMPACT.replace("density", "densty").as_bytes());
    assert_eq!(done.status.code(), Some(2));
    assert!(text(&done.stderr).contains("<stdin>:11:1"), "{}", text(&done.stderr));
    let done = fed(&["check", "-"], &vec![b'#'; 11_000_000]);
    assert!(done.status.code() == Some(2) && text(&done.stderr).contains("too large"));
    let short = [&["run", "-", "--no-report", "--set", "time.end=0.01875"], &COARSE[..]].concat();
    assert_eq!(fed(&short, IMPACT.as_bytes()).status.code(), Some(0));
    assert!(place.0.join("runs/stdin/history.csv").is_file());
}

/// Without `--strict`, a missed expectation is reported and the exit code is still 0.
#[test]
fn missed_expectations_are_an_error_with_strict() {
    let place = Place::new("strict");
    place.file("case.toml", IMPACT);
    let short = [&["run", "case.toml", "--no-report", "--set", "time.end=0.01875"], &COARSE[..]].concat();
    let done = place.carom(&short);
    assert_eq!(done.status.code(), Some(0));
    assert!(text(&done.stdout).contains("MISSED: expected -0.7827 ± 0.004"), "{}", text(&done.stdout));
    let done = place.carom(&[&short[..], &["--strict", "--quiet"]].concat());
    assert_eq!((done.status.code(), done.stdout.len()), (Some(1), 0));
    assert!(text(&done.stderr).contains("not available"), "{}", text(&done.stderr));
    let met = "expect=[{ what = \"last time\", value = 0.01875, tolerance = 1e-12 }]";
    let done = place.carom(&[&short[..], &["--strict", "--quiet", "--set", met]].concat());
    assert_eq!((done.status.code(), text(&done.stderr)), (Some(0), String::new()));
}

#[test]
fn colours_completions_and_manual_pages() {
    let place = Place::new("shell");
    let done = place.carom(&["check", "none.toml", "--color", "always"]);
    assert!(text(&done.stderr).contains("\u{1b}["));
    for shell in ["bash", "zsh", "fish", "powershell", "elvish"] {
        assert!(text(&place.carom(&["completions", shell]).stdout).contains("verify"), "{shell}");
    }
    assert!(text(&place.carom(&["man"]).stdout).contains(".TH carom 1"));
    assert_eq!(place.carom(&["man", "--out", "pages"]).status.code(), Some(0));
    assert!(place.0.join("pages/carom-run.1").is_file());
}

/// `carom schema | head -1` closes the pipe long before the schema ends.
#[test]
fn closed_output_is_no_panic() {
    let place = Place::new("pipe");
    let mut child = place.command(&["schema"]).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    drop(child.stdout.take());
    let done = child.wait_with_output().unwrap();
    assert_eq!((done.status.code(), text(&done.stderr)), (Some(0), String::new()));
}
