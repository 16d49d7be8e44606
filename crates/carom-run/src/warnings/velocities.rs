//! Warnings about the velocities at the start: a prescribed motion that begins with a jump, and an
//! impact that no elastic material survives.

use carom_case::{Case, ContactSpec, MaterialSpec, PrimarySpec};
use carom_mechanics::model::{BodyInstance, Model, Prescribed};

use super::found::{Found, short};

/// Difference of velocities, relative to the largest one of the body, that is round-off of a
/// formula.
const ALIKE: f64 = 1e-6;
/// Velocity of an impact over the speed of waves in a bar; a published bar has just a third.
const FAST: f64 = (1.0 + 1e-9) / 3.0;
/// Gap at the start, relative to the size of the bodies, up to which an obstacle touches.
const TOUCHES: f64 = 1e-9;

/// Velocities at the start with those of prescribed motions; none if a formula has no value.
struct Start {
    velocity: Vec<f64>,
    moved: Vec<Prescribed>,
}

impl Start {
    fn new(model: &Model) -> Option<Self> {
        let mut velocity = model.initial_velocity.clone();
        let mut moved = Vec::new();
        model.motions.at(0.0, &mut moved).ok()?;
        moved.iter().for_each(|prescribed| velocity[prescribed.dof] = prescribed.motion[1]);
        Some(Self { velocity, moved })
    }

    /// Mean velocity of a body, or velocity of the carrier of an obstacle.
    fn mean(&self, model: &Model, part: &BodyInstance) -> [f64; 3] {
        let d = model.dimension;
        let nodes = if part.is_rigid() { part.first_node..part.first_node + 1 } else { part.nodes() };
        let has_mass = part.total_mass > 0.0 && !part.is_rigid();
        let mass = |node: usize| model.mass.row(node).map(|(_, m)| m).sum::<f64>();
        let weights: Vec<f64> = nodes.clone().map(|node| if has_mass { mass(node) } else { 1.0 }).collect();
        let total: f64 = weights.iter().sum();
        std::array::from_fn(|i| {
            let along = |(node, weight): (usize, &f64)| weight * self.velocity[node * d + i];
            if i < d { nodes.clone().zip(&weights).map(along).sum::<f64>() / total } else { 0.0 }
        })
    }
}

pub(super) fn velocity_jump(case: &Case, model: &Model) -> Vec<Found> {
    let begins_anew = case.initial.is_none() && case.manufactured.is_none();
    let Some(start) = Start::new(model).filter(|_| begins_anew && !case.time.scheme.is_static()) else {
        return Vec::new();
    };
    let bodies = model.parts.iter().zip(&case.bodies);
    let mut found: Vec<Found> = bodies
        .filter_map(|(part, spec)| moved_at_once(case, model, &start, part, &case.materials_of(spec)))
        .collect();
    found.extend((0..case.contacts.len()).filter_map(|contact| pushed_at_once(case, model, &start, contact)));
    found
}

/// A velocity that jumps at the start.
struct Jump {
    dof: usize,
    from: f64,
    to: f64,
    is_held: bool,
}

impl Jump {
    fn size(&self) -> f64 {
        (self.to - self.from).abs()
    }
}

/// The largest jump of a body that a support moves or holds.
fn moved_at_once(
    case: &Case,
    model: &Model,
    start: &Start,
    part: &BodyInstance,
    materials: &[&MaterialSpec],
) -> Option<Found> {
    let d = model.dimension;
    let own = part.nodes().start * d..part.nodes().end * d;
    let of_support = |moved: &Prescribed| Jump {
        dof: moved.dof,
        from: model.initial_velocity[moved.dof],
        to: moved.motion[1],
        is_held: false,
    };
    let stopped = model.stopped.iter().map(|&(dof, from)| Jump { dof, from, to: 0.0, is_held: true });
    let jumps = start.moved.iter().map(of_support).chain(stopped);
    let of_part = jumps.filter(|jump| own.contains(&jump.dof));
    let largest = of_part.max_by(|a, b| a.size().total_cmp(&b.size()))?;
    let size = largest.size();
    let fastest = start.velocity[own].iter().fold(largest.to.abs(), |most, v| most.max(v.abs()));
    if size <= ALIKE * fastest || part.is_massless() {
        return None;
    }
    let units = case.labels();
    let impedance = |of: &MaterialSpec| of.density * of.wave_speed(case.plane);
    let node = largest.dof / d - part.first_node;
    let mesh = part.body.mesh();
    let cells = (0..mesh.cell_count()).filter(|&cell| mesh.cell(cell).contains(&node));
    let at_node = cells.map(|cell| impedance(materials[mesh.region(cell)])).reduce(f64::max)?;
    let stress = at_node * size;
    let axis = ["x", "y", "z"][largest.dof % d];
    let velocity = &units.velocity;
    let supports = if largest.is_held {
        format!("a support holds it along {axis}")
    } else {
        format!("a support moves it along {axis} with {} {velocity} from the start on", short(largest.to))
    };
    let what = format!(
        "{supports}, where its initial velocity is {} {velocity}: this jump of {} {velocity} starts a wave of stress ρc·{} = {} {}",
        short(largest.from),
        short(size),
        short(size),
        short(stress),
        units.stress,
    );
    Some(Found::of_body(&part.name, what))
}

