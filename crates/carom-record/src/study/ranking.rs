//! Ranking of the arms by the goal of a study.
//!
//! Every goal has measures in order of preference, and the first established one is used. The error
//! of a run is |m − r|/|r| (|m| if r = 0) for a metric m, or the root mean square deviation of
//! columns; that of an arm is the median over its ensemble, with the largest distance of a member
//! from it as its uncertainty; members that failed count for that if only one did not. Arms are
//! ranked within a level only, that is, at the same step or the same cost. Two arms of a level are
//! not distinguished if their errors differ by no more than the sum of their uncertainties, than
//! that of the reference, or than 5 %. The place of an arm is one plus the number of arms that are
//! distinguishably better, of which twins, with the same results to the last bit, count as one; a
//! method that is a twin of an earlier one at all levels is no competitor of it. Within a place
//! arms are in the order of their cost. An arm that created so much energy that the default guard
//! would have stopped it is placed behind all others; a member that did counts as failed.
//!
//! An arm has the required accuracy if neither its error nor its uncertainty exceeds that. The goal
//! of least cost ranks the arms that have it by their own processor times,
//! of which differences of up to 10 % are not distinguished.

use super::arm::Arm;
use super::compared::Compared;
use super::crosscheck;
pub use super::crosscheck::Crosscheck;
use super::design::Goal;
use super::ensemble::Spread;
use super::manifest::StudyManifest;
use super::measure::{Judge, candidates};
pub use super::measure::{Measure, error, standing};
pub use super::places::Ranked;
use super::places::{cheaper, more_accurate, places};
use super::recommendation::recommended;
pub use super::recommendation::{Confidence, Verdict};
use super::reference::Reference;
use super::row::Row;
use crate::Reason;

/// The ranking of a study.
#[derive(Clone, Debug, PartialEq)]
pub struct Ranking {
    /// The goal of the ranking.
    pub goal: Goal,
    /// The measure, or why there is none.
    pub measure: Result<Measure, Reason>,
    /// Ranked arms per level, the best first.
    pub levels: Vec<Vec<Ranked>>,
    /// Per level, whether the conclusion is another one at equal cost (at equal steps, in a design
    /// of matched cost).
    pub crosschecks: Vec<Crosscheck>,
    /// The recommendation, or the reasons why there is none.
    pub verdict: Result<Verdict, Vec<String>>,
}

impl Ranking {
    /// Ranks the arms of a study.
    pub(super) fn of(
        goal: Goal,
        manifest: &StudyManifest,
        rows: &[Row],
        compared: &[Option<Compared>],
        reference: Option<&Reference>,
    ) -> Self {
        let judge = Judge { rows, compared, reference };
        let mut passed_over = Vec::new();
        let mut found = None;
        for candidate in candidates(goal) {
            match judge.measured(&candidate) {
                Ok(measured) => {
                    found = Some(measured);
                    break;
                }
                Err(why) => passed_over.push(why),
            }
        }
        let Some((measure, errors)) = found else {
            let why =
                passed_over.iter().map(|(name, why)| format!("{name}: {why}")).collect::<Vec<_>>().join("; ");
            let reasons = vec!["the reference establishes no measure of this goal".to_owned()];
            return Self {
                goal,
                measure: Err(why.into()),
                levels: Vec::new(),
                crosschecks: Vec::new(),
                verdict: Err(reasons),
            };
        };
        let mut measure = Measure { passed_over, ..measure };
        if goal == Goal::Cost {
            measure.words =
                format!("processor time of arms whose {} is at most {}", measure.words, manifest.accuracy());
        }
        let count = manifest.arms.iter().map(|a| a.role.level + 1).max().unwrap_or(0);
        let level = |level: usize| {
            let arms =
                manifest.arms.iter().enumerate().filter(|(_, a)| a.role.level == level && !a.role.fine);
            let not_reference = arms.filter(|(_, a)| manifest.reference.as_ref() != Some(&a.name));
            let one = |(i, _): (usize, &Arm)| {
                errors[i]?;
                let sound = |run: &usize| !rows[*run].is_unsound();
                let runs = || manifest.runs_of(i).into_iter();
                let spread =
                    |runs: &mut dyn Iterator<Item = usize>| Spread::of(runs.filter_map(|run| errors[run]));
                let members = spread(&mut runs().filter(|run| *run == i || sound(run)))?;
                // One run alone tells nothing of the scatter: that of the failed ones is counted.
                let all = spread(&mut runs()).filter(|_| members.count() == 1);
                let error = members.median();
                let uncertainty = all.as_ref().unwrap_or(&members).farthest(error);
                Some(Ranked {
                    arm: i,
                    error,
                    uncertainty,
                    members: members.count(),
                    sound: sound(&i),
                    place: 0,
                })
            };
            let mut ranked: Vec<Ranked> = not_reference.filter_map(one).collect();
            let is_twin = |a: &Ranked, b: &Ranked| rows[a.arm].is_twin(&rows[b.arm]);
            let cost = |r: &Ranked| rows[r.arm].value("cpu_time").unwrap_or(f64::INFINITY);
            ranked.sort_by(|a, b| a.error.total_cmp(&b.error));
            if goal == Goal::Cost {
                ranked.retain(|r| r.has_accuracy(manifest.accuracy()) && cost(r).is_finite());
                places(&mut ranked, |a, b| cheaper(cost(a), cost(b)), is_twin);
            } else {
                places(&mut ranked, |a, b| more_accurate(a, b, measure.uncertainty), is_twin);
            }
            ranked.sort_by(|a, b| a.place.cmp(&b.place).then(cost(a).total_cmp(&cost(b))));
            ranked
        };
        let levels: Vec<Vec<Ranked>> = (0..count).map(level).collect();
        let single = without_twins(manifest, rows, &levels);
        let verdict = recommended(goal, manifest, &measure, &single, rows, reference);
        let crosschecks = if goal == Goal::Cost {
            Vec::new()
        } else {
            crosscheck::of(manifest, rows, &single, measure.uncertainty)
        };
        Self { goal, measure: Ok(measure), levels, crosschecks, verdict }
    }
}

/// The levels without methods whose arms are all twins of those of an earlier method: of the same
/// runs, one is enough.
fn without_twins(manifest: &StudyManifest, rows: &[Row], levels: &[Vec<Ranked>]) -> Vec<Vec<Ranked>> {
    let mut methods: Vec<(&str, Vec<usize>)> = Vec::new();
    let mut arms: Vec<usize> = levels.iter().flatten().map(|r| r.arm).collect();
    arms.sort_unstable();
    for arm in arms {
        let name = manifest.arms[arm].method();
        match methods.iter_mut().find(|(known, _)| *known == name) {
            Some((_, mine)) => mine.push(arm),
            None => methods.push((name, vec![arm])),
        }
    }
    let is_twin = |mine: &[usize], others: &[usize]| {
        mine.len() == others.len() && mine.iter().zip(others).all(|(a, b)| rows[*a].is_twin(&rows[*b]))
    };
    let twins: Vec<usize> = (1..methods.len())
        .filter(|k| methods[..*k].iter().any(|(_, others)| is_twin(&methods[*k].1, others)))
        .flat_map(|k| methods[k].1.clone())
        .collect();
    let single = |level: &Vec<Ranked>| level.iter().filter(|r| !twins.contains(&r.arm)).cloned().collect();
    levels.iter().map(single).collect()
}

#[cfg(test)]
mod tests;
