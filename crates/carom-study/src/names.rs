//! The names in a study: those of arms, and references to them.

use carom_record::study::Comparison;
use carom_run::case::Problem;

use crate::arms::Draft;
use crate::file::{self, StudyFile};

/// Checks the names of arms: that there are some, that they are unique, and that references to them
/// exist.
pub(crate) fn check(file: &StudyFile, drafts: &[Draft], problems: &mut Vec<Problem>) {
    if drafts.is_empty() {
        problems.push(Problem::new(
            "",
            "the study has no arms",
            "there is nothing to compare",
            "add an [[arm]] or a [grid]",
        ));
    }
    for (i, draft) in drafts.iter().enumerate() {
        if drafts[..i].iter().any(|d| d.name == draft.name) {
            let what = format!("two arms are named \"{}\"", draft.name);
            let path = if draft.path == "grid" { draft.path.clone() } else { format!("{}.name", draft.path) };
            problems.push(Problem::new(
                path,
                what,
                "tables, figures and claims identify arms by name",
                "rename one of them",
            ));
        }
    }
    if let Some(name) = &file.cost_of
        && !drafts.iter().any(|d| d.role.method.as_ref() == Some(name))
    {
        let methods: Vec<_> = file.arms.iter().map(|a| format!("\"{}\"", a.name)).collect();
        let why = format!("the methods are: {}", methods.join(", "));
        problems.push(Problem::new(
            "cost_of",
            format!("no method is named \"{name}\""),
            why,
            "use one of them",
        ));
    }
    let cost_of = file.cost_of.as_ref();
    for (i, arm) in file.arms.iter().enumerate().filter(|(_, arm)| arm.by_cost && Some(&arm.name) == cost_of)
    {
        let what = format!("\"{}\" cannot match its own cost", arm.name);
        let why = "`match = \"cost\"` matches the cost of the arm `cost_of`, and this is that arm";
        let help = "give another arm in `cost_of`, or leave `match` out";
        problems.push(Problem::new(format!("arm[{i}].match"), what, why, help));
    }
    let known = || drafts.iter().map(|d| format!("\"{}\"", d.name)).collect::<Vec<_>>().join(", ");
    let exists = |name: &str| drafts.iter().any(|d| d.name == name);
    if let Some(reference) =
        file.reference.as_deref().filter(|name| !["exact", file::FINE_NAME].contains(name) && !exists(name))
    {
        let what = format!("the reference \"{reference}\" is not an arm");
        problems.push(Problem::new(
            "reference",
            what,
            format!("the arms are: {}", known()),
            "use one of them, \"exact\", or \"fine\" for a computed reference",
        ));
    }
    for (i, claim) in file.claims.iter().enumerate() {
        let path = format!("claim[{i}].compare");
        match Comparison::parse(&claim.compare) {
            Ok(comparison) => {
                for arm in comparison.arms().into_iter().filter(|arm| !exists(arm)) {
                    let what = format!("no arm is named \"{arm}\"");
                    problems.push(Problem::new(
                        &path,
                        what,
                        format!("the arms are: {}", known()),
                        "use one of them",
                    ));
                }
            }
            Err(why) => {
                let help = "write for example 'restitution of \"ARM\" > 1.1 * restitution of \"ARM\"'";
                problems.push(Problem::new(&path, "this is not a valid comparison", why, help));
            }
        }
    }
}
