//! Bodies that overlap at the start.

use carom_case::{Case, Overlap, PrimarySpec, Problem};
use carom_mechanics::model::Model;

use super::side::{coordinates, owner};
use crate::quantity::{at_least, quantity};

/// Initial overlaps of the bodies of a case deeper than round-off, in contacts whose treatment of
/// an overlap `counts`: a problem per contact with the deepest point.
///
/// Closing an overlap within one step would drive the bodies apart, so it is an error.
pub(crate) fn overlaps(case: &Case, model: &Model, counts: impl Fn(Overlap) -> bool) -> Vec<Problem> {
    let x = &model.initial_position;
    let unit = &case.units.length;
    let problem = |(k, node, depth): (usize, usize, f64)| {
        let place = coordinates(&x[node * model.dimension..(node + 1) * model.dimension]);
        let name = &model.contacts[k].name;
        let owner = owner(&model.parts, node).map_or("", |part| part.name.as_str());
        let (inside, turn) = match &case.contacts[k].primary {
            PrimarySpec::Plane { .. } => ("behind the rigid plane", "reverse its normal, "),
            PrimarySpec::Polyline { .. } => {
                ("to the left of the polyline, which is rigid", "reverse the order of its points, ")
            }
            PrimarySpec::Surface(_) => ("behind the rigid surface", "give the surface the other `reverse`, "),
            _ => ("inside the other side's body", ""),
        };
        Problem::new(
            format!("contact[{}]", case.contacts[k].entry),
            format!("the bodies of contact \"{name}\" overlap at the start by {}", quantity(depth, unit)),
            format!(
                "the node of \"{owner}\" at {place} lies {inside}; closing the overlap within one step would drive the bodies apart"
            ),
            format!(
                "move a body by at least {}, {turn}or give the contact overlap = \"relax\" or \"keep-gap\"",
                at_least(depth, unit)
            ),
        )
    };
    let found = carom_mechanics::inside(model, x, 1e-9 * model.scale).into_iter();
    found.filter(|(k, ..)| counts(case.contacts[*k].overlap)).map(problem).collect()
}
