//! Values that are round-off: they are not drawn, because an axis that fits them shows nothing
//! else.

use carom_case::MaterialSpec;
use carom_record::{Run, metrics};

use crate::labels::is_stress;

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
    let resultants = metrics::contact_force(&run.history);
    multipliers.chain(resultants).fold(0.0, f64::max)
}

/// Whether a column is zero, or round-off of its quantity, throughout: a force compared with
/// [`force_size`], a stress compared with the shear modulus.
pub(crate) fn is_noise(run: &Run, name: &str) -> bool {
    let Some(values) = run.column(name) else { return true };
    let most = largest(values);
    let size = match name.rsplit_once('.') {
        Some((_, quantity)) if is_stress(quantity) => {
            let stored = run.manifest.case.get("materials").cloned().unwrap_or_default();
            let materials: Vec<MaterialSpec> = serde_json::from_value(stored).unwrap_or_default();
            materials.iter().map(|material| material.mu).fold(0.0, f64::max)
        }
        None if name.starts_with("contact_force") => force_size(run),
        _ => 0.0,
    };
    most == 0.0 || most < SHARE * size
}
