//! Groups of arms that differ only in one key, and their observed orders of convergence.

use carom_record::study::orders::has_words;
use carom_record::study::{Arm, step};

fn arm(sets: &[&str]) -> Arm {
    Arm {
        name: sets.join(", "),
        sets: sets.iter().map(ToString::to_string).collect(),
        case: serde_json::json!({ "time": { "step": 0.5 } }),
        ..Arm::default()
    }
}

#[test]
fn words_are_whole() {
    let name = "time.scheme=chung-hulbert 0.15, time.step=1e-3";
    assert!(has_words(name, "chung-hulbert") && has_words(name, "scheme=") && has_words(name, "0.15, time"));
    assert!(!has_words(name, "hu") && !has_words(name, "0.1") && !has_words(name, "e-3"));
    assert!(has_words("time.scheme=hu, time.step=1", "hu") && has_words(name, ""));
}

#[test]
fn steps_come_from_sets_or_the_case() {
    assert_eq!(step(&arm(&["time.step=2e-3"]), "time.step"), Some(2e-3));
    assert_eq!(step(&arm(&[]), "time.step"), Some(0.5));
    assert_eq!(step(&arm(&["body.a.mesh.cells=[8, 4]"]), "body.a.mesh.cells"), Some(0.125));
    assert_eq!(step(&arm(&["time.stepper=3"]), "time.end"), None);
    assert_eq!(step(&arm(&["time.scheme={ kind = \"hu\" }"]), "time.scheme"), None);
}
