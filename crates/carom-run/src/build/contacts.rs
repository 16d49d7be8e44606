//! The contacts of a model: kinematics from the named sides, interface from law and enforcement. A
//! new contact method is one line here.

use std::collections::{HashMap, HashSet};

use carom_case::{
    ActiveSetRule, Case, ContactLaw, ContactSpec, Enforcement, ForceTime, FrictionSpec, ObstacleMotion,
    Overlap, Persistency, PrimarySpec, Problem, load_variables,
};
use carom_contact::{
    Augmented, BothSides, Boundary, ConservingPenalty, ConservingUnilateral, ContactPoint, Detection,
    Direction, EdgeToEdge, Kinematics, NodeToFacet, NodeToObstacle, NodeToPatch, Penalty, Surface,
    Unilateral, WithEdges,
};
use carom_mechanics::model::{Augmentation, BodyInstance, Contact, Friction, Model};
use carom_solid::FacetShape;

use super::branching::branching;
use super::obstacles::{self, Moving};
use super::side::{Side, coordinates, side};
use crate::recording::consistent_weights;

/// Depth of smooth nodes of the primary in edges of the secondary, over its shortest facet.
const ALLOWED: f64 = 0.02;

/// The contacts of a case.
pub(super) fn contacts(
    case: &Case,
    parts: &[BodyInstance],
    obstacles: &[Moving],
    [massless, fixed]: [&[bool]; 2],
    problems: &mut Vec<Problem>,
) -> Vec<Contact> {
    let averages = case.time.scheme.is_alpha();
    let conserves = case.time.scheme.conserves();
    let reference: Vec<f64> = parts.iter().flat_map(|part| part.body.mesh().nodes.flat()).copied().collect();
    let mut contacts = Vec::new();
    for (k, spec) in case.contacts.iter().enumerate() {
        let secondary = match side(parts, &spec.secondary, &spec.path("secondary")) {
            Ok(side) => side,
            Err(problem) => {
                problems.push(problem);
                continue;
            }
        };
        // A node at the joint of two sides has its pair in the first of their contacts.
        let (earlier, _) = siblings(case, parts, k, secondary.part, Which::Secondary);
        let nodes = without(&secondary.nodes, &earlier);
        let mut primary_part = None;
        let mut primary_facets = None;
        let mut surface = secondary.nodes.clone();
        let shape = match obstacles::shape(&spec.primary, spec.entry) {
            Ok(shape) => shape,
            Err(problem) => {
                problems.push(problem);
                continue;
            }
        };
        // Of a rigid obstacle's contact only the nodes are needed.
        if let Ok(primary) = side(parts, spec.primary.side().unwrap_or(""), "") {
            let keys = [(&primary, "primary"), (&secondary, "secondary")];
            let both = &keys[..if primary.part == secondary.part { 1 } else { 2 }];
            problems.extend(both.iter().filter_map(|(side, key)| branching(side, parts, spec.path(key))));
        }
        let obstacle = obstacles.iter().find(|obstacle| obstacle.contact == k);
        let kinematics: Box<dyn Kinematics> = match (shape, spec.primary.side()) {
            (Some(shape), _) => {
                let lengths = longest(&nodes, &secondary.facets, &reference, case.dimension);
                let mut contact = NodeToObstacle::new(nodes, case.dimension, shape).with_lengths(lengths);
                if let Some(obstacle) = obstacle {
                    surface.extend(parts[obstacle.part].nodes());
                    contact = contact.carried_by(obstacle.carrier.clone());
                }
                Box::new(contact)
            }
            (None, name) => match side(parts, name.unwrap_or(""), &spec.path("primary")) {
                Ok(primary) if primary.part == secondary.part => {
                    primary_part = Some(primary.part);
                    if case.dimension == 3 {
                        let is_fixed = |node: usize, axis: usize| fixed[3 * node + axis];
                        Box::new(itself_in_space(&secondary, parts, &reference, is_fixed))
                    } else {
                        Box::new(itself(&secondary, parts, &reference))
                    }
                }
                Ok(primary) if case.dimension == 3 => {
                    primary_part = Some(primary.part);
                    surface.extend(&primary.nodes);
                    let (before, after) = siblings(case, parts, k, primary.part, Which::Primary);
                    let side = boundary_of(&primary, &[&before[..], &after].concat(), parts);
                    let (of_earlier, of_later) = siblings(case, parts, k, secondary.part, Which::Secondary);
                    let opposite = boundary_of(&secondary, &[of_earlier, of_later].concat(), parts);
                    let is_fixed = |node: usize, axis: usize| fixed[3 * node + axis];
                    let corners = side.nodes_of_sharp_edges(&reference, is_fixed);
                    let (others, allowed) = others(&primary, &before, &secondary, &corners, &reference, 3);
                    let of = |sides: &[Side]| sides.iter().flat_map(|side| side.nodes.clone()).collect();
                    let edges = EdgeToEdge::new(
                        [opposite.clone(), side.clone()],
                        &[of(&earlier), of(&before)],
                        &reference,
                    );
                    let facets = primary.facets.len();
                    primary_facets = Some((primary.shape, primary.facets));
                    let nodes = NodeToPatch::new(nodes, side.clone()).of_body(opposite.clone());
                    let others = NodeToPatch::new(others, opposite).with_allowed(allowed).of_body(side);
                    Box::new(WithEdges::new(BothSides::new(nodes, others), edges, facets))
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
                    let beside = |side: &Side, found: &[Side]| surface_of(side, found, parts);
                    let (before, after) = siblings(case, parts, k, primary.part, Which::Primary);
                    let side = beside(&primary, &[&before[..], &after].concat());
                    let (of_earlier, of_later) = siblings(case, parts, k, secondary.part, Which::Secondary);
                    let opposite = beside(&secondary, &[of_earlier, of_later].concat());
                    let corners = side.corners(&reference);
                    let (others, allowed) = others(&primary, &before, &secondary, &corners, &reference, 2);
                    primary_facets = Some((primary.shape, primary.facets));
                    let nodes = NodeToFacet::new(nodes, side.clone(), detection)
                        .with_point(point)
                        .of_body(opposite.clone());
                    if case.dimension == 1 || point == ContactPoint::Frozen {
                        Box::new(nodes)
                    } else {
                        let others = NodeToFacet::new(others, opposite, Detection::ClosestPoint);
                        Box::new(BothSides::new(nodes, others.with_allowed(allowed).of_body(side)))
                    }
                }
                Err(problem) => {
                    problems.push(problem);
                    continue;
                }
            },
        };
        let has_mass = |nodes: &[usize]| nodes.iter().any(|n| !massless[n * case.dimension]);
        let is_thrown = matches!(spec.motion, ObstacleMotion::Free { .. });
        let opposite = spec.primary.side().and_then(|name| side(parts, name, "").ok());
        let primary_has_mass = obstacle.is_some_and(|obstacle| parts[obstacle.part].point_mass > 0.0)
            || opposite.as_ref().is_some_and(|side| has_mass(&side.nodes));
        // A ball on a massless spring: the projection would stop the ball.
        let both_move = is_thrown || opposite.is_some();
        let follows = both_move && has_mass(&secondary.nodes) != primary_has_mass;
        let light = |part: usize| case.bodies[part].mass.is_redistributed();
        let projects = spec.law == Some(ContactLaw::Position)
            && spec.enforcement.is_exact()
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
        let shapes = || {
            std::iter::once((secondary.shape, &secondary.facets))
                .chain(primary_facets.as_ref().map(|(shape, facets)| (*shape, facets)))
        };
        let rubbing = &kinematics.secondary()[..kinematics.nodes()];
        let friction = match friction(case, spec, rubbing, &reference, shapes()) {
            Ok(mut friction) => {
                let edges = kinematics.secondary().len() - rubbing.len();
                friction.iter_mut().for_each(|friction| friction.edges = edges);
                if let Some(friction) = friction.as_mut().filter(|_| spec.enforcement == Enforcement::Penalty)
                {
                    let factor = spec.friction.stick_stiffness.unwrap_or(spec.stiffness);
                    let stiffness = |&node: &usize| factor * node_stiffness(parts, node);
                    friction.springs = rubbing.iter().map(stiffness).collect();
                }
                friction
            }
            Err(problem) => {
                problems.push(problem);
                continue;
            }
        };
        // With the predictor law y_{n+1} − y_n is not Δt v_½, and no force conserves angular
        // momentum.
        let conserving = conserves && spec.law == Some(ContactLaw::Position);
        let augmentation = (spec.enforcement == Enforcement::Augmented).then(|| Augmentation {
            factors: [spec.stiffness, spec.friction.stick_stiffness.unwrap_or(spec.stiffness)],
            stiffness: kinematics.secondary().iter().map(|&node| node_stiffness(parts, node)).collect(),
        });
        let contact = Contact {
            name: spec.name.clone(),
            interface: match spec.enforcement {
                Enforcement::Multiplier if conserving => Box::new(ConservingUnilateral),
                Enforcement::Multiplier => Box::new(Unilateral),
                Enforcement::Augmented if conserving => {
                    Box::new(Augmented::along(Direction::DiscreteGradient))
                }
                Enforcement::Augmented => Box::new(Augmented::default()),
                Enforcement::Penalty if conserves => Box::new(ConservingPenalty::new(stiffnesses())),
                Enforcement::Penalty => Box::new(Penalty::new(stiffnesses())),
            },
            // A law on velocities lets positions drift.
            depths: match (spec.enforcement.is_exact(), spec.law) {
                (true, Some(ContactLaw::Position | ContactLaw::Predictor)) => [0.01, 0.1],
                _ => [0.25; 2],
            },
            friction,
            augmentation,
            predictor: spec.law == Some(ContactLaw::Predictor),
            kinematics,
            // A mass that is thrown is a body; a prescribed obstacle is not.
            primary_part: primary_part.or(obstacle.filter(|_| is_thrown).map(|obstacle| obstacle.part)),
            itself: primary_part == Some(secondary.part),
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
        if contact.projects && !has_mass(&secondary.nodes) && !primary_has_mass {
            problems.push(Problem::new(
                format!("contact[{}]", spec.entry),
                format!("no node of contact \"{}\" has mass", spec.name),
                "persistency = \"project\" projects velocities with the mass matrix, which is zero for these nodes",
                "give this contact persistency = \"none\"",
            ));
        }
        contacts.push(contact);
    }
    contacts
}

/// The friction of a contact, without tangential springs.
fn friction<'a>(
    case: &Case,
    spec: &ContactSpec,
    nodes: &[usize],
    reference: &[f64],
    facets: impl Iterator<Item = (FacetShape, &'a Vec<Vec<usize>>)>,
) -> Result<Option<Friction>, Problem> {
    let FrictionSpec { mu, mu_dynamic, decay, shear, .. } = &spec.friction;
    if !spec.friction.exists() {
        return Ok(None);
    }
    let stick = match mu.as_ref().map(|mu| mu.formula(&load_variables(case.dimension))).transpose() {
        Ok(formula) => formula.map(|formula| (formula, format!("mu of contact \"{}\"", spec.name))),
        Err(error) => return Err(Problem::new(spec.path("mu"), error.to_string(), "", "")),
    };
    let d = case.dimension;
    let limits = shear.map(|shear| {
        let areas = consistent_weights(nodes, facets, reference, case.thickness);
        areas.iter().map(|area| shear * area).collect()
    });
    Ok(Some(Friction {
        stick,
        slip: *mu_dynamic,
        decay: decay.unwrap_or(f64::INFINITY),
        places: nodes.iter().map(|node| reference[node * d..(node + 1) * d].to_vec()).collect(),
        limits: limits.unwrap_or_default(),
        springs: Vec::new(),
        edges: 0,
    }))
}

/// Contact of a side with itself.
fn itself(side: &Side, parts: &[BodyInstance], reference: &[f64]) -> BothSides<NodeToFacet> {
    let surface = surface_of(side, &[], parts);
    let earlier = others(side, &[], side, &surface.corners(reference), reference, 2);
    let part = &parts[side.part];
    BothSides::of_itself(
        &surface,
        side.nodes.clone(),
        earlier,
        &part.body.mesh().pieces(),
        part.first_node,
        reference,
    )
}

/// The same in space.
fn itself_in_space(
    side: &Side,
    parts: &[BodyInstance],
    reference: &[f64],
    is_fixed: impl Fn(usize, usize) -> bool,
) -> WithEdges {
    let boundary = boundary_of(side, &[], parts);
    let sharp = boundary.nodes_of_sharp_edges(reference, is_fixed);
    let earlier = others(side, &[], side, &sharp, reference, 3);
    let part = &parts[side.part];
    let pieces = part.body.mesh().pieces();
    WithEdges::of_itself(&boundary, side.nodes.clone(), earlier, &pieces, part.first_node, reference)
}

/// The nodes of the primary side in `d` dimensions, each with the depth to which it may enter
/// facets of the secondary side: none at corners.
fn others(
    primary: &Side,
    earlier: &[Side],
    secondary: &Side,
    corners: &[usize],
    reference: &[f64],
    d: usize,
) -> (Vec<usize>, Vec<f64>) {
    let shortest = lengths(&secondary.facets, reference, d).map(|(_, l)| l).fold(f64::INFINITY, f64::min);
    let mut nodes = without(&primary.nodes, earlier);
    nodes.sort_unstable();
    let allowed = nodes.iter().map(|node| if corners.contains(node) { 0.0 } else { ALLOWED * shortest });
    let allowed = allowed.collect();
    (nodes, allowed)
}

/// The facets of a side in `d` dimensions with the distances between their first corners.
fn lengths<'a>(
    facets: &'a [Vec<usize>],
    reference: &[f64],
    d: usize,
) -> impl Iterator<Item = (&'a Vec<usize>, f64)> {
    facets.iter().filter(|facet| facet.len() > 1).map(move |facet| {
        let [start, end] = [facet[0], facet[1]].map(|node| &reference[d * node..d * node + d]);
        (facet, start.iter().zip(end).map(|(a, b)| (b - a) * (b - a)).sum::<f64>().sqrt())
    })
}

