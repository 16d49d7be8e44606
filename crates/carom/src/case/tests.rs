//! The shipped cases, and messages word by word.

use super::{Case, CaseError, Diagnostic, Document, Persistency, Preset, read};

const IMPACT: &str = include_str!("../../../../cases/impact/impact.toml");
const REBOUND: &str = include_str!("../../../../cases/impact/rebound.toml");

fn resolved(text: &str, sets: &[&str]) -> Result<Case, Vec<Diagnostic>> {
    let sets: Vec<String> = sets.iter().map(ToString::to_string).collect();
    let wrong = |e: CaseError| match e {
        CaseError::Wrong(found) => found,
        CaseError::Refused { .. } => unreachable!(),
    };
    let document = Document::parse("impact.toml", text, &sets).map_err(wrong)?;
    read(&document).map_err(|p| wrong(document.diagnose_all(&p)))
}

fn shown(text: &str, sets: &[&str]) -> String {
    let found = resolved(text, sets).expect_err("the case is wrong");
    found.iter().map(ToString::to_string).collect::<Vec<_>>().join("\n\n")
}

#[test]
fn shipped_cases_are_read() {
    for (text, steps) in [(IMPACT, 400.0), (REBOUND, 454.0)] {
        let case = resolved(text, &[]).unwrap_or_else(|e| panic!("{e:#?}"));
        assert!((case.time.end / case.time.step - steps).abs() < 1e-9);
        assert_eq!(case.contacts[0].persistency, Persistency::Project);
        assert_eq!(case.bodies[1].gravity, [0.0, 0.0]);
    }
}

#[test]
fn misspelt_key() {
    let text = IMPACT.replace("density", "densty");
    println!("{}", shown(&text, &[]));
    println!("{}", shown(IMPACT, &["time.scheme.rho_inf=1.2", "body.cylindr.element=T6"]));
    println!("{}", shown(IMPACT, &["time.scheme.rho_inf=1.2", "time.step=nan", "body.cylinder.element=[1"]));
    println!(
        "{}",
        shown(
            IMPACT,
            &["time.scheme.rho_inf=1.2", "time.step=nan", "body.cylinder.element=\"T7\"", "material.rubber.density=-2"]
        )
    );
    println!("{}", shown(&IMPACT.replace("[[body]]", "[[bodyx]]"), &[]));
    println!("{:?}", resolved(IMPACT, &["preset=paper"]).unwrap().preset == Preset::Paper);
}
