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
    /// The confidence as a word.
    pub fn word(self) -> &'static str {
        match self {
            Self::Low => "low",
            Self::Medium => "medium",
            Self::High => "high",
        }
    }
}

/// Criterion that distinguishes the recommended method from all others.
pub(super) enum DecidedBy {
    Error,
    /// Only the recommended one of the methods that share the best place is accurate enough.
    Accuracy,
    Cost,
    /// Neither error nor cost distinguishes the recommended method from these.
    Nothing(Vec<String>),
}

/// Evidence that a recommendation is based on.
pub(super) struct Evidence {
    pub decided_by: DecidedBy,
    /// Number of levels at which no other method is distinguishably better.
    pub first_at: usize,
    /// Other methods that share the first place with the recommended one, and at how many levels.
    pub sharing: Vec<(String, usize)>,
    /// Whether the uncertainty of the reference includes that of the mesh; without a reference,
    /// whether the ensemble refines the mesh.
    pub mesh: bool,
    /// Whether there is a reference.
    pub reference: bool,
    /// Whether every ranked arm has the values of several runs, with other phases, roles or meshes.
    pub ensemble: bool,
}

/// Confidence in a recommendation, with the reasons that lower it.
struct Doubts {
    confidence: Confidence,
    reasons: Vec<String>,
}

impl Doubts {
    fn at_most(&mut self, most: Confidence, why: impl Into<String>) {
        self.confidence = self.confidence.min(most);
        self.reasons.push(why.into());
    }
}

pub(super) fn confidence(
    goal: Goal,
    manifest: &StudyManifest,
    measure: &Measure,
    levels: &[Vec<Ranked>],
    evidence: &Evidence,
) -> (Confidence, Vec<String>) {
    let mut doubts = Doubts { confidence: Confidence::High, reasons: Vec::new() };
    let widths = if evidence.ensemble { " or the half-widths of both ensembles" } else { "" };
    let close =
        format!("differences of at most {} or {} %{widths}", short(measure.uncertainty), 100.0 * ALIKE);
    of_decision(&mut doubts, goal, manifest, &evidence.decided_by, &close);
    let count = levels.len();
    for (method, shared) in &evidence.sharing {
        let why = format!("at {shared} of {count} levels {method} is not distinguished from it ({close})");
        doubts.at_most(Confidence::Medium, why);
    }
    if evidence.first_at < count {
        let first_at = evidence.first_at;
        let why = format!("at only {first_at} of {count} levels no method is distinguishably better");
        doubts.at_most(Confidence::Low, why);
    }
    if count < 2 {
        let why = "there is only one level; the ranking may be different at another step";
        doubts.at_most(Confidence::Medium, why);
    }
    of_evidence(&mut doubts, evidence);
    of_runs(&mut doubts, manifest, levels);
    if doubts.reasons.is_empty() {
        let by = if goal == Goal::Cost {
            "10 % of the cost"
        } else {
            "the uncertainties of arms and reference and 5 %"
        };
        doubts.reasons.push(format!("it is ranked first at every level, by more than {by}"));
    }
    (doubts.confidence, doubts.reasons)
}

/// Lowers the confidence if the recommended method is not distinguished from others by its error.
fn of_decision(
    doubts: &mut Doubts,
    goal: Goal,
    manifest: &StudyManifest,
    decided_by: &DecidedBy,
    close: &str,
) {
    let not_by_error = format!("its error is not distinguished from that of other methods ({close})");
    let equal = 100.0 * EQUAL_COST;
    match decided_by {
        DecidedBy::Error => {}
        DecidedBy::Accuracy => {
            let accuracy = manifest.accuracy();
            let why = format!("{not_by_error}; it alone has the required accuracy, {accuracy}");
            doubts.at_most(Confidence::Low, why);
        }
        DecidedBy::Cost => {
            doubts.at_most(Confidence::Medium, format!("{not_by_error}; its lower cost decides"));
        }
        DecidedBy::Nothing(_) if goal == Goal::Cost => {
            let why = format!("other methods have the same cost (differences of at most {equal} %)");
            doubts.at_most(Confidence::Low, why);
        }
        DecidedBy::Nothing(others) => {
            let others = others.join("; ");
            let why = format!(
                "not distinguished from it, neither by error ({close}) nor by cost (at most {equal} % more): {others}"
            );
            doubts.at_most(Confidence::Low, why);
        }
    }
}

/// Lowers the confidence if the mesh was not refined, or if arms were run only once.
fn of_evidence(doubts: &mut Doubts, evidence: &Evidence) {
    // One of them alone leaves the ranking of this mesh, or of these instants, open.
    let most = if evidence.mesh || evidence.ensemble { Confidence::Medium } else { Confidence::Low };
    if !evidence.mesh {
        doubts.at_most(
            most,
            if evidence.reference {
                "the reference was computed on the given mesh only; `mesh = [1, 2, 4]` in [fine] refines it"
            } else {
                "all arms were computed on the given mesh; `mesh = [1, 2]` in [ensemble] refines it"
            },
        );
    }
    if !evidence.ensemble {
        doubts.at_most(
            most,
            "there are arms with the value of a single run, so that chance cannot be distinguished from the \
             method; [ensemble] runs every arm with several phases, roles and meshes",
        );
    }
}

/// Lowers the confidence if members have no value, or if steps or costs of the arms are not
/// matched.
fn of_runs(doubts: &mut Doubts, manifest: &StudyManifest, levels: &[Vec<Ranked>]) {
    // Members that failed or have no such number do not show how far it is spread.
    let all = |r: &Ranked| manifest.runs_of(r.arm).len();
    let incomplete = levels.iter().flatten().filter(|r| r.members < all(r));
    if let Some(worst) = incomplete.min_by_key(|r| r.members) {
        let name = &manifest.arms[worst.arm].name;
        let why = format!("only {} of {} members of \"{name}\" have a value", worst.members, all(worst));
        doubts.at_most(Confidence::Medium, why);
    }
    let is_off = |share: f64| (share - 1.0).abs() > EQUAL_COST;
    let off = manifest.arms.iter().filter(|arm| arm.role.cost.is_some_and(is_off)).count();
    if off > 0 {
        let why = format!("the cost of {off} arms differs from the budget by more than 10 %");
        doubts.at_most(Confidence::Medium, why);
    }
    if manifest.design.is_none() {
        let why = "the arms are not matched: the study has no `design` for equal steps or equal cost";
        doubts.at_most(Confidence::Low, why);
    }
}
