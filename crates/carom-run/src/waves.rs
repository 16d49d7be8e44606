//! The time in which a pressure wave crosses a body.

use carom_case::Case;
use carom_mechanics::model::{BodyInstance, Model};

/// Time in which a pressure wave crosses the smallest body along its shortest extent; none in
/// statics, and if no body has a mass.
pub fn crossing(case: &Case, model: &Model) -> Option<f64> {
    let across = |part: &BodyInstance| {
        let nodes = &part.body.mesh().nodes;
        let extent = |axis: usize| {
            let along = nodes.iter().map(|x| x[axis]);
            along.clone().fold(f64::NEG_INFINITY, f64::max) - along.fold(f64::INFINITY, f64::min)
        };
        (0..model.dimension).map(extent).fold(f64::INFINITY, f64::min)
    };
    let bodies = model.parts.iter().zip(&case.bodies);
    let times = bodies.filter_map(|(part, spec)| {
        let materials = case.materials_of(spec).into_iter().filter(|material| material.density > 0.0);
        // The fastest of its materials crosses it first.
        let fastest = materials.map(|material| material.wave_speed(case.plane)).reduce(f64::max)?;
        Some(across(part) / fastest)
    });
    times.reduce(f64::min).filter(|_| !case.time.scheme.is_static())
}
