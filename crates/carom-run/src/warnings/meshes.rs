//! Warnings about the meshes of the two sides of a contact, where these are near each other at the
//! start.

use carom_algebra::Vector;
use carom_case::{Case, ContactSpec, Method, PrimarySpec, Quantity};
use carom_mechanics::model::Model;

use super::found::{Found, short};
use crate::build::side::side;

/// Ratio of spacings up to which two sides count as equally fine: meshers do not meet a size
/// better.
const ALIKE: f64 = 1.1;
/// Distance between nodes along the surface, relative to their spacing, up to which they match.
const MATCH: f64 = 0.01;

/// Pairs of facets that are compared to find those that are near; larger sides are not judged.
const MOST: usize = 100_000_000;

type Place = Vector<3>;

/// The facets of a contact's sides that are near the other side.
struct Zone {
    /// The facets of the secondary and of the primary side.
    sides: [Vec<Near>; 2],
    /// Unit normal of the surfaces where they are closest.
    normal: Place,
    /// Middle of the primary facet there.
    closest: Place,
}

/// A facet near the other side.
struct Near {
    /// Nodes of the facet, its corners first.
    nodes: Vec<Place>,
    corners: usize,
    /// Mean length of its edges.
    length: f64,
    degree: usize,
}

/// The zone of a contact of deformable sides in the plane or in space: facets whose middle is at
/// most two facet lengths further from the other side than the nearest one.
fn zone(case: &Case, model: &Model, contact: usize) -> Option<Zone> {
    let spec = &case.contacts[contact];
    let PrimarySpec::Side(primary) = &spec.primary else { return None };
    let d = case.dimension;
    if d < 2 {
        return None;
    }
    let at = |n: usize| -> Place {
        Vector(std::array::from_fn(|i| if i < d { model.initial_position[d * n + i] } else { 0.0 }))
    };
    let facets = |name: &str| -> Option<Vec<Near>> {
        let side = side(&model.parts, name, "").ok()?;
        let corners = side.shape.corners();
        let degree = side.shape.degree();
        let near = |nodes: &Vec<usize>| {
            let nodes: Vec<Place> = nodes.iter().map(|&n| at(n)).collect();
            let edges = if corners == 2 { 1 } else { corners };
            let edge = |k: usize| (nodes[(k + 1) % corners] - nodes[k]).norm();
            let length = (0..edges).map(edge).sum::<f64>() / edges as f64;
            Near { nodes, corners, length, degree }
        };
        Some(side.facets.iter().map(near).collect())
    };
    let sides = [facets(&spec.secondary)?, facets(primary)?];
    if sides[0].len().saturating_mul(sides[1].len()) > MOST {
        return None;
    }
    let middles = sides.each_ref().map(|side| side.iter().map(Near::middle).collect::<Vec<_>>());
    let mean = |side: &[Near]| side.iter().map(|f| f.length).sum::<f64>() / side.len() as f64;
    let reach = 2.0 * f64::max(mean(&sides[0]), mean(&sides[1]));
    let gap = |middle: Place, other: &[Place]| {
        other.iter().map(|&o| (o - middle).norm()).fold(f64::INFINITY, f64::min)
    };
    let gaps: [Vec<f64>; 2] =
        [0, 1].map(|s| middles[s].iter().map(|&middle| gap(middle, &middles[1 - s])).collect());
    let (closest, least) =
        gaps[1].iter().copied().enumerate().min_by(|a, b| a.1.total_cmp(&b.1)).filter(|g| g.1.is_finite())?;
    let normal = sides[1][closest].normal();
    let closest = middles[1][closest];
    let mut gaps = gaps.into_iter();
    let sides = sides.map(|side| {
        let near = side.into_iter().zip(gaps.next().unwrap_or_default());
        near.filter(|(_, gap)| *gap <= least + reach).map(|(facet, _)| facet).collect()
    });
    Some(Zone { sides, normal, closest })
}

impl Near {
    fn middle(&self) -> Place {
        let corners = &self.nodes[..self.corners];
        let mean = |i: usize| corners.iter().map(|x| x[i]).sum::<f64>() / corners.len() as f64;
        Vector(std::array::from_fn(mean))
    }

    fn normal(&self) -> Place {
        let a = self.nodes[1] - self.nodes[0];
        // In the plane z is across.
        let b = if self.corners == 2 { Vector([0.0, 0.0, 1.0]) } else { self.nodes[2] - self.nodes[0] };
        let n = Vector([a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]);
        Vector(n.0.map(|x| x / n.norm()))
    }
}