/// The length of the longest facet of each node of a side.
fn longest(nodes: &[usize], facets: &[Vec<usize>], reference: &[f64], d: usize) -> Vec<f64> {
    let mut of: HashMap<usize, f64> = HashMap::new();
    for (facet, length) in lengths(facets, reference, d) {
        for &node in facet {
            let longest = of.entry(node).or_default();
            *longest = longest.max(length);
        }
    }
    nodes.iter().filter_map(|node| of.get(node).copied()).collect()
}

/// A side of a contact.
#[derive(Clone, Copy, PartialEq)]
enum Which {
    Primary,
    Secondary,
}

/// The sides of a body that other contacts have in the place of this one's, with the same opposite
/// side: of earlier contacts, and of later ones. Together they are one surface.
fn siblings(
    case: &Case,
    parts: &[BodyInstance],
    k: usize,
    part: usize,
    which: Which,
) -> (Vec<Side>, Vec<Side>) {
    let spec = &case.contacts[k];
    let of = |other: &ContactSpec| {
        let (same, name) = match which {
            Which::Primary => (other.secondary == spec.secondary, other.primary.side()?),
            Which::Secondary => (other.primary == spec.primary, other.secondary.as_str()),
        };
        // There may be a contact per pair of bodies: few of them need their nodes.
        if same { side(parts, name, "").ok().filter(|side| side.part == part) } else { None }
    };
    let of_contacts = |contacts: &[ContactSpec]| contacts.iter().filter_map(of).collect();
    (of_contacts(&case.contacts[..k]), of_contacts(&case.contacts[k + 1..]))
}

