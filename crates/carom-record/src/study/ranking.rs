//! Ranking of the arms by the goal of a study, with a recommendation and its confidence.
//!
//! Every goal has measures in order of preference, and the first established one is used. The error
//! of an arm is |m − r|/|r| (|m| if r = 0) for a metric m, or the root mean square deviation of
//! columns. Arms are ranked within a level only, that is, at the same step or the same cost.
//! Methods are ordered by their mean rank over the levels. Two arms of a level are not
//! distinguished if their errors differ by no more than the uncertainty of the reference, or by
//! 5 %. Of the methods that are not distinguished from the best, the cheapest is recommended.
//! Processor times within 10 % of the smallest count as equal; the smaller error then decides.

use super::compared::Compared;
use super::design::{Goal, Kind};
use super::digits::short;
use super::manifest::StudyManifest;
use super::measure::{Judge, candidates};
pub use super::measure::{Measure, error, standing};
use super::reference::Reference;
use super::row::Row;

/// Relative difference below which errors are not distinguished.
const ALIKE: f64 = 0.05;
/// Relative difference below which processor times count as equal: measurements do not reproduce
/// better than this.
const EQUAL_COST: f64 = 0.1;

/// An arm in the ranking of its level.
#[derive(Clone, Debug, PartialEq)]
pub struct Ranked {
    /// Number of the arm.
    pub arm: usize,
    /// Its error.
    pub error: f64,
    /// Place, from 1; arms that are not distinguished share one.
    pub place: usize,
}

/// Confidence in a recommendation.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Confidence {
    /// The ranking may be accidental.
    Low,
    /// The ranking holds for this study.
    Medium,
    /// The ranking holds at every level, by more than all uncertainties.
    High,
}

impl Confidence {
    /// As a word.
    pub fn word(self) -> &'static str {
        match self {
            Self::Low => "low",
            Self::Medium => "medium",
            Self::High => "high",
        }
    }
}

/// The recommendation.
#[derive(Clone, Debug, PartialEq)]
pub struct Verdict {
    /// The recommended arm.
    pub arm: usize,
    /// Methods (arms in a study without methods) that are not distinguished from it.
    pub alike: Vec<String>,
    /// Reasons for the recommendation.
    pub reasons: Vec<String>,
    /// Confidence in it.
    pub confidence: Confidence,
    /// Reasons for the confidence.
    pub confidence_reasons: Vec<String>,
}

/// The ranking of a study.
#[derive(Clone, Debug, PartialEq)]
pub struct Ranking {
    /// The goal.
    pub goal: Goal,
    /// The measure, or why there is none.
    pub measure: Result<Measure, String>,
    /// Ranked arms per level, the best first.
    pub levels: Vec<Vec<Ranked>>,
    /// The recommendation; none if nothing can be ranked.
    pub verdict: Option<Verdict>,
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
        let Some((measure, mut errors)) = found else {
            let why =
                passed_over.iter().map(|(name, why)| format!("{name}: {why}")).collect::<Vec<_>>().join("; ");
            return Self { goal, measure: Err(why), levels: Vec::new(), verdict: None };
        };
        let mut measure = Measure { passed_over, ..measure };
        if goal == Goal::Cost {
            // The work of the arms that are accurate enough.
            let works = rows.iter().map(|r| r.value("cpu_time"));
            errors = errors
                .iter()
                .zip(works)
                .map(|(e, work)| e.filter(|e| *e <= manifest.accuracy()).and(work))
                .collect();
            measure.words =
                format!("processor time of arms whose {} is at most {}", measure.words, manifest.accuracy());
            measure.uncertainty = 0.0;
        }
        let count = manifest.arms.iter().map(|a| a.role.level + 1).max().unwrap_or(0);
        let level = |level: usize| {
            let arms =
                manifest.arms.iter().enumerate().filter(|(_, a)| a.role.level == level && !a.role.fine);
            let not_reference = arms.filter(|(_, a)| manifest.reference.as_ref() != Some(&a.name));
            let mut ranked: Vec<Ranked> = not_reference
                .filter_map(|(i, _)| Some(Ranked { arm: i, error: errors[i]?, place: 0 }))
                .collect();
            ranked.sort_by(|a, b| a.error.total_cmp(&b.error));
            places(&mut ranked, measure.uncertainty);
            ranked
        };
        let levels: Vec<Vec<Ranked>> = (0..count).map(level).collect();
        let verdict = verdict(goal, manifest, &measure, &levels, rows);
        Self { goal, measure: Ok(measure), levels, verdict }
    }
}

fn alike(a: f64, b: f64, uncertainty: f64) -> bool {
    (a - b).abs() <= f64::max(uncertainty, ALIKE * f64::min(a, b))
}

