//! The names in a study: those of arms, and references to them. A number in a name may be written
//! in any way: `hht, Δt 0.005` is the arm `hht, Δt 5e-3`.

use carom_record::study::Comparison;
use carom_run::case::Problem;

use crate::arms::Draft;
use crate::file::{self, StudyFile};

/// Gives the arms that are named with other spellings of their numbers the names that they have.
pub(crate) fn resolve(file: &mut StudyFile, drafts: &[Draft]) {
    let names: Vec<&str> = drafts.iter().map(|draft| draft.name.as_str()).collect();
    let own = |given: &mut String| {
        if let Some(name) = meant(given, &names) {
            name.clone_into(given);
        }
    };
    file.reference.iter_mut().for_each(own);
    let quoted = file.claims.iter_mut().map(|claim| &mut claim.compare);
    let quoted = quoted.chain(file.expects.iter_mut().flat_map(|expect| {
        std::iter::once(&mut expect.what).chain(expect.order.iter_mut().map(|order| &mut order.of))
    }));
    for text in quoted {
        for quote in ['"', '\''] {
            let named = |(k, part): (usize, &str)| match meant(part, &names) {
                Some(name) if k % 2 == 1 => name.to_owned(),
                _ => part.to_owned(),
            };
            let parts: Vec<String> = text.split(quote).enumerate().map(named).collect();
            *text = parts.join(&quote.to_string());
        }
    }
}

/// The name that has the same words and numbers; none if the given one is a name.
fn meant<'a>(given: &str, names: &[&'a str]) -> Option<&'a str> {
    if names.contains(&given) {
        return None;
    }
    let given = with_plain_numbers(given);
    names.iter().copied().find(|name| with_plain_numbers(name) == given)
}

/// A name with its numbers in one notation. Digits within words, as in `TR-BDF2`, are not numbers.
fn with_plain_numbers(name: &str) -> String {
    let plain = |word: &str| {
        let (word, end) = word.split_at(word.trim_end_matches([',', ';', ')']).len());
        let start = word.len() - word.trim_start_matches(['(', '=']).len();
        let start = word.rfind('=').map_or(start, |at| at + 1);
        let number = word[start..].parse().map(|x: f64| format!("{x:e}"));
        format!("{}{}{end}", &word[..start], number.as_deref().unwrap_or(&word[start..]))
    };
    name.split(' ').map(plain).collect::<Vec<_>>().join(" ")
}

/// Names in quotes, with commas between them.
pub(crate) fn quoted<'a>(names: impl Iterator<Item = &'a str>) -> String {
    names.map(|name| format!("\"{name}\"")).collect::<Vec<_>>().join(", ")
}

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
        let methods = quoted(file.arms.iter().map(|arm| arm.name.as_str()));
        let why = format!("the methods are: {methods}");
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
    let known = || format!("the arms are: {}", quoted(drafts.iter().map(|draft| draft.name.as_str())));
    let exists = |name: &str| drafts.iter().any(|d| d.name == name);
    if let Some(reference) =
        file.reference.as_deref().filter(|name| !["exact", file::FINE_NAME].contains(name) && !exists(name))
    {
        let what = format!("the reference \"{reference}\" is not an arm");
        problems.push(Problem::new(
            "reference",
            what,
            known(),
            "use one of them, \"exact\", or \"fine\" for a computed reference",
        ));
    }
    for (i, claim) in file.claims.iter().enumerate() {
        let path = format!("claim[{i}].compare");
        match Comparison::parse(&claim.compare) {
            Ok(comparison) => {
                let is_computed =
                    |arm: &str| file.reference.as_deref() == Some(arm) && arm == file::FINE_NAME;
                for arm in comparison.arms().into_iter().filter(|arm| !exists(arm) && !is_computed(arm)) {
                    let what = format!("no arm is named \"{arm}\"");
                    problems.push(Problem::new(&path, what, known(), "use one of them"));
                }
            }
            Err(why) => {
                let help = "write for example 'restitution of \"ARM\" > 1.1 * restitution of \"ARM\"'";
                problems.push(Problem::new(&path, "this is not a valid comparison", why, help));
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_spelt_in_any_way() {
        let names = ["hht, Δt 5e-3", "TR-BDF2 (rho=0.5), cost of Δt 2.5e-3", "time.step=0.001, n=4"];
        let cases = [
            ("hht, Δt 0.005", Some(names[0])),
            ("TR-BDF2 (rho=.50), cost of Δt 0.0025", Some(names[1])),
            ("time.step=1e-3, n=4", Some(names[2])),
            ("hht, Δt 5e-4", None),
            ("hht,  Δt 0.005", None),
            (names[0], None),
        ];
        for (given, meant_name) in cases {
            assert_eq!(meant(given, &names), meant_name, "{given}");
        }
    }

    #[test]
    fn claims_name_the_arms_as_they_are() {
        let mut file = StudyFile {
            claims: vec![file::ClaimKeys {
                text: String::new(),
                compare: "restitution of 'hht, Δt 0.005' > 2 * restitution of \"hht, Δt 0.0025\"".into(),
            }],
            ..StudyFile::default()
        };
        let draft = |name: &str| Draft { name: name.into(), ..Draft::default() };
        resolve(&mut file, &[draft("hht, Δt 5e-3"), draft("hht, Δt 2.5e-3")]);
        let compare = "restitution of 'hht, Δt 5e-3' > 2 * restitution of \"hht, Δt 2.5e-3\"";
        assert_eq!(file.claims[0].compare, compare);
    }
}
