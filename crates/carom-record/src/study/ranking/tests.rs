//! Rankings and recommendations of studies that are written down by hand.

use super::*;
use crate::metrics::Metric;
use crate::study::StudySource;
use crate::study::compared::Deviated;
use crate::study::design::{Design, Kind, MemberOf, Role};
use crate::study::ensemble::{Ensemble, Member};
use crate::study::reference::{Level, Trajectory};
use crate::{Machine, Status};

/// A run: its method and level, its energy drift (the measure of the goal `energy`, which should be
/// 0), and its processor time.
type Made = (&'static str, usize, f64, f64);

fn arm(&(method, level, ..): &Made) -> Arm {
    Arm {
        name: format!("{method} {level}"),
        role: Role { method: Some(method.into()), level, ..Role::default() },
        case: serde_json::json!({ "time": { "step": 1.0 / (1.0 + level as f64) } }),
        ..Arm::default()
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
        warnings: Vec::new(),
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
        overlays: Vec::new(),
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

/// Ranks a study by cost. The errors are its energy drifts, taken as deviations of a displacement
/// from a reference of three identical runs.
fn by_cost((manifest, rows): &(StudyManifest, Vec<Row>)) -> Ranking {
    let column = || ("A.uy".to_owned(), vec![0.0, 1.0]);
    let run = || Trajectory { times: vec![0.0, 1.0], columns: [column()].into(), metrics: Vec::new() };
    let levels = [4.0, 2.0, 1.0].map(|step| Level::single(step, run()));
    let reference = Reference::of_levels(String::new(), levels.into());
    let compared = |row: &Row| {
        let off = row.value("energy_drift");
        let column = Deviated { column: "A.uy".into(), whole: off, before: None, after: None };
        Some(Compared { columns: vec![column], late: None })
    };
    let compared: Vec<_> = rows.iter().map(compared).collect();
    Ranking::of(Goal::Cost, manifest, rows, &compared, Some(&reference))
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

/// A is first at the coarse level (0.2 against 0.4) and alike at the fine one (0.051 and 0.049); C
/// is worse than A at the coarse level, and accurate at the fine one.
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

/// With every arm, members of an ensemble with these errors and processor times.
fn with_members(study: (StudyManifest, Vec<Row>), members: &[&[(f64, f64)]]) -> (StudyManifest, Vec<Row>) {
    let (mut manifest, mut rows) = study;
    let phases = 1 + members.iter().map(|of| of.len()).max().unwrap() as u32;
    manifest.ensemble = Some(Ensemble { phases, swapped: false, mesh: vec![1.0], sets: Vec::new() });
    for (i, members) in members.iter().enumerate() {
        for (k, (error, cost)) in members.iter().enumerate() {
            let phase = (1.0 + k as f64) / f64::from(phases);
            let member = MemberOf { arm: i, member: Member { phase, swapped: false, mesh: 1.0, set: 0 } };
            let arm = manifest.arms[i].clone();
            manifest.members.push(Arm { role: Role { member: Some(member), ..arm.role.clone() }, ..arm });
            rows.push(row("member", &[("energy_drift", *error), ("cpu_time", *cost)]));
        }
    }
    (manifest, rows)
}

/// A is accurate in the median, 0.04, but not in one of its members; B costs 8 % more, which is not
/// distinguished, and C 15 % more than A. What the members cost is of no interest.
#[test]
fn cost_is_that_of_the_arm_and_accuracy_that_of_the_median() {
    let arms = [("a", 0, 0.04, 1.0), ("b", 0, 0.03, 1.08), ("c", 0, 0.01, 1.15), ("d", 0, 0.06, 0.1)];
    let members: [&[(f64, f64)]; 4] =
        [&[(0.02, 5.0), (0.07, 7.0)], &[(0.03, 1.0), (0.03, 1.0)], &[(0.01, 1.0); 2], &[(0.06, 0.1); 2]];
    let ranking = by_cost(&with_members(study(&arms), &members));
    let found: Vec<_> = ranking.levels[0].iter().map(|r| (r.arm, r.place, r.error)).collect();
    assert_eq!(found, [(0, 1, 0.04), (1, 1, 0.03), (2, 2, 0.01)]);
    assert!((ranking.levels[0][0].uncertainty - 0.03).abs() < 1e-15);
    // Of the two that cost the same, the more accurate one is recommended.
    let verdict = ranking.verdict.unwrap();
    assert_eq!((verdict.arm, verdict.alike), (1, vec!["a".into()]));
    assert!(verdict.reasons[0].ends_with("is at most 0.05: 1.08 s"), "{:?}", verdict.reasons);
}

/// The median of A is accurate, but one of its members is off by 0.09, more than the accuracy of
/// 0.05: it is not recommended, and B is not distinguished from it.
#[test]
fn an_arm_that_scatters_by_more_than_the_accuracy_does_not_have_it() {
    let of = |arms: &[Made], members: &[&[(f64, f64)]]| by_energy(&with_members(study(arms), members));
    let a = ("a", 0, 0.01, 1.0);
    let b = ("b", 0, 0.03, 2.0);
    let scatters: &[_] = &[(0.01, 1.0), (0.1, 1.0)];
    let agrees: &[_] = &[(0.03, 2.0); 2];
    assert_eq!(of(&[a, b], &[scatters, agrees]).verdict.unwrap().arm, 1);
    let why = of(&[a], &[scatters]).verdict.unwrap_err();
    assert!(
        why[0].contains("one of which is off it by 0.09, more than the required accuracy, 0.05"),
        "{why:?}"
    );
    let (manifest, rows) = with_members(study(&[a, b]), &[scatters, agrees]);
    let ranking = by_cost(&(manifest, rows));
    assert_eq!(ranking.levels[0].iter().map(|r| r.arm).collect::<Vec<_>>(), [1]);
}

/// Only members with a value count as evidence: all three, two of three, or one.
#[test]
fn failed_members_are_no_evidence() {
    let arms =
        || study(&[("a", 0, 0.01, 1.0), ("b", 0, 0.04, 1.0), ("a", 1, 0.005, 2.0), ("b", 1, 0.02, 2.0)]);
    let of = |failed: usize| {
        let others: [&[(f64, f64)]; 4] =
            [&[(0.01, 1.0); 2], &[(0.04, 1.0); 2], &[(0.005, 2.0); 2], &[(0.02, 2.0); 2]];
        let (manifest, mut rows) = with_members(arms(), &others);
        rows[4..4 + failed].iter_mut().for_each(|row| row.metrics.clear());
        let ranking = by_energy(&(manifest, rows));
        let verdict = ranking.verdict.unwrap();
        assert_eq!((verdict.arm, ranking.levels[0][0].members), (0, 3 - failed));
        (verdict.confidence, verdict.confidence_reasons.join("; "))
    };
    let mesh = "all arms were computed on the given mesh";
    let (confidence, why) = of(0);
    assert_eq!(
        (confidence, why.contains("members of"), why.contains(mesh)),
        (Confidence::Medium, false, true)
    );
    let (confidence, why) = of(1);
    assert!(
        confidence == Confidence::Medium && why.contains("only 2 of 3 members of \"a 0\" have a value"),
        "{why}"
    );
    let (confidence, why) = of(2);
    assert!(confidence == Confidence::Low && why.contains("the value of a single run"), "{why}");
}

/// Two of three members created energy. The scatter of an arm with one sound member is not zero,
/// but that of all: 0.03 from 0.01.
#[test]
fn one_sound_member_has_the_scatter_of_all() {
    let members: [&[(f64, f64)]; 2] = [&[(0.02, 1.0), (0.04, 1.0)], &[(0.03, 1.0); 2]];
    let (manifest, mut rows) = with_members(study(&[("a", 0, 0.01, 1.0), ("b", 0, 0.03, 1.0)]), &members);
    for row in &mut rows[2..4] {
        let created = Metric { name: "energy_created".into(), value: Some(0.5), ..row.metrics[0].clone() };
        row.metrics.push(created);
    }
    let ranking = by_energy(&(manifest, rows));
    let found: Vec<_> = ranking.levels[0].iter().map(|r| (r.arm, r.place, r.members)).collect();
    assert_eq!(found, [(0, 1, 1), (1, 1, 3)]);
    let of_a = &ranking.levels[0][0];
    assert!((of_a.error - 0.01).abs() < 1e-15 && (of_a.uncertainty - 0.03).abs() < 1e-15);
}

/// Both arms are accurate at the fine level only, where B is cheaper; A is cheaper at the coarse
/// one.
#[test]
fn least_cost_is_looked_for_over_all_levels() {
    let runs = [("a", 0, 0.2, 0.5), ("b", 0, 0.2, 1.0), ("a", 1, 0.01, 3.0), ("b", 1, 0.0101, 2.0)];
    let verdict = by_cost(&study(&runs)).verdict.unwrap();
    assert!(verdict.arm == 3 && verdict.alike.is_empty(), "{verdict:?}");
    // A is accurate at both: its coarse arm is the cheapest, though B ranks first at the fine
    // level.
    let runs = [("a", 0, 0.04, 1.5), ("b", 0, 0.2, 1.0), ("a", 1, 0.01, 3.0), ("b", 1, 0.0101, 2.0)];
    assert_eq!(by_cost(&study(&runs)).verdict.unwrap().arm, 0);
    let none = by_cost(&study(&[("a", 0, 0.2, 1.0)])).verdict.unwrap_err();
    assert_eq!(none, ["no arm has the required accuracy, 0.05"]);
}

/// B has all results of A: it takes no place from C, and is no competitor of A. With another
/// result it is both.
#[test]
fn identical_arms_count_once() {
    let found = |b: f64| {
        let runs = [("a", 0, 0.01, 1.0), ("b", 0, b, 1.0), ("c", 0, 0.04, 1.0)];
        let ranking = by_energy(&study(&runs));
        let places: Vec<_> = ranking.levels[0].iter().map(|r| (r.arm, r.place)).collect();
        (places, ranking.verdict.unwrap().alike)
    };
    assert_eq!(found(0.01), (vec![(0, 1), (1, 1), (2, 2)], vec![]));
    assert_eq!(found(0.0101), (vec![(0, 1), (1, 1), (2, 3)], vec!["b".to_owned()]));
}

/// Three arms, of which the one with the smallest drift created 3 % of energy; the guard allows 2
/// %.
#[test]
fn an_arm_that_creates_energy_is_last_and_not_recommended() {
    let (manifest, mut rows) = study(&[("a", 0, 0.01, 1.0), ("b", 0, 0.03, 1.0), ("c", 0, 0.04, 1.0)]);
    let created = |row: &mut Row, share: f64| {
        row.metrics.push(Metric {
            name: "energy_created".into(),
            value: Some(share),
            ..row.metrics[0].clone()
        });
    };
    created(&mut rows[0], 0.03);
    created(&mut rows[1], 0.019);
    let ranking = by_energy(&(manifest.clone(), rows.clone()));
    let found: Vec<_> = ranking.levels[0].iter().map(|r| (r.arm, r.place, r.sound)).collect();
    assert_eq!(found, [(1, 1, true), (2, 2, true), (0, 3, false)]);
    assert_eq!(ranking.verdict.unwrap().arm, 1);
    rows[1..].iter_mut().for_each(|row| created(row, 0.5));
    rows[1].metrics.remove(2);
    let why = by_energy(&(manifest, rows)).verdict.unwrap_err();
    assert_eq!(why, ["no arm that did not create energy has a value for: energy_drift, which should be 0"]);
}

/// A has the error 0.4/cost. At the coarse step B has 0.3 at the cost 2, where A has 0.2: half
/// more, which is a change unless the uncertainties are as large. At the fine step A does not reach
/// the cost of B.
#[test]
fn conclusions_change_by_more_than_the_uncertainties() {
    let runs = [("a", 0, 0.4, 1.0), ("b", 0, 0.3, 2.0), ("a", 1, 0.1, 4.0), ("b", 1, 0.03, 8.0)];
    let (manifest, rows) = study(&runs);
    let of = |own: f64, reference: f64| {
        let ranked = |(arm, place)| Ranked {
            arm,
            error: runs[arm].2,
            uncertainty: own,
            members: 3,
            sound: true,
            place,
        };
        let levels = [vec![ranked((1, 1)), ranked((0, 2))], vec![ranked((3, 1)), ranked((2, 2))]];
        crosscheck::of(&manifest, &rows, &levels, reference)
    };
    let found = of(0.0, 0.0);
    assert_eq!(found.len(), 1);
    assert_eq!((found[0].at, found[0].value, found[0].first.as_str()), ("cost", 2.0, "b"));
    assert_eq!((found[0].errors[0].0.as_str(), found[0].better.as_deref()), ("a", Some("a")));
    assert!((found[0].errors[0].1 - 0.2).abs() < 1e-15);
    assert_eq!(of(0.04, 0.09)[0].better.as_deref(), Some("a"));
    assert_eq!((&of(0.06, 0.0)[0].better, &of(0.0, 0.11)[0].better), (&None, &None));
}

/// Where two arms share the first place, table and check begin with the same one, the cheaper.
#[test]
fn the_check_begins_with_the_first_arm_of_the_table() {
    let runs = [("a", 0, 0.100, 2.0), ("b", 0, 0.102, 1.0), ("a", 1, 0.050, 4.0), ("b", 1, 0.051, 3.0)];
    let ranking = by_energy(&study(&runs));
    assert_eq!((ranking.levels[1][0].arm, ranking.levels[1][1].place), (3, 1));
    let [check] = &ranking.crosschecks[..] else { panic!("{:?}", ranking.crosschecks) };
    assert_eq!((check.level, check.first.as_str(), check.value, &check.better), (1, "b", 3.0, &None));
}

/// A is first at the coarse level and shares the first place at the fine one, where B has the
/// smaller error: it is recommended, but not with high confidence.
#[test]
fn a_shared_place_is_not_ranked_first() {
    let runs = [("a", 0, 0.010, 1.0), ("b", 0, 0.020, 1.0), ("a", 1, 0.0050, 2.0), ("b", 1, 0.0049, 2.0)];
    let members: [&[(f64, f64)]; 4] =
        [&[(0.010, 1.0); 2], &[(0.020, 1.0); 2], &[(0.0050, 2.0); 2], &[(0.0049, 2.0); 2]];
    let (mut manifest, rows) = with_members(study(&runs), &members);
    manifest.ensemble.as_mut().unwrap().mesh = vec![1.0, 2.0];
    let verdict = by_energy(&(manifest, rows)).verdict.unwrap();
    assert_eq!((verdict.arm, verdict.confidence), (0, Confidence::Medium));
    let why = verdict.confidence_reasons.join("; ");
    assert!(why.contains("at 1 of 2 levels b is not distinguished from it"), "{why}");
}

/// B is better at the coarse level, where A is recommended, because B created energy at the fine
/// one.
#[test]
fn why_the_smaller_error_does_not_win_is_said() {
    let runs = [("a", 0, 0.020, 1.0), ("b", 0, 0.010, 1.0), ("a", 1, 0.008, 2.0), ("b", 1, 0.005, 2.0)];
    let (manifest, mut rows) = study(&runs);
    let created = Metric { name: "energy_created".into(), value: Some(0.5), ..rows[3].metrics[0].clone() };
    rows[3].metrics.push(created);
    let verdict = by_energy(&(manifest, rows)).verdict.unwrap();
    assert_eq!(verdict.arm, 0);
    let why = verdict.reasons.join("; ");
    assert!(why.contains("b has a smaller error at this level, 0.01, but b 1 created energy"), "{why}");
}

/// Costs that were matched by counting are equal, whatever the processor times: nothing decides.
#[test]
fn measured_times_do_not_decide_between_matched_costs() {
    let (mut manifest, rows) = study(&[("a", 0, 0.0100, 2.0), ("b", 0, 0.0101, 1.0)]);
    assert_eq!(by_energy(&(manifest.clone(), rows.clone())).verdict.unwrap().arm, 1);
    manifest.design.as_mut().unwrap().kind = Kind::MatchedCost;
    let verdict = by_energy(&(manifest, rows)).verdict.unwrap();
    assert_eq!((verdict.arm, verdict.alike, verdict.confidence), (0, vec!["b".into()], Confidence::Low));
    assert!(!verdict.reasons.iter().any(|why| why.contains("processor time")), "{:?}", verdict.reasons);
}
