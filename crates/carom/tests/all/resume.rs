//! A run that is killed, interrupted, or run with other options has the same record, byte for byte.

use std::collections::BTreeMap;
use std::io::{BufRead, BufReader};
use std::path::Path;
use std::process::{Command, Output, Stdio};
use std::time::{Duration, Instant};

use crate::common::{COARSE, IMPACT, Place, text};

fn place(name: &str) -> Place {
    let place = Place::new(name);
    // With the frames of a case that does not say how often.
    let lines = IMPACT.split_inclusive('\n').filter(|line| !line.starts_with("fields_every"));
    place.file("case.toml", lines.collect::<String>());
    place
}

/// `carom run` of the coarse impact into `out`.
fn run(place: &Place, out: &str, more: &[&str]) -> Command {
    let mut command = place.command(&["run", "case.toml", "--no-report", "--out", out]);
    command.args(COARSE).args(["--set", "output.checkpoint_every=7"]).args(more);
    command
}

fn resume(place: &Place, out: &str) -> Command {
    place.command(&["resume", out, "--no-report"])
}

/// The files that must be the same: rows, events, fields. The manifest has wall times, and an
/// interrupted run has checkpoints at other steps.
fn record(place: &Place, out: &str) -> Files {
    let compared =
        |name: &String| name.starts_with("fields") || !name.contains('/') && name != "manifest.json";
    files(&place.0.join(out)).into_iter().filter(|(name, _)| compared(name)).collect()
}

/// Bytes by path.
type Files = BTreeMap<String, Vec<u8>>;

fn files(directory: &Path) -> Files {
    let mut found = Files::new();
    for entry in std::fs::read_dir(directory).unwrap() {
        let path = entry.unwrap().path();
        let name = path.file_name().unwrap().to_string_lossy().into_owned();
        if path.is_dir() {
            found.extend(files(&path).into_iter().map(|(inner, bytes)| (format!("{name}/{inner}"), bytes)));
        } else {
            found.insert(name, std::fs::read(path).unwrap());
        }
    }
    found
}

/// Compares names and bytes; reports which file differs, not how.
fn assert_same(a: &Files, b: &Files, when: &str) {
    assert_eq!(a.keys().collect::<Vec<_>>(), b.keys().collect::<Vec<_>>(), "{when}");
    for (name, bytes) in a {
        assert!(bytes == &b[name], "{when}: {name} differs ({} and {} bytes)", bytes.len(), b[name].len());
    }
}

fn ended(command: &mut Command, code: i32) -> Output {
    let done = command.output().unwrap();
    assert_eq!(done.status.code(), Some(code), "{}", String::from_utf8_lossy(&done.stderr));
    done
}

/// Reproducible random numbers in [0, 1) (Knuth's MMIX generator).
fn random(seed: &mut u64) -> f64 {
    *seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
    (*seed >> 11) as f64 / (1u64 << 53) as f64
}

/// The record of an uninterrupted run, and its duration.
fn whole(place: &Place) -> (Files, Duration) {
    let began = Instant::now();
    ended(&mut run(place, "whole", &[]), 0);
    let record = record(place, "whole");
    for name in ["history.csv", "contact.csv", "log.jsonl", "fields.pvd", "metrics.json"] {
        assert!(record[name].len() > 200, "{name} is nearly empty");
    }
    let frames = record.keys().filter(|name| name.starts_with("fields/")).count();
    assert!((100..=155).contains(&frames), "{frames}");
    (record, began.elapsed())
}

#[test]
fn twenty_kills_leave_the_same_bytes() {
    let place = place("kills");
    let (expected, wall) = whole(&place);
    let (mut seed, mut kills, mut resumed) = (2, 0, 0);
    for life in 0.. {
        let out = format!("killed-{life}");
        loop {
            let exists = place.0.join(&out).exists();
            let mut command = if exists { resume(&place, &out) } else { run(&place, &out, &[]) };
            resumed += u32::from(exists);
            if kills == 20 {
                ended(&mut command, 0);
                break;
            }
            // The first kill comes at once; the others are spread so that about twenty fit into one
            // run, from where there is a directory: a busy machine starts a program late.
            let delay = if kills == 0 { Duration::ZERO } else { wall.mul_f64(0.15 * random(&mut seed)) };
            let mut child = command.stdout(Stdio::null()).stderr(Stdio::null()).spawn().unwrap();
            while kills > 0 && !place.0.join(&out).exists() && child.try_wait().unwrap().is_none() {
                std::thread::sleep(Duration::from_millis(1));
            }
            std::thread::sleep(delay);
            if let Some(status) = child.try_wait().unwrap() {
                assert_eq!(status.code(), Some(0));
                break;
            }
            child.kill().unwrap();
            child.wait().unwrap();
            kills += 1;
        }
        assert_same(&expected, &record(&place, &out), &out);
        if kills == 20 {
            break;
        }
    }
    assert!(resumed >= 10, "only {resumed} of 20 kills came after the directory was created");
}