/// Nodes that belong to none of these sides.
fn without(nodes: &[usize], sides: &[Side]) -> Vec<usize> {
    let belongs = |node: &usize| sides.iter().any(|side| side.nodes.contains(node));
    nodes.iter().copied().filter(|node| !belongs(node)).collect()
}

/// A side of the plane with its siblings and the rest of its body's boundary.
fn surface_of(side: &Side, siblings: &[Side], parts: &[BodyInstance]) -> Surface {
    let (rest, count) = rest_of(side, siblings, parts);
    Surface::new(side.shape, &side.facets, &side.orientations).bounded_by(&rest, count)
}

/// The same in space.
fn boundary_of(side: &Side, siblings: &[Side], parts: &[BodyInstance]) -> Boundary {
    let (rest, count) = rest_of(side, siblings, parts);
    Boundary::new(side.shape, &side.facets, &rest, count)
}

/// The rest of the boundary of a side's body, the facets of its siblings first, and their number.
fn rest_of(side: &Side, siblings: &[Side], parts: &[BodyInstance]) -> (Vec<Vec<usize>>, usize) {
    let own: HashSet<&Vec<usize>> = siblings.iter().flat_map(|sibling| &sibling.facets).collect();
    let mut rest = side.rest(parts);
    rest.sort_by_key(|facet| !own.contains(facet));
    let count = rest.iter().filter(|facet| own.contains(facet)).count();
    (rest, count)
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

/// Initial overlaps of the bodies of a case deeper than round-off: a problem per contact with the
/// deepest point.
///
/// Closing an overlap within one step would drive the bodies apart, so it is an error.
pub fn overlaps(case: &Case, model: &Model) -> Vec<Problem> {
    let x = &model.initial_position;
    let problem = |(k, node, depth): (usize, usize, f64)| {
        let place = coordinates(&x[node * model.dimension..(node + 1) * model.dimension]);
        let name = &model.contacts[k].name;
        let owner = model.parts.iter().find(|part| part.nodes().contains(&node));
        let owner = owner.map_or("", |part| part.name.as_str());
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
            format!("the bodies of contact \"{name}\" overlap at the start by {depth:.6e}"),
            format!(
                "the node of \"{owner}\" at {place} lies {inside}; closing the overlap within one step would drive the bodies apart"
            ),
            format!(
                "move a body by at least {depth:.6e}, {turn}or give the contact overlap = \"relax\" or \"keep-gap\""
            ),
        )
    };
    let found = carom_mechanics::inside(model, x, 1e-9 * model.scale).into_iter();
    let kept = |k: usize| {
        model.contacts[k]
            .kinematics
            .secondary()
            .iter()
            .enumerate()
            .any(|(n, _)| model.contacts[k].kinematics.kept(n) > 0.0)
    };
    found.filter(|(k, ..)| case.contacts[*k].overlap != Overlap::Relax || kept(*k)).map(problem).collect()
}
