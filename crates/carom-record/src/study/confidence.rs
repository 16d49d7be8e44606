//! How far a recommendation can be trusted, with the reasons.

use super::design::Goal;
use super::digits::short;
use super::manifest::StudyManifest;
use super::measure::Measure;
use super::places::{ALIKE, EQUAL_COST, Ranked};

/// Confidence in a recommendation.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Confidence {
    /// The ranking may be due to chance.
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

/// What distinguishes the recommended method from all others.
pub(super) enum DecidedBy {
    Error,
    /// Its error alone is small enough, though not distinguished from the others.
    Accuracy,
    Cost,
    /// Nothing does from these methods.
    Nothing(Vec<String>),
}

/// What a recommendation rests on.
pub(super) struct Evidence {
    pub decided_by: DecidedBy,
    /// Number of levels at which no method is distinguishably better.
    pub first_at: usize,
    /// Other methods that share the first place with it, and at how many levels.
    pub sharing: Vec<(String, usize)>,
    /// The reference was computed on finer meshes; without one, the arms were.
    pub mesh: bool,
    /// There is a reference.
    pub reference: bool,
    /// The arms were run with several phases, roles or meshes.
    pub ensemble: bool,
}

pub(super) fn confidence(
    goal: Goal,
    manifest: &StudyManifest,
    measure: &Measure,
    levels: &[Vec<Ranked>],
    evidence: Evidence,
) -> (Confidence, Vec<String>) {
    let mut confidence = Confidence::High;
    let mut reasons = Vec::new();
    let mut at_most = |most: Confidence, why: String| {
        confidence = confidence.min(most);
        reasons.push(why);
    };
    let widths = if evidence.ensemble { " or the half-widths of both ensembles" } else { "" };
    let close =
        format!("differences of at most {} or {} %{widths}", short(measure.uncertainty), 100.0 * ALIKE);
    match evidence.decided_by {
        DecidedBy::Error => {}
        DecidedBy::Accuracy => at_most(
            Confidence::Low,
            format!(
                "its error is not distinguished from that of other methods ({close}); it alone has the \
                 required accuracy, {}",
                manifest.accuracy()
            ),
        ),
        DecidedBy::Cost => at_most(
            Confidence::Medium,
            format!(
                "its error is not distinguished from that of other methods ({close}); its lower cost decides"
            ),
        ),
        DecidedBy::Nothing(_) if goal == Goal::Cost => at_most(
            Confidence::Low,
            format!("other methods have the same cost (differences of at most {} %)", 100.0 * EQUAL_COST),
        ),
        DecidedBy::Nothing(others) => at_most(
            Confidence::Low,
            format!(
                "not distinguished from it, neither by error ({close}) nor by cost (at most {} % more): {}",
                100.0 * EQUAL_COST,
                others.join("; ")
            ),
        ),
    }
    for (method, count) in evidence.sharing {
        at_most(
            Confidence::Medium,
            format!("at {count} of {} levels {method} is not distinguished from it ({close})", levels.len()),
        );
    }
    let first_at = evidence.first_at;
    if first_at < levels.len() {
        at_most(
            Confidence::Low,
            format!("at only {first_at} of {} levels no method is distinguishably better", levels.len()),
        );
    }
    if levels.len() < 2 {
        at_most(
            Confidence::Medium,
            "there is only one level; the ranking may be different at another step".to_owned(),
        );
    }
    let unseen = |what: &str, cure: &str| format!("{what}; {cure}");
    let mesh = if evidence.reference {
        unseen("the reference was computed on the given mesh only", "`mesh = [1, 2, 4]` in [fine] refines it")
    } else {
        unseen("all arms were computed on the given mesh", "`mesh = [1, 2]` in [ensemble] refines it")
    };
    let ensemble = unseen(
        "there are arms with the value of a single run, so that chance cannot be distinguished from the \
         method",
        "[ensemble] runs every arm with several phases, roles and meshes",
    );
    // One of them alone leaves the ranking of this mesh, or of these instants, open.
    let most = if evidence.mesh || evidence.ensemble { Confidence::Medium } else { Confidence::Low };
    for why in [(evidence.mesh, mesh), (evidence.ensemble, ensemble)] {
        if !why.0 {
            at_most(most, why.1);
        }
    }
    // Members that failed or have no such number do not show how far it is spread.
    let all = |r: &&Ranked| manifest.runs_of(r.arm).len();
    let incomplete = levels.iter().flatten().filter(|r| r.members < all(r));
    if let Some(worst) = incomplete.min_by_key(|r| r.members) {
        at_most(
            Confidence::Medium,
            format!(
                "only {} of {} members of \"{}\" have a value",
                worst.members,
                all(&worst),
                manifest.arms[worst.arm].name
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
        let by = if goal == Goal::Cost {
            "10 % of the cost"
        } else {
            "the uncertainties of arms and reference and 5 %"
        };
        reasons.push(format!("it is ranked first at every level, by more than {by}"));
    }
    (confidence, reasons)
}
