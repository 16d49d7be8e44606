//! The shipped cases, defaults and presets, overrides, and messages.

#![allow(clippy::unwrap_used)] // the helpers are tests too

mod contact_messages;
mod corpus;
mod example;
mod excerpt;
mod explained_columns;
mod files;
mod load_table;
mod memory;
mod mesh_file;
mod messages;
mod misspelt;
mod place;
mod polygon;
mod quantities;
mod refine;
mod schema;
mod shapes;
mod surface_file;
mod unit;

use carom_case::*;

const IMPACT: &str = include_str!("../../../../cases/impact/impact.toml");
const REBOUND: &str = include_str!("../../../../cases/impact/rebound.toml");

/// Two bars in a row, with everything that dimension 1 and a second contact can have.
const BARS: &str = r#"
dimension = 1
thickness = 2e-2
preset = "paper"
material = [{ name = "steel", law = "linear-elastic", density = 7850.0, young = 2.1e11, poisson = 0.3 }]
time = { end = 1e-3, step = 1e-5, scheme = { kind = "newmark", rho_inf = 1 }, energy_guard = 0.5 }
output = { at_times = [1e-3] }

[[body]]
name = "left"
material = "steel"
element = "L3"
mesh = { shape = "interval", min = 0, max = 1, cells = 10 }
velocity = [1]

[[body]]
name = "right"
material = "steel"
element = "L2"
mass = "lumped"
mesh = { shape = "interval", min = 1.1, max = 2.1, cells = 10 }

[[support]]
name = "wall"
on = ["right.right"]
fix = ["x"]

[[contact]]
name = "hit"
secondary = "left.right"
primary = "right.left"

[[contact]]
name = "floor"
secondary = "left.left"
primary = { plane = { point = [-1.0], normal = [2] } }
persistency = "project"

[[probe]]
name = "tip"
at = [1.0]
body = "left"
record = ["ux", "sigma_xx"]

[[expect]]
what = "time of max tip.sigma_xx"
at_most = 1e-3

[[expect]]
what = "last wall.reaction_x"
value = 0.0
relative = 0.1

[[expect]]
what = "max floor.force_x"
at_least = 0.0
"#;

fn resolved(text: &str, sets: &[&str]) -> Result<Case, Vec<Diagnostic>> {
    resolved_as("a/case.toml", text, sets)
}

fn resolved_as(name: &str, text: &str, sets: &[&str]) -> Result<Case, Vec<Diagnostic>> {
    let sets: Vec<String> = sets.iter().map(ToString::to_string).collect();
    let wrong = |e: CaseError| match e {
        CaseError::Wrong(found) => found,
        CaseError::Refused { .. } => unreachable!(),
    };
    let document = Document::parse(name, text, &sets).map_err(wrong)?;
    read(&document).map_err(|p| wrong(document.diagnose_all(&p)))
}

/// A case after the way through the text of a manifest.
fn stored(case: &Case) -> Case {
    let text = case.to_json().unwrap().to_string();
    Case::from_json(text.parse().unwrap()).unwrap()
}

#[test]
fn shipped_cases_are_read() {
    for (text, steps) in [(IMPACT, 400), (REBOUND, 454)] {
        let case = resolved(text, &[]).unwrap();
        assert_eq!(case.time.steps(), steps);
        assert!(case.bodies[1].gravity.iter().all(FormulaSpec::is_zero) && case.bodies[1].gravity.len() == 2);
        assert!(case.bodies[0].velocity.iter().all(FormulaSpec::is_zero));
        let strike = &case.contacts[0];
        assert_eq!((strike.persistency, strike.active_set), (Persistency::Project, ActiveSetRule::Within));
        assert_eq!((strike.detection, strike.force), (Detection::ClosestPoint, ForceTime::AlphaF));
        assert_eq!(case.time.energy_guard, Some(0.02));
        assert_eq!(
            case.newton,
            NewtonSpec {
                tolerance: 1e-9,
                max_iterations: 40,
                linear: LinearRule::Auto,
                tangent: TangentRule::Frozen,
                mixing: 4
            }
        );
        assert_eq!(case.units.mass, "kg");
    }
}

