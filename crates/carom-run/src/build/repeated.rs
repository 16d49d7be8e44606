//! Facets that face each other in two contacts: each contact would add its own force, or of gaps
//! that depend on each other the order of the contacts would decide which friction holds.

use std::collections::{BTreeMap, HashSet};

use carom_case::{Case, ContactSpec, Problem};
use carom_mechanics::model::Contact;

/// The facets of a side, by their nodes.
type Facets<'a> = HashSet<&'a [usize]>;

/// A problem for each contact in which facets face each other that do so in one before. Obstacles
/// are the same if they are written in the same way.
pub(super) fn repeated(case: &Case, contacts: &[Contact], part_of: impl Fn(usize) -> usize) -> Vec<Problem> {
    // Only contacts of the same two bodies can repeat each other.
    let mut of_bodies: BTreeMap<[Option<usize>; 2], Vec<&Contact>> = BTreeMap::new();
    for contact in contacts {
        let part = |side: usize| Some(part_of(*contact.facets.get(side)?.1.first()?.first()?));
        let mut bodies = [part(0), part(1)];
        bodies.sort_unstable();
        of_bodies.entry(bodies).or_default().push(contact);
    }
    let mut problems = Vec::new();
    for of_these in of_bodies.values().filter(|contacts| contacts.len() > 1) {
        let sides: Vec<[Facets; 2]> =
            of_these.iter().map(|contact| [0, 1].map(|number| side(contact, number))).collect();
        for later in 1..of_these.len() {
            let repeats = |&earlier: &usize| {
                let meets = |own: usize, its: usize| !sides[later][own].is_disjoint(&sides[earlier][its]);
                if sides[later][1].is_empty() {
                    let specs = [of_these[later], of_these[earlier]].map(|contact| spec(case, contact));
                    meets(0, 0) && is_alike(specs)
                } else {
                    meets(0, 0) && meets(1, 1) || meets(0, 1) && meets(1, 0)
                }
            };
            let Some(earlier) = (0..later).find(repeats) else { continue };
            let [first, name] = [earlier, later].map(|contact| &of_these[contact].name);
            let entry = spec(case, of_these[later]).map_or(0, |spec| spec.entry);
            problems.push(Problem::new(
                format!("contact[{entry}]"),
                format!("some facets face each other in contact \"{first}\" and in contact \"{name}\""),
                "their gaps are the same, and the order of the contacts would decide which friction holds",
                "give the two contacts sides without common facets, or leave one of them out",
            ));
        }
    }
    problems
}

fn spec<'a>(case: &'a Case, contact: &Contact) -> Option<&'a ContactSpec> {
    case.contacts.iter().find(|spec| spec.name == contact.name)
}

/// Whether two contacts have the same rigid obstacle, or are both of a body with itself.
fn is_alike([one, other]: [Option<&ContactSpec>; 2]) -> bool {
    one.zip(other).is_some_and(|(one, other)| {
        let both_of_sides = one.primary.side().is_some() && other.primary.side().is_some();
        both_of_sides || one.primary == other.primary && one.motion == other.motion
    })
}

/// The secondary side of a contact, number 0, or the primary one, without facets if that is rigid
/// or the same.
fn side(contact: &Contact, number: usize) -> Facets<'_> {
    let facets = contact.facets.get(number);
    facets.iter().flat_map(|(_, facets)| facets).map(Vec::as_slice).collect()
}