#[test]
fn interrupted_runs_exit_130_and_resume() {
    let place = place("interrupt");
    let (expected, _) = whole(&place);
    let mut child =
        run(&place, "stopped", &["--json"]).stdout(Stdio::piped()).stderr(Stdio::null()).spawn().unwrap();
    let mut lines = BufReader::new(child.stdout.take().unwrap()).lines().map(Result::unwrap);
    assert!(lines.any(|line| line.contains("\"progress\"")));
    let kill = format!("kill -INT {}", child.id());
    assert!(Command::new("sh").args(["-c", &kill]).status().unwrap().success());
    let last: serde_json::Value = serde_json::from_str(&lines.last().unwrap()).unwrap();
    assert_eq!((child.wait().unwrap().code(), &last["event"]), (Some(130), &"interrupted".into()));
    assert!(last["steps"].as_u64().unwrap() < 400);

    let output = ended(&mut resume(&place, "stopped"), 0).stdout;
    assert!(text(&output).starts_with("400 steps to t = 0.75"));
    assert_same(&expected, &record(&place, "stopped"), "interrupted");
}

#[test]
fn a_finished_run_is_left_alone() {
    let place = place("finished");
    ended(&mut run(&place, "done", &["--set", "time.end=0.05625"]), 0);
    ended(&mut place.command(&["report", "done"]), 0);
    let before = files(&place.0.join("done"));
    let output = ended(&mut place.command(&["resume", "done"]), 0).stdout;
    assert!(text(&output).contains("nothing was computed"));
    assert_same(&before, &files(&place.0.join("done")), "finished");
}

#[test]
fn threads_and_outputs_change_no_bit() {
    let place = place("threads");
    let (expected, _) = whole(&place);
    ended(&mut run(&place, "two", &["--threads", "2"]), 0);
    assert_same(&expected, &record(&place, "two"), "--threads 2");

    let sparse = [
        "--set",
        "output.fields_every=0",
        "--set",
        "output.history_every=3",
        "--set",
        "output.checkpoint_every=50",
    ];
    ended(&mut run(&place, "sparse", &sparse), 0);
    let sparse = record(&place, "sparse");
    assert!(!sparse.keys().any(|name| name.starts_with("fields/")));
    let steps = |record: &Files| -> BTreeMap<String, String> {
        let text = text(&record["history.csv"]);
        text.lines().map(|line| (line.split(',').next().unwrap().to_owned(), line.to_owned())).collect()
    };
    let (all, some) = (steps(&expected), steps(&sparse));
    assert_eq!((all.len(), some.len()), (402, 1 + 134 + 1), "heading, every third of 0..=400, the last");
    // Counts and depths are those since the previous row; all else is that of the instant.
    let counts = ["activations", "releases", "newton", "rejected"];
    let depths = ["penetration", "penetration_secondary"];
    let heads: Vec<&str> = all["step"].split(',').collect();
    let values = |line: &str| -> Vec<f64> { line.split(',').map(|cell| cell.parse().unwrap()).collect() };
    let (mut sums, mut deepest) = (vec![0.0; heads.len()], vec![0.0_f64; heads.len()]);
    let mut rows: Vec<_> = all.iter().filter(|(step, _)| *step != "step").collect();
    rows.sort_by_key(|(step, _)| step.parse::<u64>().unwrap());
    for (step, line) in rows {
        let row = values(line);
        for (i, value) in row.iter().enumerate() {
            sums[i] += value;
            deepest[i] = deepest[i].max(*value);
        }
        let Some(other) = some.get(step) else { continue };
        for (i, other) in values(other).into_iter().enumerate() {
            let expected = match heads[i] {
                head if depths.contains(&head) => deepest[i],
                head if counts.contains(&head) => sums[i],
                _ => row[i],
            };
            assert_eq!(other, expected, "step {step}, {}", heads[i]);
        }
        sums.fill(0.0);
        deepest.fill(0.0);
    }
}

/// What is counted in a run does not depend on how often rows are written; times are known to a
/// row.
#[test]
fn metrics_of_thinned_rows() {
    let place = place("thinned");
    let metrics = |every: &str, resumed: bool| {
        let name = format!("rows-{every}-{resumed}");
        // Forces of few rows are compared: they are smooth with much damping.
        let sets = [
            format!("output.history_every={every}"),
            "output.checkpoint_every=7".to_owned(),
            "time.scheme.rho_inf=0.1".to_owned(),
        ];
        let sets: Vec<&str> = sets.iter().flat_map(|set| ["--set", set]).collect();
        let mut command = run(&place, &name, &sets);
        if resumed {
            // A checkpoint between two rows, then a kill.
            place.killed(command, &name);
            ended(&mut resume(&place, &name), 0);
        } else {
            ended(&mut command, 0);
        }
        let run = carom_record::Run::open(&place.0.join(&name)).unwrap();
        (carom_record::metrics::of_run(&run), run.manifest)
    };
    let ((each, _), (tenth, _), (resumed, _)) =
        (metrics("1", false), metrics("10", false), metrics("10", true));
    // Ten steps of 1.875e-3 s.
    let row = 0.01875;
    for ((one, ten), again) in each.iter().zip(&tenth).zip(&resumed) {
        assert_eq!([&one.name, &one.name], [&ten.name, &again.name]);
        let name = one.name.as_ref();
        if sensitivity(name) != Sensitivity::Machine {
            assert_eq!(ten.value, again.value, "{name} after a resume");
        }
        let (Some(a), Some(b)) = (one.value, ten.value) else {
            let few = sensitivity(name) == Sensitivity::Shape && ten.value.is_none();
            assert!(few || one.value == ten.value, "{name}: {:?} and {:?}", one.value, ten.value);
            continue;
        };
        match sensitivity(name) {
            Sensitivity::None => assert_eq!(a, b, "{name}"),
            Sensitivity::Instant(rows) => assert!((a - b).abs() <= rows * row, "{name}: {a} and {b}"),
            Sensitivity::Value => assert!((a - b).abs() <= 0.1 * a.abs(), "{name}: {a} and {b}"),
            Sensitivity::Shape | Sensitivity::Machine => {}
        }
    }
}

