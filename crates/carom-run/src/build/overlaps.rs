//! Bodies that overlap at the start.

use carom_case::{Case, Overlap, PrimarySpec, Problem};
use carom_mechanics::model::Model;

use super::side::{coordinates, owner};
use crate::quantity::{at_least, quantity};

/// Depth, relative to L, of round-off.
const ROUND_OFF: f64 = 1e-9;

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
        let chord = deviation(model, k, node);
        let (straight, curved) = if chord > ROUND_OFF * model.scale {
            let chord = quantity(chord, unit);
            (
                format!(", {chord} of it behind straight cells that stand for a curved side"),
                "use curved cells there, ",
            )
        } else {
            (String::new(), "")
        };
        Problem::new(
            format!("contact[{}]", case.contacts[k].entry),
            format!("the bodies of contact \"{name}\" overlap at the start by {}", quantity(depth, unit)),
            format!(
                "the node of \"{owner}\" at {place} lies {inside}{straight}; closing the overlap within one step would drive the bodies apart"
            ),
            format!(
                "move a body by at least {}, {turn}{curved}or give the contact overlap = \"relax\" or \"keep-gap\"",
                at_least(depth, unit)
            ),
        )
    };
    let found = carom_mechanics::inside(model, x, ROUND_OFF * model.scale).into_iter();
    found.filter(|(k, ..)| counts(case.contacts[*k].overlap)).map(problem).collect()
}

/// How far a node of a contact lies behind the straight facet that it faces and in front of the
/// curved side that the facet stands for.
fn deviation(model: &Model, contact: usize, node: usize) -> f64 {
    let kinematics = &model.contacts[contact].kinematics;
    let place = kinematics.secondary().iter().position(|&other| other == node);
    let height = place.and_then(|place| kinematics.roundings(&model.initial_position).get(place).copied());
    height.map_or(0.0, |height| -height)
}
