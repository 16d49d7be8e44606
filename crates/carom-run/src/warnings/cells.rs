//! Warning about cells that are nearly flat, by their scaled Jacobian (`quality.rs` of
//! `carom-solid`): 1 of an equilateral cell, 0 of a flat one.

use carom_case::Case;
use carom_mechanics::model::Model;

use super::found::{Found, short};

/// Scaled Jacobian below which a cell is doubtful.
const FLAT: f64 = 0.1;

pub(super) fn flat_cell(case: &Case, model: &Model) -> Vec<Found> {
    let unit = &case.units.length;
    let mut found = Vec::new();
    for part in &model.parts {
        let worst = part.body.mesh().worst_cell().filter(|worst| worst.scaled_jacobian < FLAT);
        let Some(worst) = worst else { continue };
        let place: Vec<String> = worst.place.iter().map(|x| short(*x)).collect();
        let what = format!(
            "the scaled Jacobian of its cell at ({}) {unit} is {}",
            place.join(", "),
            short(worst.scaled_jacobian)
        );
        found.push(Found::of_body(&part.name, what));
    }
    found
}