/// How a metric depends on the number of steps between two rows.
#[derive(PartialEq)]
enum Sensitivity {
    /// Not at all: it is counted or accumulated in every step.
    None,
    /// An instant, or a difference of instants: known to so many rows.
    Instant(f64),
    /// Values at the ends of contact, or extremes of a smooth curve.
    Value,
    /// The variation of the recorded curve, or the peaks of a noisy one.
    Shape,
    /// Time of the machine.
    Machine,
}

/// Every metric must be in this table.
fn sensitivity(name: &str) -> Sensitivity {
    let (column, what) = name.split_once(':').map_or(("", name), |(column, what)| (column, what));
    match (column, what) {
        (
            "",
            "contact_episodes"
            | "impulse_x"
            | "impulse_y"
            | "impulse_z"
            | "energy_created"
            | "friction_lost"
            | "slip_distance"
            | "stick_share"
            | "penetration"
            | "penetration_secondary"
            | "steps"
            | "newton_iterations"
            | "rejected_steps"
            | "factorisations"
            | "cost",
        ) => Sensitivity::None,
        ("", "contact_start" | "contact_end" | "turning_time" | "apex_time") => Sensitivity::Instant(1.0),
        ("", "contact_duration") => Sensitivity::Instant(2.0),
        (
            "",
            "peak_force"
            | "peak_mean_force"
            | "chatter"
            | "restitution"
            | "apex"
            | "energy_lost"
            | "energy_drift"
            | "energy_error"
            | "energy_lost_impact"
            | "dissipated_integrator"
            | "plastic_lost"
            | "permanent_set"
            | "dissipated_contact",
        )
        | (_, "peak_mean")
        | ("A.uy" | "B.uy", "min" | "max") => Sensitivity::Value,
        ("", "force_roughness" | "force_high_frequency" | "penetration_mean")
        | (_, "roughness" | "high_frequency")
        | ("C.sigma_yy", "min" | "max") => Sensitivity::Shape,
        ("", "cpu_time" | "wall_time") => Sensitivity::Machine,
        _ => panic!("how does `{name}` depend on the rows?"),
    }
}

/// Trapezoidal rule without dissipation: contact creates energy unless velocities are projected
/// where it begins.
#[test]
fn created_energy_stops_the_run_with_exit_3() {
    let place = place("guard");
    let trapezoidal = ["--set", "time.scheme={kind=\"newmark\",beta=0.25,gamma=0.5}"];
    ended(&mut run(&place, "projected", &trapezoidal), 0);

    // Shorter steps do not help against what contact creates.
    let plain = ["contact.strike.persistency=none", "time.energy_guard=1e-6"];
    let plain = plain.iter().flat_map(|set| ["--set", *set]);
    let plain: Vec<&str> = trapezoidal.into_iter().chain(plain).chain(["--json"]).collect();
    let done = ended(&mut run(&place, "plain", &plain), 3);
    let last: serde_json::Value = serde_json::from_str(text(&done.stdout).lines().last().unwrap()).unwrap();
    assert_eq!((&last["event"], &last["directory"]), (&"stopped".into(), &"plain".into()));
    let output = text(&done.stderr);
    for part in
        ["energy was created", "the last valid state is saved in plain", "persistency=project': velocities"]
    {
        assert!(output.contains(part), "{part:?} not in\n{output}");
    }
    let manifest: serde_json::Value =
        serde_json::from_slice(&files(&place.0.join("plain"))["manifest.json"]).unwrap();
    assert_eq!(manifest["status"], "failed");
    assert!(manifest["reason"].as_str().unwrap().contains("energy was created"));
}

#[test]
fn a_place_that_cannot_be_written_exits_4() {
    let place = place("refused");
    let done = ended(&mut run(&place, "case.toml/below/a/file", &[]), 4);
    assert!(text(&done.stderr).contains("case.toml/below"));
    assert_eq!(files(&place.0).keys().collect::<Vec<_>>(), ["case.toml"]);
}
