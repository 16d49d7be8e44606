//! The recommendation that follows from a ranking, with its confidence, or why there is none.
//!
//! ```text
//! accurate      `accuracy` given: e + U ≤ accuracy;   otherwise: the error is at most 5 % larger than that of the
//!               most accurate arm, or at most half larger and not distinguished from it
//! candidates    accurate, and no arm has a smaller error at no more cost
//! recommended   of the candidates within 10 % of the lowest cost, the one with the smallest error
//! ```

use super::design::Goal;
use super::digits::short;
use super::measure::Measured;
use super::ranked::{Apart, Ranked};
use super::row::Row;

/// Factor within which counted costs are equal.
const EQUAL_COST: f64 = 1.1;
/// Factor within which errors are equal.
const EQUAL_ERROR: f64 = 1.05;
/// Required accuracy of the goal `cost`, unless it is given.
const ACCURACY: f64 = 0.05;
/// Factor by which an error is clearly smaller than that of another arm.
const CLEAR: f64 = 1.5;

/// Confidence in a recommendation.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Confidence {
    /// Another arm of the same cost may be as good.
    Low,
    /// The arm is the best of its cost in this study.
    Medium,
    /// No arm of its cost has a smaller error, up to 5 %, whatever the solution within the
    /// uncertainty of the reference, over an ensemble.
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

/// The recommendation.
#[derive(Clone, Debug, PartialEq)]
pub struct Verdict {
    /// Number of the recommended arm.
    pub arm: usize,
    /// Arms of other methods that are tied with it, by name: they cost no more, and are not
    /// distinguished from it or within 5 % of its error.
    pub alike: Vec<String>,
    /// Reasons for the recommendation.
    pub reasons: Vec<String>,
    /// Confidence in the recommendation.
    pub confidence: Confidence,
    /// Reasons for the confidence.
    pub confidence_reasons: Vec<String>,
}

/// The ranked arms of a study, of all levels.
pub(super) struct Field<'a> {
    pub(super) goal: Goal,
    pub(super) rows: &'a [Row],
    pub(super) measured: &'a Measured<'a>,
    pub(super) apart: &'a [Apart],
    pub(super) ranked: Vec<&'a Ranked>,
}

