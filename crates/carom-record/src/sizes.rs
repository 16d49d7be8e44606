//! Sizes of the quantities of a run, beside which values are round-off.

use std::collections::BTreeMap;

use crate::metrics::Unit;
use crate::{History, Run};

/// A value below this share of the size of its quantity is round-off.
const ROUND_OFF: f64 = 1e-12;

/// The largest value of each unit in the history of a run; of stresses, the shear modulus if that
/// is larger; 1 of what has no unit.
#[derive(Clone, Debug)]
pub struct Sizes(BTreeMap<String, f64>);

impl Sizes {
    /// The sizes of a run.
    pub fn of(run: &Run) -> Self {
        Self::in_history(&run.history, modulus(run))
    }

    /// The sizes of the columns of a history, and the modulus of the stresses.
    pub fn in_history(history: &History, modulus: f64) -> Self {
        let mut sizes = BTreeMap::from([(Unit::Stress.label(history), modulus)]);
        for (column, values) in history.columns.iter().zip(&history.values) {
            let size = sizes.entry(column.unit.clone()).or_insert(0.0);
            let finite = values.iter().filter(|x| x.is_finite());
            *size = finite.fold(*size, |most, x| most.max(x.abs()));
        }
        sizes.insert(String::new(), 1.0);
        Self(sizes)
    }

    /// Whether a value of a unit is round-off, and not zero.
    pub fn is_round_off(&self, x: f64, unit: &str) -> bool {
        x != 0.0 && x.abs() < ROUND_OFF * self.0.get(unit).copied().unwrap_or(0.0)
    }
}

/// The largest shear modulus of the materials of a run; zero where the record has none.
pub fn modulus(run: &Run) -> f64 {
    let materials = run.manifest.case.get("materials").and_then(|list| list.as_array());
    let moduli = materials.into_iter().flatten().filter_map(|material| material.get("mu")?.as_f64());
    moduli.fold(0.0, f64::max)
}
