//! Rankings and recommendations of studies that are written down by hand.

use super::*;
use crate::metrics::Metric;
use crate::study::StudySource;
use crate::study::design::{Design, Kind, Role};
use crate::{Machine, Status};

/// A run: its method and level, its energy drift (the measure of the goal `energy`, which should be
/// 0), and its processor time.
type Made = (&'static str, usize, f64, f64);

fn arm(&(method, level, ..): &Made) -> Arm {
    Arm {
        name: format!("{method} {level}"),
        directory: String::new(),
        sets: Vec::new(),
        steps: 1,
        role: Role { method: Some(method.into()), level, ..Role::default() },
        case_path: None,
        case: serde_json::json!({ "time": { "step": 1.0 / (1.0 + level as f64) } }),
    }
}

fn row(name: &str, metrics: &[(&'static str, f64)]) -> Row {
    let metric = |&(name, value): &(&'static str, f64)| Metric {
        name: name.into(),
        value: Some(value),
        unit: String::new(),
        definition: "",
    };
    Row {
        name: name.to_owned(),
        status: Some(Status::Finished),
        reason: None,
        metrics: metrics.iter().map(metric).collect(),
        expectations: Vec::new(),
        contact: true,
    }
}

/// A study of these runs with a required accuracy of 0.05.
fn study(runs: &[Made]) -> (StudyManifest, Vec<Row>) {
    let levels = 1 + runs.iter().map(|run| run.1).max().unwrap();
    let steps = (0..levels).map(|level| 1.0 / (1.0 + level as f64)).collect();
    let manifest = StudyManifest {
        status: Status::Finished,
        title: String::new(),
        version: String::new(),
        input_hash: String::new(),
        created: String::new(),
        machine: Machine::current(),
        reference: None,
        design: Some(Design { kind: Kind::MatchedStep, cost_of: runs[0].0.into(), steps }),
        goal: None,
        accuracy: Some(0.05),
        arms: runs.iter().map(arm).collect(),
        ensemble: None,
        members: Vec::new(),
        claims: Vec::new(),
        expects: Vec::new(),
        source: StudySource::default(),
    };
    let rows = runs.iter().map(|run| row(run.0, &[("energy_drift", run.2), ("cpu_time", run.3)]));
    (manifest, rows.collect())
}

fn by_energy((manifest, rows): &(StudyManifest, Vec<Row>)) -> Ranking {
    Ranking::of(Goal::Energy, manifest, rows, &vec![None; rows.len()], None)
}

/// 0.049 and 0.051 share a place, and only the dearer one is accurate enough.
#[test]
fn accuracy_goes_before_cost() {
    let ranking = by_energy(&study(&[("cheap", 0, 0.051, 1.0), ("exact", 0, 0.049, 2.0)]));
    assert_eq!(ranking.levels[0].iter().map(|r| r.place).collect::<Vec<_>>(), [1, 1]);
    let verdict = ranking.verdict.unwrap();
    assert_eq!((verdict.arm, verdict.alike, verdict.confidence), (1, vec!["cheap".into()], Confidence::Low));
}

/// A is first at the coarse level (0.2 against 0.4) and alike at the fine one (0.051 and 0.049); C is
/// worse than A at the coarse level, and accurate at the fine one.
#[test]
fn a_refusal_is_true() {
    let at_two_levels = |fine: [f64; 2]| {
        by_energy(&study(&[
            ("a", 0, 0.2, 1.0),
            ("c", 0, 0.4, 1.0),
            ("a", 1, fine[0], 2.0),
            ("c", 1, fine[1], 2.0),
        ]))
    };
    let refused = |fine: [f64; 2]| at_two_levels(fine).verdict.unwrap_err().join("; ");
    assert_eq!(
        refused([0.051, 0.049]),
        "the method with the best places, a, does not have the required accuracy, 0.05: its smallest error \
         is 0.051; c 1 has an error of 0.049"
    );
    assert_eq!(
        refused([0.08, 0.0795]),
        "no arm has the required accuracy, 0.05; the best one, c 1, has an error of 0.0795"
    );
    // Each is first at one level; the one that is first at the fine level is named.
    let verdict = at_two_levels([0.04, 0.01]).verdict.unwrap();
    assert_eq!((verdict.arm, verdict.alike), (3, vec!["a".into()]));
}
