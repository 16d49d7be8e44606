//! The contacts of a model: kinematics from the named sides, interface from law and enforcement. A
//! new contact method is one line here.

use std::collections::{HashMap, HashSet};

use carom_case::{
    ActiveSetRule, Case, ContactLaw, ContactSpec, Detection, Enforcement, ForceTime, FrictionSpec, Method,
    ObstacleMotion, Persistency, Problem,
};
use carom_contact::{
    Augmented, ConservingPenalty, ConservingUnilateral, Direction, InPlane, Interface, Kinematics,
    NodeToObstacle, Obstacle, Penalty, Unilateral,
};
use carom_mechanics::model::{AllowedDepths, Augmentation, BodyInstance, Contact, Friction, OfRows, Springs};

use super::areas::{consistent_weights, has_edge};
use super::between_sides::{Bodies, Which, longest, without};
use super::branching::branching;
use super::given::in_space_and_time;
use super::obstacles::{self, Moving};
use super::repeated::repeated;
use super::side::Side;

/// The contacts of a case.
pub(super) fn contacts(
    case: &Case,
    parts: &[BodyInstance],
    obstacles: &[Moving],
    [massless, fixed, moved]: [&[bool]; 3],
    closed: &HashSet<Vec<usize>>,
    problems: &mut Vec<Problem>,
) -> Vec<Contact> {
    let reference: Vec<f64> = parts.iter().flat_map(|part| part.body.mesh().nodes.flat()).copied().collect();
    let bodies = Bodies { case, parts, reference: &reference, fixed, moved, closed };
    let made = (0..case.contacts.len()).map(|k| contact(k, &bodies, obstacles, massless));
    let contacts: Vec<_> =
        made.filter_map(|made| made.map_err(|problem| problems.push(problem)).ok()).collect();
    problems.extend(branching(parts, &contacts));
    let part_of = |node: usize| parts.partition_point(|part| part.nodes().end <= node);
    problems.extend(repeated(case, &contacts, part_of));
    contacts
}

