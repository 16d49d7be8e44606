//! Rankings and recommendations of studies that are written down by hand.

use carom_record::metrics::{Distance, Metric};
use carom_record::study::compared::{Compared, Deviation};
use carom_record::study::design::{Design, Goal, Kind as Matched, MemberOf, Role};
use carom_record::study::ensemble::{Ensemble, Member};
use carom_record::study::measure::Errors;
use carom_record::study::ranking::{Ranking, Ranks};
use carom_record::study::reference::{Known, Level, Reference, Trajectory};
use carom_record::study::verdict::Confidence;
use carom_record::study::{Arm, Row, StudyManifest, StudySource};
use carom_record::{Machine, Status, Warning};

/// A run: its method and level, its energy error (the measure of the goal `energy`, which should be
/// 0), and its counted cost.
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
        design: Some(Design { kind: Matched::MatchedStep, cost_of: runs[0].0.into(), steps }),
        goal: None,
        accuracy: Some(0.05),
        window: None,
        overlays: Vec::new(),
        arms: runs.iter().map(arm).collect(),
        ensemble: None,
        members: Vec::new(),
        claims: Vec::new(),
        expects: Vec::new(),
        source: StudySource::default(),
    };
    let rows = runs.iter().map(|run| row(run.0, &[("energy_error", run.2), ("cost", run.3)]));
    (manifest, rows.collect())
}

fn by_energy((manifest, rows): &(StudyManifest, Vec<Row>)) -> Ranking {
    Ranks { manifest, rows, compared: &vec![None; rows.len()], reference: None }.of(Goal::Energy)
}

/// Ranks by a goal of columns, with the errors of each run as a vector.
fn by_vectors(
    goal: Goal,
    (manifest, rows): &(StudyManifest, Vec<Row>),
    reference: &Reference,
    vector: impl Fn(usize) -> Vec<f64>,
) -> Ranking {
    let compared = |run: usize| {
        let errors = vector(run);
        let smooth = errors.iter().map(|x| x * x).sum::<f64>().sqrt();
        let deviation = Deviation { distance: Distance { smooth, rough: 0.0 }, errors };
        let each = |known: &Known| Some(vec![deviation.clone(); known.windows.len()]);
        Some(Compared { groups: reference.known.iter().map(each).collect(), ..Compared::default() })
    };
    let compared: Vec<_> = (0..rows.len()).map(compared).collect();
    Ranks { manifest, rows, compared: &compared, reference: Some(reference) }.of(goal)
}

/// Ranks by a goal of columns, with errors given for each run. Successive arms err in opposite
/// directions, so that they are distinguished if their intervals have no point in common.
fn by_columns(goal: Goal, study: &(StudyManifest, Vec<Row>), reference: &Reference) -> Ranking {
    by_vectors(goal, study, reference, |run| {
        let off = study.1[run].value("energy_error").unwrap_or_default();
        vec![if run % 2 == 0 { off } else { -off }]
    })
}

/// A reference whose displacements of 1 are known up to 1.25 `off`.
fn reference(off: f64) -> Reference {
    let run = |off: f64| {
        let columns = [("A.uy".to_owned(), vec![0.0, off, 1.0])].into();
        let metrics = row("", &[("penetration_secondary", 0.0)]).metrics;
        Trajectory { times: vec![0.0, 0.5, 1.0], columns, metrics, ..Trajectory::default() }
    };
    // Triangles of the height h have the norm h/√3; errors of 4, 2 and 1 converge with order 1,
    // which counts as 2/3.
    let height = off * 3.0_f64.sqrt() * (2.0_f64.powf(2.0 / 3.0) - 1.0);
    let levels = [4.0, 2.0, 1.0].map(|step| Level::single(step, run(step * height)));
    Reference::of_levels(String::new(), levels.into()).grouped(&[].into(), &Ok(0.1))
}

fn arms(ranking: &Ranking) -> Vec<(usize, usize)> {
    ranking.levels.iter().flatten().map(|r| (r.arm, r.place)).collect()
}

/// With every arm, members of an ensemble with these errors.
fn with_members(study: (StudyManifest, Vec<Row>), members: &[&[f64]]) -> (StudyManifest, Vec<Row>) {
    let (mut manifest, mut rows) = study;
    let phases = 1 + members.iter().map(|of| of.len()).max().unwrap() as u32;
    manifest.ensemble = Some(Ensemble { phases, swapped: false, mesh: vec![1.0], sets: Vec::new() });
    for (i, members) in members.iter().enumerate() {
        for (k, error) in members.iter().enumerate() {
            let phase = (1.0 + k as f64) / f64::from(phases);
            let member = MemberOf { arm: i, member: Member { phase, swapped: false, mesh: 1.0, set: 0 } };
            let arm = manifest.arms[i].clone();
            manifest.members.push(Arm { role: Role { member: Some(member), ..arm.role.clone() }, ..arm });
            rows.push(row("member", &[("energy_error", *error), ("cost", 1.0)]));
        }
    }
    (manifest, rows)
}