#[test]
fn paper_preset_and_explicit_keys() {
    let case = resolved(BARS, &[]).unwrap();
    assert_eq!(case.title, "case");
    let [hit, floor] = &case.contacts[..] else { panic!() };
    assert_eq!((hit.persistency, hit.active_set), (Persistency::None, ActiveSetRule::After));
    assert_eq!(hit.detection, Detection::Trajectory);
    assert_eq!(floor.persistency, Persistency::Project);
    assert_eq!(floor.primary, PrimarySpec::Plane { point: vec![-1.0], normal: vec![2.0] });
    assert_eq!(case.time.energy_guard, Some(0.5));
    assert_eq!(resolved(IMPACT, &["preset=paper"]).unwrap().time.energy_guard, None);
    assert_eq!(resolved(IMPACT, &["time.energy_guard=false"]).unwrap().time.energy_guard, None);
    assert_eq!((case.output.fields_every, case.output.at_times.as_slice()), (Some(0), &[1e-3][..]));
    // λ = Eν/((1+ν)(1−2ν)) = 1.2115e11 and μ = E/(2(1+ν)) = 8.0769e10 for steel.
    let steel = &case.materials[0];
    assert!((steel.lambda / 1.211538461538e11 - 1.0).abs() < 1e-12);
    assert!((steel.mu / 8.076923076923e10 - 1.0).abs() < 1e-12);
    assert_eq!(case.expects[1].bound, Bound::Relative { value: 0.0, relative: 0.1 });
}

#[test]
fn resolved_case_survives_json_bit_for_bit() {
    for text in [IMPACT, REBOUND, BARS] {
        let case = resolved(text, &["time.scheme.forces=average-state"]).unwrap();
        let back = stored(&case);
        assert_eq!(back, case);
        assert_eq!(back.to_json().unwrap(), case.to_json().unwrap());
    }
    let odd = [0.1 + 0.2, 1.0 / 3.0, f64::MIN_POSITIVE, 5e-324, f64::MAX, -0.0, 1.875e-3];
    let mut case = resolved(IMPACT, &[]).unwrap();
    case.output.at_times = odd.to_vec();
    let back = stored(&case);
    assert!(back.output.at_times.iter().zip(odd).all(|(a, b)| a.to_bits() == b.to_bits()));
}

/// √((200 + 2·15)/0.25), and with Λ = 2·200·15/230 in plane stress √((26.087 + 30)/0.25).
#[test]
fn pressure_waves() {
    let material = &resolved(IMPACT, &[]).unwrap().materials[0];
    assert!((material.wave_speed(Plane::Strain) - 30.33150).abs() < 1e-5);
    assert!((material.wave_speed(Plane::Stress) - 14.97825).abs() < 1e-5);
}

#[test]
fn bodies_of_contacts() {
    let of = |sets: &[&str]| {
        resolved(IMPACT, sets).unwrap().contacts[0].bodies().map(str::to_owned).collect::<Vec<_>>()
    };
    assert_eq!(of(&[]), ["cylinder", "prism"]);
    let plane = "contact.strike.primary={ plane = { point = [0.0, 0.0], normal = [0.0, 1.0] } }";
    assert_eq!(of(&[plane]), ["cylinder"]);
}

/// Keys that were added later have the value of records without them.
#[test]
fn records_without_later_keys_are_read() {
    let case = resolved(IMPACT, &[]).unwrap();
    let mut json = case.to_json().unwrap();
    assert!(json["contacts"][0].as_object_mut().unwrap().remove("xi").is_some());
    assert!(json.as_object_mut().unwrap().remove("refine").is_some());
    assert_eq!(Case::from_json(json).unwrap(), case);
}

#[test]
fn overrides_replace_values() {
    let sets = [
        "body.cylinder.element=T6",
        "contact.strike.persistency=\"none\"",
        "material.rubber.density=0.5",
        "time.step = 1e-3",
        "time.scheme={ kind = \"hu\" }",
        "newton.max_iterations=7",
        "body.prism.mesh.cells=[2, 3]",
        "title=two words",
    ];
    let case = resolved(IMPACT, &sets).unwrap();
    assert_eq!(case.bodies[0].element, carom_solid::Element::T6);
    assert_eq!(case.contacts[0].persistency, Persistency::None);
    assert_eq!((case.materials[0].density, case.time.step, case.newton.max_iterations), (0.5, 1e-3, 7));
    assert_eq!((case.time.scheme.kind.as_str(), case.time.scheme.parameters.len()), ("hu", 0));
    assert!(matches!(case.bodies[1].mesh, MeshSpec::Rectangle { cells: [2, 3], .. }));
    assert_eq!(case.title, "two words");
    assert_eq!(
        resolved(IMPACT, &["time.scheme.rho_inf=0.5"]).unwrap().time.scheme.parameters["rho_inf"],
        0.5
    );
}

#[test]
fn rectangle_by_size() {
    let mesh = "body.prism.mesh={ shape = \"rectangle\", min = [0, -0.5], max = [1, 0], size = 0.13 }";
    let case = resolved(IMPACT, &[mesh]).unwrap();
    assert!(matches!(case.bodies[1].mesh, MeshSpec::Rectangle { cells: [8, 4], .. }));
}