fn contact(k: usize, bodies: &Bodies, obstacles: &[Moving], massless: &[bool]) -> Result<Contact, Problem> {
    let Bodies { case, parts, reference, .. } = *bodies;
    let spec = &case.contacts[k];
    let averages = case.time.scheme.is_alpha();
    let conserves = case.time.scheme.conserves();
    let secondary = bodies.side(&spec.secondary, &spec.path("secondary"))?;
    let opposite = opposite(spec, bodies)?;
    let primary = if let Opposite::Side(side) = &opposite { Some(side) } else { None };
    let obstacle = obstacles.iter().find(|obstacle| obstacle.contact == k);
    let primary_part = primary.map(|primary| primary.part);
    let itself = primary_part == Some(secondary.part);
    let has_mass = |nodes: &[usize]| nodes.iter().any(|n| !massless[n * case.dimension]);
    let primary_has_mass = obstacle.is_some_and(|obstacle| parts[obstacle.part].point_mass > 0.0)
        || primary.is_some_and(|side| has_mass(&side.nodes));
    let kinematics = kinematics(k, bodies, &secondary, &opposite, obstacle);
    let mut surface = secondary.nodes.clone();
    surface.extend(primary.iter().flat_map(|side| &side.nodes));
    surface.extend(obstacle.iter().flat_map(|obstacle| parts[obstacle.part].nodes()));
    surface.sort_unstable();
    surface.dedup();
    let is_thrown = matches!(spec.motion, ObstacleMotion::Free { .. });
    // A ball on a massless spring: the projection would stop the ball.
    let both_move = is_thrown || primary.is_some();
    let follows = both_move && has_mass(&secondary.nodes) != primary_has_mass;
    let light = |part: usize| case.bodies[part].mass.is_redistributed();
    // No projection is needed with a predictor that respects the contact, with a spring, in load
    // steps, and for massless nodes that follow the other side: it would give the massive side the
    // velocity of the light one.
    let projects = spec.persistency == Persistency::Project
        && spec.law == Some(ContactLaw::Position)
        && spec.enforcement.is_exact()
        && !case.time.scheme.is_static()
        && !light(secondary.part)
        && !follows
        && !primary_part.is_some_and(light);
    if projects && !has_mass(&secondary.nodes) && !primary_has_mass {
        return Err(Problem::new(
            format!("contact[{}]", spec.entry),
            format!("no node of contact \"{}\" has mass", spec.name),
            "persistency = \"project\" projects velocities with the mass matrix, which is zero for these nodes",
            "give this contact persistency = \"none\"",
        ));
    }
    let facets: Vec<_> = std::iter::once(&secondary)
        .chain(primary.filter(|_| !itself))
        .map(|s| (s.shape, s.facets.clone()))
        .collect();
    let diagonal = match spec.enforcement {
        Enforcement::Multiplier => Vec::new(),
        _ => spread(&*kinematics, stiffnesses(kinematics.secondary(), parts)),
    };
    let stick = spec.friction.stick_stiffness.unwrap_or(spec.stiffness);
    let mut friction = friction(case, spec, kinematics.secondary(), reference, &secondary)?;
    if let Some(friction) = &mut friction {
        if let Some(shear) = spec.friction.shear {
            // Coefficients of a pressure have the whole area, which leaves none for single nodes.
            let has_field = kinematics.is_of_field(0);
            for (node, limit) in friction.limits.iter_mut().enumerate() {
                let of_node = if has_field { 0.0 } else { *limit };
                *limit = kinematics.area(node).map_or(of_node, |area| shear * case.thickness * area);
            }
        }
        let count = kinematics.secondary().len();
        for node in 0..count {
            let stays = |InPlane { nodes, normal }: &InPlane| {
                nodes.iter().all(|&node| !bodies.moves(node, *normal)) && !spec.motion.may_cross(*normal)
            };
            if kinematics.in_plane_of_symmetry(node).as_ref().is_some_and(stays) {
                friction.limits.resize(count, f64::INFINITY);
                friction.limits[node] = 0.0;
            }
        }
    }
    Ok(Contact {
        name: spec.name.clone(),
        interface: interface(spec, conserves),
        depths: allowed_depths(case, spec),
        friction,
        springs: (spec.enforcement == Enforcement::Penalty).then(|| Springs {
            factors: [spec.stiffness, stick],
            diagonal: OfRows {
                of_rows: diagonal.clone(),
                of_nodes: of_nodes(&secondary.nodes, stiffnesses(&secondary.nodes, parts)),
            },
        }),
        augmentation: (spec.enforcement == Enforcement::Augmented)
            .then_some(Augmentation { factors: [spec.stiffness, stick], stiffness: diagonal }),
        predictor: spec.law == Some(ContactLaw::Predictor),
        kinematics,
        // A mass that is thrown is a body; a prescribed obstacle is not.
        primary_part: primary_part.or(obstacle.filter(|_| is_thrown).map(|obstacle| obstacle.part)),
        itself,
        facets,
        surface,
        // Other schemes evaluate the contact force at the ends of their stages: nothing is
        // averaged.
        at_the_end: averages && spec.force == ForceTime::End,
        projects,
        within: spec.active_set == ActiveSetRule::Within,
        restitution: spec.restitution,
    })
}

