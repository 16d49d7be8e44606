//! Checks that the records of a study will contain what its goal compares.

use std::collections::BTreeSet;

use carom_record::body_of;
use carom_record::study::design::Goal;
use carom_record::study::groups::{is_stress, is_trajectory};
use carom_run::case::{Case, ContactSpec, Problem, history_columns};

use crate::file::StudyFile;
use crate::resolved::Planned;

/// Columns that a goal compares: a test of the name of a column, and what is missing without one.
struct Compared {
    is_column: fn(&str) -> bool,
    missing: &'static str,
    help: &'static str,
}

/// The columns that a goal compares; none if every record has it.
fn compared(goal: Goal) -> Option<Compared> {
    let of = |is_column, missing, help| Some(Compared { is_column, missing, help });
    match goal {
        Goal::Stress => of(
            is_stress,
            "no probe records a stress",
            "add a [[probe]] with a stress in `record`, for example \"von_mises\", or choose another goal",
        ),
        Goal::Force => of(
            |column| column.starts_with("contact_force_"),
            "there is no contact",
            "add a [[contact]], or choose another goal",
        ),
        Goal::Friction => of(
            |column| column == "slip",
            "no contact has friction",
            "give a contact a coefficient `mu`, or choose another goal",
        ),
        Goal::Trajectory | Goal::Cost | Goal::Energy => None,
    }
}

/// Whether the forces of all contacts are those on one party: there is one contact, or one body
/// meets rigid obstacles.
fn counts_as_one(case: &Case) -> bool {
    let body = |contact: &ContactSpec| body_of(&contact.secondary).to_owned();
    let bodies: BTreeSet<String> = case.contacts.iter().map(body).collect();
    let is_obstacle = |contact: &ContactSpec| contact.primary.side().is_none();
    case.contacts.len() < 2 || bodies.len() == 1 && case.contacts.iter().all(is_obstacle)
}

/// Adds the problem that an arm, or the exact solution, has nothing that the goal compares.
pub(crate) fn check(file: &StudyFile, arms: &[Planned], problems: &mut Vec<Problem>) {
    let Some(goal) = file.goal else { return };
    let has_motion = |arm: &Planned| arm.case.exact.keys().any(|column| is_trajectory(column));
    let is_of_motion = matches!(goal, Goal::Trajectory | Goal::Cost);
    if is_of_motion && file.reference.as_deref() == Some("exact") && !arms.first().is_some_and(has_motion) {
        let what = format!("the exact solution has nothing that the goal `{}` compares", goal.word());
        let why = "[exact] has no displacement and no centre of a body";
        let help = "add a formula for one to [exact] of the case, or write `reference = \"fine\"`";
        problems.push(Problem::new("reference", what, why, help));
    }
    let Some(Compared { is_column, missing, help }) = compared(goal) else { return };
    let is_recorded = |case: &Case| {
        let has_contact = goal != Goal::Force || !case.contacts.is_empty();
        has_contact && history_columns(case).iter().any(|column| is_column(&column.name))
    };
    let what = format!("nothing is recorded that the goal `{}` compares", goal.word());
    if let Some(arm) = arms.iter().find(|arm| !is_recorded(&arm.case)) {
        let name = &arm.draft.name;
        problems.push(Problem::new("goal", what, format!("{missing} in the case of \"{name}\""), help));
        return;
    }
    let is_exact = file.reference.as_deref() == Some("exact") && goal != Goal::Friction;
    let Some(Planned { case, .. }) = arms.first().filter(|_| is_exact) else { return };
    // The sum over several contacts would depend on which sides are secondary.
    let has_sum = goal != Goal::Force || counts_as_one(case);
    let of_contact = |column: &str| {
        let names = case.contacts.iter().map(|contact| contact.name.as_str());
        names.filter_map(|name| column.strip_prefix(name)).any(|rest| rest.starts_with(".force_"))
    };
    let is_compared = |column: &String| if has_sum { is_column(column) } else { of_contact(column) };
    if !case.exact.keys().any(is_compared) {
        let what = format!("the exact solution has nothing that the goal `{}` compares", goal.word());
        let help = "add a formula for it to [exact] of the case, or write `reference = \"fine\"`";
        let why = if has_sum {
            "[exact] has no such column"
        } else {
            "[exact] has no force of one of the contacts, such as CONTACT.force_x"
        };
        problems.push(Problem::new("reference", what, why, help));
        return;
    }
    if file.window.is_none() {
        let what = format!("the goal `{}` beside an exact reference needs `window`", goal.word());
        let why = "forces and stresses are compared after averaging, and formulas have no contact interval to \
                   take the time from";
        problems.push(Problem::new("reference", what, why, "write for example `window = 0.01`"));
    }
    if !has_sum {
        return;
    }
    let has = |name: &str, axis: &str| case.exact.contains_key(&format!("contact_{name}_{axis}"));
    let unpaired = ["x", "y", "z"].into_iter().find(|axis| has("force", axis) != has("impulse", axis));
    if let Some(axis) = unpaired.filter(|_| goal == Goal::Force) {
        let missing = if has("force", axis) { "impulse" } else { "force" };
        let what = format!("[exact] has no `contact_{missing}_{axis}`");
        let why = "the goal `force` compares forces averaged by their impulses, and needs both columns";
        problems.push(Problem::new("reference", what, why, "add its formula to [exact] of the case"));
    }
}
