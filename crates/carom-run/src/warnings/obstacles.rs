//! Warning about bodies inside a rigid obstacle at the start. Contact acts on one side of a body,
//! whose nodes may lie on the surface, so that nothing overlaps where contact is found.

use carom_case::{Case, PrimarySpec};
use carom_mechanics::model::Model;

use super::found::Found;
use crate::build::side::owner;

/// Depth, relative to L, of round-off.
const ROUND_OFF: f64 = 1e-9;

/// A body without a node on the free side of its obstacle.
pub(super) fn inside_obstacle(case: &Case, model: &Model) -> Vec<Found> {
    // The other run has moved its bodies.
    if case.initial.is_some() {
        return Vec::new();
    }
    let y = &model.initial_position;
    let mut found = Vec::new();
    for (contact, spec) in model.contacts.iter().zip(&case.contacts) {
        let kinematics = &contact.kinematics;
        let Some(&first) = kinematics.secondary().first() else { continue };
        let Some(part) = owner(&model.parts, first) else { continue };
        let nodes = part.first_node..part.first_node + part.body.mesh().nodes.len();
        let count = nodes.len();
        let distances: Vec<f64> = nodes.filter_map(|node| kinematics.distance_to_obstacle(node, y)).collect();
        let round_off = ROUND_OFF * model.scale;
        let inside = distances.iter().filter(|distance| **distance < -round_off).count();
        if inside == 0 || distances.iter().any(|distance| *distance > round_off) {
            continue;
        }
        let what = format!("{inside} of {count} nodes of body \"{}\" are inside the obstacle", part.name);
        let advice = match &spec.primary {
            PrimarySpec::Plane { .. } => "the opposite normal of the plane",
            PrimarySpec::Polyline { .. } => "the points of the polyline in the opposite order",
            PrimarySpec::Surface(_) => "the other `reverse` of the surface",
            PrimarySpec::Circle { .. } => "the other `inside` of the circle",
            _ => "another place of the body or the obstacle",
        };
        found.push(Found::of_contact(&spec.name, what).with_advice(advice.to_owned()));
    }
    found
}