/// Assigns places: an arm shares the place of the first arm of its group as long as the two are not
/// distinguished.
fn places(ranked: &mut [Ranked], uncertainty: f64) {
    let mut first = 0;
    for i in 0..ranked.len() {
        if !alike(ranked[first].error, ranked[i].error, uncertainty) {
            first = i;
        }
        ranked[i].place = first + 1;
    }
}

fn verdict(
    goal: Goal,
    manifest: &StudyManifest,
    measure: &Measure,
    levels: &[Vec<Ranked>],
    rows: &[Row],
) -> Option<Verdict> {
    let name = |arm: usize| manifest.arms[arm].role.method.as_ref().unwrap_or(&manifest.arms[arm].name);
    let full: Vec<&Vec<Ranked>> = levels.iter().filter(|l| !l.is_empty()).collect();
    let mut methods: Vec<&String> = Vec::new();
    for ranked in full.iter().flat_map(|l| l.iter()) {
        if !methods.contains(&name(ranked.arm)) {
            methods.push(name(ranked.arm));
        }
    }
    // A method without an arm at a level is placed after all others.
    let places = |method: &String| {
        let place = |l: &&Vec<Ranked>| {
            l.iter().find(|r| name(r.arm) == method).map_or(manifest.arms.len() + 1, |r| r.place)
        };
        full.iter().map(place).sum::<usize>() as f64 / full.len() as f64
    };
    let finest = |method: &String| {
        full.iter()
            .rev()
            .find_map(|l| l.iter().find(|r| name(r.arm) == method))
            .map_or(f64::INFINITY, |r| r.error)
    };
    methods.sort_by(|a, b| places(a).total_cmp(&places(b)).then(finest(a).total_cmp(&finest(b))));
    let least = places(methods.first()?);
    let tied: Vec<&String> = methods.into_iter().filter(|m| places(m) <= least).collect();
    let accuracy = manifest.accuracy();
    // The arm of a method that would be recommended.
    let arm_of = |method: &String| {
        let arms: Vec<&Ranked> =
            full.iter().filter_map(|l| l.iter().find(|r| name(r.arm) == method)).collect();
        match goal {
            Goal::Cost => arms.iter().min_by(|a, b| a.error.total_cmp(&b.error)).copied(),
            _ => arms.iter().find(|r| r.error <= accuracy).or(arms.last()).copied(),
        }
    };
    let costs: Vec<Option<f64>> =
        tied.iter().map(|m| rows.get(arm_of(m)?.arm)?.value("cpu_time").filter(|c| *c > 0.0)).collect();
    let picked = cheapest(&costs);
    let best = tied[picked];
    let alike_ones: Vec<String> =
        tied.iter().enumerate().filter(|(i, _)| *i != picked).map(|(_, m)| (*m).clone()).collect();
    let chosen = arm_of(best)?;
    let first_at = full.iter().filter(|l| l.iter().any(|r| r.place == 1 && name(r.arm) == best)).count();
    let mut reasons = vec![format!("{}: {}", measure.words, short(chosen.error))];
    let others = full
        .iter()
        .flat_map(|l| l.iter())
        .filter(|r| manifest.arms[r.arm].role.level == manifest.arms[chosen.arm].role.level);
    if let Some(next) = others.filter(|r| name(r.arm) != best).min_by(|a, b| a.error.total_cmp(&b.error)) {
        reasons.push(format!(
            "best of the other methods at the same level, {}: {}",
            name(next.arm),
            short(next.error)
        ));
    }
    reasons.push(format!("ranked first at {first_at} of {} levels", full.len()));
    let next = costs.iter().enumerate().filter(|(i, _)| *i != picked).filter_map(|(i, c)| Some((i, (*c)?)));
    let next = next.min_by(|a, b| a.1.total_cmp(&b.1));
    // Cost of the cheapest of the others, relative to that of the recommended one.
    let times = next.zip(costs[picked]).map(|((_, other), own)| other / own);
    if let Some(((i, other), own)) = next.zip(costs[picked]).filter(|_| goal != Goal::Cost) {
        let words = if other > (1.0 + EQUAL_COST) * own {
            "cheapest of the methods that are not distinguished"
        } else {
            "none of the methods that are not distinguished is cheaper by more than 10 %"
        };
        reasons.push(format!("{words}: {} s of processor time; {}: {} s", short(own), tied[i], short(other)));
    }
    if goal != Goal::Cost {
        reasons.push(if chosen.error <= accuracy {
            format!("the coarsest level at which its error is at most {accuracy}")
        } else {
            format!("its finest level; its error is above {accuracy} at every level")
        });
    }
    let dearer = times.is_some_and(|times| times > 1.0 + EQUAL_COST) && goal != Goal::Cost;
    let alone = Alone { method: alike_ones.is_empty(), by_cost: dearer };
    let (mut confidence, mut confidence_reasons) = confidence(manifest, measure, &full, first_at, &alone);
    if goal != Goal::Cost && chosen.error > accuracy {
        confidence = Confidence::Low;
        let why = format!(
            "the error of the recommended arm, {}, is larger than the required accuracy, {accuracy}",
            short(chosen.error)
        );
        confidence_reasons.push(why);
    }
    let arm = &manifest.arms[chosen.arm];
    if let Some(design) =
        manifest.design.as_ref().filter(|d| d.kind == Kind::MatchedStep && manifest.by_cost(arm))
    {
        confidence = confidence.min(Confidence::Medium);
        confidence_reasons.push(format!(
            "it is compared at the cost of {}, the other methods at their common step",
            design.cost_of
        ));
    }
    Some(Verdict { arm: chosen.arm, alike: alike_ones, reasons, confidence, confidence_reasons })
}

