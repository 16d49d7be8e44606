//! Bodies that overlap at the start.

use carom_case::{Case, Overlap, PrimarySpec, Problem};
use carom_mechanics::DeepPlace;
use carom_mechanics::model::{BodyInstance, Model};

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
    let problem = |found: DeepPlace| {
        let DeepPlace { contact: k, node, depth, is_mean } = found;
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
        let what =
            format!("the bodies of contact \"{name}\" overlap at the start by {}", quantity(depth, unit));
        let by = at_least(depth, unit);
        if is_mean {
            return Problem::new(
                format!("contact[{}]", case.contacts[k].entry),
                what,
                format!(
                    "near {place} the side of \"{owner}\" lies {inside} on average, between nodes that lie on it; closing the overlap within one step would drive the bodies apart"
                ),
                format!(
                    "give the contact overlap = \"touch\", with which the sides touch as they are, move a body by at least {by}, or use smaller cells there"
                ),
            );
        }
        let instead = match case.contacts[k].overlap {
            Overlap::Refuse => "give the contact overlap = \"relax\" or \"keep-gap\"",
            Overlap::Relax | Overlap::KeepGap | Overlap::Touch => "name the sides that overlap",
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
            what,
            format!(
                "the node of \"{owner}\" at {place} lies {inside}{straight}; closing the overlap within one step would drive the bodies apart"
            ),
            format!("move a body by at least {by}, {turn}{curved}or {instead}"),
        )
    };
    let mut found = carom_mechanics::inside(model, x, ROUND_OFF * model.scale);
    found.retain(|place| counts(case.contacts[place.contact].overlap));
    let is_known = |contact: usize| found.iter().any(|place| place.contact == contact);
    let others = (0..case.contacts.len()).filter(|&k| counts(case.contacts[k].overlap) && !is_known(k));
    let at_one_place: Vec<Problem> = others.filter_map(|k| at_one_place(case, model, k)).collect();
    found.into_iter().map(problem).chain(at_one_place).collect()
}

/// Bodies one of which has a cell in the other one, although no node of their sides is inside: as
/// where a body is given twice.
fn at_one_place(case: &Case, model: &Model, contact: usize) -> Option<Problem> {
    let names: Vec<&str> = case.contacts[contact].bodies().collect();
    let [a, b] = names[..] else { return None };
    let part = |name: &str| model.parts.iter().find(|part| part.name == name && !part.is_rigid());
    let [one, other] = [part(a)?, part(b)?];
    let stays = |part: &BodyInstance| part.of(&model.initial_position) == part.of(&model.reference);
    if a == b || !stays(one) || !stays(other) {
        return None;
    }
    let holds = |outer: &BodyInstance, inner: &BodyInstance| {
        let center = middle_of_first_cell(inner);
        let is_near = (0..model.dimension).all(|i| {
            let along = || outer.body.mesh().nodes.iter().map(|node| node[i]);
            along().fold(f64::INFINITY, f64::min) <= center[i]
                && center[i] <= along().fold(-f64::INFINITY, f64::max)
        });
        (is_near && !outer.body.locate(&center).is_empty()).then_some(center)
    };
    let place = holds(one, other).or_else(|| holds(other, one))?;
    Some(Problem::new(
        format!("contact[{}]", case.contacts[contact].entry),
        format!("the bodies of contact \"{}\" overlap at the start", model.contacts[contact].name),
        format!("both \"{a}\" and \"{b}\" are at {}", coordinates(&place)),
        "move a body, or remove the one that is given twice".to_owned(),
    ))
}

fn middle_of_first_cell(part: &BodyInstance) -> Vec<f64> {
    let mesh = part.body.mesh();
    let nodes = mesh.cell(0);
    let d = mesh.dimension();
    let all = part.body.reference_nodes();
    let xi: Vec<f64> =
        (0..d).map(|i| all.iter().map(|node| node[i]).sum::<f64>() / all.len() as f64).collect();
    let mut shares = vec![0.0; nodes.len()];
    part.body.shape(&xi, &mut shares);
    let along = |i: usize| nodes.iter().zip(&shares).map(|(node, share)| share * mesh.nodes[*node][i]).sum();
    (0..d).map(along).collect()
}

/// How far a node of a contact lies behind the straight facet that it faces and in front of the
/// curved side that the facet stands for.
fn deviation(model: &Model, contact: usize, node: usize) -> f64 {
    let kinematics = &model.contacts[contact].kinematics;
    let place = kinematics.secondary().iter().position(|&other| other == node);
    let height = place.and_then(|place| kinematics.roundings(&model.initial_position).get(place).copied());
    height.map_or(0.0, |height| -height)
}
