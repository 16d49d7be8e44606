//! Warning about bodies that fly at each other without a contact. Until something touches it, a
//! body moves with its initial velocity v and gravity g; two bodies with the relative course
//! w(t) = v t + g t²/2 meet when their extents overlap along every one of some directions n:
//!
//! ```text
//! min_b − max_a < n·w(t) < max_b − min_a,      min, max of n·y over the nodes at the start
//! ```
//!
//! Where a contact between them names sides, they are moved on their courses, and it matters which
//! nodes come to lie inside first: those of its sides, or others. The same is asked of a body and
//! the rigid obstacle of its contact.
//!
//! After a declared contact, nothing is known before the run.

use std::collections::BTreeSet;

use carom_case::{Case, ContactSpec, ObstacleMotion, PrimarySpec};
use carom_mechanics::model::{BodyInstance, Model};
use carom_mechanics::{DeepPlace, Overlap, Penetration, Undeclared};

use super::found::{Found, covered_by, short};

/// Directions in the plane: convex bodies are wrapped to 1 − cos(π/32), half a per cent.
const DIRECTIONS: usize = 16;
/// Instants at which rigid obstacles, and nodes inside bodies, are looked for on a course.
const INSTANTS: u32 = 64;
/// Depth, relative to L, from which a node is inside an obstacle.
const INSIDE: f64 = 1e-6;

/// The free motion of a body: velocity and acceleration.
type Course = [[f64; 3]; 2];

pub(super) fn undeclared_contact(case: &Case, model: &Model) -> Vec<Found> {
    if case.dimension < 2 || case.time.scheme.is_static() || case.initial.is_some() {
        return Vec::new();
    }
    let mut scene = Scene::new(case, model);
    let mut found = Vec::new();
    for a in 0..model.parts.len() {
        for b in a + 1..model.parts.len() {
            let contacts = scene.between(a, b);
            let meeting = if contacts.is_empty() {
                scene.meet(a, b).map(|[first, _]| first).filter(|time| *time > 0.0)
            } else {
                scene.meet_elsewhere(a, b)
            };
            let Some(time) = meeting else { continue };
            if scene.flies_until(a, Some(b), time) && scene.flies_until(b, Some(a), time) {
                let [first, second] = [a, b].map(|k| &model.parts[k].name);
                let place = format!("bodies \"{first}\" and \"{second}\"");
                let specs: Vec<&ContactSpec> = contacts.iter().map(|&k| &case.contacts[k]).collect();
                let where_not = covered_by(&specs);
                let what = format!("as they move at the start, they meet at t = {}{where_not}", short(time));
                found.push(Found::at(place, what));
            }
        }
    }
    for (k, contact) in case.contacts.iter().enumerate() {
        if let Some((body, time)) = scene.falls_into_obstacle(k)
            && scene.flies_until(body, None, time)
        {
            let what = format!(
                "as it moves at the start, it meets the obstacle of contact \"{}\" at t = {}{}",
                contact.name,
                short(time),
                covered_by(&[contact])
            );
            found.push(Found::of_body(&model.parts[body].name, what));
        }
    }
    found
}

/// The bodies on their courses.
struct Scene<'a> {
    case: &'a Case,
    model: &'a Model,
    directions: Vec<[f64; 3]>,
    /// None of a body that is not free, or moved by a formula.
    courses: Vec<Option<Course>>,
    /// Extents of each body along the directions at the start.
    extents: Vec<Vec<[f64; 2]>>,
    undeclared: Undeclared,
    contacts: Penetration,
    /// Contacts whose bodies overlap at the start.
    overlapping: BTreeSet<usize>,
}

impl<'a> Scene<'a> {
    fn new(case: &'a Case, model: &'a Model) -> Self {
        let directions = directions(case.dimension);
        let momentum = {
            let mut product = vec![0.0; model.dofs()];
            model.mass.multiply_into(&model.initial_velocity, &mut product);
            product
        };
        let moved: Vec<usize> = model.motions.dofs().collect();
        // Under a gravity that varies the course of a body is no parabola.
        let is_parabola = |k: usize| {
            case.bodies.get(k).is_none_or(|body| body.gravity.iter().all(|g| g.constant().is_some()))
        };
        let course = |(k, part)| course(model, part, &momentum, &moved).filter(|_| is_parabola(k));
        let courses = model.parts.iter().enumerate().map(course).collect();
        let extents = model.parts.iter().map(|part| extents(model, part, &directions)).collect();
        let undeclared = Undeclared::new(model);
        let mut contacts = Penetration::of_contacts(model);
        let inside = contacts.inside(model, &model.initial_position, INSIDE * model.scale);
        let overlapping = inside.iter().map(|place| place.contact).collect();
        Self { case, model, directions, courses, extents, undeclared, contacts, overlapping }
    }

