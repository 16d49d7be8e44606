//! Values that are round-off: they are not drawn, because an axis or colours that fit them show
//! nothing else.

use carom_case::MaterialSpec;
use carom_record::{FieldSet, Run, metrics, modulus};

use crate::labels::is_stress;
use crate::recorded::Recorded;

/// A value below this share of the size of its quantity is round-off.
const SHARE: f64 = 1e-10;

/// The largest magnitude of some values.
pub(crate) fn largest<'a>(values: impl IntoIterator<Item = &'a f64>) -> f64 {
    values.into_iter().filter(|x| x.is_finite()).fold(0.0, |most, x| most.max(x.abs()))
}

/// The size of contact forces: the largest resultant, or force at a node. Those of two contacts may
/// cancel.
pub(crate) fn force_size(run: &Run) -> f64 {
    let multipliers = run.contact.iter().map(|row| row.multiplier.abs()).filter(|x| x.is_finite());
    let resultants = metrics::contact_force(run);
    multipliers.chain(resultants).fold(0.0, f64::max)
}

/// Values of an array of a field file up to which it is round-off: stresses compared with the shear
/// modulus, displacements with the size of the bodies, velocities with the speed of shear waves.
pub(crate) fn floor(run: &Recorded, fields: &FieldSet, array: &str) -> f64 {
    let size = match array {
        "displacement" => {
            let span = |axis: usize| {
                let (low, high) = crate::axis::range(fields.points.iter().map(|point| &point[axis]));
                high - low
            };
            (0..3).map(span).fold(0.0, f64::max)
        }
        "velocity" => {
            let speed = |material: &MaterialSpec| (material.mu / material.density).sqrt();
            run.case.materials.iter().map(speed).fold(0.0, f64::max)
        }
        "stress" | "von_mises" | "principal_stress" | "contact_pressure" => modulus(run),
        _ => 1.0,
    };
    SHARE * size
}

/// Whether a column is zero, or round-off of its quantity, throughout: a force compared with
/// [`force_size`], a stress compared with the shear modulus.
pub(crate) fn is_noise(run: &Run, name: &str) -> bool {
    let Some(values) = run.column(name) else { return true };
    let most = largest(values);
    let size = match name.rsplit_once('.') {
        Some((_, quantity)) if is_stress(quantity) => modulus(run),
        None if name.starts_with("contact_force") => force_size(run),
        _ => 0.0,
    };
    most == 0.0 || most < SHARE * size
}