fn with(row: &mut Row, name: &'static str, value: f64) {
    row.metrics.push(Metric { name: name.into(), value: Some(value), ..row.metrics[0].clone() });
}

/// An error of 0.049 does not promise 0.05 if the reference is uncertain by 0.0125; 0.03 does.
#[test]
fn accuracy_is_promised_with_the_uncertainty_included() {
    let of = |error: f64| by_columns(Goal::Trajectory, &study(&[("a", 0, error, 1.0)]), &reference(0.01));
    let found = of(0.03);
    let [low, high] = found.levels[0][0].interval;
    assert!((low - 0.0175).abs() < 1e-4 && (high - 0.0425).abs() < 1e-4, "{low} {high}");
    assert_eq!(found.verdict.unwrap().arm, 0);
    let why = of(0.049).verdict.unwrap_err();
    assert!(
        why[0].contains("no arm has the required accuracy, 0.05, with the uncertainty included"),
        "{why:?}"
    );
    assert_eq!(why.len(), 1);
    let study = study(&[("a", 0, 0.03, 1.0)]);
    let why = by_columns(Goal::Trajectory, &study, &reference(0.05)).verdict.unwrap_err();
    assert!(why[1].contains("the uncertainty of the reference alone is 0.0625"), "{why:?}");
}

/// Nobody who reads the table can find an arm with a smaller error at no more cost than that of the
/// recommended one; within 10 % of the lowest cost the error decides.
#[test]
fn no_arm_of_the_table_beats_the_recommended_one() {
    let runs = [("a", 0, 0.04, 1.0), ("b", 0, 0.01, 1.05), ("c", 0, 0.03, 1.0), ("d", 1, 0.001, 3.0)];
    let verdict = by_energy(&study(&runs)).verdict.unwrap();
    assert_eq!((verdict.arm, verdict.confidence), (1, Confidence::Medium));
    // Without a required accuracy the most accurate arm is recommended.
    let (mut manifest, rows) = study(&runs);
    manifest.accuracy = None;
    assert_eq!(by_energy(&(manifest, rows)).verdict.unwrap().arm, 3);
}

/// The order of the arms changes neither places nor recommendation.
#[test]
fn the_order_of_the_arms_does_not_matter() {
    let runs = [("a", 0, 0.02, 1.0), ("b", 0, 0.02, 1.0), ("c", 0, 0.0201, 1.0), ("d", 0, 0.3, 0.5)];
    let of = |order: [usize; 4]| {
        let runs = order.map(|i| runs[i]);
        let study = study(&runs);
        let found = by_energy(&study);
        let named = |arm: usize| study.0.arms[arm].name.clone();
        let table: Vec<_> = found.levels[0].iter().map(|r| (named(r.arm), r.place)).collect();
        let verdict = found.verdict.unwrap();
        (table, named(verdict.arm), verdict.alike, verdict.reasons, verdict.confidence_reasons)
    };
    let first = of([0, 1, 2, 3]);
    assert_eq!(first.1, "a 0");
    for order in [[3, 2, 1, 0], [1, 3, 0, 2], [2, 0, 3, 1]] {
        assert_eq!(of(order), first);
    }
}

/// A scatters between 0.01 and 0.2, which B, at 0.05, does not: the error of an arm is the largest
/// one of its members.
#[test]
fn scatter_is_not_rewarded() {
    let runs = study(&[("a", 0, 0.01, 1.0), ("b", 0, 0.05, 1.0)]);
    let (mut manifest, rows) = with_members(runs, &[&[0.2, 0.02], &[0.05, 0.05]]);
    manifest.accuracy = None;
    let ranking = by_energy(&(manifest, rows));
    assert_eq!(arms(&ranking), [(1, 1), (0, 2)]);
    let verdict = ranking.verdict.unwrap();
    assert_eq!((verdict.arm, verdict.alike.len(), verdict.confidence), (1, 0, Confidence::High));
}