fn kinematics(
    k: usize,
    bodies: &Bodies,
    secondary: &Side,
    opposite: &Opposite,
    obstacle: Option<&Moving>,
) -> Box<dyn Kinematics> {
    let shape = match opposite {
        Opposite::Side(primary) => return bodies.kinematics(k, secondary, primary),
        Opposite::Obstacle(shape) => shape.clone(),
    };
    // A node at the joint of two sides has its pair in the first of their contacts.
    let [earlier, _] = bodies.siblings(k, secondary.part, Which::Secondary);
    let nodes = without(&secondary.nodes, &earlier);
    let d = bodies.case.dimension;
    let lengths = longest(&nodes, &secondary.facets, bodies.reference, d);
    let contact = NodeToObstacle::new(nodes, d, shape).with_lengths(lengths);
    bodies.with_tips(
        k,
        secondary,
        match obstacle {
            Some(obstacle) => contact.carried_by(obstacle.carrier.clone()),
            None => contact,
        },
    )
}

/// Values of nodes by their global numbers.
fn of_nodes(nodes: &[usize], values: Vec<f64>) -> HashMap<usize, f64> {
    nodes.iter().copied().zip(values).collect()
}

/// The law of the normal forces.
fn interface(spec: &ContactSpec, conserves: bool) -> Box<dyn Interface> {
    // With the predictor law y_{n+1} − y_n is not Δt v_½, and no force conserves angular momentum.
    let conserving = conserves && spec.law == Some(ContactLaw::Position);
    match spec.enforcement {
        Enforcement::Multiplier if conserving => Box::new(ConservingUnilateral),
        Enforcement::Multiplier => Box::new(Unilateral),
        Enforcement::Augmented if conserving => Box::new(Augmented::along(Direction::DiscreteGradient)),
        Enforcement::Augmented => Box::new(Augmented::default()),
        Enforcement::Penalty if conserves => Box::new(ConservingPenalty),
        Enforcement::Penalty => Box::new(Penalty),
    }
}

/// The depths with which a step is accepted. A law on velocities lets positions drift; one on
/// positions with restitution holds a mean of three of them, whose last one may be inside.
fn allowed_depths(case: &Case, spec: &ContactSpec) -> AllowedDepths {
    // Where two facets of length h on curved sides meet, the gap is zero on average.
    let is_mean = spec.method == Method::Mortar;
    let is_on_positions = matches!(spec.law, Some(ContactLaw::Position | ContactLaw::Predictor));
    let is_weighted = case.time.scheme.is_explicit() && spec.restitution > 0.0;
    if !spec.enforcement.is_exact() || !is_on_positions || is_mean || is_weighted {
        return AllowedDepths { smooth: 0.25, kinks: 0.25, others: 0.25 };
    }
    // A frozen contact point is not the closest one; springs leave a part of the gap; forward
    // increments know the facet of the start of the step, and a conserving force acts along a mean
    // of both ends.
    let smooth = match (spec.enforcement, spec.detection) {
        (Enforcement::Multiplier, Detection::ClosestPoint) if !case.time.scheme.conserves() => {
            if case.time.scheme.is_explicit() { 1e-5 } else { 1e-6 }
        }
        _ => 0.01,
    };
    AllowedDepths { smooth, kinks: 0.01, others: 0.1 }
}

/// The side or the obstacle opposite to a secondary side.
enum Opposite {
    Side(Side),
    Obstacle(Obstacle),
}

fn opposite(spec: &ContactSpec, bodies: &Bodies) -> Result<Opposite, Problem> {
    Ok(match obstacles::shape(&spec.primary, spec.entry)? {
        Some(shape) => Opposite::Obstacle(shape),
        None => Opposite::Side(bodies.side(spec.primary.side().unwrap_or(""), &spec.path("primary"))?),
    })
}

