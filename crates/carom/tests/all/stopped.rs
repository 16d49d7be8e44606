//! Runs that stop: why, where, what to try, and a smaller case that stops too.

use carom_record::{Manifest, Stop};

use crate::common::{Place, text};

/// A press that moves through a block: a cell is inverted, whatever the step. A ball beside it
/// matters to nothing.
const CRUSHED: &str = r#"
title = "Crushed"
dimension = 2
[[material]]
name = "rubber"
law = "neo-hookean"
density = 1.0
young = 100.0
poisson = 0.3
[[body]]
name = "block"
material = "rubber"
element = "T3"
mesh = { shape = "rectangle", min = [0.0, 0.0], max = [1.0, 1.0], cells = [2, 2] }
[[body]]
name = "ball"
material = "rubber"
element = "T6"
mesh = { shape = "disc", radius = 0.4, center = [3.0, 1.0], size = 0.2 }
velocity = [0.0, -1.0]
[[support]]
on = ["block.bottom"]
fix = ["x", "y"]
[[support]]
on = ["block.top"]
fix = ["x"]
move = { y = "-t*t" }
[[contact]]
name = "floor"
secondary = "ball.arc"
primary = { plane = { point = [0.0, 0.5], normal = [0.0, 1.0] } }
[time]
end = 2.0
step = 0.02
scheme = { kind = "bathe", rho_inf = 0.0 }
energy_guard = false
[output]
checkpoint_every = 20
"#;

/// A bar whose scheme creates energy: γ < 1/2.
const GROWS: &str = r#"
title = "Grows"
dimension = 1
material = [{ name = "steel", law = "linear-elastic", density = 1, young = 100, poisson = 0 }]
[[body]]
name = "bar"
material = "steel"
element = "L2"
mesh = { shape = "interval", min = 0, max = 1, cells = 4 }
velocity = ["X - 0.5"]
[time]
end = 2.0
step = 0.02
scheme = { kind = "newmark", beta = 0.25, gamma = 0.45 }
"#;

/// A strip that starts folded, far from any equilibrium.
const FOLDED: &str = r#"
title = "Folded"
dimension = 2
material = [{ name = "steel", law = "saint-venant-kirchhoff", density = 1, young = 10000, poisson = 0.3 }]
[[body]]
name = "strip"
material = "steel"
element = "Q9"
mesh = { shape = "rectangle", min = [0.0, -0.01], max = [2.2, 0.01], cells = [33, 1] }
position = [
    "if(X < pi/4, -0.5 + (0.5 - Y)*cos(2*X), -0.5 - (X - pi/4))",
    "if(X < pi/4, (0.5 - Y)*sin(2*X), 0.5 - Y)",
]
[[support]]
on = ["strip.left"]
fix = ["x", "y"]
[[contact]]
name = "plate"
secondary = "strip.bottom"
primary = { plane = { point = [0.0, 0.51], normal = [0.0, -1.0] } }
[time]
end = 1.0
step = 0.01
scheme = { kind = "static" }
"#;

fn stop(place: &Place, run: &str) -> Stop {
    let directory = place.0.join(run);
    Stop::read(&directory, &Manifest::read(&directory).unwrap()).unwrap().unwrap()
}