    /// The contacts between two bodies.
    fn between(&self, a: usize, b: usize) -> Vec<usize> {
        let [first, second] = [a, b].map(|k| self.model.parts[k].name.as_str());
        let is_between = |contact: &ContactSpec| {
            let bodies: Vec<&str> = contact.bodies().collect();
            bodies == [first, second] || bodies == [second, first]
        };
        (0..self.case.contacts.len()).filter(|&k| is_between(&self.case.contacts[k])).collect()
    }

    /// When nodes of two bodies that their contacts do not cover come to lie inside the other body,
    /// before those that they cover.
    fn meet_elsewhere(&mut self, a: usize, b: usize) -> Option<f64> {
        let [from, to] = self.meet(a, b)?;
        self.enters(from, to, &self.between(a, b), Overlap::Bodies(a, b))
    }

    /// The body of a contact with a fixed obstacle, and when nodes of it that are not in the side
    /// of the contact come to lie in the obstacle, before those of the side.
    fn falls_into_obstacle(&mut self, contact: usize) -> Option<(usize, f64)> {
        let spec = &self.case.contacts[contact];
        if matches!(spec.primary, PrimarySpec::Side(_)) || spec.motion != ObstacleMotion::Fixed {
            return None;
        }
        let name = spec.bodies().next()?;
        let body = self.model.parts.iter().position(|part| part.name == name)?;
        let [v, g] = self.courses[body]?;
        if v == [0.0; 3] && g == [0.0; 3] {
            return None;
        }
        let overlap = Overlap::Obstacle { body, contact };
        Some((body, self.enters(0.0, self.case.time.end, &[contact], overlap)?))
    }

    /// When this overlap is first seen between two times, unless one of the contacts that cover
    /// other nodes of the same bodies acts before.
    fn enters(&mut self, from: f64, to: f64, covering: &[usize], overlap: Overlap) -> Option<f64> {
        if !self.undeclared.watches(self.model, overlap) {
            return None;
        }
        for k in 1..=INSTANTS {
            let time = from + (to - from) * f64::from(k) / f64::from(INSTANTS);
            let y = self.positions(time);
            let acting = self.contacts.inside(self.model, &y, INSIDE * self.model.scale);
            let mut covered = acting.iter().filter(|place| covering.contains(&place.contact)).peekable();
            if covered.peek().is_some() {
                // Behind a side that faces away from it, a node enters the body elsewhere.
                return covered.all(|place| self.starts_behind(place)).then_some(time);
            }
            if self.undeclared.overlapping(self.model, &y).contains(&overlap) {
                return Some(time);
            }
        }
        None
    }

    /// Whether a node of a contact is behind its side, though outside its body, at the start.
    fn starts_behind(&self, place: &DeepPlace) -> bool {
        let y = &self.model.initial_position;
        let kinematics = &self.model.contacts[place.contact].kinematics;
        let index = kinematics.secondary().iter().position(|&node| node == place.node);
        let distance = index.and_then(|index| kinematics.signed_distance(index, y));
        let is_outside = !self.overlapping.contains(&place.contact);
        is_outside && distance.is_some_and(|distance| distance < -INSIDE * self.model.scale)
    }

    /// When the extents of two bodies that move relative to each other begin and cease to overlap,
    /// if nothing stops them before; from zero if they do at the start.
    fn meet(&self, a: usize, b: usize) -> Option<[f64; 2]> {
        let [[v, g], [v_b, g_b]] = [self.courses[a]?, self.courses[b]?];
        let along = |n: &[f64; 3], x: &[f64; 3], x_b: &[f64; 3]| (0..3).map(|i| n[i] * (x[i] - x_b[i])).sum();
        let bands: Vec<Band> = (self.directions.iter().zip(self.extents[a].iter().zip(&self.extents[b])))
            .map(|(n, (of_a, of_b))| Band {
                v: along(n, &v, &v_b),
                g: along(n, &g, &g_b),
                limits: [of_b[0] - of_a[1], of_b[1] - of_a[0]],
            })
            .collect();
        let mut instants: Vec<f64> = bands.iter().flat_map(Band::crossings).collect();
        let end = self.case.time.end;
        instants.retain(|t| *t > 0.0 && *t < end);
        instants.extend([0.0, end]);
        instants.sort_unstable_by(f64::total_cmp);
        let overlap = |t: f64| bands.iter().all(|band| band.contains(t));
        let first = instants.windows(2).find(|between| overlap(0.5 * (between[0] + between[1])))?;
        (v != v_b || g != g_b).then_some([first[0], first[1]])
    }

