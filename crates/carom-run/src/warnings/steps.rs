//! Warning about the step: the Courant number C = c Δt/h with the speed c of pressure waves and the
//! size h of a cell.
//!
//! An implicit step is stable for any C, but it resolves a wave of length ℓ only if ω Δt = 2π c
//! Δt/ℓ is below about 1, where a scheme of order two is wrong by ω²Δt²/12 = 8 % in its period. So
//! ℓ > 2π C h. At C = 10 these are 63 cells, more than the bodies of an impact usually have across:
//! no wave that the mesh carries and the contact excites is resolved by the step.

use carom_case::{Case, ContactSpec};
use carom_mechanics::model::Model;
use carom_solid::Mesh;

use super::found::{Found, short};

/// Courant number that is warned about.
const LONG: f64 = 10.0;

pub(super) fn long_step(case: &Case, model: &Model) -> Vec<Found> {
    if case.time.scheme.is_static() {
        return Vec::new();
    }
    let unit = &case.units.length;
    let touches = |name: &str| case.contacts.iter().flat_map(ContactSpec::bodies).any(|body| body == name);
    let mut found = Vec::new();
    for (part, spec) in model.parts.iter().zip(&case.bodies).filter(|(part, _)| touches(&part.name)) {
        let Some(material) = case.material(spec) else { continue };
        let cell = cell_size(part.body.mesh());
        let courant = material.wave_speed(case.plane) * case.time.step / cell;
        if courant > LONG && material.density > 0.0 {
            found.push(Found::of_body(
                &part.name,
                format!(
                    "its Courant number is {0}: a pressure wave crosses {0} cells of size {1} {unit} in a step, and waves shorter than {2} {unit} are not resolved in time",
                    short(courant),
                    short(cell),
                    short(2.0 * std::f64::consts::PI * courant * cell)
                ),
            ));
        }
    }
    found
}

/// Mean size of a cell: its length, or the side of the square of two triangles.
fn cell_size(mesh: &Mesh) -> f64 {
    let count = mesh.cell_count() as f64;
    if mesh.dimension() > 1 {
        return (2.0 * mesh.area() / count).sqrt();
    }
    let places = || mesh.nodes.iter().map(|x| x[0]);
    (places().fold(f64::NEG_INFINITY, f64::max) - places().fold(f64::INFINITY, f64::min)) / count
}
