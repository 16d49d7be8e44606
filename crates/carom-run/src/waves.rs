//! The time in which a pressure wave crosses a body.

use carom_case::Case;
use carom_mechanics::model::{BodyInstance, Model};
use carom_solid::{Facet, Mesh};

/// Number of facets whose normals are tried.
const TRIED: usize = 64;

/// Time in which a pressure wave crosses the smallest body along its shortest extent, of those
/// along the axes and across its facets; none in statics, and if no body has a mass.
pub fn crossing(case: &Case, model: &Model) -> Option<f64> {
    let bodies = model.parts.iter().zip(&case.bodies);
    let times = bodies.filter_map(|(part, spec)| {
        let materials = case.materials_of(spec).into_iter().filter(|material| material.density > 0.0);
        // The fastest of its materials crosses it first.
        let fastest = materials.map(|material| material.wave_speed(case.plane)).reduce(f64::max)?;
        Some(shortest(part) / fastest)
    });
    times.reduce(f64::min).filter(|_| !case.time.scheme.is_static())
}

/// The shortest extent of a body, along the axes and across some of its facets.
fn shortest(part: &BodyInstance) -> f64 {
    let mesh = part.body.mesh();
    let dimension = mesh.element.dimension();
    let axes = (0..dimension).map(|axis| std::array::from_fn(|i| if i == axis { 1.0 } else { 0.0 }));
    let skin = part.skin();
    let across =
        skin.iter().step_by(skin.len().div_ceil(TRIED).max(1)).filter_map(|facet| normal(mesh, facet));
    axes.chain(across).map(|direction| extent(mesh, direction)).fold(f64::INFINITY, f64::min)
}

fn extent(mesh: &Mesh, direction: [f64; 3]) -> f64 {
    let places = mesh.nodes.iter().map(|x| x.iter().zip(&direction).map(|(x, n)| x * n).sum::<f64>());
    let ends = places.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], x| [low.min(x), high.max(x)]);
    ends[1] - ends[0]
}

/// The normal of a facet by its corners; none of the end of a bar.
fn normal(mesh: &Mesh, facet: &Facet) -> Option<[f64; 3]> {
    let edge = |k: usize| {
        let [from, to] = [0, k].map(|k| &mesh.nodes[facet.nodes[k]]);
        std::array::from_fn(|i| if i < mesh.element.dimension() { to[i] - from[i] } else { 0.0 })
    };
    let [a, b]: [[f64; 3]; 2] = match mesh.element.dimension() {
        1 => return None,
        2 => [edge(1), [0.0, 0.0, 1.0]],
        _ => [edge(1), edge(2)],
    };
    let cross = [0, 1, 2].map(|i| a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3]);
    let size = cross.into_iter().fold(0.0, f64::hypot);
    (size > 0.0).then(|| cross.map(|x| x / size))
}