/// 0.03 and 0.05 are not distinguished by a reference that is uncertain by 0.0125; 0.03 and 0.06
/// are.
#[test]
fn places_follow_from_intervals() {
    let runs = [("a", 0, 0.03, 1.0), ("b", 0, 0.05, 1.0), ("c", 0, 0.06, 1.0)];
    let ranking = by_columns(Goal::Trajectory, &study(&runs), &reference(0.01));
    assert_eq!(arms(&ranking), [(0, 1), (1, 1), (2, 2)]);
    let (mut manifest, rows) = study(&runs);
    manifest.accuracy = None;
    let verdict = by_columns(Goal::Trajectory, &(manifest, rows), &reference(0.01)).verdict.unwrap();
    assert_eq!((verdict.arm, verdict.alike, verdict.confidence), (0, vec!["b 0".into()], Confidence::Low));
}

/// Errors of 0.1 and 0.1002 whose difference has the length 0.004 are not distinguished by a
/// reference that is uncertain by 0.0125 (the quotient is 0.005), but equal to 0.004/0.0875 < 5 %
/// for every solution: no other arm is better by more. With a difference of 0.006 one may be.
#[test]
fn what_is_the_same_leaves_the_confidence_high() {
    let of = |apart: f64| {
        let runs = study(&[("a", 0, 0.1, 1.0), ("b", 0, 0.1002, 1.0), ("c", 0, 0.3, 1.0)]);
        let (mut manifest, rows) = with_members(runs, &[&[0.1], &[0.1002], &[0.3]]);
        manifest.accuracy = None;
        // By the law of cosines.
        let cosine = (0.1_f64.powi(2) + 0.1002_f64.powi(2) - apart.powi(2)) / (2.0 * 0.1 * 0.1002);
        let second = vec![0.1002 * cosine, 0.1002 * (1.0 - cosine * cosine).sqrt()];
        let errors = [vec![0.1, 0.0], second, vec![0.0, 0.3]];
        by_vectors(Goal::Trajectory, &(manifest, rows), &reference(0.01), |run| errors[run % 3].clone())
    };
    let found = of(0.004);
    assert_eq!(arms(&found), [(0, 1), (1, 1), (2, 3)]);
    let verdict = found.verdict.unwrap();
    assert_eq!((verdict.arm, verdict.alike, verdict.confidence), (0, vec!["b 0".into()], Confidence::High));
    let verdict = of(0.006).verdict.unwrap();
    assert_eq!((verdict.arm, verdict.alike, verdict.confidence), (0, vec!["b 0".into()], Confidence::Low));
}

/// By hand: with errors of 0.03 and 0.05 in the same direction, the solutions as far from one as
/// from the other are 0.04 from the reference, which is uncertain by 0.0125 only.
#[test]
fn errors_in_common_do_not_hide_a_difference() {
    let far = |x: f64, y: f64| Errors { error: x.hypot(y), vector: vec![x, y], noise: None };
    assert!(
        far(0.03, 0.0).is_nearer(&far(0.05, 0.0), 0.039) && !far(0.03, 0.0).is_nearer(&far(0.05, 0.0), 0.041)
    );
    assert!(!far(0.03, 0.0).is_nearer(&far(-0.05, 0.0), 0.0125));
    // Disjoint intervals suffice.
    assert!(far(0.03, 0.0).is_nearer(&far(-0.06, 0.0), 0.0125));
    assert!(
        !far(0.05, 0.0).is_nearer(&far(0.03, 0.0), 0.0) && !far(0.03, 0.0).is_nearer(&far(0.03, 0.0), 0.0)
    );
}

/// Differences that no sample has seen: errors of 0.06 and 0.21 beside an exact reference are not
/// the same.
#[test]
fn places_follow_from_errors_that_samples_miss() {
    let unseen = |error: f64| Errors { error, vector: vec![0.0; 8], noise: None };
    assert!(unseen(0.06).is_nearer(&unseen(0.21), 0.0) && !unseen(0.21).is_nearer(&unseen(0.06), 0.0));
    // Disjoint intervals: 0.06 ± 0.07 and 0.21 ± 0.07.
    assert!(unseen(0.06).is_nearer(&unseen(0.21), 0.07));
    assert!((unseen(0.06).distance(&unseen(0.21)) - 0.15).abs() < 1e-12);
}