/// The friction of a contact, without tangential springs.
fn friction(
    case: &Case,
    spec: &ContactSpec,
    nodes: &[usize],
    reference: &[f64],
    secondary: &Side,
) -> Result<Option<Friction>, Problem> {
    let FrictionSpec { mu, mu_dynamic, decay, shear, .. } = &spec.friction;
    if !spec.friction.exists() {
        return Ok(None);
    }
    let read = |mu| in_space_and_time(case, mu, &spec.path("mu"));
    let stick = mu.as_ref().map(read).transpose()?;
    let d = case.dimension;
    if shear.is_some() && spec.method != Method::Mortar && has_edge(secondary, reference) {
        return Err(Problem::new(
            spec.path("shear"),
            format!("facets of side {} meet at more than 60°", spec.secondary),
            "the limit of a node is `shear` times its area, and at an edge this would include faces that do not touch",
            "name the side that touches as the secondary one, refine a side that should be smooth, or use method = \"mortar\"",
        ));
    }
    // Nodes of the primary side lie over areas that those of the secondary one have already: of the
    // two laws they have Coulomb's alone.
    let on_primary = if mu.is_some() { f64::INFINITY } else { 0.0 };
    let limits_at = |nodes: &[usize], shear: f64| -> Vec<f64> {
        let facets = std::iter::once((secondary.shape, &secondary.facets));
        let areas = consistent_weights(nodes, facets, reference, case.thickness);
        let limit = |(node, area): (&usize, &f64)| {
            if secondary.nodes.contains(node) { shear * area } else { on_primary }
        };
        nodes.iter().zip(&areas).map(limit).collect()
    };
    let limits = shear.map(|shear| limits_at(nodes, shear));
    let limits_of_nodes = shear.map(|shear| of_nodes(&secondary.nodes, limits_at(&secondary.nodes, shear)));
    Ok(Some(Friction {
        stick: stick.map(|formula| (formula, format!("mu of contact \"{}\"", spec.name))),
        slip: *mu_dynamic,
        decay: decay.unwrap_or(f64::INFINITY),
        places: nodes.iter().map(|node| reference[node * d..(node + 1) * d].to_vec()).collect(),
        limits: limits.unwrap_or_default(),
        limits_of_nodes: limits_of_nodes.unwrap_or_default(),
    }))
}

/// The stiffness of the springs of a pressure field per area, the same for all its coefficients, so
/// that a uniform pressure closes them alike; other springs as they are.
fn spread(kinematics: &dyn Kinematics, mut stiffnesses: Vec<f64>) -> Vec<f64> {
    let areas: Vec<Option<f64>> = (0..stiffnesses.len()).map(|place| kinematics.area(place)).collect();
    let of_field = || stiffnesses.iter().zip(&areas).filter_map(|(of, area)| Some((of, (*area)?)));
    let per_area = of_field().map(|(of, _)| of).sum::<f64>() / of_field().map(|(_, area)| area).sum::<f64>();
    for (of, area) in stiffnesses.iter_mut().zip(&areas) {
        *of = area.map_or(*of, |area| per_area * area);
    }
    stiffnesses
}

/// For each node the mean over the directions of its diagonal of the tangent in the reference
/// configuration.
fn stiffnesses(nodes: &[usize], parts: &[BodyInstance]) -> Vec<f64> {
    let mut of: HashMap<usize, f64> = nodes.iter().map(|&node| (node, 0.0)).collect();
    for part in parts.iter().filter(|part| nodes.iter().any(|node| part.nodes().contains(node))) {
        let mesh = part.body.mesh();
        let n = mesh.element.dofs();
        let d = mesh.dimension();
        let mut force = vec![0.0; n];
        let mut tangent = vec![0.0; n * n];
        for cell in 0..mesh.cell_count() {
            let members = || mesh.cell(cell).iter().map(|node| node + part.first_node).enumerate();
            // The reference configuration is never inverted.
            if !members().any(|(_, node)| of.contains_key(&node))
                || part.body.cell_tangent(cell, mesh.nodes.flat(), &mut force, &mut tangent).is_err()
            {
                continue;
            }
            for (place, node) in members() {
                if let Some(sum) = of.get_mut(&node) {
                    *sum += (place * d..(place + 1) * d).map(|i| tangent[i * n + i]).sum::<f64>() / d as f64;
                }
            }
        }
    }
    nodes.iter().map(|node| of[node]).collect()
}
