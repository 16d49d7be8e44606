//! Warnings about waves: a speed that no material has, and a run in which none crosses a body.
//! Either may be a mistake in the units of the case.

use carom_case::{Case, MaterialSpec};
use carom_mechanics::model::{BodyInstance, Model};
use carom_record::units::metres_per_second;

use super::extent;
use super::found::{Found, short};

/// Speeds of pressure waves in m/s between which those of solids lie, from foams and gels to
/// diamond, 18 000.
const SPEEDS: [f64; 2] = [1.0, 20_000.0];

/// Only of cases that declare their units, with labels that are known: others may be dimensionless.
pub(super) fn wave_speed(case: &Case, _: &Model) -> Vec<Found> {
    let units = &case.units;
    let unit = metres_per_second(&units.length, &units.time).filter(|_| units.declared);
    let Some(unit) = unit else { return Vec::new() };
    let used = |name: &str| case.bodies.iter().any(|body| body.material_names().contains(&name));
    let mut found = Vec::new();
    for material in case.materials.iter().filter(|m| m.density > 0.0 && used(&m.name)) {
        let speed = material.wave_speed(case.plane);
        if !(SPEEDS[0]..=SPEEDS[1]).contains(&(speed * unit)) {
            let [own, metric] = [speed, speed * unit].map(short);
            let metric = if unit == 1.0 { String::new() } else { format!(", {metric} m/s") };
            let velocity = &case.labels().velocity;
            let what = format!("the speed of its pressure waves is {own} {velocity}{metric}");
            found.push(Found::of_material(&material.name, what));
        }
    }
    found
}

/// The way across is the thickness of the body. A start from another run may be in the middle of an
/// event.
pub(super) fn short_run(case: &Case, model: &Model) -> Vec<Found> {
    let is_free = case.initial.is_none() && case.manufactured.is_none();
    if case.time.scheme.is_static() || !is_free {
        return Vec::new();
    }
    let units = case.labels();
    let mut found = Vec::new();
    for (part, spec) in model.parts.iter().zip(&case.bodies) {
        let materials = case.materials_of(spec).into_iter().filter(|material| material.density > 0.0);
        let speed = |of: &MaterialSpec| of.wave_speed(case.plane);
        // No wave is faster than that of the fastest of its materials.
        let Some(speed) = materials.map(speed).reduce(f64::max) else { continue };
        if is_held(model, part) {
            continue;
        }
        let across = extent::thickness(part, volume(part) / case.thickness);
        let crossing = across / speed;
        if case.time.end < crossing {
            let [end, crossing, across] = [case.time.end, crossing, across].map(short);
            let time = &units.time;
            let length = &units.length;
            let what = format!(
                "the run ends at {end} {time}, and a pressure wave needs {crossing} {time} to cross {across} {length}, twice the body's volume over its surface"
            );
            found.push(Found::of_body(&part.name, what));
        }
    }
    found
}

/// Volume of a body, × thickness.
fn volume(part: &BodyInstance) -> f64 {
    let mesh = part.body.mesh();
    let mut volumes = vec![0.0; mesh.element.nodes()];
    let of_cell = |cell: usize| {
        part.body.cell_volumes(cell, &mut volumes);
        volumes.iter().sum::<f64>()
    };
    (0..mesh.cell_count()).map(of_cell).sum()
}

/// Whether no node of a body's boundary can move: it serves as an obstacle.
fn is_held(model: &Model, part: &BodyInstance) -> bool {
    let d = model.dimension;
    let boundary = part.nodes().zip(part.on_boundary()).filter(|(_, on)| *on);
    boundary.flat_map(|(node, _)| node * d..(node + 1) * d).all(|dof| model.fixed[dof])
}
