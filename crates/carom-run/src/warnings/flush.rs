//! A warning about contact between whole boundaries of which faces lie in one plane at the start: a
//! node at the common outline is as near to the face beside the other body's edge as to the one
//! that it presses on.

use std::collections::HashMap;

use carom_case::Case;
use carom_mechanics::model::{Contact, Model};
use carom_solid::FacetShape;

use super::found::Found;

/// Steps of the components of normals that are compared.
const STEPS: f64 = 100.0;
/// Distance between two planes, over the length of a facet, up to which they are one.
const ONE: f64 = 0.01;

/// A plane n·y = offset with the length of a facet in it, and the piece of a body that it bounds.
struct Plane {
    offset: f64,
    length: f64,
    piece: usize,
}

type Planes = HashMap<[i64; 3], Vec<Plane>>;

pub(super) fn flush_outlines(case: &Case, model: &Model) -> Vec<Found> {
    let is_flush = |(k, contact): (usize, &Contact)| {
        contact.primary_part?;
        let sides = contact.facets.iter().map(|(shape, facets)| planes(model, *shape, facets));
        let sides: Vec<Planes> = sides.collect();
        let (first, last) = (sides.first()?, sides.last()?);
        let near = |a: &Plane, b: &Plane| {
            (!contact.itself || a.piece != b.piece)
                && (a.offset - b.offset).abs() < ONE * a.length.min(b.length)
        };
        let meets = |(normal, here): (&[i64; 3], &Vec<Plane>)| {
            last.get(normal).is_some_and(|there| here.iter().any(|a| there.iter().any(|b| near(a, b))))
        };
        let what = "faces of both sides lie in one plane, and point in the same direction".to_owned();
        first.iter().any(meets).then(|| Found::of_contact(&case.contacts[k].name, what))
    };
    model.contacts.iter().enumerate().filter_map(is_flush).collect()
}

/// The planes of the facets of a side, each once.
fn planes(model: &Model, shape: FacetShape, facets: &[Vec<usize>]) -> Planes {
    let d = model.dimension;
    let place = |node: usize| -> [f64; 3] {
        std::array::from_fn(|i| if i < d { model.initial_position[d * node + i] } else { 0.0 })
    };
    let mut pieces: HashMap<usize, Vec<usize>> = HashMap::new();
    let mut planes = Planes::new();
    for nodes in facets.iter().filter(|_| shape.dimension() == d && d > 1) {
        let [a, b] = [place(nodes[0]), place(nodes[1])];
        let to = |c: [f64; 3]| -> [f64; 3] { std::array::from_fn(|i| c[i] - a[i]) };
        let (p, q) = (to(b), if d == 3 { to(place(nodes[2])) } else { [0.0, 0.0, 1.0] });
        let across: [f64; 3] = std::array::from_fn(|i| {
            let (j, k) = ((i + 1) % 3, (i + 2) % 3);
            p[j] * q[k] - p[k] * q[j]
        });
        let size = |x: [f64; 3]| x.iter().map(|x| x * x).sum::<f64>().sqrt();
        let (area, length) = (size(across), size(p));
        if area == 0.0 {
            continue;
        }
        let normal = across.map(|x| x / area);
        let offset = (0..3).map(|i| normal[i] * a[i]).sum::<f64>();
        let Some(part) = model.parts.iter().position(|part| part.nodes().contains(&nodes[0])) else {
            continue;
        };
        let body = &model.parts[part];
        let of_body = pieces.entry(part).or_insert_with(|| body.body.mesh().pieces());
        let piece = of_body[nodes[0] - body.first_node];
        let known = planes.entry(normal.map(|x| (STEPS * x).round() as i64)).or_default();
        if !known.iter().any(|one| one.piece == piece && (one.offset - offset).abs() < 1e-6 * length) {
            known.push(Plane { offset, length, piece });
        }
    }
    planes
}
