//! The contacts of a model: kinematics from the named sides, interface from law and enforcement. A
//! new contact method is one line here.

use carom_case::{
    ActiveSetRule, Case, ContactLaw, Enforcement, ForceTime, ObstacleMotion, Persistency, Problem,
};
use carom_contact::{
    BothSides, ConservingPenalty, ConservingUnilateral, ContactPoint, Detection, Kinematics, NodeToFacet,
    NodeToObstacle, Penalty, Surface, Unilateral,
};
use carom_mechanics::model::{BodyInstance, Contact, Model};

use super::obstacles::{self, Moving};
use super::side::{Side, coordinates, side};

/// The contacts of a case.
pub(super) fn contacts(
    case: &Case,
    parts: &[BodyInstance],
    obstacles: &[Moving],
    massless: &[bool],
    problems: &mut Vec<Problem>,
) -> Vec<Contact> {
    let averages = case.time.scheme.is_alpha();
    let conserves = case.time.scheme.conserves();
    let reference: Vec<f64> = parts.iter().flat_map(|part| part.body.mesh().nodes.flat()).copied().collect();
    let mut contacts = Vec::new();
    for (k, spec) in case.contacts.iter().enumerate() {
        let secondary = match side(parts, &spec.secondary, &format!("contact[{k}].secondary")) {
            Ok(side) => side,
            Err(problem) => {
                problems.push(problem);
                continue;
            }
        };
        let mut primary_part = None;
        let mut primary_facets = None;
        let mut surface = secondary.nodes.clone();
        let shape = match obstacles::shape(&spec.primary, k) {
            Ok(shape) => shape,
            Err(problem) => {
                problems.push(problem);
                continue;
            }
        };
        let obstacle = obstacles.iter().find(|obstacle| obstacle.contact == k);
        let kinematics: Box<dyn Kinematics> = match (shape, spec.primary.side()) {
            (Some(shape), _) => {
                let mut contact = NodeToObstacle::new(secondary.nodes.clone(), case.dimension, shape);
                if let Some(obstacle) = obstacle {
                    surface.extend(parts[obstacle.part].nodes());
                    contact = contact.carried_by(obstacle.carrier.clone());
                }
                Box::new(contact)
            }
            (None, name) => match side(parts, name.unwrap_or(""), &format!("contact[{k}].primary")) {
                Ok(primary) if primary.part == secondary.part => {
                    problems.push(Problem::new(
                        format!("contact[{k}].primary"),
                        format!(
                            "both sides of contact \"{}\" belong to body \"{}\"",
                            spec.name, parts[primary.part].name
                        ),
                        "self-contact is planned for a later version of Carom",
                        "give a side of another body",
                    ));
                    continue;
                }
                Ok(primary) => {
                    primary_part = Some(primary.part);
                    surface.extend(&primary.nodes);
                    let detection = match spec.detection {
                        carom_case::Detection::ClosestPoint => Detection::ClosestPoint,
                        carom_case::Detection::Trajectory => Detection::Trajectory,
                    };
                    let point = match spec.xi {
                        carom_case::ContactPoint::Closest => ContactPoint::Closest,
                        carom_case::ContactPoint::Frozen => ContactPoint::Frozen,
                    };
                    let [side, opposite] = [&primary, &secondary].map(|side| surface_of(side, parts));
                    let corners = side.corners(&reference);
                    primary_facets = Some((primary.shape, primary.facets));
                    let nodes = NodeToFacet::new(secondary.nodes.clone(), side, detection).with_point(point);
                    if corners.is_empty() || detection == Detection::Trajectory {
                        Box::new(nodes)
                    } else {
                        Box::new(BothSides::new(nodes, NodeToFacet::new(corners, opposite, detection)))
                    }
                }
                Err(problem) => {
                    problems.push(problem);
                    continue;
                }
            },
        };
        let has_mass = |nodes: &[usize]| nodes.iter().any(|n| !massless[n * case.dimension]);
        // A ball on a massless spring: the projection would stop the ball.
        let is_thrown = matches!(spec.motion, ObstacleMotion::Free { .. });
        let follows = is_thrown && !has_mass(&secondary.nodes);
        let light = |part: usize| case.bodies[part].mass.is_redistributed();
        let projects = spec.law == Some(ContactLaw::Position)
            && spec.enforcement == Enforcement::Multiplier
            && !case.time.scheme.is_static()
            && !light(secondary.part)
            && !follows
            && !primary_part.is_some_and(light);
        surface.sort_unstable();
        surface.dedup();
        let stiffnesses = || {
            kinematics
                .secondary()
                .iter()
                .map(|&node| spec.stiffness * node_stiffness(parts, node))
                .collect::<Vec<_>>()
        };
        let contact = Contact {
            name: spec.name.clone(),
            interface: match spec.enforcement {
                // With the predictor law y_{n+1} − y_n is not Δt v_½, and no force conserves moment of
                // momentum.
                Enforcement::Multiplier if conserves && spec.law == Some(ContactLaw::Position) => {
                    Box::new(ConservingUnilateral)
                }
                Enforcement::Multiplier => Box::new(Unilateral),
                Enforcement::Penalty if conserves => Box::new(ConservingPenalty::new(stiffnesses())),
                Enforcement::Penalty => Box::new(Penalty::new(stiffnesses())),
            },
            depths: if spec.enforcement == Enforcement::Multiplier { [0.01, 0.1] } else { [0.25; 2] },
            predictor: spec.law == Some(ContactLaw::Predictor),
            kinematics,
            // A mass that is thrown is a body; a prescribed obstacle is not.
            primary_part: primary_part.or(obstacle.filter(|_| is_thrown).map(|obstacle| obstacle.part)),
            facets: std::iter::once((secondary.shape, secondary.facets)).chain(primary_facets).collect(),
            surface,
            // Other schemes evaluate the contact force at the ends of their stages: nothing is
            // averaged.
            at_the_end: averages && spec.force == ForceTime::End,
            // No projection is needed with a predictor that respects the contact, with a spring, in
            // load steps, and for massless nodes that follow the other side: it would give the
            // massive side the velocity of the light one.
            projects: projects && spec.persistency == Persistency::Project,
            within: spec.active_set == ActiveSetRule::Within,
            restitution: spec.restitution,
        };
        let primary_has_mass = obstacle.is_some_and(|obstacle| parts[obstacle.part].point_mass > 0.0)
            || spec
                .primary
                .side()
                .is_some_and(|name| side(parts, name, "").is_ok_and(|s| has_mass(&s.nodes)));
        if contact.projects && !has_mass(&secondary.nodes) && !primary_has_mass {
            problems.push(Problem::new(
                format!("contact[{k}]"),
                format!("no node of contact \"{}\" has mass", spec.name),
                "persistency = \"project\" projects velocities with the mass matrix, which is zero for these nodes",
                "give this contact persistency = \"none\"",
            ));
        }
        contacts.push(contact);
    }
    contacts
}