#[test]
fn a_stop_is_explained_and_reduced() {
    let place = Place::new("crushed");
    place.file("case.toml", CRUSHED);
    let done = place.carom(&["run", "case.toml", "--out", "run"]);
    assert_eq!(done.status.code(), Some(3));
    let said = text(&done.stderr);
    assert!(said.contains("run/report.html") && said.contains("carom reduce run"), "{said}");
    let first = stop(&place, "run");
    let at = first.place.clone().unwrap();
    assert_eq!((first.kind.as_str(), at.body.as_deref()), ("inverted-cell", Some("block")));
    assert_eq!(at.cell_nodes.len(), 3);
    // No step gets a block past zero height at t = 1.
    assert!(first.time < 1.01 && first.last <= first.time && !first.iterations.is_empty());
    assert!(first.advice.iter().any(|advice| !advice.sets.is_empty()));
    let page = std::fs::read_to_string(place.0.join("run/report.html")).unwrap();
    let section = page.find("Why it stopped").unwrap();
    assert!(section < page.find("Input hash").unwrap() && page.contains("figures/stopped.svg"));

    let reduced = place.carom(&["reduce", "run"]);
    assert_eq!(reduced.status.code(), Some(0), "{}", text(&reduced.stderr));
    assert!(text(&reduced.stdout).contains("body \"ball\""), "{}", text(&reduced.stdout));
    let case = std::fs::read_to_string(place.0.join("run-reduced/case.toml")).unwrap();
    assert!(!case.contains("ball.arc"), "{case}");
    let again = place.carom(&["run", "run-reduced/case.toml", "--out", "again"]);
    assert_eq!(again.status.code(), Some(3));
    let second = stop(&place, "again");
    assert_eq!((second.step, &second.place), (first.step, &first.place));

    // The state has its clock.
    for (set, key) in [("time.step=0.01", "step 40 is at 0.4"), ("time.end=0.5", "ends before the state")] {
        let other = place.carom(&["run", "run-reduced/case.toml", "--out", "other", "--set", set]);
        let said = text(&other.stderr);
        assert!(other.status.code() == Some(2) && said.contains(key), "{said}");
    }

    // Resumed, it stops again, and says the same.
    assert_eq!(place.carom(&["resume", "run"]).status.code(), Some(3));
    assert_eq!(stop(&place, "run"), first);
    place.file("run/stopped.json", "{}");
    let damaged = place.carom(&["report", "run"]);
    assert_eq!(damaged.status.code(), Some(2));
    assert!(text(&damaged.stderr).contains("changed"), "{}", text(&damaged.stderr));
}

/// A scheme that creates energy is stopped, and the advice has one that does not.
#[test]
fn the_advice_after_created_energy_has_a_scheme_that_damps() {
    let place = Place::new("grows");
    place.file("case.toml", GROWS);
    assert_eq!(place.carom(&["run", "case.toml", "--out", "run"]).status.code(), Some(3));
    let stop = stop(&place, "run");
    assert_eq!((stop.kind.as_str(), stop.place), ("energy-guard", None));
    let bathe = stop.advice.iter().find(|a| a.sets.iter().any(|set| set.contains("bathe"))).unwrap();
    let run = ["run", "case.toml", "--out", "damped", "--set", &bathe.sets[0]];
    assert_eq!(place.carom(&run).status.code(), Some(0));
}

/// Load steps that find no equilibrium from a strained start: with inertia there is a motion.
#[test]
fn load_steps_from_a_strained_start_are_told_of_inertia() {
    let place = Place::new("folded");
    place.file("case.toml", FOLDED);
    let done = place.carom(&["run", "case.toml", "--out", "run"]);
    assert_eq!(done.status.code(), Some(3));
    let said = text(&done.stderr);
    let option = "time.scheme={ kind = \"backward-euler\" }";
    assert!(said.contains(&format!("--set '{option}': a scheme with inertia")), "{said}");
    let first = stop(&place, "run").advice.swap_remove(0);
    assert!(first.what.contains("a scheme with inertia") && first.sets == [option], "{first:?}");
    let on = place.carom(&["run", "case.toml", "--out", "on", "--set", option, "--set", "time.end=0.05"]);
    assert_eq!(on.status.code(), Some(0), "{}", text(&on.stderr));
}

