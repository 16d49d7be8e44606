//! Checks that the runs of a study with a goal can be compared: they end together, no step that is
//! given for one of them is ignored, and an exact reference has formulas.

use carom_record::study::design::Kind;
use carom_run::case::Problem;
use toml_edit::Value;

use crate::file::StudyFile;
use crate::resolved::Planned;

/// Adds the problems of a study with a goal; `planned` are the arms and the runs of
/// the computed reference.
pub(crate) fn check(file: &StudyFile, planned: &[Planned], problems: &mut Vec<Problem>) {
    if let Some(key) = [("reference", file.reference.is_some()), ("overlay", !file.overlays.is_empty())]
        .into_iter()
        .find_map(|(key, is_given)| is_given.then_some(key))
    {
        units(key, planned, problems);
    }
    let has_formulas = planned.iter().any(|arm| !arm.case.exact.is_empty());
    if file.reference.as_deref() == Some("exact") && !has_formulas {
        let why = "`reference = \"exact\"` compares with the formulas of [exact] in the case";
        let help = "add [exact] to the case, or write `reference = \"fine\"`";
        problems.push(Problem::new("reference", "the case has no exact solution", why, help));
    }
    if file.goal.is_some() {
        ends(planned, problems);
        ignored_steps(file, problems);
    }
}

/// A reference, exact formulas and measured data are in one system of units.
fn units(key: &str, planned: &[Planned], problems: &mut Vec<Problem>) {
    let system = |arm: &Planned| {
        [&arm.case.units.length, &arm.case.units.time, &arm.case.units.mass].map(Clone::clone)
    };
    let Some(first) = planned.first() else { return };
    if let Some(other) = planned.iter().find(|arm| system(arm) != system(first)) {
        let what = format!("\"{}\" has other units than \"{}\"", other.draft.name, first.draft.name);
        let why = "a reference, or measured data, and all arms that are compared with it need the same units";
        problems.push(Problem::new(key, what, why, "give all of them the same [units]"));
    }
}

/// Runs of different lengths differ by what happens in the rest, and in cost.
fn ends(planned: &[Planned], problems: &mut Vec<Problem>) {
    let Some(Planned { draft: first, case, .. }) = planned.first() else { return };
    let differs = |other: &&Planned| {
        let step = case.time.step.max(other.case.time.step);
        (other.case.time.end - case.time.end).abs() > step
    };
    if let Some(Planned { draft, case: other, .. }) = planned.iter().find(differs) {
        let what = format!(
            "\"{}\" ends at {}, and \"{}\" at {}",
            draft.name, other.time.end, first.name, case.time.end
        );
        let why = "errors and costs of runs are compared over the same time";
        let path = if draft.role.fine { "fine" } else { draft.path.as_str() };
        problems.push(Problem::new(path, what, why, "give all of them the same `time.end`"));
    }
}

/// Steps of methods and of the computed reference follow from `steps`.
fn ignored_steps(file: &StudyFile, problems: &mut Vec<Problem>) {
    let is_step = |(key, _): &(String, Value)| key == "time.step";
    if file.fine.set.iter().any(is_step) {
        let why = "the steps of the computed reference follow from those of the arms and from `refine`";
        problems.push(Problem::new(
            "fine.set.\"time.step\"",
            "[fine] cannot set `time.step`",
            why,
            "leave it out, or change `refine` of [fine]",
        ));
    }
    if file.steps.is_empty() || file.design == Some(Kind::MatchedCost) {
        return;
    }
    for (i, arm) in file.arms.iter().enumerate().filter(|(_, arm)| !arm.by_cost) {
        if arm.set.iter().any(is_step) {
            let why = "every method is run at each of the `steps` of the study";
            let help = "leave it out, write `match = \"cost\"`, or leave out `steps`";
            let what = format!("the step of \"{}\" would be ignored", arm.name);
            problems.push(Problem::new(format!("arm[{i}].set.\"time.step\""), what, why, help));
        }
    }
}