/// An obstacle with a prescribed motion that touches a body at the start and moves into it.
fn pushed_at_once(case: &Case, model: &Model, start: &Start, contact: usize) -> Option<Found> {
    let spec = &case.contacts[contact];
    let moves = matches!(spec.motion, carom_case::ObstacleMotion::Prescribed { .. });
    let kinematics = &model.contacts[contact].kinematics;
    let y = &model.initial_position;
    let fastest = start.velocity.iter().fold(0.0, |most: f64, v| most.max(v.abs()));
    if !moves || fastest == 0.0 {
        return None;
    }
    // Small compared with the bodies, large compared with the round-off of a gap.
    let ahead = 1e-6 * model.scale / fastest;
    let later: Vec<f64> = y.iter().zip(&start.velocity).map(|(y, v)| y + ahead * v).collect();
    let closing = |node: usize| {
        let [now, then] = [y, &later].map(|y| kinematics.signed_distance(node, y));
        Some((now? - then?) / ahead).filter(|_| now.is_some_and(|gap| gap <= TOUCHES * model.scale))
    };
    let nodes = 0..kinematics.secondary().len();
    let size = nodes.filter_map(closing).fold(0.0, f64::max);
    let unit = case.labels().velocity;
    let what = format!(
        "its obstacle touches the body and moves into it with {} {unit} relative to it from the start on",
        short(size)
    );
    (size > ALIKE * fastest).then(|| Found::of_contact(&spec.name, what))
}

/// Bodies of a declared contact of which one moves towards the other faster than a third of the
/// speed of waves in a bar of the softer one.
pub(super) fn fast_impact(case: &Case, model: &Model) -> Vec<Found> {
    let Some(start) = Start::new(model).filter(|_| case.initial.is_none() && !case.time.scheme.is_static())
    else {
        return Vec::new();
    };
    case.contacts.iter().filter_map(|contact| too_fast(case, model, &start, contact)).collect()
}

fn too_fast(case: &Case, model: &Model, start: &Start, contact: &ContactSpec) -> Option<Found> {
    let part = |name: &str| model.parts.iter().find(|part| part.name == name);
    let of = |name: &str| part(name).map(|part| start.mean(model, part));
    let body = contact.bodies().next()?;
    let other = match &contact.primary {
        PrimarySpec::Side(_) => of(contact.bodies().nth(1)?)?,
        // The carrier of an obstacle that moves has the name of its contact.
        _ if contact.motion.is_fixed() => [0.0; 3],
        _ => of(&contact.name)?,
    };
    let speed = of(body)?.iter().zip(other).fold(0.0, |sum, (v, w)| f64::hypot(sum, v - w));
    let materials = case.bodies.iter().filter(|spec| contact.bodies().any(|name| name == spec.name));
    let materials = materials.flat_map(|spec| case.materials_of(spec)).filter(|m| m.density > 0.0);
    let bar = |material: &MaterialSpec| (young(material) / material.density).sqrt();
    let softest = materials.min_by(|a, b| (a.density * bar(a)).total_cmp(&(b.density * bar(b))))?;
    let unit = case.labels().velocity;
    let what = format!(
        "its bodies start with a relative velocity of {} {unit}, {} times the speed √(E/ρ) = {} {unit} of waves in a bar of \"{}\"",
        short(speed),
        short(speed / bar(softest)),
        short(bar(softest)),
        softest.name
    );
    (speed > FAST * bar(softest)).then(|| Found::of_contact(&contact.name, what))
}

fn young(material: &MaterialSpec) -> f64 {
    let lambda = material.lambda;
    let mu = material.mu;
    mu * (3.0 * lambda + 2.0 * mu) / (lambda + mu)
}