/// Arms that created energy, stopped or penetrated are not ranked, and the reason is known.
#[test]
fn unsound_arms_are_set_apart() {
    let runs = [("a", 0, 0.01, 1.0), ("b", 0, 0.01, 1.0), ("c", 0, 0.01, 1.0), ("d", 0, 0.04, 1.0)];
    let (manifest, mut rows) = study(&runs);
    with(&mut rows[0], "energy_created", 0.03);
    rows[1].status = Some(Status::Failed);
    rows[1].reason = Some("no convergence".into());
    with(&mut rows[2], "penetration_secondary", 0.05);
    with(&mut rows[3], "penetration_secondary", 0.01);
    let ranking = by_columns(Goal::Cost, &(manifest, rows), &reference(1e-4));
    let apart: Vec<_> = ranking.apart.iter().map(|apart| (apart.arm, apart.why.as_str())).collect();
    let known = [
        "it created 0.03 of the energy",
        "it stopped (no convergence)",
        "it penetrates by 0.05, 0.05 of the motion more than the reference, and 0.02 at most is allowed",
    ];
    assert_eq!(apart, [(0, known[0]), (1, known[1]), (2, known[2])]);
    assert_eq!((arms(&ranking), ranking.verdict.unwrap().arm), (vec![(3, 1)], 3));
}

/// Energy that friction hides sets an arm apart, and so does a quantity of the measure that it
/// lacks: no arm vanishes.
#[test]
fn no_arm_is_left_out_without_a_word() {
    let runs = [("a", 0, 0.01, 1.0), ("b", 0, 0.02, 1.0), ("c", 0, 0.03, 1.0)];
    let (manifest, mut rows) = study(&runs);
    rows[0].warnings.push(Warning {
        id: "hidden-energy".into(),
        place: "the run".into(),
        what: "scheme and contact created 8 %".into(),
        why: String::new(),
        advice: String::new(),
    });
    rows[1].metrics.retain(|metric| metric.name != "energy_error");
    let ranking = by_energy(&(manifest, rows));
    let apart: Vec<_> = ranking.apart.iter().map(|apart| (apart.arm, apart.why.as_str())).collect();
    assert_eq!(apart, [(0, "scheme and contact created 8 %"), (1, "it lacks a quantity of the measure")]);
    assert_eq!(arms(&ranking), [(2, 1)]);
}

/// An error that is three times as large is not distinguished by a coarse reference, and is not
/// recommended for being cheaper all the same.
#[test]
fn an_arm_that_is_clearly_less_accurate_is_not_recommended() {
    let (mut manifest, rows) = study(&[("a", 0, 0.03, 2.0), ("b", 0, 0.09, 1.0)]);
    manifest.accuracy = None;
    let ranking = by_columns(Goal::Trajectory, &(manifest, rows), &reference(0.1));
    assert_eq!(arms(&ranking), [(0, 1), (1, 1)]);
    assert_eq!(ranking.verdict.unwrap().arm, 0);
}

/// B has all results of A: it takes no place from C, and is not tied with A.
#[test]
fn identical_arms_count_once() {
    let found = |b: f64| {
        let runs = [("a", 0, 0.01, 1.0), ("b", 0, b, 1.0), ("c", 0, 0.04, 1.0)];
        let ranking = by_energy(&study(&runs));
        (arms(&ranking), ranking.verdict.unwrap().alike)
    };
    assert_eq!(found(0.01), (vec![(0, 1), (1, 1), (2, 2)], vec![]));
    assert_eq!(found(0.010_000_001).0, [(0, 1), (1, 1), (2, 3)]);
}

/// The least cost is looked for over all levels.
#[test]
fn least_cost_is_looked_for_over_all_levels() {
    let runs = [("a", 0, 0.2, 0.5), ("b", 0, 0.2, 1.0), ("a", 1, 0.01, 3.0), ("b", 1, 0.0101, 2.0)];
    let of = |runs: &[Made]| by_columns(Goal::Cost, &study(runs), &reference(1e-4)).verdict;
    assert_eq!(of(&runs).unwrap().arm, 3);
    let none = of(&[("a", 0, 0.2, 1.0)]).unwrap_err();
    assert!(none[0].contains("the best one, a 0, has an error of 0.2"), "{none:?}");
}

/// On one mesh nothing is established, so that nothing is recommended; the reason is said.
#[test]
fn one_mesh_establishes_nothing() {
    let run = || Trajectory {
        times: vec![0.0, 1.0],
        columns: [("A.uy".to_owned(), vec![0.0, 1.0])].into(),
        ..Trajectory::default()
    };
    let level = |step: f64| Level { step, mesh: 1.0, phases: 1, members: vec![run()] };
    let reference = Reference::of_levels(String::new(), vec![level(4.0), level(2.0), level(1.0)]);
    let reference = reference.grouped(&[].into(), &Ok(0.1));
    let why = by_columns(Goal::Trajectory, &study(&[("a", 0, 0.01, 1.0)]), &reference).verdict.unwrap_err();
    assert!(why[0].contains("its mesh was not refined"), "{why:?}");
}
