//! Extents of bodies.

use carom_mechanics::model::{BodyInstance, Model};
use carom_solid::{Facet, Mesh};

/// Extent of a body along a direction at the start.
pub(super) fn along(model: &Model, part: &BodyInstance, direction: &[f64; 3]) -> f64 {
    let nodes = part.of(&model.initial_position).chunks_exact(model.dimension);
    let places = nodes.map(|x| x.iter().zip(direction).map(|(x, n)| x * n).sum::<f64>());
    let ends = places.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], x| [low.min(x), high.max(x)]);
    ends[1] - ends[0]
}

/// Twice the volume over the surface: the thickness of a plate, a ring or a tube, and less than the
/// smallest extent of a compact body. Facets are those of their corners.
pub(super) fn thickness(part: &BodyInstance, volume: f64) -> f64 {
    let mesh = part.body.mesh();
    2.0 * volume / part.skin().iter().map(|facet| size(mesh, facet)).sum::<f64>()
}

/// Length or area of a facet; 1 of an end of a bar.
fn size(mesh: &Mesh, facet: &Facet) -> f64 {
    let shape = mesh.element.facet_shape();
    let edge = |k: usize| -> [f64; 3] {
        let [a, b] = [0, k].map(|k| &mesh.nodes[facet.nodes[k]]);
        std::array::from_fn(|i| if i < a.len() { b[i] - a[i] } else { 0.0 })
    };
    let norm = |x: [f64; 3]| x.into_iter().fold(0.0, f64::hypot);
    let cross = |a: [f64; 3], b: [f64; 3]| {
        [0, 1, 2].map(|i| a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3])
    };
    match shape.dimension() {
        1 => 1.0,
        2 => norm(edge(1)),
        _ => (2..shape.corners()).map(|k| 0.5 * norm(cross(edge(k - 1), edge(k)))).sum(),
    }
}