impl Zone {
    /// Mean distance between neighbouring nodes of a side.
    fn spacing(&self, side: usize) -> f64 {
        let spacing = |facet: &Near| facet.length / facet.degree as f64;
        self.sides[side].iter().map(spacing).sum::<f64>() / self.sides[side].len() as f64
    }

    /// Whether a place is within a facet's length of a side, and not much further from the other
    /// one than this side is: on a coarse round body the far end may be in the zone, too.
    fn reaches(&self, at: Place) -> bool {
        let height = |y: Place| (y - self.closest).dot(&self.normal).abs();
        self.sides.iter().any(|side| {
            let least = side.iter().flat_map(|f| &f.nodes).map(|&y| height(y)).fold(f64::INFINITY, f64::min);
            side.iter().any(|facet| {
                facet.nodes.iter().any(|&y| (y - at).norm() <= facet.length)
                    && height(at) <= least + 2.0 * facet.length
            })
        })
    }

    /// Whether every secondary node has a node of the primary at the same place along the surface.
    fn matches(&self) -> bool {
        let along = |side: usize| {
            let places = self.sides[side].iter().flat_map(|facet| &facet.nodes);
            let flat = |y: &Place| *y - self.normal * y.dot(&self.normal);
            places.map(flat).collect::<Vec<Place>>()
        };
        let near = along(1);
        let tolerance = MATCH * self.spacing(1);
        along(0).iter().all(|s| near.iter().any(|p| (*p - *s).norm() <= tolerance))
    }
}

pub(super) fn coarse_secondary(case: &Case, model: &Model) -> Vec<Found> {
    let coarse = |k: usize| {
        let zone = zone(case, model, k)?;
        let [secondary, primary] = [0, 1].map(|side| zone.spacing(side));
        (secondary > ALIKE * primary).then(|| {
            let secondary = short(secondary);
            let primary = short(primary);
            let unit = &case.units.length;
            let what = format!(
                "near the contact the nodes of the secondary side are {secondary} {unit} apart, those of the primary {primary} {unit}"
            );
            let contact = &case.contacts[k];
            let found = Found::of_contact(&contact.name, what);
            if contact.between { found.with_advice(finer_or_apart(contact)) } else { found }
        })
    };
    (0..case.contacts.len()).filter_map(coarse).collect()
}

/// Advice for a contact of `between`, of which the softer body is the secondary one.
fn finer_or_apart(contact: &ContactSpec) -> String {
    let body = |side: &str| side.split('.').next().unwrap_or_default().to_owned();
    let [secondary, primary] = [&*contact.secondary, contact.primary.side().unwrap_or_default()].map(body);
    format!(
        "a finer mesh of {secondary} there; or a [[contact]] of its own for the two bodies, secondary = \"{primary}.SIDE\" and \
         primary = \"{secondary}.SIDE\", which `between` then leaves out"
    )
}

/// Given where the case asks for a pressure, in an expectation, or for a stress near the contact,
/// at a probe within a facet's length of it. Bodies of which one is curved never match: a warning
/// to every one of them would not be read.
pub(super) fn unmatched_pressure(case: &Case, model: &Model) -> Vec<Found> {
    let stress = |q: &Quantity| q.is_stress();
    let unmatched = |(k, contact): (usize, &ContactSpec)| {
        if contact.method == Method::Mortar {
            return None;
        }
        let zone = zone(case, model, k).filter(|zone| !zone.matches())?;
        let pressures = case.expects.iter().filter(|expect| expect.what.contains("pressure"));
        let mut places: Vec<String> =
            pressures.map(|expect| format!("the expected {}", expect.what)).collect();
        for probe in case.probes.iter().filter(|probe| probe.record.iter().any(stress)) {
            if zone.reaches(Vector(std::array::from_fn(|i| probe.at.get(i).copied().unwrap_or(0.0)))) {
                let names: Vec<&str> = probe.record.iter().filter(|q| stress(q)).map(|q| q.word()).collect();
                places.push(format!("probe \"{}\" ({})", probe.name, names.join(", ")));
            }
        }
        let last = places.pop()?;
        let listed = if places.is_empty() { last } else { format!("{} and {last}", places.join(", ")) };
        let what = format!("the nodes of its sides do not match, which affects {listed}");
        Some(Found::of_contact(&contact.name, what))
    };
    case.contacts.iter().enumerate().filter_map(unmatched).collect()
}
