//! Facets that face each other in two contacts: each contact would add its own force, or of gaps
//! that depend on each other the order of the contacts would decide which law holds.

use std::collections::HashSet;

use carom_case::{Case, Problem};
use carom_mechanics::model::Contact;

/// The facets of a side, by their nodes.
type Facets<'a> = HashSet<&'a [usize]>;

/// A problem for each contact in which facets face each other that do so in one before.
pub(super) fn repeated(case: &Case, contacts: &[Contact]) -> Vec<Problem> {
    if contacts.len() < 2 {
        return Vec::new();
    }
    let sides: Vec<[Facets; 2]> = contacts.iter().map(|of| [0, 1].map(|number| side(of, number))).collect();
    let primary = |contact: &Contact| {
        let spec = case.contacts.iter().find(|spec| spec.name == contact.name);
        spec.map(|spec| &spec.primary)
    };
    let repeats = |one: usize, other: usize| {
        let meets = |own: usize, its: usize| !sides[one][own].is_disjoint(&sides[other][its]);
        let rigid = [one, other].map(|contact| sides[contact][1].is_empty());
        match rigid {
            [false, false] => meets(0, 0) && meets(1, 1) || meets(0, 1) && meets(1, 0),
            [true, true] => meets(0, 0) && primary(&contacts[one]) == primary(&contacts[other]),
            _ => false,
        }
    };
    let mut problems = Vec::new();
    for later in (1..contacts.len()).filter(|&contact| !contacts[contact].itself) {
        let Some(earlier) = (0..later).find(|&earlier| !contacts[earlier].itself && repeats(earlier, later))
        else {
            continue;
        };
        let [first, name] = [earlier, later].map(|contact| &contacts[contact].name);
        let entry = case.contacts.iter().find(|spec| spec.name == *name).map_or(0, |spec| spec.entry);
        problems.push(Problem::new(
            format!("contact[{entry}]"),
            format!("some facets face each other in contact \"{first}\" and in contact \"{name}\""),
            "each of the two would add its own force there, and their order would decide which friction holds",
            "give the two contacts sides without common facets, or leave one of them out",
        ));
    }
    problems
}

/// The secondary side of a contact, number 0, or the primary one, without facets if that is rigid.
fn side(contact: &Contact, number: usize) -> Facets<'_> {
    let facets = contact.facets.get(number);
    facets.iter().flat_map(|(_, facets)| facets).map(Vec::as_slice).collect()
}