    /// Whether a body meets nothing that it has a contact with before this time, other than the one
    /// that it meets then.
    fn flies_until(&self, body: usize, partner: Option<usize>, time: f64) -> bool {
        let is_declared = |&other: &usize| Some(other) != partner && !self.between(body, other).is_empty();
        let others = (0..self.model.parts.len()).filter(is_declared);
        let mut meetings = others.filter_map(|other| Some(self.meet(body, other)?[0]));
        !meetings.any(|meeting| meeting < time) && !self.meets_obstacle(body, time)
    }

    fn meets_obstacle(&self, body: usize, time: f64) -> bool {
        let name = self.model.parts[body].name.as_str();
        let mut contacts = self.model.contacts.iter().zip(&self.case.contacts);
        contacts.any(|(contact, spec)| {
            !matches!(spec.primary, PrimarySpec::Side(_))
                && spec.bodies().next() == Some(name)
                && (1..=INSTANTS).any(|k| {
                    let y = self.positions(time * f64::from(k) / f64::from(INSTANTS));
                    let nodes = 0..contact.kinematics.secondary().len();
                    let mut gaps = nodes.filter_map(|node| contact.kinematics.signed_distance(node, &y));
                    gaps.any(|gap| gap < -INSIDE * self.model.scale)
                })
        })
    }

    fn positions(&self, time: f64) -> Vec<f64> {
        let model = self.model;
        let d = self.model.dimension;
        let mut y = model.initial_position.clone();
        for (part, course) in model.parts.iter().zip(&self.courses) {
            let [v, g] = course.unwrap_or_default();
            for node in part.nodes() {
                (0..d).for_each(|i| y[node * d + i] += time * (v[i] + 0.5 * time * g[i]));
            }
        }
        y
    }
}

/// n·w(t) between two limits.
struct Band {
    v: f64,
    g: f64,
    limits: [f64; 2],
}

impl Band {
    fn contains(&self, t: f64) -> bool {
        let w = t * (self.v + 0.5 * t * self.g);
        self.limits[0] < w && w < self.limits[1]
    }

    /// Times at which w reaches a limit; of no acceleration one of them is infinite.
    fn crossings(&self) -> impl Iterator<Item = f64> {
        let Self { v, g, .. } = *self;
        self.limits.into_iter().flat_map(move |limit| {
            let q = -0.5 * (v + (v * v + 2.0 * g * limit).sqrt().copysign(v));
            [2.0 * q / g, -limit / q].into_iter().filter(|t| t.is_finite())
        })
    }
}

fn directions(dimension: usize) -> Vec<[f64; 3]> {
    if dimension == 2 {
        let angles = (0..DIRECTIONS).map(|k| std::f64::consts::PI * k as f64 / DIRECTIONS as f64);
        return angles.map(|angle| [angle.cos(), angle.sin(), 0.0]).collect();
    }
    // Normals of the faces of a cube, of its edges and of its corners.
    let mut all = Vec::new();
    for k in 14..27 {
        let n = [k / 9 - 1, k / 3 % 3 - 1, k % 3 - 1].map(f64::from);
        let length = (n[0] * n[0] + n[1] * n[1] + n[2] * n[2]).sqrt();
        all.push(n.map(|x| x / length));
    }
    all
}

/// A body that supports hold in a direction does not move in it.
fn course(model: &Model, part: &BodyInstance, momentum: &[f64], moved: &[usize]) -> Option<Course> {
    let d = model.dimension;
    let dofs = part.nodes().start * d..part.nodes().end * d;
    if part.is_rigid() || part.total_mass == 0.0 || moved.iter().any(|dof| dofs.contains(dof)) {
        return None;
    }
    let mean = |forces: &[f64]| {
        std::array::from_fn(|i| {
            let of = || dofs.clone().skip(i).step_by(d);
            if i >= d || of().any(|dof| model.fixed[dof]) {
                return 0.0;
            }
            of().map(|dof| forces[dof]).sum::<f64>() / part.total_mass
        })
    };
    Some([mean(momentum), mean(&model.gravity)])
}

fn extents(model: &Model, part: &BodyInstance, directions: &[[f64; 3]]) -> Vec<[f64; 2]> {
    let d = model.dimension;
    let along = |n: &[f64; 3]| {
        let places =
            part.nodes().map(|node| (0..d).map(|i| n[i] * model.initial_position[node * d + i]).sum::<f64>());
        places.fold([f64::INFINITY, f64::NEG_INFINITY], |[least, most], s| [least.min(s), most.max(s)])
    };
    directions.iter().map(along).collect()
}
