//! What a run records: probes, rows of history.csv, fields, checkpoints.

use serde::{Deserialize, Serialize};

/// A material point whose quantities are recorded as columns.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ProbeSpec {
    /// Name; columns are `name.quantity`.
    pub name: String,
    /// Reference position.
    pub at: Vec<f64>,
    /// Body it belongs to.
    pub body: String,
    /// Recorded quantities.
    pub record: Vec<Quantity>,
}

/// Measured data of a column, in the units of the case.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct OverlaySpec {
    /// Name in figures and metrics.
    pub name: String,
    /// Name of the file as written.
    pub file: String,
    /// The column of history.csv.
    pub column: String,
    /// Times.
    pub times: Vec<f64>,
    /// Values.
    pub values: Vec<f64>,
    /// Where the data come from.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub source: Option<String>,
}

/// Quantities that a probe can record.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
#[allow(missing_docs)]
pub enum Quantity {
    Ux,
    Uy,
    Uz,
    Vx,
    Vy,
    Vz,
    Ax,
    Ay,
    Az,
    SigmaXx,
    SigmaYy,
    SigmaZz,
    SigmaXy,
    SigmaYz,
    SigmaXz,
    VonMises,
    DetF,
}

impl Quantity {
    /// Names in the order of the quantities.
    pub const NAMES: [&str; 17] = [
        "ux",
        "uy",
        "uz",
        "vx",
        "vy",
        "vz",
        "ax",
        "ay",
        "az",
        "sigma_xx",
        "sigma_yy",
        "sigma_zz",
        "sigma_xy",
        "sigma_yz",
        "sigma_xz",
        "von_mises",
        "det_f",
    ];

    /// Its name in cases and columns.
    pub fn name(self) -> &'static str {
        Self::NAMES[self as usize]
    }
}

/// What is written, and how often.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct OutputSpec {
    /// Steps between two outputs of the fields, 0 for none; without a value, frames are spread over
    /// the run, with more of them while contact is closed.
    pub fields_every: Option<usize>,
    /// Fields are also written at the steps nearest to these times.
    pub at_times: Vec<f64>,
    /// Steps between two rows of history.csv.
    pub history_every: usize,
    /// Steps between two checkpoints.
    pub checkpoint_every: usize,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_of_quantities_are_those_of_cases() {
        for name in Quantity::NAMES {
            let read: Quantity = serde_json::from_value(name.into()).unwrap();
            assert_eq!(read.name(), name);
        }
    }
}