/// A side with the rest of its body's boundary.
fn surface_of(side: &Side, parts: &[BodyInstance]) -> Surface {
    Surface::new(side.shape, &side.facets, &side.orientations).bounded_by(&side.rest(parts))
}

/// Mean over the directions of a node's diagonal of the tangent in the reference configuration.
fn node_stiffness(parts: &[BodyInstance], node: usize) -> f64 {
    let Some(part) = parts.iter().find(|part| part.nodes().contains(&node)) else { return 0.0 };
    let mesh = part.body.mesh();
    let (n, d) = (mesh.element.dofs(), mesh.dimension());
    let (mut force, mut tangent, mut sum) = (vec![0.0; n], vec![0.0; n * n], 0.0);
    for cell in 0..mesh.cell_count() {
        let Some(place) = mesh.cell(cell).iter().position(|&m| m + part.first_node == node) else { continue };
        // The reference configuration is never inverted.
        if part.body.cell_tangent(cell, mesh.nodes.flat(), &mut force, &mut tangent).is_ok() {
            sum += (place * d..(place + 1) * d).map(|i| tangent[i * n + i]).sum::<f64>() / d as f64;
        }
    }
    sum
}

/// Initial overlaps deeper than round-off: a problem per contact with the deepest point.
///
/// Closing an overlap within one step would drive the bodies apart, so it is an error.
pub fn overlaps(model: &Model) -> Vec<Problem> {
    let x = &model.initial_position;
    let problem = |(k, node, depth): (usize, usize, f64)| {
        let place = coordinates(&x[node * model.dimension..(node + 1) * model.dimension]);
        let name = &model.contacts[k].name;
        let owner = model.parts.iter().find(|part| part.nodes().contains(&node));
        let owner = owner.map_or("", |part| part.name.as_str());
        Problem::new(
            format!("contact[{k}]"),
            format!("the bodies of contact \"{name}\" overlap at the start by {depth:.6e}"),
            format!(
                "the node of \"{owner}\" at {place} lies inside the other side's body; closing the overlap within one step would drive the bodies apart"
            ),
            format!("move a body by at least {depth:.6e}"),
        )
    };
    carom_mechanics::inside(model, x, 1e-9 * model.scale).into_iter().map(problem).collect()
}