impl<'a> Field<'a> {
    fn name(&self, ranked: &Ranked) -> &'a str {
        &self.measured.manifest.arms[ranked.arm].name
    }

    /// The arm with the least value, of equal ones the first by name.
    fn least(&self, arms: impl Iterator<Item = &'a Ranked>, value: fn(&Ranked) -> f64) -> Option<&'a Ranked> {
        arms.min_by(|a, b| value(a).total_cmp(&value(b)).then_with(|| self.name(a).cmp(self.name(b))))
    }

    /// The accuracy that an arm must have, if one is required.
    fn required(&self) -> Option<f64> {
        let least_work = (self.goal == Goal::Cost).then_some(ACCURACY);
        self.measured.manifest.accuracy.or(least_work)
    }

    /// Whether no arm has a smaller error at no more cost.
    fn is_on_front(&self, ranked: &Ranked) -> bool {
        let beats = |other: &&Ranked| {
            let is_as_good = other.error <= ranked.error && other.cost <= ranked.cost;
            is_as_good && (other.error < ranked.error || other.cost < ranked.cost)
        };
        !self.ranked.iter().any(beats)
    }

    /// Arms of other methods that cost no more than an arm, up to what counts as equal.
    fn rivals(&self, chosen: &'a Ranked) -> impl Iterator<Item = &'a Ranked> {
        let method = |ranked: &Ranked| self.measured.manifest.arms[ranked.arm].method();
        let is_rival = move |r: &Ranked| {
            let is_other = method(r) != method(chosen) && !self.rows[r.arm].is_twin(&self.rows[chosen.arm]);
            is_other && r.cost <= EQUAL_COST * chosen.cost
        };
        self.ranked.iter().copied().filter(move |r| is_rival(r))
    }
}

/// Error of an arm with its interval, in words.
fn known(ranked: &Ranked) -> String {
    let [low, high] = ranked.interval;
    format!("{} ({} to {})", short(ranked.error), short(low), short(high))
}

/// The recommendation, or the reasons why there is none.
pub(super) fn recommended(field: &Field) -> Result<Verdict, Vec<String>> {
    let all = || field.ranked.iter().copied();
    let Some(best) = field.least(all(), |r| r.error) else {
        let apart =
            |apart: &Apart| format!("{}: {}", field.measured.manifest.arms[apart.arm].name, apart.why);
        let nothing = format!("no arm has a value for: {}", field.measured.measure.words);
        return Err(std::iter::once(nothing).chain(field.apart.iter().map(apart)).collect());
    };
    let required = field.required();
    let is_accurate = |r: &&Ranked| {
        if let Some(accuracy) = required {
            return r.interval[1] <= accuracy;
        }
        let is_alike = r.error <= CLEAR * best.error && !field.measured.is_better(best.arm, r.arm);
        is_alike || r.error <= EQUAL_ERROR * best.error
    };
    let candidates = || all().filter(|r| is_accurate(r) && field.is_on_front(r));
    let Some(cheapest) = field.least(candidates(), |r| r.cost) else {
        let accuracy = required.unwrap_or_default();
        let uncertainty = field.measured.measure.uncertainty;
        let mut reasons = vec![format!(
            "no arm has the required accuracy, {accuracy}, with the uncertainty included; the best one, {}, has \
             an error of {}",
            field.name(best),
            known(best)
        )];
        if uncertainty > accuracy {
            reasons.push(format!(
                "no arm can have it: the uncertainty of the reference alone is {}; refine the reference, or \
                 require less",
                short(uncertainty)
            ));
        }
        return Err(reasons);
    };
    let affordable = candidates().filter(|r| r.cost <= EQUAL_COST * cheapest.cost);
    let chosen = field.least(affordable, |r| r.error).unwrap_or(cheapest);
    let mut alike: Vec<&str> = field
        .rivals(chosen)
        .filter(|r| !field.measured.is_better(chosen.arm, r.arm) || r.error <= EQUAL_ERROR * chosen.error)
        .filter(|r| required.is_none() || is_accurate(r))
        .map(|r| field.name(r))
        .collect();
    alike.sort_unstable();
    let (confidence, confidence_reasons) = confidence(field, chosen);
    Ok(Verdict {
        arm: chosen.arm,
        alike: alike.into_iter().map(str::to_owned).collect(),
        reasons: reasons(field, chosen, best),
        confidence,
        confidence_reasons,
    })
}

fn reasons(field: &Field, chosen: &Ranked, best: &Ranked) -> Vec<String> {
    let mut reasons = vec![format!("{}: {}", field.measured.measure.words, known(chosen))];
    reasons.push(match field.required() {
        Some(accuracy) => {
            format!("smallest error of the arms within 10 % of the lowest cost, of those with an error of at most {accuracy}, its uncertainty included")
        }
        None if best.arm == chosen.arm => "no ranked arm has a smaller error".to_owned(),
        None => format!(
            "smallest error of the arms within 10 % of the lowest cost, of those that are as accurate as the most accurate one, up to 5 %, or half less accurate and not distinguished from it, {}: {}",
            field.name(best),
            known(best)
        ),
    });
    reasons.push("no ranked arm has a smaller error at no more cost".to_owned());
    if !field.measured.measure.left_out.is_empty() {
        let left_out = field.measured.measure.left_out.join("; ");
        reasons.push(format!("not established by the reference, and left out: {left_out}"));
    }
    reasons
}

/// Confidence that no other method is better at the cost of an arm, with the reasons that lower it.
fn confidence<'a>(field: &Field<'a>, chosen: &'a Ranked) -> (Confidence, Vec<String>) {
    let mut confidence = Confidence::High;
    let mut reasons = Vec::new();
    let mut at_most = |most: Confidence, why: String| {
        confidence = confidence.min(most);
        reasons.push(why);
    };
    if field.rivals(chosen).next().is_none() {
        at_most(Confidence::Medium, "no other method with other results was run at this cost".to_owned());
    }
    let is_settled = |r: &Ranked| {
        let is_same = || field.measured.is_within(EQUAL_ERROR - 1.0, chosen.arm, r.arm);
        field.measured.is_better(chosen.arm, r.arm) || is_same()
    };
    let open = field.rivals(chosen).filter(|r| !is_settled(r));
    if let Some(next) = field.least(open, |r| r.error) {
        at_most(Confidence::Low, format!("not distinguished from {}: {}", field.name(next), known(next)));
    }
    if let Some(accuracy) = field.required() {
        let cheaper = field.ranked.iter().filter(|r| EQUAL_COST * r.cost < chosen.cost);
        let open = field.least(cheaper.copied().filter(|r| r.interval[0] <= accuracy), |r| r.cost);
        if let Some(open) = open {
            let why =
                format!("{}, which costs less, may have the accuracy too: {}", field.name(open), known(open));
            at_most(Confidence::Medium, why);
        }
    }
    let runs_of = |ranked: &Ranked| field.measured.manifest.runs_of(ranked.arm);
    if field.ranked.iter().any(|ranked| runs_of(ranked).len() == 1) {
        let why = "there are arms with the value of a single run, so that chance cannot be distinguished from the \
                   method; [ensemble] runs every arm with several phases, roles and meshes";
        at_most(Confidence::Medium, why.to_owned());
    }
    if reasons.is_empty() {
        let why = "whatever the solution within the uncertainty of the reference, no other method at its cost \
                   has a smaller error, up to 5 %";
        reasons.push(why.to_owned());
    }
    (confidence, reasons)
}
