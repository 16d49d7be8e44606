//! Under a limit of address space, what does not fit is refused at its key, before it is allocated,
//! by every command alike.

use std::process::{Command, Output, Stdio};

use crate::common::{IMPACT, Place, text};

/// The address space in kibibytes.
const LIMIT: &str = "400000";

fn limited(place: &Place, arguments: &[&str]) -> Output {
    Command::new("sh")
        .args(["-c", "ulimit -v \"$0\" && exec \"$@\"", LIMIT, env!("CARGO_BIN_EXE_carom")])
        .args(arguments)
        .current_dir(&place.0)
        .stdin(Stdio::null())
        .output()
        .unwrap()
}

#[test]
fn too_large_a_case_is_refused_by_check_and_run() {
    let place = Place::new("limited");
    place.file("impact.toml", IMPACT);
    let mesh = "is too large for the memory";
    let cases: &[(&[&str], &str, &str)] = &[
        (&["body.cylinder.mesh.size=1e-3"], "--set:1:", mesh),
        (&["body.prism.mesh.cells=[3000, 3000]"], "--set:1:", mesh),
        (&["refine=200"], "--set:1:", mesh),
        (&["body.cylinder.mesh.radius=1e308"], "", mesh),
        (&["time.end=1.5e5"], "", "the record is too large for the memory"),
        (&["time.end=1.5e5", "output.history_every=2"], "", "the record is too large for the memory"),
    ];
    for (sets, origin, words) in cases {
        let sets: Vec<&str> = sets.iter().flat_map(|set| ["--set", *set]).collect();
        let done =
            ["check", "run"].map(|command| limited(&place, &[&[command, "impact.toml"], &sets[..]].concat()));
        let said = text(&done[0].stderr);
        assert_eq!(done[0].status.code(), done[1].status.code(), "{said}");
        assert!(matches!(done[0].status.code(), Some(2 | 4)), "{:?}: {said}", done[0].status);
        assert!(said.contains(words) && said.contains(origin), "{sets:?}: {said}");
        assert_eq!(said, text(&done[1].stderr));
    }
    assert_eq!(place.entries(), ["impact.toml"]);
}

#[test]
fn too_large_a_grid_is_refused() {
    let place = Place::new("grid");
    place.file("impact.toml", IMPACT);
    let keys = ["a", "b", "c", "d", "e", "f", "g", "h"];
    let line = |key: &&str| format!("\"{key}.x\" = [1, 2, 3, 4, 5, 6, 7, 8, 9, 10]\n");
    let study = "case = \"impact.toml\"\n[grid]\n".to_owned() + &keys.iter().map(line).collect::<String>();
    place.file("study.toml", study);
    for command in ["check", "study"] {
        let done = limited(&place, &[command, "study.toml"]);
        let said = text(&done.stderr);
        assert_eq!(done.status.code(), Some(4), "{said}");
        assert!(said.contains("1.000e8 arms") && said.contains("study.toml:2:1"), "{said}");
    }
}

/// Runs at once need the sum of the largest.
#[test]
fn runs_at_once_that_do_not_fit_are_refused_with_the_number_that_does() {
    let place = Place::new("jobs");
    place.file("impact.toml", IMPACT);
    let study = "case = \"impact.toml\"\nset = { \"body.prism.mesh.cells\" = [50, 25] }\n[grid]\n\
        \"time.scheme.rho_inf\" = [0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8]\n";
    place.file("study.toml", study);
    let done = limited(&place, &["study", "study.toml", "--jobs", "8", "--out", "out"]);
    let said = text(&done.stderr);
    assert_eq!(done.status.code(), Some(4), "{said}");
    assert!(said.contains("8 runs at once need about") && said.contains("use --jobs"), "{said}");
    assert!(!place.0.join("out").exists());
}

/// The estimate that `check` prints.
#[test]
fn check_prints_the_estimate() {
    let place = Place::new("estimate");
    place.file("impact.toml", IMPACT);
    let said = text(&place.carom(&["check", "impact.toml"]).stdout);
    assert!(said.contains("memory   about") && said.contains("MiB for a run"), "{said}");
}