/// A contact of `between` has no keys of its own, and the skin of a body has all its nodes.
#[test]
fn a_stop_among_contacts_between_bodies() {
    let place = Place::new("between");
    place.file("all.toml", include_str!("../../../../cases/self/all.toml"));
    // Coarse, so that it stops where contact begins.
    let keys = ["newton.max_iterations=3", "time.step=5e-3", "body.ring.mesh.size=0.25"];
    let sets: Vec<&str> = keys.iter().flat_map(|set| ["--set", *set]).collect();
    let run = [&["run", "all.toml", "--out", "run"][..], &sets].concat();
    assert_eq!(place.carom(&run).status.code(), Some(3));
    let stop = stop(&place, "run");
    assert!(stop.place.unwrap().contact.unwrap().starts_with("all-"));
    let optional: Vec<_> = stop.advice.iter().filter(|advice| !advice.sets.is_empty()).collect();
    assert!(optional.iter().any(|advice| advice.sets[0] == "contact.all.enforcement=penalty"));
    for advice in optional {
        let mut check = [&["check", "all.toml"][..], &sets].concat();
        advice.sets.iter().for_each(|set| check.extend(["--set", set]));
        let checked = place.carom(&check);
        assert_eq!(checked.status.code(), Some(0), "{advice:?}: {}", text(&checked.stderr));
    }
    let reduced = place.carom(&["reduce", "run"]);
    assert_eq!(reduced.status.code(), Some(0), "{}", text(&reduced.stderr));
    assert!(std::fs::read_to_string(place.0.join("run-reduced/case.toml")).unwrap().contains("between"));
}

/// A key that is given contradicts what a remedy would set: it has no option then.
#[test]
fn options_fit_the_keys_that_are_given() {
    let place = Place::new("given");
    place.file("all.toml", include_str!("../../../../cases/self/all.toml"));
    let sets = ["newton.max_iterations=1", "contact.all.enforcement=penalty", "contact.all.stiffness=1.0"];
    let given: Vec<&str> = sets.iter().flat_map(|set| ["--set", *set]).collect();
    let run = [&["run", "all.toml", "--out", "run"][..], &given].concat();
    assert_eq!(place.carom(&run).status.code(), Some(3));
    let stop = stop(&place, "run");
    let multipliers = stop.advice.iter().find(|advice| advice.what.starts_with("multipliers")).unwrap();
    assert!(multipliers.sets.is_empty() && stop.advice.len() > 3, "{multipliers:?}");
    for advice in stop.advice {
        let more: Vec<&str> = advice.sets.iter().flat_map(|set| ["--set", set]).collect();
        let checked = place.carom(&[&["check", "all.toml"], &given[..], &more].concat());
        assert_eq!(checked.status.code(), Some(0), "{advice:?}: {}", text(&checked.stderr));
    }
}

#[test]
fn a_run_that_did_not_stop_is_not_reduced() {
    let place = Place::new("finished");
    place.file("case.toml", GROWS);
    let arguments = ["run", "case.toml", "--out", "run", "--set", "time.energy_guard=false"];
    assert_eq!(place.carom(&arguments).status.code(), Some(0));
    let done = place.carom(&["reduce", "run"]);
    assert_eq!(done.status.code(), Some(2));
    assert!(text(&done.stderr).contains("exit code 3") && !place.0.join("run-reduced").exists());
}

#[test]
fn an_overlap_is_listed_and_drawn() {
    let place = Place::new("overlap");
    place.file("fit.toml", include_str!("../../../../cases/overlap/strips.toml"));
    let done = place.carom(&["check", "fit.toml"]);
    let said = text(&done.stdout);
    assert_eq!(done.status.code(), Some(0), "{}", text(&done.stderr));
    // All are as deep: last digits decide which of the side y = 1 are listed.
    let of_lower: Vec<&str> = said.lines().filter(|line| line.contains(" of lower at [")).collect();
    let is_on_side = |line: &&str| line.ends_with(", 1] penetrates by 0.01");
    assert!(!of_lower.is_empty() && of_lower.iter().all(is_on_side), "{said}");
    assert!(said.contains("fit-overlap.svg"), "{said}");
    assert!(std::fs::read_to_string(place.0.join("fit-overlap.svg")).unwrap().contains("16 nodes inside"));
    let refused = place.carom(&["check", "fit.toml", "--set", "contact.fit.overlap=refuse"]);
    assert_eq!(refused.status.code(), Some(2));
    assert!(
        text(&refused.stderr).contains("keep-gap") && text(&refused.stdout).contains("penetrates by 0.01")
    );
}