/// Index of the first method whose cost is within 10 % of the smallest; 0 if no cost is known.
fn cheapest(costs: &[Option<f64>]) -> usize {
    let least = costs.iter().flatten().copied().fold(f64::INFINITY, f64::min);
    costs.iter().position(|c| c.is_some_and(|c| c <= (1.0 + EQUAL_COST) * least)).unwrap_or(0)
}

/// Whether the recommended method is distinguished from all others.
struct Alone {
    /// By its errors.
    method: bool,
    /// By its cost, if not by its errors.
    by_cost: bool,
}

fn confidence(
    manifest: &StudyManifest,
    measure: &Measure,
    levels: &[&Vec<Ranked>],
    first_at: usize,
    alone: &Alone,
) -> (Confidence, Vec<String>) {
    let (mut confidence, mut reasons) = (Confidence::High, Vec::new());
    let mut at_most = |most: Confidence, why: String| {
        confidence = confidence.min(most);
        reasons.push(why);
    };
    if !alone.method {
        let close = format!("differences of at most {} or {} %", short(measure.uncertainty), 100.0 * ALIKE);
        if alone.by_cost {
            let why = format!(
                "its error is not distinguished from that of other methods ({close}); its lower cost decides"
            );
            at_most(Confidence::Medium, why);
        } else {
            let why = format!(
                "other methods are not distinguished from it, neither by error ({close}) nor by cost"
            );
            at_most(Confidence::Low, why);
        }
    }
    if first_at < levels.len() {
        at_most(Confidence::Low, format!("it is ranked first at only {first_at} of {} levels", levels.len()));
    }
    if levels.len() < 2 {
        at_most(
            Confidence::Medium,
            "there is only one level; the ranking may be different at another step".to_owned(),
        );
    }
    if !measure.passed_over.is_empty() {
        let names: Vec<&str> = measure.passed_over.iter().map(|(name, _)| name.as_str()).collect();
        at_most(
            Confidence::Medium,
            format!(
                "preferred measures are not established by the reference: {}; a substitute is used",
                names.join(", ")
            ),
        );
    }
    let off = manifest
        .arms
        .iter()
        .filter(|a| a.role.cost.is_some_and(|share| (share - 1.0).abs() > EQUAL_COST))
        .count();
    if off > 0 {
        at_most(
            Confidence::Medium,
            format!("the cost of {off} arms differs from the budget by more than 10 %"),
        );
    }
    if manifest.design.is_none() {
        at_most(
            Confidence::Low,
            "the arms are not matched: the study has no `design` for equal steps or equal cost".to_owned(),
        );
    }
    if reasons.is_empty() {
        reasons.push(
            "it is ranked first at every level, by more than the uncertainty of the reference and 5 %"
                .to_owned(),
        );
    }
    (confidence, reasons)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// 1.00 and 1.04 share a place, 1.2 does not; with an uncertainty of 0.3 all three do.
    #[test]
    fn places_are_shared() {
        let of = |uncertainty: f64| {
            let mut ranked: Vec<Ranked> = [1.0, 1.04, 1.2]
                .iter()
                .enumerate()
                .map(|(arm, e)| Ranked { arm, error: *e, place: 0 })
                .collect();
            places(&mut ranked, uncertainty);
            ranked.iter().map(|r| r.place).collect::<Vec<_>>()
        };
        assert_eq!((of(0.0), of(0.3)), (vec![1, 1, 3], vec![1, 1, 1]));
    }

    /// 1.05 is equal to 1, 1.2 is not; unknown costs are ignored.
    #[test]
    fn the_cheapest_within_a_tenth_is_taken_in_order() {
        assert_eq!(cheapest(&[Some(9.9), Some(1.05), Some(1.0)]), 1);
        assert_eq!(cheapest(&[Some(1.2), None, Some(1.0)]), 2);
        assert_eq!((cheapest(&[None, None]), cheapest(&[Some(3.0)])), (0, 0));
    }
}