#[test]
fn later_problems_are_placed() {
    let document = Document::parse("case.toml", IMPACT, &[]).unwrap();
    let place = |path: &str| {
        let found = document.diagnose(&Problem::new(path, "w", "", ""));
        let span: String = found.quoted.chars().skip(found.column.max(1) - 1).take(found.length).collect();
        (found.line, span)
    };
    assert_eq!(place("probe[1].at[1]").1, "0.0");
    assert_eq!(place("body[0].mesh.size").1, "0.1");
    // An omitted key is reported at its table, or at the header of the table around it.
    assert!(place("body[1].mesh.size").1.starts_with("{ shape = \"rectangle\""));
    assert_eq!(place("contact[0].force").1, "[[contact]]");
    assert_eq!(place("newton.tolerance").0, 0);
}

/// Every member is read under the name that `explain` and cases use, and the example of each key is
/// an admissible value.
#[test]
fn every_member_of_every_kind_is_read() {
    for kind in carom_time::KINDS {
        for member in kind.members {
            let parameters: Vec<_> =
                member.parameters.iter().map(|(key, value)| format!("{key}={value:?}")).collect();
            let spec = read_scheme(kind.name, &parameters).unwrap();
            assert_eq!((&*spec.kind, spec.parameters.len()), (kind.name, member.parameters.len()));
            assert!(
                member.parameters.iter().all(|(key, value)| spec.parameters[*key] == *value),
                "{}",
                kind.name
            );
        }
        for set in kind.sets {
            let examples: Vec<_> = set.iter().map(|p| format!("{}={}", p.key, p.example)).collect();
            read_scheme(kind.name, &examples).unwrap();
        }
    }
}

/// Keys and constructors have the same ranges: both accept or refuse each end as the table states,
/// and both refuse the next number outside.
#[test]
fn ranges_are_those_of_the_constructors() {
    use std::ops::{Bound, RangeBounds};
    for (kind, set) in carom_time::KINDS.iter().flat_map(|kind| kind.sets.iter().map(move |set| (kind, set)))
    {
        for parameter in *set {
            let end = |bound, out: fn(f64) -> f64| match bound {
                Bound::Included(x) | Bound::Excluded(x) => vec![x, out(x)],
                Bound::Unbounded => Vec::new(),
            };
            let low = end(parameter.range.0, f64::next_down);
            for value in low.into_iter().chain(end(parameter.range.1, f64::next_up)) {
                let at = |p: &carom_time::Parameter| {
                    if p.key == parameter.key { value } else { p.example.parse().unwrap() }
                };
                let keys: Vec<_> = set.iter().map(|p| format!("{}={:?}", p.key, at(p))).collect();
                let values = set.iter().map(|p| (p.key.to_owned(), at(p))).collect();
                let built = carom_time::scheme(kind.name, &values, carom_time::ForceRule::AverageForces);
                let takes = parameter.range.contains(&value);
                assert_eq!(read_scheme(kind.name, &keys).is_ok(), takes, "{} {keys:?}", kind.name);
                assert_eq!(built.is_ok(), takes, "{} {keys:?}: {built:?}", kind.name);
            }
        }
    }
}

#[test]
fn schemes_alone() {
    let read = |kind, parameters: &[&str]| {
        let parameters: Vec<_> = parameters.iter().map(ToString::to_string).collect();
        read_scheme(kind, &parameters).map_err(|e| e.to_string())
    };
    let spec = read("hht", &["alpha=0.05", "forces=average-state"]).unwrap();
    assert_eq!((spec.parameters["alpha"], spec.forces), (0.05, carom_time::ForceRule::AverageState));
    assert!(read("hht", &["alpha=-0.05"]).unwrap_err().contains("did you mean `alpha = 0.05`?"));
    assert!(read("chung_hulbert", &["rho_inf=0.5"]).unwrap_err().contains("did you mean `chung-hulbert`?"));
    assert!(read("newmark", &["beta=0.25"]).unwrap_err().contains("`gamma` is missing"));
    assert!(read("hu", &["rho_inf"]).unwrap_err().contains("written KEY=VALUE"));
    // The words are quoted as they were given.
    let marked = |kind, parameters: &[&str]| {
        read(kind, parameters).unwrap_err().lines().skip(1).take(2).collect::<Vec<_>>().join("\n")
    };
    assert_eq!(marked("chung", &["rho_inf=0.5"]), "  chung rho_inf=0.5\n  ^^^^^");
    assert_eq!(marked("hht", &["alpha=-0.05"]), "  hht alpha=-0.05\n            ^^^^^");
    assert_eq!(marked("wbz", &["rho=0.5"]), "  wbz rho=0.5\n      ^^^");
}
